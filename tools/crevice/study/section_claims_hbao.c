/* SPDX-License-Identifier: MIT */
#include "claims_hbao.h"
#include "sections.h"

static int depth_layers(const horizon_study *h)
{
    crv_options o = h->paper;

    o.directions = 12;
    o.steps = 12;
    page_heading(h->s->page, 3, "hbao-layers", "Depth layers");
    return horizon_layers(h, &o, "2008b, section 3",
                          "More than one depth layer, such as front and back faces, "
                          "improves the picture.");
}

int study_claims_hbao(study *s)
{
    static int (*const PARTS[])(const horizon_study *) = {hbao_speed,    hbao_attenuation,
                                                          hbao_sampling, hbao_jitter,
                                                          hbao_bias,     depth_layers};
    horizon_study h;
    int result;

    page_heading(s->page, 2, "claims-hbao", "Horizon-based ambient occlusion, 2008");
    page_text(
        s->page,
        "Bavoil, Sainz, Dimitrov: Image-Space Horizon-Based Ambient Occlusion. What "
        "the paper states, measured on the view `%s`, radius %.3g, at %dx%d; uniform "
        "weighting and linear falloff as in the paper, one depth layer. Pictures "
        "show the part of the view that varies most.",
        s->main->name, (double)s->main->radius, s->main->width, s->main->height);
    result = horizon_open(s, "hbao", "claims_hbao", &h);
    for (size_t i = 0; result == EXIT_DONE && i < sizeof PARTS / sizeof PARTS[0]; i++)
        result = PARTS[i](&h);
    return result;
}

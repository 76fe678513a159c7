/* SPDX-License-Identifier: MIT */
#include "claims_horizon.h"
#include "sections.h"

int study_claims_hsao(study *s)
{
    static int (*const PARTS[])(const horizon_study *) = {
        hsao_convergence, hsao_cost, hsao_radius, hsao_numbers, hsao_sets, hsao_limits};
    horizon_study h;
    int result;

    page_heading(s->page, 2, "claims-hsao", "Horizon-split ambient occlusion, 2008");
    page_text(
        s->page,
        "Dimitrov, Bavoil, Sainz: Horizon-Split Ambient Occlusion. What the paper "
        "states, measured on the view `%s`, radius %.3g, at %dx%d; cosine weighting "
        "and linear falloff as in the paper, one depth layer, unfiltered unless "
        "noted. Pictures show the part of the view that varies most.",
        s->main->name, (double)s->main->radius, s->main->width, s->main->height);
    result = horizon_open(s, "hsao", "claims_hsao", &h);
    for (size_t i = 0; result == EXIT_DONE && i < sizeof PARTS / sizeof PARTS[0]; i++)
        result = PARTS[i](&h);
    return result;
}

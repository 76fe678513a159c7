/* SPDX-License-Identifier: MIT */
#include "groove_forms.h"

#include <math.h>

#include "closed_forms.h"

/* Draws of the noise for each measurement: with the strip's pixels more than a thousand
 * values, so that an RMS is known to a few percent. */
enum { DRAWS = 2 };

/* Alchemy is run at this part of its strength and its error divided by it: near the wall
 * its sum passes 1, and a result that is clamped says nothing of the sum. */
static const double ALCHEMY_STRENGTH = 0.25;

static const groove_form FORMS[] = {
    {"hbao", CRV_FALLOFF_NONE, "uniform, none", closed_form_uniform_none},
    {"hbao", CRV_FALLOFF_LINEAR, "uniform, linear", closed_form_uniform_linear},
    {"hsao", CRV_FALLOFF_NONE, "cosine, none", closed_form_cosine_none},
    {"hsao", CRV_FALLOFF_LINEAR, "cosine, linear", closed_form_cosine_linear},
    {"raymarch", CRV_FALLOFF_NONE, "cosine, none", closed_form_cosine_none},
    {"raymarch", CRV_FALLOFF_LINEAR, "cosine, linear", closed_form_cosine_linear},
    {"containment", CRV_FALLOFF_NONE, "cosine, none", closed_form_cosine_none},
    {"containment", CRV_FALLOFF_LINEAR, "cosine, linear", closed_form_cosine_linear},
    {"vao", CRV_FALLOFF_LINEAR, "tangent sphere", closed_form_tangent_sphere},
    {"ssao", CRV_FALLOFF_LINEAR, "ball", closed_form_ssao},
    {"alchemy", CRV_FALLOFF_LINEAR, "its own sum", NULL},
    {"vo", CRV_FALLOFF_LINEAR, "open half of the ball", closed_form_vo}};

const groove_form *groove_form_at(int32_t index)
{
    return index >= 0 && (size_t)index < sizeof FORMS / sizeof *FORMS ? &FORMS[index]
                                                                      : NULL;
}

static bool reads(const crv_method *method, const char *key)
{
    return crv_option_applies(crv_option_find(key), method, NULL) != 0;
}

bool groove_form_is_directional(const groove_form *form)
{
    return reads(crv_method_find(form->method), "directions");
}

/* Sets only what the method reads: the library warns of the rest. */
static crv_options options_of(const groove_form *form, const groove_effort *effort)
{
    crv_options o;

    crv_options_init(&o, sizeof o, form->method);
    o.filter = NULL;
    o.radius = 1.0f;
    o.noise_size = 64;
    if (reads(o.method, "falloff"))
        o.falloff = form->falloff;
    if (reads(o.method, "directions"))
        o.directions = effort->directions;
    if (reads(o.method, "steps"))
        o.steps = effort->steps;
    if (reads(o.method, "normal_rays"))
        o.normal_rays = effort->normal_rays;
    if (reads(o.method, "samples"))
        o.samples = effort->samples;
    if (reads(o.method, "bias_deg"))
        o.bias_deg = 0.0f;
    if (reads(o.method, "thickness"))
        o.thickness = 0.0f; /* behind the wall all is solid */
    if (form->occlusion == NULL)
        o.intensity = (float)ALCHEMY_STRENGTH;
    return o;
}

/* What the column's pixels should be. */
static double exact_of(const groove *g, const groove_form *form, const crv_options *o,
                       int32_t column)
{
    double occlusion =
        form->occlusion != NULL
            ? form->occlusion(g->c[column])
            : closed_form_alchemy(g->c[column], GROOVE_DEPTH - g->x[column],
                                  (double)o->alchemy_bias, (double)o->alchemy_eps);

    return 1.0 - (double)o->intensity * occlusion;
}

int groove_measure(study *s, groove *g, const groove_form *form,
                   const groove_effort *effort, groove_error *out)
{
    crv_options o = options_of(form, effort);
    double sum = 0.0, squares = 0.0, count = (double)DRAWS * g->columns * GROOVE_ROWS;

    *out = (groove_error){.lookups = study_samples(&o)};
    for (int32_t draw = 1; draw <= DRAWS; draw++) {
        int code;
        o.seed = draw;
        code = groove_run(s, g, &o);
        if (code != EXIT_DONE)
            return code;
        for (int32_t x = 0; x < g->columns; x++) {
            double exact = exact_of(g, form, &o, x);
            for (int32_t y = 0; y < GROOVE_ROWS; y++) {
                double a = (double)g->accessibility[y * g->columns + x];
                double error = (a - exact) / (double)o.intensity;
                sum += error;
                squares += error * error;
                out->largest = fmax(out->largest, fabs(error));
            }
        }
    }
    out->mean = sum / count;
    out->rms = sqrt(squares / count);
    return EXIT_DONE;
}

/* SPDX-License-Identifier: MIT */
#include "target.h"

#include <stdio.h>
#include <string.h>

#include "exact.h"

const char *const target_weightings[] = {"uniform", "cosine", NULL};
const char *const target_falloffs[] = {"none",        "linear",  "sqrt", "cubic",
                                       "exponential", "alchemy", NULL};

/* Falloffs of the methods that have one of their own. */
static const struct own_falloff {
    const char *method;
    crv_falloff falloff;
} own_falloffs[] = {{"alchemy", CRV_FALLOFF_ALCHEMY},
                    {"vo", CRV_FALLOFF_CUBIC},
                    {"ssao", CRV_FALLOFF_NONE}};

static bool reads(const crv_options *o, const char *key)
{
    return crv_option_applies(crv_option_find(key), o->method, NULL) != 0;
}

static crv_falloff falloff_of(const crv_options *o)
{
    if (reads(o, "falloff"))
        return o->falloff;
    for (size_t i = 0; i < sizeof own_falloffs / sizeof own_falloffs[0]; i++)
        if (strcmp(own_falloffs[i].method, o->method->name) == 0)
            return own_falloffs[i].falloff;
    return CRV_FALLOFF_NONE;
}

reference_options target_of(const crv_options *options)
{
    reference_options o = {
        .weighting =
            reads(options, "weighting") ? options->weighting : options->method->weighting,
        .falloff = falloff_of(options),
        .tau = options->tau,
        .u = options->u,
        .radius = options->radius,
        .thickness = options->thickness,
    };
    /* vao's pipes fill the tangent sphere. */
    if (strcmp(options->method->name, "vao") == 0)
        o.definition = REFERENCE_TANGENT_SPHERE;
    return o;
}

static bool same(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

bool target_equal(const reference_options *a, const reference_options *b)
{
    if (a->definition != b->definition || a->kind != b->kind
        || !same(a->radius, b->radius) || a->normals != b->normals
        || (a->kind == REFERENCE_VISIBLE && !same(a->thickness, b->thickness)))
        return false;
    if (a->definition == REFERENCE_TANGENT_SPHERE)
        return true;
    return a->weighting == b->weighting && a->falloff == b->falloff
           && (a->falloff != CRV_FALLOFF_EXPONENTIAL || same(a->tau, b->tau))
           && (a->falloff != CRV_FALLOFF_ALCHEMY || same(a->u, b->u));
}

const char *target_flags(const reference_options *o, char *out, size_t size)
{
    char number[32];
    int used = snprintf(out, size, " --radius %s", exact_number(o->radius, 1.0, number));
    if (o->definition == REFERENCE_TANGENT_SPHERE) {
        snprintf(out + used, size - (size_t)used, " --definition tangent-sphere");
        return out;
    }
    used += snprintf(out + used, size - (size_t)used, " --weighting %s --falloff %s",
                     target_weightings[o->weighting], target_falloffs[o->falloff]);
    if (o->falloff == CRV_FALLOFF_EXPONENTIAL)
        snprintf(out + used, size - (size_t)used, " --tau %s",
                 exact_number(o->tau, 1.0, number));
    if (o->falloff == CRV_FALLOFF_ALCHEMY)
        snprintf(out + used, size - (size_t)used, " --u %s",
                 exact_number(o->u, 1.0, number));
    return out;
}

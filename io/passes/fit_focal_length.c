/* SPDX-License-Identifier: MIT */
/*
 * fit_focal_length.c: the normals that depth implies lean more, the longer the focal
 * length is taken. They agree with the given ones at the right length only, unless all
 * that is seen faces the camera.
 */
#include <math.h>
#include <stdlib.h>

#include "internal.h"
#include "trial.h"

/* Steps of the focal length: a first look from 150 to 5 degrees, then parts of what is
 * left. */
#define STEP 1.18
enum { STEPS = 28, PARTS = 16 };

/* Degrees. What a tenth more or less must cost, at least, and by how much other lengths
 * must be worse. */
static const double least_rise = 0.1, least_lead = 0.2;

typedef struct search {
    const io__court *c;
    io__trial start;
    float fx_px, fy_px; /* at scale 1 */
    size_t pairs;       /* of the best so far */
} search;

/* The deviation at a focal length; too few pairs are no agreement. */
static int deviation_at(search *s, double scale, io__trial *t, double *deviation)
{
    *t = s->start;
    t->camera.fx_px = s->fx_px * (float)scale;
    t->camera.fy_px = s->fy_px * (float)scale;
    if (io__try(s->c, t))
        return -1;
    const bool enough = t->reading.id && 2 * t->pairs > s->pairs;
    *deviation = enough ? t->reading.deviation : (double)INFINITY;
    s->pairs = t->pairs > s->pairs ? t->pairs : s->pairs;
    return 0;
}

/* Narrows the best scale down between two others, by golden section (Kiefer 1953). */
static int narrow(search *s, double low, double high, double *best)
{
    const double share = 0.5 * (sqrt(5.0) - 1.0);
    double a = log(low), b = log(high), at[2], value[2];
    io__trial t;
    at[0] = b - share * (b - a);
    at[1] = a + share * (b - a);
    for (int k = 0; k < 2; k++)
        if (deviation_at(s, exp(at[k]), &t, &value[k]))
            return -1;
    for (int i = 0; i < PARTS; i++) {
        const int keep = value[0] < value[1] ? 0 : 1;
        *(keep ? &a : &b) = at[1 - keep];
        at[1 - keep] = at[keep];
        value[1 - keep] = value[keep];
        at[keep] = keep ? a + share * (b - a) : b - share * (b - a);
        if (deviation_at(s, exp(at[keep]), &t, &value[keep]))
            return -1;
    }
    *best = exp(0.5 * (a + b));
    return 0;
}

static int refuse(const io__court *c, const char *why)
{
    const char *remedy = c->request->remedies.camera;
    return io__fail(c->log, c->path, "its field of view cannot be found: %s; %s", why,
                    remedy ? remedy : "give it");
}

/* The first look: the index of the smallest deviation, or -1. */
static int look(search *s, double deviations[STEPS])
{
    int best = 0;
    io__trial t;
    for (int i = 0; i < STEPS; i++) {
        if (deviation_at(s, pow(STEP, i), &t, &deviations[i]))
            return -1;
        if (deviations[i] < deviations[best])
            best = i;
    }
    return best;
}

/* NULL if the smallest deviation is that of one focal length alone. */
static const char *doubt(const double deviations[STEPS], int near_by, double smallest,
                         double shorter, double longer)
{
    if (!(smallest < IO__SUSPICIOUS))
        return "normals and depth disagree at any";
    const double rise = fmax(least_rise, 0.05 * smallest);
    if (!(shorter > smallest + rise && longer > smallest + rise))
        return "normals and depth agree as well at others, as of walls that face the "
               "camera";
    for (int i = 0; i < STEPS; i++)
        if (abs(i - near_by) > 1 && deviations[i] < 1.1 * smallest + least_lead)
            return "normals and depth agree about as well at another";
    return NULL;
}

static int fit(search *s, io__trial *t, double beside[2], const char **why)
{
    double deviations[STEPS], scale, smallest;
    const int best = look(s, deviations);
    *why = NULL;
    if (best < 0)
        return -1;
    if (best == 0 || best == STEPS - 1 || !isfinite(deviations[best])) {
        *why = isfinite(deviations[best])
                   ? "normals and depth agree best at the narrowest or widest; an "
                     "orthographic view has a height instead"
                   : "too few pixels are smooth";
        return 0;
    }
    if (narrow(s, pow(STEP, best - 1), pow(STEP, best + 1), &scale)
        || deviation_at(s, 0.9 * scale, t, &beside[0])
        || deviation_at(s, 1.1 * scale, t, &beside[1])
        || deviation_at(s, scale, t, &smallest))
        return -1;
    *why = doubt(deviations, best, smallest, beside[0], beside[1]);
    return 0;
}

static double vfov_deg(const io__court *c, const io__trial *t)
{
    const double height = c->frame->image.display_height / (double)t->camera.fy_px;
    return 2.0 * atan(0.5 * height) * 57.29577951308232;
}

int io__fit_focal_length(const io__court *c, io__trial *t)
{
    /* Twice tan(75 degrees) */
    const float widest = (float)c->frame->image.display_height / 7.464f;
    search s = {.c = c, .start = *t};
    double beside[2];
    const char *why;
    if (!c->has_normals)
        return refuse(c, "it has no normals");
    if (t->camera.projection != CRV_PERSPECTIVE)
        return refuse(c, "it is orthographic");
    s.fy_px = widest;
    s.fx_px = widest * t->camera.fx_px / t->camera.fy_px;
    if (fit(&s, t, beside, &why))
        return -1;
    /* Radial depth needs no number that the file does not hold. */
    if (!c->request->encoding_given && t->format.encoding == CRV_DEPTH_PLANAR
        && (why || t->reading.deviation > IO__DOUBTFUL)) {
        io__trial radial = *t;
        search other = s;
        const char *why_not;
        double beside_it[2];
        other.start.format.encoding = CRV_DEPTH_RADIAL;
        other.pairs = 0;
        if (fit(&other, &radial, beside_it, &why_not))
            return -1;
        if (!why_not && (why || radial.reading.deviation < 0.5 * t->reading.deviation)) {
            *t = radial;
            why = NULL;
            beside[0] = beside_it[0];
            beside[1] = beside_it[1];
            io__warn(c->log, c->path,
                     "depth is read as radial (distance from the eye), which its normals "
                     "fit; %s",
                     c->request->remedies.encoding ? c->request->remedies.encoding
                                                   : "check its encoding");
        }
    }
    if (why)
        return refuse(c, why);
    io__info(
        c->log, c->path,
        "normals and depth agree best at a vertical field of view of %.2f degrees: to "
        "%.2f degrees, and to %.2f and %.2f with focal lengths a tenth shorter and "
        "longer",
        vfov_deg(c, t), t->reading.deviation, beside[0], beside[1]);
    return 0;
}

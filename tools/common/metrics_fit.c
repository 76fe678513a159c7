/* SPDX-License-Identifier: MIT */
/*
 * The best intensity is exact: between the values of s at which pixels become black the
 * squared error is a parabola, and all of them are visited. The power and both together
 * have no closed form: a search over the whole range on at most a thousand groups of
 * alike pixels finds the valley, damped Gauss-Newton steps on all pixels its bottom.
 */
#include "metrics_fit.h"

#include <math.h>
#include <stdlib.h>

enum { GROUPS_MAX = 1024, POWER_STEPS = 64, INTENSITY_STEPS = 48, ITERATIONS_MAX = 60 };

typedef struct sample {
    double dark; /* 1 - A */
    double wanted;
    double weight; /* how many pixels it stands for */
} sample;

typedef struct samples {
    sample *at; /* the darkest first */
    size_t count;
} samples;

/* The sum of squares at a curve, and what a Gauss-Newton step needs there: gradient and
 * Hessian by the logarithms of intensity and power, in which the valley where both make
 * up for each other is straight. */
typedef struct slope {
    double square;
    double gradient[2];
    double hessian[3]; /* ss, sp, pp */
} slope;

static int by_darkness(const void *x, const void *y)
{
    const sample *a = x, *b = y;
    if (a->dark > b->dark || a->dark < b->dark)
        return a->dark > b->dark ? -1 : 1;
    /* Sums must not depend on how qsort() orders equals. */
    return (a->wanted > b->wanted) - (a->wanted < b->wanted);
}

static bool collect(const float *a, const float *b, const uint8_t *mask, size_t count,
                    samples *out)
{
    out->at = malloc((count > 0 ? count : 1) * sizeof *out->at);
    out->count = 0;
    if (!out->at)
        return false;
    for (size_t i = 0; i < count; i++)
        if (!mask || mask[i])
            out->at[out->count++] = (sample){1.0 - (double)a[i], (double)b[i], 1.0};
    return true;
}

static bool gather(const float *a, const float *b, const uint8_t *mask, size_t count,
                   samples *out)
{
    if (!collect(a, b, mask, count, out))
        return false;
    qsort(out->at, out->count, sizeof *out->at, by_darkness);
    return true;
}

/* Means of neighbours in the order of darkness. */
static void group(const samples *all, sample *memory, samples *out)
{
    const size_t count = all->count < GROUPS_MAX ? all->count : GROUPS_MAX;
    *out = (samples){memory, count};
    for (size_t g = 0; g < count; g++) {
        const size_t first = all->count * g / count, end = all->count * (g + 1) / count;
        sample sum = {0.0, 0.0, (double)(end - first)};

        for (size_t i = first; i < end; i++) {
            sum.dark += all->at[i].dark;
            sum.wanted += all->at[i].wanted;
        }
        memory[g] = (sample){sum.dark / sum.weight, sum.wanted / sum.weight, sum.weight};
    }
}

static double square_error(const samples *s, double intensity, double power)
{
    double sum = 0.0;
    for (size_t i = 0; i < s->count; i++) {
        const double open = fmax(0.0, 1.0 - intensity * s->at[i].dark);
        const double error = pow(open, power) - s->at[i].wanted;
        sum += s->at[i].weight * error * error;
    }
    return sum;
}

static slope slope_at(const samples *s, double intensity, double power)
{
    slope out = {0};
    for (size_t i = 0; i < s->count; i++) {
        const sample *p = &s->at[i];
        const double open = 1.0 - intensity * p->dark, n = p->weight;
        double by_intensity = 0.0, by_power = 0.0, value = 0.0;

        if (open > 0.0) {
            const double log_open = log(open);
            value = exp(power * log_open);
            by_intensity = -power * intensity * p->dark * value / open;
            by_power = power * value * log_open;
        }
        const double error = value - p->wanted;
        out.square += n * error * error;
        out.gradient[0] += n * error * by_intensity;
        out.gradient[1] += n * error * by_power;
        out.hessian[0] += n * by_intensity * by_intensity;
        out.hessian[1] += n * by_intensity * by_power;
        out.hessian[2] += n * by_power * by_power;
    }
    return out;
}

static double limited(double value, double factor_log, double low, double high)
{
    return fmin(fmax(value * exp(factor_log), low), high);
}

/* A damped step from a curve, of what may change. If the power comes to an end of its
 * range, the intensity makes the best of that. */
static metrics_curve step(const slope *at, const metrics_curve *from, double damping,
                          unsigned what)
{
    const bool both = what == (METRICS_INTENSITY | METRICS_POWER);
    const double a = at->hessian[0] * (1.0 + damping);
    const double c = at->hessian[2] * (1.0 + damping);
    const double b = both ? at->hessian[1] : 0.0, determinant = a * c - b * b;
    double by_power = 0.0;
    metrics_curve to = *from;
    if (both && determinant > 0.0)
        by_power = -(a * at->gradient[1] - b * at->gradient[0]) / determinant;
    else if ((what & METRICS_POWER) && c > 0.0)
        by_power = -at->gradient[1] / c;
    to.power = limited(from->power, by_power, METRICS_POWER_MIN, METRICS_POWER_MAX);
    if (!(what & METRICS_INTENSITY) || !(a > 0.0))
        return to;
    by_power = log(to.power / from->power);
    to.intensity = limited(from->intensity, -(at->gradient[0] + b * by_power) / a, 0.0,
                           METRICS_INTENSITY_MAX);
    return to;
}

/* Downhill from `curve`, which is never left for a worse one. */
static void descend(const samples *s, unsigned what, metrics_curve *curve)
{
    slope at = slope_at(s, curve->intensity, curve->power);
    double damping = 1e-3;
    for (int i = 0; i < ITERATIONS_MAX && damping < 1e9; i++) {
        metrics_curve to = step(&at, curve, damping, what);
        slope there = slope_at(s, to.intensity, to.power);

        if (!(there.square < at.square)) {
            damping *= 10.0;
            continue;
        }
        const double gain = at.square - there.square;
        *curve = to;
        at = there;
        damping *= 0.1;
        if (gain <= 1e-13 * at.square)
            break;
    }
}

/* The best of a grid that is even in the logarithm of the power and of the intensity. */
static metrics_curve search(const samples *s, bool fixed)
{
    metrics_curve best = {.intensity = 1.0, .power = 1.0};
    double least = square_error(s, 1.0, 1.0);
    for (int i = 0; i <= (fixed ? 0 : INTENSITY_STEPS); i++) {
        const double intensity =
            fixed ? 1.0 : pow(METRICS_INTENSITY_MAX, 2.0 * i / INTENSITY_STEPS - 1.0);
        for (int k = 0; k <= POWER_STEPS; k++) {
            const double power =
                METRICS_POWER_MIN
                * pow(METRICS_POWER_MAX / METRICS_POWER_MIN, (double)k / POWER_STEPS);
            const double square = square_error(s, intensity, power);
            if (square < least) {
                least = square;
                best.intensity = intensity;
                best.power = power;
            }
        }
    }
    return best;
}

/* Between two values of s at which a pixel becomes black, the pixels from m on are not:
 * sum (1 - s u - b)^2 of those, b^2 of the rest. */
static double best_intensity(const samples *s)
{
    double best = 1.0, least = square_error(s, 1.0, 1.0);
    double slope_sum = 0.0, curvature = 0.0, lit = 0.0, black = 0.0;
    for (size_t i = 0; i < s->count; i++)
        black += s->at[i].wanted * s->at[i].wanted;
    least -= 1e-14 * black; /* if s does not matter, rounding shall not choose it */
    for (size_t m = s->count;; m--) {
        if (m < s->count) {
            const sample *p = &s->at[m];
            slope_sum += p->dark * (1.0 - p->wanted);
            curvature += p->dark * p->dark;
            lit += (1.0 - p->wanted) * (1.0 - p->wanted);
            black -= p->wanted * p->wanted;
        }
        const double above = m > 0 ? s->at[m - 1].dark : INFINITY;
        const double below = m < s->count ? s->at[m].dark : 0.0;
        const double low = m == 0 ? 0.0 : above > 0.0 ? 1.0 / above : INFINITY;
        double high = below > 0.0 ? 1.0 / below : METRICS_INTENSITY_MAX;
        high = fmin(high, METRICS_INTENSITY_MAX);
        if (low <= high && curvature > 0.0) {
            const double at = fmin(fmax(slope_sum / curvature, low), high);
            const double square =
                lit - 2.0 * at * slope_sum + at * at * curvature + black;
            if (square < least) {
                least = square;
                best = at;
            }
        }
        if (m == 0)
            return best;
    }
}

static void set_rmse(const samples *s, metrics_curve *curve)
{
    curve->rmse =
        sqrt(square_error(s, curve->intensity, curve->power) / (double)s->count);
}

static void fit(const samples *all, const samples *groups, metrics_fit *out)
{
    out->power = search(groups, true);
    descend(all, METRICS_POWER, &out->power);
    set_rmse(all, &out->power);
    out->intensity = (metrics_curve){.intensity = best_intensity(all), .power = 1.0};
    set_rmse(all, &out->intensity);

    out->both = search(groups, false);
    descend(groups, METRICS_INTENSITY | METRICS_POWER, &out->both);
    set_rmse(all, &out->both);
    /* Groups only stand for the pixels; both is no worse than one alone. */
    if (!(out->both.rmse < out->power.rmse))
        out->both = out->power;
    if (!(out->both.rmse < out->intensity.rmse))
        out->both = out->intensity;
    descend(all, METRICS_INTENSITY | METRICS_POWER, &out->both);
    set_rmse(all, &out->both);
}

bool metrics_fit_curves(const float *a, const float *b, const uint8_t *mask,
                        int32_t width, int32_t height, metrics_fit *out)
{
    const metrics_curve none = {NAN, NAN, NAN};
    sample memory[GROUPS_MAX];
    samples all, groups;
    *out = (metrics_fit){none, none, none};
    if (!gather(a, b, mask, (size_t)width * (size_t)height, &all))
        return false;
    if (all.count > 0) {
        group(&all, memory, &groups);
        fit(&all, &groups, out);
    }
    free(all.at);
    return true;
}

bool metrics_fit_near(const float *a, const float *b, size_t count, unsigned what,
                      metrics_curve *curve)
{
    samples all;
    if (!collect(a, b, NULL, count, &all))
        return false;
    descend(&all, what, curve);
    set_rmse(&all, curve);
    free(all.at);
    return true;
}

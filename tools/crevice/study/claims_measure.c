/* SPDX-License-Identifier: MIT */
#include "claims_measure.h"

#include <math.h>
#include <stdlib.h>

int measure_picture(study *s, study_view *v, const crv_options *options, float **out)
{
    study_estimate estimate = {0};
    int result = study_run(s, v, options, STUDY_ONE_LAYER, 0, &estimate);

    *out = result == EXIT_DONE ? estimate.accessibility : NULL;
    return result;
}

static bool reads(const crv_options *options, const char *key)
{
    return crv_option_applies(crv_option_find(key), options->method, NULL) != 0;
}

/* What a method does not read stays at its default: the library warns of the rest. */
crv_options measure_much(const crv_options *options, int32_t samples)
{
    crv_options much = *options;

    much.filter = NULL;
    much.noise_size = 4;
    if (reads(options, "bands"))
        much.bands = 1;
    if (reads(options, "samples"))
        much.samples = samples;
    if (reads(options, "directions"))
        much.directions = 24;
    /* One step of containment is another estimator, not a coarse one. */
    if (reads(options, "steps") && options->steps > 1)
        much.steps = 24;
    return much;
}

crv_options measure_cubic(const study_view *v, const char *method, int32_t samples)
{
    crv_options o = study_options(v, method, CRV_PRESET_MEDIUM);

    o.filter = NULL;
    o.noise_size = 4;
    o.samples = samples;
    if (reads(&o, "falloff"))
        o.falloff = CRV_FALLOFF_CUBIC;
    if (reads(&o, "steps"))
        o.steps = 1;
    if (reads(&o, "thickness"))
        o.thickness = 0.0f;
    return o;
}

int measure_error(study *s, study_view *v, const crv_options *options, const float *truth,
                  int32_t draws, double *rmse)
{
    double squares = 0.0;

    for (int32_t draw = 0; draw < draws; draw++) {
        crv_options drawn = *options;
        float *picture = NULL;
        metrics m;
        int result;

        drawn.seed = options->seed + draw;
        result = measure_picture(s, v, &drawn, &picture);
        if (result == EXIT_DONE)
            result = study_compare(s, v, picture, truth, &m);
        free(picture);
        if (result != EXIT_DONE)
            return result;
        squares += m.rmse * m.rmse;
    }
    *rmse = sqrt(squares / draws);
    return EXIT_DONE;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static double median(double *values, int32_t count)
{
    qsort(values, (size_t)count, sizeof *values, by_value);
    return count % 2 == 1 ? values[count / 2]
                          : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

static int time_rounds(study *s, study_view *v, const crv_options *options, int32_t count,
                       int32_t rounds, double taken[MEASURE_MAX][MEASURE_MAX])
{
    for (int32_t round = 0; round < rounds; round++) {
        for (int32_t i = 0; i < count; i++) {
            study_estimate estimate = {0};
            int result = study_run(s, v, &options[i], STUDY_ONE_LAYER, 1, &estimate);

            if (result != EXIT_DONE)
                return result;
            taken[i][round] = estimate.ms;
            free(estimate.accessibility);
        }
    }
    return EXIT_DONE;
}

int measure_times(study *s, study_view *v, const crv_options *options, int32_t count,
                  int32_t rounds, double *ms)
{
    double taken[MEASURE_MAX][MEASURE_MAX];
    int result = time_rounds(s, v, options, count, rounds, taken);

    for (int32_t i = 0; i < count && result == EXIT_DONE; i++)
        ms[i] = median(taken[i], rounds);
    return result;
}

int measure_fastest(study *s, study_view *v, const crv_options *options, int32_t count,
                    int32_t rounds, double *ms)
{
    double taken[MEASURE_MAX][MEASURE_MAX];
    int result = time_rounds(s, v, options, count, rounds, taken);

    for (int32_t i = 0; i < count && result == EXIT_DONE; i++) {
        ms[i] = taken[i][0];
        for (int32_t round = 1; round < rounds; round++)
            ms[i] = fmin(ms[i], taken[i][round]);
    }
    return result;
}

int measure_fit(study *s, const study_view *v, const float *picture, const float *linear,
                const float *truth, measure_fitted *out)
{
    metrics m;
    metrics_fit fit;
    int result = study_compare(s, v, picture, truth, &m);

    if (result != EXIT_DONE)
        return result;
    if (!metrics_fit_curves(linear, truth, v->mask, v->width, v->height, &fit))
        return report_no_memory(s->r);
    *out = (measure_fitted){.rmse = m.rmse,
                            .bias = m.bias,
                            .ssim = m.ssim,
                            .intensity = fit.intensity.intensity * (double)MEASURE_LINEAR,
                            .intensity_rmse = fit.intensity.rmse,
                            .fitted_rmse = fit.both.rmse};
    return EXIT_DONE;
}

float measure_at_intensity(double intensity, float linear)
{
    double occlusion = (1.0 - (double)linear) / (double)MEASURE_LINEAR;

    return (float)fmax(0.0, 1.0 - intensity * occlusion);
}

double measure_crossing(const double *x, const double *y, int32_t count, double level)
{
    if (y[0] <= level)
        return y[0] < level ? 0.0 : x[0];
    for (int32_t i = 1; i < count; i++) {
        if (y[i] <= level) {
            double t = log(y[i - 1] / level) / log(y[i - 1] / y[i]);

            return x[i - 1] * pow(x[i] / x[i - 1], t);
        }
    }
    return INFINITY;
}

double measure_slope(const double *x, const double *y, int32_t count)
{
    double mean_x = 0.0, mean_y = 0.0, across = 0.0, along = 0.0;

    for (int32_t i = 0; i < count; i++) {
        mean_x += log(x[i]) / count;
        mean_y += log(y[i]) / count;
    }
    for (int32_t i = 0; i < count; i++) {
        across += (log(x[i]) - mean_x) * (log(y[i]) - mean_y);
        along += (log(x[i]) - mean_x) * (log(x[i]) - mean_x);
    }
    return across / along;
}

void measure_claim(study *s, page_claim claim)
{
    if (claim.verdict != PAGE_PARTLY && claim.verdict != PAGE_FAILS)
        claim.reason = NULL;
    page_claim_box(s->page, &claim);
}

cJSON *measure_object(study *s, cJSON *to, const char *name)
{
    cJSON *object = cJSON_AddObjectToObject(to, name);

    if (object == NULL)
        report_no_memory(s->r);
    return object;
}

bool measure_array(study *s, cJSON *to, const char *name, const double *values,
                   int32_t count)
{
    cJSON *array = cJSON_CreateDoubleArray(values, count);

    if (array != NULL && cJSON_AddItemToObject(to, name, array))
        return true;
    cJSON_Delete(array);
    report_no_memory(s->r);
    return false;
}

/* SPDX-License-Identifier: MIT */
/* claims_measure.h: errors over draws of the noise and times side by side, for the
 * sections on what the papers state. All return an exit code where they can fail. */
#ifndef TOOL_STUDY_CLAIMS_MEASURE_H
#define TOOL_STUDY_CLAIMS_MEASURE_H

#include "plot.h"
#include "study.h"

enum { MEASURE_MAX = 16 };

/* The picture of one run without a time; free() it. */
int measure_picture(study *s, study_view *v, const crv_options *options, float **out);

/* The options with all that their method may spend, unfiltered: what is left of the error
 * is the method's own. samples: n; horizon methods take 24 directions of 24 steps. */
crv_options measure_much(const crv_options *options, int32_t samples);

/* A method that samples points as its paper has it (containment tests the end of a ray
 * alone, against a depth buffer solid without end), unfiltered, a 4x4 tile, with the
 * falloff of vao where it has a choice. */
crv_options measure_cubic(const study_view *v, const char *method, int32_t samples);

/* RMS error against truth over so many draws of the noise. */
int measure_error(study *s, study_view *v, const crv_options *options, const float *truth,
                  int32_t draws, double *rmse);

/* Milliseconds of each of count options (MEASURE_MAX at most), filters included: medians
 * of so many rounds (MEASURE_MAX at most) in which all take their turn, so that whatever
 * else the machine does meets them alike. */
int measure_times(study *s, study_view *v, const crv_options *options, int32_t count,
                  int32_t rounds, double *ms);

/* The shortest instead of the median: steadier on a busy machine, for a search. */
int measure_fastest(study *s, study_view *v, const crv_options *options, int32_t count,
                    int32_t rounds, double *ms);

/* How near a picture comes to a truth, as it is and at its best strength. */
typedef struct measure_fitted {
    double rmse, bias, ssim;          /* as it is */
    double intensity, intensity_rmse; /* with the best intensity */
    double fitted_rmse;               /* with the best intensity and contrast */
} measure_fitted;

/* picture: of intensity 1. linear: the same at MEASURE_LINEAR, where nothing is clamped
 * at 0; a fit of it is one of the option `intensity`. */
#define MEASURE_LINEAR 0.05f
int measure_fit(study *s, const study_view *v, const float *picture, const float *linear,
                const float *truth, measure_fitted *out);

/* The value at an intensity, of that at MEASURE_LINEAR. */
float measure_at_intensity(double intensity, float linear);

/* Where x lies at which a falling curve of count points (x rising, both above 0) reaches
 * y, linear in logarithms; beyond the ends INFINITY and 0. */
double measure_crossing(const double *x, const double *y, int32_t count, double level);

/* The slope of log y over log x by least squares. */
double measure_slope(const double *x, const double *y, int32_t count);

/* Writes the claim's box; its reason only where it does not hold. */
void measure_claim(study *s, page_claim claim);

/* An object that is a member of `to`, or NULL after an error line. */
cJSON *measure_object(study *s, cJSON *to, const char *name);

/* Adds an array; false after an error line. */
bool measure_array(study *s, cJSON *to, const char *name, const double *values,
                   int32_t count);

#endif

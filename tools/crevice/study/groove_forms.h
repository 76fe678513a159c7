/* SPDX-License-Identifier: MIT */
/* groove_forms.h: which closed form each method has in the groove, and how far off it is
 * after how much work. */
#ifndef TOOL_STUDY_GROOVE_FORMS_H
#define TOOL_STUDY_GROOVE_FORMS_H

#include "groove.h"

typedef struct groove_form {
    const char *method;
    crv_falloff falloff;           /* of methods that read one */
    const char *integral;          /* "cosine, linear" */
    double (*occlusion)(double c); /* NULL: alchemy's sum */
} groove_form;

/* Index from 0; NULL beyond the last. */
const groove_form *groove_form_at(int32_t index);

/* Whether the method is refined by directions and steps rather than by samples. */
bool groove_form_is_directional(const groove_form *form);

/* How much work an estimate may do; a method reads what applies to it. */
typedef struct groove_effort {
    int32_t directions, steps, normal_rays, samples;
} groove_effort;

/* Over the strip and a few draws of the noise. */
typedef struct groove_error {
    double lookups; /* for each pixel, at most */
    double rms, mean, largest;
} groove_error;

/* Single pixels, no filter. Returns an exit code. */
int groove_measure(study *s, groove *g, const groove_form *form,
                   const groove_effort *effort, groove_error *out);

#endif

/* SPDX-License-Identifier: MIT */
/* claims_alchemy.h: the parts of the section on McGuire et al. 2011 that have a file of
 * their own. Each writes to the page and to `to`, and returns an exit code. */
#ifndef TOOL_STUDY_CLAIMS_ALCHEMY_H
#define TOOL_STUDY_CLAIMS_ALCHEMY_H

#include "study.h"

/* What the paper's figures take: 12 samples, no bands. */
crv_options claims_twelve_samples(const study_view *v);

/* Figures 8 and 9: time and noise over the radius. band_px: of the run with bands. */
int claims_radius(study *s, float band_px, cJSON *to);

/* Figures 10 and 11: alchemy, vo and hbao at equal time. */
int claims_equal_time(study *s, cJSON *to);

/* Section 2: compositing with several depth samples for each pixel. */
int claims_multisample(study *s, cJSON *to);

/* A byte for each pixel of the view: 1 where a surface lies just behind the outline of
 * another, which is nearer by more than the radius and covers a pixel within half of the
 * projected radius. free() it. */
int claims_silhouettes(study *s, study_view *v, uint8_t **out);

#endif

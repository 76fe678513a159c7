/* SPDX-License-Identifier: MIT */
/* claims_vao.h: the parts of the section on Szirmay-Kalos et al. 2010 that have a file of
 * their own. Each writes to the page and to `to`, and returns an exit code. */
#ifndef TOOL_STUDY_CLAIMS_VAO_H
#define TOOL_STUDY_CLAIMS_VAO_H

#include "study.h"

/* Figures 9 and 10: error over samples, interleaving, the weighted normaliser. */
int claims_samples(study *s, cJSON *to);

/* Figure 12: the height field in the characteristic function. */
int claims_relief(study *s, cJSON *to);

#endif

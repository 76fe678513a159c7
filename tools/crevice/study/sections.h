/* SPDX-License-Identifier: MIT */
/* sections.h: the sections of the page, a file each. Each writes to the page and to
 * s->results and returns an exit code. */
#ifndef TOOL_STUDY_SECTIONS_H
#define TOOL_STUDY_SECTIONS_H

#include "study.h"

/* The views, before all others; and, after them, the references that were traced. */
int study_views_section(study *s);
void study_references_section(study *s);

/* Every method at every preset on every view: pictures, errors, times. */
int study_methods(study *s);

/* What keeps each estimate from the truth: estimator, sampling, filter, missing data. */
int study_missing(study *s);

/* Kernels that move samples a little beside exact ones: error and time of both. */
int study_structure(study *s);

/* What the papers state. */
int study_claims_hsao(study *s);    /* Dimitrov, Bavoil, Sainz 2008 */
int study_claims_hbao(study *s);    /* Bavoil, Sainz, Dimitrov 2008 */
int study_claims_alchemy(study *s); /* McGuire, Osman, Bukowski, Hennessy 2011 */
int study_claims_vao(study *s);     /* Szirmay-Kalos et al. 2010 */

/* How fast the estimates reach the closed forms of a groove. */
int study_closed_forms(study *s);

/* What changes from frame to frame when the camera moves. */
int study_stability(study *s);

#endif

/* SPDX-License-Identifier: MIT */
/* closed_forms_reference.h: the ray-traced reference in the groove. */
#ifndef TOOL_STUDY_CLOSED_FORMS_REFERENCE_H
#define TOOL_STUDY_CLOSED_FORMS_REFERENCE_H

#include "study.h"

/* Measures its error over rays, writes plot and table, and adds to `json` what it found.
 * Returns an exit code. */
int closed_forms_reference(study *s, cJSON *json);

#endif

/* SPDX-License-Identifier: MIT */
/* claims_hbao.h: the parts of the section on the paper of 2008b. Functions return an exit
 * code. */
#ifndef TOOL_STUDY_CLAIMS_HBAO_H
#define TOOL_STUDY_CLAIMS_HBAO_H

#include "claims_horizon.h"

/* Figure 1: speed and error against ray marching. */
int hbao_speed(const horizon_study *h);

/* Equation 3 read literally, and as an integral. */
int hbao_attenuation(const horizon_study *h);

/* Section 3: directions and steps, noise for banding, the tangent's bias. */
int hbao_sampling(const horizon_study *h);
int hbao_jitter(const horizon_study *h);
int hbao_bias(const horizon_study *h);

#endif

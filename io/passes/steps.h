/* SPDX-License-Identifier: MIT */
#ifndef CREVICE_IO_PASSES_STEPS_H
#define CREVICE_IO_PASSES_STEPS_H

#include "passes.h"

/* The number of different depths, 32 to 1024, if they are steps of one size (*size), as
 * 8 bits leave them; else 0. Numbers from `background` on are not looked at. */
int32_t io__depth_steps(const crv_image *depth, float background, float *size);

#endif

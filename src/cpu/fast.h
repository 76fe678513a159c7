/* SPDX-License-Identifier: MIT */
/* The fast structure's memory and tables (kernels/fast.h). */
#ifndef CRV_CPU_FAST_H
#define CRV_CPU_FAST_H

#include "core/setup.h"
#include "cpu/kernels/kernel.h"

typedef struct crv__fast_state crv__fast_state;

/*
 * Takes the memory that runs of this plan need; *state NULL, with CRV_OK, where the plan
 * is better or only computed exactly: the context asks for it; the method has no fast
 * kernel in this instruction set; noise_size is not 1, 2 or 4; more than
 * CRV__FAST_MOST_SAMPLES samples, or 3 layers; or the tables would take more than is left
 * of 48 bytes a pixel, and more than 2 MiB. OUT_OF_MEMORY without a line.
 */
crv_status crv__fast_create(const crv__setup *setup, crv__fast_state **state);
void crv__fast_destroy(const crv__setup *setup, crv__fast_state *state);

/* Makes the state, NULL or not, that of the setup's new options; false, and nothing is
 * changed, if that takes other memory. */
bool crv__fast_update(const crv__setup *setup, crv__fast_state *state);

/* Deals the frame's depth out and brings the tables up to its camera. */
const crv__fast *crv__fast_prepare(crv__fast_state *state, const crv__setup *setup,
                                   const crv__frame *frame);

/* The kernel to run then. */
crv__fast_kernel crv__fast_kernel_of(const crv__fast_state *state);

/* Whether a surface at this depth is in no bucket. */
int crv__fast_is_beyond(const crv__fast *fast, const crv__params *params, float depth);

#endif

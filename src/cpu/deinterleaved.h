/* SPDX-License-Identifier: MIT */
/* The deinterleaved structure's memory and tables (kernels/deinterleaved.h). */
#ifndef CRV_CPU_DEINTERLEAVED_H
#define CRV_CPU_DEINTERLEAVED_H

#include "core/setup.h"
#include "cpu/kernels/kernel.h"

typedef struct crv__deinterleaved_state crv__deinterleaved_state;

/*
 * Takes the memory that runs of this plan need; *state NULL, with CRV_OK, where the plan
 * is better or only computed exactly: the context asks for it; the method has no di
 * kernel in this instruction set; noise_size is not 1, 2 or 4; more than
 * CRV__MOST_SAMPLES samples, or 3 layers; or the tables would take more than is left
 * of 48 bytes a pixel, and more than 2 MiB. OUT_OF_MEMORY without a line.
 */
crv_status crv__deinterleaved_create(const crv__setup *setup,
                                     crv__deinterleaved_state **state);
void crv__deinterleaved_destroy(const crv__setup *setup, crv__deinterleaved_state *state);

/* Makes the state, NULL or not, that of the setup's new options; false, and nothing is
 * changed, if that takes other memory. */
bool crv__deinterleaved_update(const crv__setup *setup, crv__deinterleaved_state *state);

/* Deinterleaves the frame's depth and brings the tables up to its camera. */
const crv__deinterleaved *crv__deinterleaved_prepare(crv__deinterleaved_state *state,
                                                     const crv__setup *setup,
                                                     const crv__frame *frame);

/* The kernel to run then. */
crv__deinterleaved_kernel crv__deinterleaved_kernel_of(
    const crv__deinterleaved_state *state, bool with_bent);

/* Whether a surface at this depth is in no bucket. */
int crv__deinterleaved_is_beyond(const crv__deinterleaved *di, const crv__params *params,
                                 float depth);

#endif

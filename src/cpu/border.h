/* SPDX-License-Identifier: MIT */
/* What deinterleaved kernels read of the buffers' borders (kernels/deinterleaved.h). */
#ifndef CRV_CPU_BORDER_H
#define CRV_CPU_BORDER_H

#include "cpu/kernels/deinterleaved.h"

#include <stddef.h>

/* How many floats that is. */
size_t crv__border_size(const crv__deinterleaved *di);

void crv__border_fill(const crv__deinterleaved *di, const crv__frame *frame);

#endif

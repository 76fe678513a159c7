/* SPDX-License-Identifier: MIT */
/* Which instruction set the kernels are taken from. */
#ifndef CRV_CPU_ISA_H
#define CRV_CPU_ISA_H

#include "core/context.h"
#include "cpu/kernels/kernel.h"

/* Gives the context the kernels of the fastest set that this machine has and the context
 * allows; if there is none, the context keeps the specification. */
void crv__isa_choose(crv_context *context);

#endif

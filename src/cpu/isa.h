/* SPDX-License-Identifier: MIT */
#ifndef CRV_CPU_ISA_H
#define CRV_CPU_ISA_H

#include "core/context.h"
#include "cpu/kernels/kernel.h"

/* The fastest set of kernels that this machine has among the bits of `allowed`; NULL: the
 * scalar specification. */
const crv__kernels *crv__kernels_best(uint32_t allowed);

/* A set's kernel, NULL where it has none. kernels may be NULL. exact: that is rounded as
 * the scalar code. */
crv__estimate_kernel crv__kernels_estimate(const crv__kernels *kernels, const char *name,
                                           int exact);
const crv__fast_kind *crv__kernels_fast(const crv__kernels *kernels, const char *name);
crv__filter_kernel crv__kernels_filter(const crv__kernels *kernels, const char *name);

#endif

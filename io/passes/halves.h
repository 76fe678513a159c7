/* SPDX-License-Identifier: MIT */
/* halves.h: depth that was rounded to half floats. */
#ifndef CREVICE_IO_PASSES_HALVES_H
#define CREVICE_IO_PASSES_HALVES_H

#include <stdbool.h>

#include "crevice/crevice.h"

/*
 * Takes the steps out of distances that hold half floats: each moves by at most half a
 * step of its own, to where surfaces are as flat as that allows. One channel, in place.
 * Returns 0, or -1 if memory is missing.
 */
int io__smooth_halves(const crv_image *depth);

#endif

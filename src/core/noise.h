/* SPDX-License-Identifier: MIT */
#ifndef CRV_CORE_NOISE_H
#define CRV_CORE_NOISE_H

#include "shared/params.h"

/*
 * Fills a size x size tile of rotations alpha in [0, sector_rad), jitters beta in (-1, 1)
 * and sector offsets in [0, 1). The triples are a Hammersley set (bases 2 and 3), so that
 * any size x size window of pixels holds a well-spread sample of all. They are laid out
 * by an ordered-dither matrix where size is a power of two (neighbours differ much) and
 * shuffled otherwise. `seed` shifts the set and its layout. scratch: size * size
 * integers.
 */
void crv__noise_fill(crv__noise_texel *tile, int32_t size, double sector_rad,
                     int32_t seed, uint32_t *scratch);

/*
 * The tile of another frame: every pixel goes on in a low-discrepancy sequence of
 * rotations, jitters and offsets, so that means over frames converge fast. index 0: the
 * tile itself. out may be the tile.
 */
void crv__noise_advance(const crv__noise_texel *tile, int32_t size, double sector_rad,
                        uint32_t index, crv__noise_texel *out);

#endif

/* SPDX-License-Identifier: MIT */
#ifndef CRV_CORE_NOISE_H
#define CRV_CORE_NOISE_H

#include "shared/params.h"

/*
 * Fills a size x size tile of rotations alpha in [0, sector_rad), jitters beta in (-1, 1)
 * and sector offsets in [0, 1). Each is stratified over the tile. Of a size that is a
 * power of two, 4 at least, so is every row and column of a 4x4 block: a filter finds all
 * quarters of each of the three on a line of four pixels, and all pairs of quarters in a
 * block. Other sizes take a Hammersley set (bases 2 and 3), shuffled. `seed` shifts the
 * numbers and their layout. scratch: size * size integers.
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

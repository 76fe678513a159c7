/* SPDX-License-Identifier: MIT */
/* methods/bitmask.c itself, with samples where the deinterleaved structure has them. */
#include "deinterleaved_samples.h"

#define crv__slice_texel_at reference_slice_texel
#define crv__method_bitmask reference_method_bitmask
extern const struct crv__method reference_method_bitmask;
#include "methods/bitmask.c"

float reference_bitmask(const crv__frame *f, int32_t x, int32_t y, float radius_px,
                        crv__vec3 *bent)
{
    return reference_slices_open(f, x, y, radius_px, blocked_share, bent);
}

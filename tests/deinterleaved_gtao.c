/* SPDX-License-Identifier: MIT */
/* methods/gtao.c itself, with samples where the deinterleaved structure has them. */
#include "deinterleaved_samples.h"

#define crv__slice_texel_at reference_slice_texel
#define crv__method_gtao    reference_method_gtao
extern const struct crv__method reference_method_gtao;
#include "methods/gtao.c"

float reference_gtao(const crv__frame *f, int32_t x, int32_t y, float radius_px,
                     crv__vec3 *bent)
{
    return reference_slices_open(f, x, y, radius_px, blocked_share, bent);
}

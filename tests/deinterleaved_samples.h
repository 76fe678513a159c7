/* SPDX-License-Identifier: MIT */
/* Where the deinterleaved structure has samples, and the methods on slices with them. */
#ifndef TESTS_DEINTERLEAVED_SAMPLES_H
#define TESTS_DEINTERLEAVED_SAMPLES_H

#include "methods/slice.h"

/* Where a sample is: of a step in pixels, rounded to the nearest texel and, where it
 * leads 32 pixels to a side or more, to one a multiple of 4 away. */
static inline void reference_texel(float across, float down, float step[2])
{
    step[0] = floorf(across + 0.5f);
    step[1] = floorf(down + 0.5f);
    if (fabsf(step[0]) < 32 && fabsf(step[1]) < 32)
        return;
    step[0] = 4 * rintf(step[0] / 4);
    step[1] = 4 * rintf(step[1] / 4);
}

/* crv__slice_texel_at() with its texel moved. */
static inline bool reference_slice_texel(const crv__params *p,
                                         const crv__slice_site *site,
                                         const crv__slice *slice, int32_t i,
                                         crv__slice_texel *texel)
{
    float step[2];
    if (!crv__slice_texel_at(p, site, slice, i, texel))
        return false;
    const float share = crv__slice_spaced(p, (float)i + slice->jitter);
    const float t = fmaxf(1, share * slice->length_px);
    reference_texel(t * slice->step_x, t * slice->step_y, step);
    texel->u = site->x + (int32_t)step[0];
    texel->v = site->y + (int32_t)step[1];
    return fabsf(step[0]) < CRV_MAX_SIZE && fabsf(step[1]) < CRV_MAX_SIZE;
}

/* crv__slices_open() with slices of another radius' length. */
static inline float reference_slices_open(const crv__frame *f, int32_t x, int32_t y,
                                          float radius_px, crv__slice_fn blocked_share,
                                          crv__vec3 *bent)
{
    crv__slice_site site = crv__slice_site_at(f, x, y);
    site.nearness = radius_px * f->params->inv_radius * f->params->inv_fy;
    return crv__slices_of(f, &site, blocked_share, bent);
}

/* The accessibility of a pixel with this projected radius (vertically), and its bent
 * normal if bent is not NULL. */
float reference_gtao(const crv__frame *f, int32_t x, int32_t y, float radius_px,
                     crv__vec3 *bent);
float reference_bitmask(const crv__frame *f, int32_t x, int32_t y, float radius_px,
                        crv__vec3 *bent);

#endif

/* SPDX-License-Identifier: MIT */
/* pairs.h: given normals beside those that depth implies. */
#ifndef CREVICE_IO_PASSES_PAIRS_H
#define CREVICE_IO_PASSES_PAIRS_H

#include "normal_fit.h"
#include "passes.h"

typedef struct io__pair_list {
    float (*from)[3]; /* given normals, made unit; owned */
    float (*to)[3];   /* implied by depth, view space; owned */
    size_t count, capacity;
} io__pair_list;

/* Pairs at well-spread pixels at which planar depth is smooth; none if memory is missing.
 * io__free_pairs() must follow. */
void io__find_pairs(const crv_image *depth, const crv_camera *camera,
                    const crv_image *normals, io__pair_list *pairs);
void io__free_pairs(io__pair_list *pairs);

/* How much planar depth bends at the pixels that bend least: three in ten implied normals
 * differ by less than this angle, in degrees, from those a hundredth of the picture away.
 * Next to 0 for depth that is what it is taken for and shows walls or floors. -1: too
 * little is seen. */
double io__surface_bend(const crv_image *depth, const crv_camera *camera);

/* How much inverse depth jumps from pixel to pixel, as a share of it, if that is noise
 * and not shape; else 0. */
double io__surface_noise(const crv_image *depth);

/* The distance in pixels between the ones that are looked at. */
int32_t io__sampling_step(const crv_image *image);

double io__length(const float n[3]);
void io__load_normal(const crv_image *image, int32_t x, int32_t y, float n[3]);

#endif

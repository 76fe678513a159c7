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

/* Pairs at well-spread pixels where depth is smooth; none if memory is missing.
 * io__free_pairs() must follow. */
void io__find_pairs(const io_frame *frame, io__pair_list *pairs);
void io__free_pairs(io__pair_list *pairs);

/* The distance in pixels between the ones that are looked at. */
int32_t io__sampling_step(const io_frame *frame);

double io__length(const float n[3]);
void io__load_normal(const crv_image *image, int32_t x, int32_t y, float n[3]);

#endif

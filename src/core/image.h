/* SPDX-License-Identifier: MIT */
/* Checks of the host's images, and the planes in which Crevice keeps its own. */
#ifndef CRV_CORE_IMAGE_H
#define CRV_CORE_IMAGE_H

#include "base/alloc.h"
#include "crevice/image.h"

/* INVALID_ARGUMENT with a line that begins with `what` unless the image has this size and
 * number of channels, strides that are multiples of 4 and, if it is an output, no
 * pixels that overlap. */
crv_status crv__input_check(const crv_logger *logger, const char *what,
                            const crv_const_image *image, int32_t width, int32_t height,
                            int32_t channels);
crv_status crv__output_check(const crv_logger *logger, const char *what,
                             const crv_image *image, int32_t width, int32_t height,
                             int32_t channels);

/* One component of a rectangle of pixels [x0, x0 + width) x [y0, y0 + height); rows are
 * padded to 64 bytes. */
typedef struct crv__plane {
    float *data;
    ptrdiff_t pitch; /* floats from a row to the next */
    int32_t x0, y0, width, height;
} crv__plane;

/* 0 when done, -1 when memory is out. */
int crv__plane_create(crv__plane *plane, const crv_allocator *allocator, int32_t x0,
                      int32_t y0, int32_t width, int32_t height);
void crv__plane_destroy(crv__plane *plane, const crv_allocator *allocator);

static inline float *crv__plane_at(const crv__plane *plane, int32_t x, int32_t y)
{
    return plane->data + (ptrdiff_t)(y - plane->y0) * plane->pitch + (x - plane->x0);
}

static inline int crv__plane_holds(const crv__plane *plane, int32_t x, int32_t y)
{
    return x >= plane->x0 && y >= plane->y0 && x - plane->x0 < plane->width
           && y - plane->y0 < plane->height;
}

/* What a plan computes, over one rectangle. */
typedef struct crv__picture {
    crv__plane accessibility;
    crv__plane bent[3]; /* the bent normal's components; data NULL: there are none */
} crv__picture;

#endif

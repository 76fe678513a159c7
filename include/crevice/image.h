/* SPDX-License-Identifier: MIT */
/*
 * image.h: a view of float pixels that live in the host's memory. Crevice never owns
 * them.
 */
#ifndef CREVICE_IMAGE_H
#define CREVICE_IMAGE_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The largest width and height that Crevice takes. */
#define CRV_MAX_SIZE 32768

/*
 * A rectangle of 32-bit floats with free strides, so that interleaved, planar, padded and
 * bottom-up memory are all described without a copy. Component c of pixel (x, y), row 0
 * on top, is the float at (char *)data + y * row_stride + x * pixel_stride + c *
 * channel_stride Strides are bytes, multiples of 4, and may be negative (a bottom-up
 * image points data at its last row). Different components must not overlap in an image
 * that Crevice writes. An image passed as an input is only read, although data is not
 * const.
 */
typedef struct crv_image {
    float *data;
    int32_t width;    /* px, 1 to CRV_MAX_SIZE */
    int32_t height;   /* px, 1 to CRV_MAX_SIZE */
    int32_t channels; /* 1 (depth, accessibility), 2 (texture coordinates), 3 (normals),
                         or one for each subpixel sample */
    ptrdiff_t row_stride;     /* bytes from a row to the one below */
    ptrdiff_t pixel_stride;   /* bytes from a pixel to the one on its right */
    ptrdiff_t channel_stride; /* bytes from a component to the next */
} crv_image;

/* The view of tightly packed memory: rows without padding, components interleaved (as in
 * float data[height][width][channels]). Checks nothing; the calls that take the image do.
 * Thread-safe. */
CRV_API crv_image crv_image_packed(float *data, int32_t width, int32_t height,
                                   int32_t channels);

/* The address of one component. (x, y, c) must lie inside the image. Thread-safe. */
static inline float *crv_image_at(const crv_image *image, int32_t x, int32_t y, int32_t c)
{
    return (float *)(void *)((char *)(void *)image->data
                             + (ptrdiff_t)y * image->row_stride
                             + (ptrdiff_t)x * image->pixel_stride
                             + (ptrdiff_t)c * image->channel_stride);
}

#ifdef __cplusplus
}
#endif
#endif

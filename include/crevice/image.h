/* SPDX-License-Identifier: MIT */
/*
 * image.h: views of float pixels that live in the host's memory. Crevice never owns or
 * keeps them: every call is done with the pixels when it returns.
 *
 * A view has free strides, so that interleaved, planar, padded and bottom-up memory are
 * all described without a copy. Component c of pixel (x, y), row 0 on top, is the float
 * at
 *
 *     (char *)data + y * row_stride + x * pixel_stride + c * channel_stride
 *
 * Strides are in bytes, multiples of 4, and may be negative (a bottom-up image points
 * data at its last row). data is aligned to 4 bytes.
 *
 * Calls that compute take floats. Convert pixels of other types (half floats, doubles,
 * integers) with crv_image_convert() first.
 *
 * Everything here is thread-safe.
 */
#ifndef CREVICE_IMAGE_H
#define CREVICE_IMAGE_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The largest width and height that Crevice takes. */
#define CRV_MAX_SIZE 32768

/* An image that a call writes. Components must not overlap in memory. */
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

/* An image that a call only reads. Members as in crv_image. Strides of 0 repeat a pixel
 * or a row. */
typedef struct crv_const_image {
    const float *data;
    int32_t width, height, channels;
    ptrdiff_t row_stride, pixel_stride, channel_stride;
} crv_const_image;

/* A view of tightly packed memory: rows without padding, components interleaved, as in
 * float data[height][width][channels]. Checks nothing; the calls that take the image
 * do. */
CRV_API crv_image crv_image_packed(float *data, int32_t width, int32_t height,
                                   int32_t channels);
CRV_API crv_const_image crv_const_image_packed(const float *data, int32_t width,
                                               int32_t height, int32_t channels);

/* A read-only view of the same pixels. */
static inline crv_const_image crv_image_const(crv_image image)
{
    crv_const_image view;
    view.data = image.data;
    view.width = image.width;
    view.height = image.height;
    view.channels = image.channels;
    view.row_stride = image.row_stride;
    view.pixel_stride = image.pixel_stride;
    view.channel_stride = image.channel_stride;
    return view;
}

/* The address of one component. (x, y, c) must lie inside the image. */
static inline float *crv_image_at(const crv_image *image, int32_t x, int32_t y, int32_t c)
{
    return (float *)(void *)((char *)(void *)image->data
                             + (ptrdiff_t)y * image->row_stride
                             + (ptrdiff_t)x * image->pixel_stride
                             + (ptrdiff_t)c * image->channel_stride);
}

static inline const float *crv_const_image_at(const crv_const_image *image, int32_t x,
                                              int32_t y, int32_t c)
{
    return (const float *)(const void *)((const char *)(const void *)image->data
                                         + (ptrdiff_t)y * image->row_stride
                                         + (ptrdiff_t)x * image->pixel_stride
                                         + (ptrdiff_t)c * image->channel_stride);
}

/* The types of pixels that crv_image_convert() and G-buffers take. */
typedef enum crv_texel {
    CRV_TEXEL_FLOAT = 0,
    CRV_TEXEL_DOUBLE = 1,
    CRV_TEXEL_HALF = 2, /* IEEE 754 binary16, as GPUs and EXR files have it */
    CRV_TEXEL_UINT8 = 3,
    CRV_TEXEL_UINT16 = 4,
    CRV_TEXEL_INT16 = 5
} crv_texel;

/* Pixels of another type. Strides are in bytes and need no alignment. A value v becomes
 * v * scale + offset. */
typedef struct crv_texels {
    const void *data;
    crv_texel type;
    int32_t width, height, channels; /* as in crv_image */
    ptrdiff_t row_stride, pixel_stride, channel_stride;
    /* Defaults 1 and 0. Depth buffer of 16 bits: 1 / 65535.0 and 0. Normals of 8 bits:
     * 2 / 255.0 and -1. */
    double scale, offset;
} crv_texels;

/* A view of tightly packed memory: rows without padding, components interleaved. scale 1,
 * offset 0. Checks nothing. */
CRV_API crv_texels crv_texels_packed(const void *data, crv_texel type, int32_t width,
                                     int32_t height, int32_t channels);

/* Writes the pixels as floats to an image of the same size and channels. The two must not
 * share memory. logger: gets the reason for a failure; NULL: nobody. Errors:
 * INVALID_ARGUMENT. */
CRV_API crv_status crv_image_convert(const crv_texels *from, const crv_image *to,
                                     const crv_logger *logger);

#ifdef __cplusplus
}
#endif
#endif

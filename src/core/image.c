/* SPDX-License-Identifier: MIT */
#include "core/image.h"

#include "base/log.h"

#include <stdbool.h>
#include <stdlib.h>

crv_image crv_image_packed(float *data, int32_t width, int32_t height, int32_t channels)
{
    const ptrdiff_t pixel = (ptrdiff_t)channels * (ptrdiff_t)sizeof(float);
    return (crv_image){.data = data,
                       .width = width,
                       .height = height,
                       .channels = channels,
                       .row_stride = (ptrdiff_t)width * pixel,
                       .pixel_stride = pixel,
                       .channel_stride = (ptrdiff_t)sizeof(float)};
}

crv_const_image crv_const_image_packed(const float *data, int32_t width, int32_t height,
                                       int32_t channels)
{
    crv_const_image image =
        crv_image_const(crv_image_packed(NULL, width, height, channels));
    image.data = data;
    return image;
}

/* Whether no two components share memory, for the layouts that occur: each stride, taken
 * from small to large, must step over all that the smaller ones span. */
static bool strides_are_disjoint(const crv_image *image)
{
    struct {
        ptrdiff_t stride;
        ptrdiff_t count;
    } axes[3] = {{image->row_stride, image->height},
                 {image->pixel_stride, image->width},
                 {image->channel_stride, image->channels}};
    ptrdiff_t span = (ptrdiff_t)sizeof(float);
    for (int done = 0; done < 3; done++) {
        int next = -1;
        for (int i = 0; i < 3; i++) {
            if (axes[i].count > 0
                && (next < 0 || llabs(axes[i].stride) < llabs(axes[next].stride)))
                next = i;
        }
        if (axes[next].count > 1) {
            ptrdiff_t stride = (ptrdiff_t)llabs(axes[next].stride);
            if (stride < span)
                return false;
            span += stride * (axes[next].count - 1);
        }
        axes[next].count = 0;
    }
    return true;
}

crv_status crv__input_check(const crv_logger *logger, const char *what,
                            const crv_const_image *image, int32_t width, int32_t height,
                            int32_t channels)
{
    if (!image || !image->data)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "%s: image or its data is NULL; pass a filled image", what);
    if (image->width != width || image->height != height)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "%s: image is %d x %d, expected %d x %d", what, image->width,
                         image->height, width, height);
    if (image->channels != channels)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "%s: image has %d channels, expected %d", what, image->channels,
                         channels);
    const ptrdiff_t unit = (ptrdiff_t)sizeof(float);
    const ptrdiff_t strides[3] = {image->row_stride, image->pixel_stride,
                                  image->channel_stride};
    const int32_t counts[3] = {height, width, channels};
    for (int i = 0; i < 3; i++) {
        const ptrdiff_t limit = PTRDIFF_MAX / 4 / counts[i]; /* three spans fit */
        if (strides[i] % unit != 0 || strides[i] > limit || strides[i] < -limit)
            return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                             "%s: a stride of %td bytes is not a multiple of 4 in range",
                             what, strides[i]);
    }
    if ((uintptr_t)image->data % sizeof(float) != 0)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "%s: data is not aligned to 4 bytes", what);
    return CRV_OK;
}

crv_status crv__output_check(const crv_logger *logger, const char *what,
                             const crv_image *image, int32_t width, int32_t height,
                             int32_t channels)
{
    const crv_const_image view =
        image ? crv_image_const(*image) : (crv_const_image){.data = NULL};
    const crv_status status =
        crv__input_check(logger, what, &view, width, height, channels);
    if (status == CRV_OK && !strides_are_disjoint(image))
        return crv__fail(
            logger, CRV_ERROR_INVALID_ARGUMENT,
            "%s: strides make pixels overlap; an output needs its own memory for "
            "each pixel",
            what);
    return status;
}

int crv__plane_create(crv__plane *plane, const crv_allocator *allocator, int32_t x0,
                      int32_t y0, int32_t width, int32_t height)
{
    const ptrdiff_t unit = CRV__ALIGNMENT / (ptrdiff_t)sizeof(float);
    /* An odd number of cache lines, and none near a multiple of the 64 sets of a first
     * level cache: else the rows of a window, or neighbours along a row and across rows,
     * fall on the same few sets and drive each other out. */
    ptrdiff_t lines = (width + unit - 1) / unit | 1;
    if (lines > 64 && (lines + 3) % 64 < 7)
        lines += 8;
    const ptrdiff_t pitch = lines * unit;
    float *data = crv__allocate(allocator, (size_t)height, (size_t)pitch * sizeof(float));
    if (!data)
        return -1;
    *plane = (crv__plane){data, pitch, x0, y0, width, height};
    return 0;
}

void crv__plane_destroy(crv__plane *plane, const crv_allocator *allocator)
{
    crv__release(allocator, plane->data, (size_t)plane->height,
                 (size_t)plane->pitch * sizeof(float));
    *plane = (crv__plane){0};
}

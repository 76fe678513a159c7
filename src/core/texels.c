/* SPDX-License-Identifier: MIT */
/* Pixels of other types than float, converted to it. */
#include "core/gbuffer.h"

#include "base/log.h"

#include <math.h>
#include <string.h>

static size_t size_of(crv_texel type)
{
    static const size_t SIZES[] = {
        [CRV_TEXEL_FLOAT] = 4, [CRV_TEXEL_DOUBLE] = 8, [CRV_TEXEL_HALF] = 2,
        [CRV_TEXEL_UINT8] = 1, [CRV_TEXEL_UINT16] = 2, [CRV_TEXEL_INT16] = 2};
    return (size_t)type < sizeof SIZES / sizeof SIZES[0] ? SIZES[type] : 0;
}

/* IEEE 754 binary16: a sign, 5 bits of exponent, 10 of fraction. */
static double half_value(uint16_t bits)
{
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    double value = ldexp(fraction, -24);
    if (exponent == 31)
        value = fraction ? (double)NAN : (double)INFINITY;
    else if (exponent > 0)
        value = ldexp(1024 + fraction, exponent - 25);
    return bits >> 15 ? -value : value;
}

#define LOAD(type) (memcpy(&(type##_value), from, sizeof type##_value), type##_value)

static double load(crv_texel type, const void *from)
{
    float float_value;
    double double_value;
    uint8_t uint8_value;
    uint16_t uint16_value;
    int16_t int16_value;
    switch (type) {
    case CRV_TEXEL_FLOAT:
        return (double)LOAD(float);
    case CRV_TEXEL_DOUBLE:
        return LOAD(double);
    case CRV_TEXEL_HALF:
        return half_value(LOAD(uint16));
    case CRV_TEXEL_UINT8:
        return LOAD(uint8);
    case CRV_TEXEL_UINT16:
        return LOAD(uint16);
    case CRV_TEXEL_INT16:
        return LOAD(int16);
    }
    return (double)NAN;
}

crv_texels crv_texels_packed(const void *data, crv_texel type, int32_t width,
                             int32_t height, int32_t channels)
{
    const ptrdiff_t size = (ptrdiff_t)size_of(type);
    return (crv_texels){.data = data,
                        .type = type,
                        .width = width,
                        .height = height,
                        .channels = channels,
                        .row_stride = size * channels * width,
                        .pixel_stride = size * channels,
                        .channel_stride = size,
                        .scale = 1};
}

crv_texels crv__texels_of(const crv_const_image *image)
{
    return (crv_texels){.data = image->data,
                        .type = CRV_TEXEL_FLOAT,
                        .width = image->width,
                        .height = image->height,
                        .channels = image->channels,
                        .row_stride = image->row_stride,
                        .pixel_stride = image->pixel_stride,
                        .channel_stride = image->channel_stride,
                        .scale = 1};
}

crv__texel_row crv__texels_row(const crv_texels *texels, int32_t y)
{
    return (crv__texel_row){.at = (const char *)texels->data + y * texels->row_stride,
                            .type = texels->type,
                            .stride = texels->pixel_stride,
                            .channel = texels->channel_stride,
                            .scale = (float)texels->scale,
                            .offset = (float)texels->offset};
}

float crv__texel_at(const crv__texel_row *row, int32_t x, int32_t channel)
{
    const float v = (float)load(row->type, (const char *)row->at + x * row->stride
                                               + channel * row->channel);
    return row->scale == 1 && row->offset == 0 ? v : v * row->scale + row->offset;
}

crv_status crv__texels_check(const crv_logger *logger, const char *what,
                             const crv_texels *texels, int32_t width, int32_t height,
                             int32_t channels)
{
    if (!texels || !texels->data || size_of(texels->type) == 0)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "%s: texels are NULL, without data or of an unknown type; begin "
                         "with crv_texels_packed()",
                         what);
    if (texels->width != width || texels->height != height
        || texels->channels != channels)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "%s: texels are %d x %d with %d channels, expected %d x %d with "
                         "%d",
                         what, texels->width, texels->height, texels->channels, width,
                         height, channels);
    if (!isfinite((float)texels->scale) || !isfinite((float)texels->offset))
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "%s: scale %g or offset %g does not fit a float; without them "
                         "they are 1 and 0",
                         what, texels->scale, texels->offset);
    return CRV_OK;
}

crv_status crv_image_convert(const crv_texels *from, const crv_image *to,
                             const crv_logger *logger)
{
    if (!from || !from->data || size_of(from->type) == 0)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "texels: NULL, without data or of an unknown type; begin with "
                         "crv_texels_packed()");
    if (from->width < 1 || from->height < 1 || from->channels < 1
        || from->width > CRV_MAX_SIZE || from->height > CRV_MAX_SIZE)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "texels: %d x %d with %d channels; width and height are from 1 "
                         "to %d",
                         from->width, from->height, from->channels, CRV_MAX_SIZE);
    const crv_status status = crv__output_check(logger, "texels", to, from->width,
                                                from->height, from->channels);
    if (status)
        return status;
    for (int32_t y = 0; y < from->height; y++) {
        for (int32_t x = 0; x < from->width; x++) {
            for (int32_t c = 0; c < from->channels; c++) {
                const char *at = (const char *)from->data + y * from->row_stride
                                 + x * from->pixel_stride + c * from->channel_stride;
                const double value = load(from->type, at);
                *crv_image_at(to, x, y, c) = (float)(value * from->scale + from->offset);
            }
        }
    }
    return CRV_OK;
}

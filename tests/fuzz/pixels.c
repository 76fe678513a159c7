/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include <string.h>

static ptrdiff_t magnitude(ptrdiff_t value)
{
    return value < 0 ? -value : value;
}

fuzz_pixels fuzz_make_pixels(fuzz_bytes *in, int32_t width, int32_t height,
                             int32_t channels)
{
    const uint32_t shape = fuzz_byte(in);
    const ptrdiff_t float_size = shape & 1 ? 8 : 4, padding = (ptrdiff_t)(shape >> 4) * 4;
    const bool planar = (shape & 2) != 0, bottom_up = (shape & 4) != 0;
    fuzz_pixels p = {.image = {.width = width, .height = height, .channels = channels}};
    crv_image *i = &p.image;
    i->pixel_stride = planar ? float_size : float_size * channels;
    i->row_stride = i->pixel_stride * width + padding;
    i->channel_stride = planar ? i->row_stride * height : float_size;
    const size_t size =
        (size_t)((height - 1) * i->row_stride + (width - 1) * i->pixel_stride
                 + (channels - 1) * i->channel_stride + 4);
    p.block = malloc(size);
    memset(p.block, 0x7f, size);
    i->data = (float *)(void *)p.block;
    if (bottom_up) {
        i->data = (float *)(void *)(p.block + (height - 1) * i->row_stride);
        i->row_stride = -i->row_stride;
    }
    return p;
}

fuzz_pixels fuzz_fill_pixels(fuzz_bytes *in, int32_t width, int32_t height,
                             int32_t channels, float usual)
{
    fuzz_pixels p = fuzz_make_pixels(in, width, height, channels);
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++)
            for (int32_t c = 0; c < channels; c++)
                *crv_image_at(&p.image, x, y, c) =
                    in->left ? fuzz_float(in, usual)
                             : usual + 0.1f * (float)((x ^ y) % 5);
    return p;
}

void fuzz_spoil(fuzz_bytes *in, crv_image *image)
{
    switch (fuzz_byte(in) % 32) {
    case 0:
        image->width = fuzz_int(in, 64);
        break;
    case 1:
        image->height = fuzz_int(in, 64);
        break;
    case 2:
        image->channels = fuzz_int(in, 4);
        break;
    case 3:
        image->row_stride += 2;
        break;
    case 4:
        image->data = NULL;
        break;
    case 5:
        image->pixel_stride = 0;
        break;
    case 6:
        image->row_stride = 0;
        break;
    case 7:
        image->channel_stride = PTRDIFF_MAX;
        break;
    default:
        break;
    }
}

fuzz_texels fuzz_make_texels(fuzz_bytes *in, int32_t width, int32_t height,
                             int32_t channels)
{
    static const ptrdiff_t sizes[] = {4, 8, 2, 1, 2, 2};
    const uint32_t shape = fuzz_byte(in), type = fuzz_byte(in) % 6;
    fuzz_texels t = {
        .texels = crv_texels_packed(NULL, (crv_texel)type, width, height, channels)};
    crv_texels *of = &t.texels;
    of->pixel_stride += shape & 3;
    of->row_stride = of->pixel_stride * width + (shape >> 2 & 3);
    if (shape & 16)
        of->row_stride = -of->row_stride;
    const ptrdiff_t row = magnitude(of->row_stride) * (height - 1);
    const size_t size = (size_t)(row + of->pixel_stride * (width - 1)
                                 + of->channel_stride * (channels - 1) + sizes[type]);
    t.block = malloc(size);
    for (size_t i = 0; i < size; i++)
        t.block[i] = (char)(in->left ? fuzz_byte(in) : 0x3c + i % 3);
    of->data = t.block + (of->row_stride < 0 ? row : 0);
    if (shape & 32) {
        of->scale = (double)fuzz_float(in, 0.1f);
        of->offset = (double)fuzz_float(in, 1.0f);
    }
    if (fuzz_seldom(in, 32))
        of->type = (crv_texel)(6 + fuzz_byte(in)); /* no such type */
    if (fuzz_seldom(in, 32))
        of->data = NULL;
    return t;
}

void fuzz_check_pixels(const crv_image *image, float least, float most, const char *what)
{
    for (int32_t y = 0; y < image->height; y++)
        for (int32_t x = 0; x < image->width; x++)
            for (int32_t c = 0; c < image->channels; c++) {
                const float value = *crv_image_at(image, x, y, c);
                FUZZ_CHECK(value >= least && value <= most, "%s: %g at %d, %d", what,
                           (double)value, x, y);
            }
}

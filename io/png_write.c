/* SPDX-License-Identifier: MIT */
/* png_write.c: grey or RGB PNG of 8 or 16 bits, linear or with the sRGB curve. */
#include <errno.h>
#include <math.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "png_io.h"

typedef struct writer {
    io__output *output;
    const io_image *image;
    png_structp png;
    png_infop info;
    int channels, bits;
    int32_t index[3];
    bool srgb;
    unsigned char *row; /* owned */
    io__png_message message;
} writer;

/* The curve of IEC 61966-2-1. */
static float encode_srgb(float v)
{
    return v <= 0.0031308f ? 12.92f * v : 1.055f * powf(v, 1.0f / 2.4f) - 0.055f;
}

unsigned io_quantise(float value, bool srgb, unsigned largest)
{
    if (!(value > 0.0f)) /* NaN too */
        return 0;
    const float clamped = value < 1.0f ? value : 1.0f;
    const float curved = srgb ? encode_srgb(clamped) : clamped;
    return (unsigned)(curved * (float)largest + 0.5f);
}

static void fill_row(const writer *w, int32_t y)
{
    const size_t channels = (size_t)w->channels;
    const size_t first = (size_t)y * (size_t)w->image->width;
    for (size_t i = 0; i < (size_t)w->image->width * channels; i++) {
        const io_channel *channel = &w->image->channels[w->index[i % channels]];
        const float value = channel->data[first + i / channels];
        if (w->bits == 16) {
            const unsigned q = io_quantise(value, w->srgb, 65535);
            w->row[2 * i] = (unsigned char)(q >> 8);
            w->row[2 * i + 1] = (unsigned char)(q & 255u);
        } else {
            w->row[i] = (unsigned char)io_quantise(value, w->srgb, 255);
        }
    }
}

static void write_bytes(png_structp png, png_bytep bytes, size_t size)
{
    if (io__write(png_get_io_ptr(png), bytes, size) != size)
        png_error(png, strerror(errno));
}

/* io__output_commit() does. */
static void flush_nothing(png_structp png)
{
    (void)png;
}

static int write_all(writer *w)
{
    errno = 0;
    if (setjmp(png_jmpbuf(w->png)))
        return errno || ferror(w->output->file.stream)
                   ? io__output_fail(w->output)
                   : io__fail(w->output->log, w->output->path,
                              "libpng cannot write it (%s); try .exr", w->message.text);
    png_set_write_fn(w->png, w->output->file.stream, write_bytes, flush_nothing);
    png_set_user_limits(w->png, CRV_MAX_SIZE, CRV_MAX_SIZE);
    png_set_IHDR(
        w->png, w->info, (png_uint_32)w->image->width, (png_uint_32)w->image->height,
        w->bits, w->channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY,
        PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    /* Nothing is said about linear pictures: a gamma of 1 would make viewers brighten
     * accessibility, which is data and not light. */
    if (w->srgb)
        png_set_sRGB_gAMA_and_cHRM(w->png, w->info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (w->image->made[0]) {
        char key[] = "crevice";
        png_text text = {.compression = PNG_TEXT_COMPRESSION_NONE,
                         .key = key,
                         .text = (png_charp)(uintptr_t)w->image->made,
                         .text_length = strlen(w->image->made)};
        png_set_text(w->png, w->info, &text, 1);
    }
    png_write_info(w->png, w->info);
    for (int32_t y = 0; y < w->image->height; y++) {
        if (io__output_stops(w->output))
            return io__output_stopped(w->output);
        fill_row(w, y);
        png_write_row(w->png, w->row);
        io__tell(w->output->watch, y + 1, w->image->height);
    }
    png_write_end(w->png, NULL);
    return 0;
}

int io__png_write(io__output *output, const io_image *image,
                  const io_write_options *options)
{
    writer w = {.output = output,
                .image = image,
                .bits = options->bits ? options->bits : 8,
                .srgb = options->srgb};
    if (w.bits != 8 && w.bits != 16)
        return io__fail(output->log, output->path, "PNG with %d bits; choose 8 or 16",
                        w.bits);
    w.channels = io__colour_channels(image, w.index, output->path, "PNG", output->log);
    if (w.channels < 0)
        return -1;
    w.row = malloc((size_t)image->width * (size_t)w.channels * (size_t)(w.bits / 8));
    w.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &w.message, io__png_error,
                                    io__png_warning);
    w.info = w.png ? png_create_info_struct(w.png) : NULL;
    const int result = w.row && w.info ? write_all(&w)
                                       : io__fail(output->log, output->path,
                                                  "no memory; close other programs");
    png_destroy_write_struct(&w.png, &w.info);
    free(w.row);
    return result;
}

/* SPDX-License-Identifier: MIT */
/*
 * pfm.c: portable float maps: "Pf" (grey) or "PF" (colour), width, height, a scale whose
 * sign tells the byte order (negative: little-endian), then rows from bottom to top.
 */
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

typedef struct pfm_header {
    int32_t width, height, channels;
    bool little_endian;
} pfm_header;

static bool recognises_pfm(const unsigned char *head, size_t size)
{
    return size >= 3 && head[0] == 'P' && (head[1] == 'f' || head[1] == 'F')
           && isspace(head[2]);
}

/* Reads a word and the single white space after it. */
static bool read_word(FILE *stream, char *out, size_t size)
{
    size_t used = 0;
    int c = getc(stream);
    while (c != EOF && isspace(c))
        c = getc(stream);
    while (c != EOF && !isspace(c) && used + 1 < size) {
        out[used++] = (char)c;
        c = getc(stream);
    }
    out[used] = '\0';
    return used > 0 && c != EOF && isspace(c);
}

static bool parse_size(const char *word, int64_t *out)
{
    char *end = NULL;
    errno = 0;
    *out = strtoll(word, &end, 10);
    return *end == '\0' && errno == 0;
}

static int read_header(const io__file *file, pfm_header *header)
{
    char magic[8], width[24], height[24], scale[48];
    int64_t w = 0, h = 0;
    char *end = NULL;
    if (!read_word(file->stream, magic, sizeof magic)
        || !read_word(file->stream, width, sizeof width)
        || !read_word(file->stream, height, sizeof height)
        || !read_word(file->stream, scale, sizeof scale) || !parse_size(width, &w)
        || !parse_size(height, &h))
        return io__fail(file->log, file->path,
                        "its PFM header is damaged or cut off; write it again");
    const double factor = strtod(scale, &end);
    if (*end || !isfinite(factor) || factor == 0.0)
        return io__fail(file->log, file->path,
                        "the scale in its PFM header is \"%s\"; write -1 or 1", scale);
    if (io__check_size(file->log, file->path, w, h))
        return -1;
    *header = (pfm_header){.width = (int32_t)w,
                           .height = (int32_t)h,
                           .channels = magic[1] == 'F' ? 3 : 1,
                           .little_endian = factor < 0.0};
    const int64_t needed = w * h * header->channels * (int64_t)sizeof(float);
    const int64_t rest = file->size - (int64_t)ftell(file->stream);
    if (rest < needed)
        return io__fail(file->log, file->path,
                        "is cut off: %lld of %lld bytes are missing; write it again",
                        (long long)(needed - rest), (long long)needed);
    return 0;
}

static float load_float(const unsigned char b[4], bool little_endian)
{
    const uint32_t bits =
        little_endian
            ? (uint32_t)b[3] << 24 | (uint32_t)b[2] << 16 | (uint32_t)b[1] << 8 | b[0]
            : (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void store_float(float value, unsigned char b[4])
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++)
        b[i] = (unsigned char)(bits >> (8 * i) & 255u);
}

static int read_rows(const io__file *file, const pfm_header *header, io_image *image)
{
    const size_t width = (size_t)header->width, channels = (size_t)header->channels;
    unsigned char *row = malloc(width * channels * 4);
    if (!row)
        return io__fail(file->log, file->path, "no memory; close other programs");
    int result = 0;
    for (int32_t y = header->height - 1; !result && y >= 0; y--) {
        if (io__read(file->stream, row, width * channels * 4) != width * channels * 4)
            result = io__fail(file->log, file->path,
                              "cannot be read (%s); copy it to another disk",
                              errno ? strerror(errno) : "it was cut off");
        for (size_t i = 0; !result && i < width * channels; i++)
            image->channels[i % channels].data[(size_t)y * width + i / channels] =
                load_float(row + 4 * i, header->little_endian);
        io__tell(file->watch, header->height - y, header->height);
    }
    free(row);
    return result;
}

static int read_pfm(const io__file *file, const char *const *names, int32_t count,
                    io_image *out)
{
    pfm_header header;
    io_image all = {0};
    if (read_header(file, &header)
        || io__image_init_colour(&all, header.width, header.height, header.channels,
                                 file))
        return -1;
    if (read_rows(file, &header, &all)) {
        io_image_free(&all);
        return -1;
    }
    return io__select_channels(file, &all, names, count, out);
}

static int probe_pfm(const io__file *file, io_image *out)
{
    pfm_header header;
    if (read_header(file, &header))
        return -1;
    return io__probe_colour(file, header.width, header.height, header.channels, out);
}

static int write_rows(io__output *output, const io_image *image, const int32_t *index,
                      size_t channels)
{
    const size_t width = (size_t)image->width;
    unsigned char *row = malloc(width * channels * 4);
    if (!row)
        return io__fail(output->log, output->path, "no memory; close other programs");
    int result = 0;
    for (int32_t y = image->height - 1; !result && y >= 0; y--) {
        for (size_t i = 0; i < width * channels; i++) {
            const io_channel *channel = &image->channels[index[i % channels]];
            store_float(channel->data[(size_t)y * width + i / channels], row + 4 * i);
        }
        if (io__write(output->file.stream, row, width * channels * 4)
            != width * channels * 4)
            result = io__output_fail(output);
        else if (io__output_stops(output))
            result = io__output_stopped(output);
        io__tell(output->watch, image->height - y, image->height);
    }
    free(row);
    return result;
}

static int write_pfm(io__output *output, const io_image *image,
                     const io_write_options *options)
{
    int32_t index[3] = {0};
    (void)options;
    const int channels =
        io__colour_channels(image, index, output->path, "PFM", output->log);
    if (channels < 0)
        return -1;
    if (fprintf(output->file.stream, "%s\n%d %d\n-1.0\n", channels == 3 ? "PF" : "Pf",
                (int)image->width, (int)image->height)
        < 0)
        return io__output_fail(output);
    return write_rows(output, image, index, (size_t)channels);
}

const io__format io__format_pfm = {.name = "a PFM file",
                                   .extension = ".pfm",
                                   .recognises = recognises_pfm,
                                   .probe = probe_pfm,
                                   .read = read_pfm,
                                   .write = write_pfm};

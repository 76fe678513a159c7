/* SPDX-License-Identifier: MIT */
/* png_read.c: PNG of 1 to 16 bits, palettes expanded, to [0, 1]; the format's row. */
#include <errno.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "png_io.h"

/* Deflate packs at most 1032 to 1, and each row takes at least a byte more. */
enum { MAX_RATIO = 1100 };

typedef struct reader {
    const io__file *file;
    png_structp png;
    png_infop info;
    int32_t width, height, channels, bytes, passes;
    size_t stored_row_bytes, row_bytes; /* in the file, and expanded */
    unsigned char *pixels;              /* owned */
    png_bytep *rows;                    /* owned */
    int io_error;                       /* errno of a failed read */
    io__png_message message;
} reader;

void io__png_error(png_structp png, png_const_charp text)
{
    io__png_message *message = png_get_error_ptr(png);
    snprintf(message->text, sizeof message->text, "%s", text);
    png_longjmp(png, 1);
}

/* libpng warns of colour profiles and the like, which do not matter here. */
void io__png_warning(png_structp png, png_const_charp text)
{
    (void)png;
    (void)text;
}

static void read_bytes(png_structp png, png_bytep bytes, size_t size)
{
    reader *r = png_get_io_ptr(png);
    if (io__read(r->file->stream, bytes, size) == size)
        return;
    r->io_error = errno;
    png_error(png, "it ends in the middle");
}

static int damaged(const reader *r)
{
    if (r->io_error)
        return io__fail(r->file->log, r->file->path,
                        "cannot be read (%s); copy it to another disk",
                        strerror(r->io_error));
    return io__fail(r->file->log, r->file->path,
                    "is a damaged or cut off PNG (%s); write it again",
                    r->message.text[0] ? r->message.text : "libpng gives no reason");
}

static void close_reader(reader *r)
{
    png_destroy_read_struct(&r->png, &r->info, NULL);
    free(r->pixels);
    free(r->rows);
}

/* Reads the header and asks for grey or colour with 8 or 16 bits a sample. */
static int read_header(reader *r)
{
    if (setjmp(png_jmpbuf(r->png)))
        return damaged(r);
    png_set_read_fn(r->png, r, read_bytes);
    png_set_user_limits(r->png, 0x7fffffff, 0x7fffffff);
    png_read_info(r->png, r->info);
    const int64_t width = png_get_image_width(r->png, r->info);
    const int64_t height = png_get_image_height(r->png, r->info);
    if (io__check_size(r->file->log, r->file->path, width, height))
        return -1;
    r->stored_row_bytes = png_get_rowbytes(r->png, r->info);
    png_set_expand(r->png);
    if (png_get_bit_depth(r->png, r->info) == 16) {
        const uint16_t probe = 1;
        unsigned char low;
        memcpy(&low, &probe, 1);
        if (low == 1) /* PNG is big-endian, this machine is not */
            png_set_swap(r->png);
    }
    r->passes = png_set_interlace_handling(r->png);
    png_read_update_info(r->png, r->info);
    r->width = (int32_t)width;
    r->height = (int32_t)height;
    r->channels = png_get_channels(r->png, r->info);
    r->bytes = png_get_bit_depth(r->png, r->info) / 8;
    r->row_bytes = png_get_rowbytes(r->png, r->info);
    return 0;
}

/* Texts that stand before the pixels. */
static void find_made(const reader *r, char made[IO_MADE_SIZE])
{
    png_textp texts = NULL;
    int count = 0;
    png_get_text(r->png, r->info, &texts, &count);
    for (int i = 0; i < count; i++)
        if (!strcmp(texts[i].key, "crevice"))
            snprintf(made, IO_MADE_SIZE, "%s", texts[i].text);
}

/* libpng takes the memory that a chunk announces before it reads the chunk: each must fit
 * in the file. (PNG specification, 5.3: length, type, data, CRC.) */
static int check_chunks(reader *r)
{
    unsigned char head[8];
    for (uint64_t at = 8; at < (uint64_t)r->file->size;) {
        const int64_t got = file_read_at(r->file->stream, head, sizeof head, at);
        r->io_error = got < 0 ? errno : 0;
        if (got < (int64_t)sizeof head)
            break;
        at += 12
              + ((uint64_t)head[0] << 24 | (uint64_t)head[1] << 16
                 | (uint64_t)head[2] << 8 | head[3]);
        if (at > (uint64_t)r->file->size)
            break;
        if (!memcmp(head + 4, "IEND", 4))
            return 0;
    }
    snprintf(r->message.text, sizeof r->message.text, "it ends in the middle");
    return damaged(r);
}

static int open_reader(const io__file *file, reader *r)
{
    memset(r, 0, sizeof *r);
    r->file = file;
    if (check_chunks(r))
        return -1;
    r->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &r->message, io__png_error,
                                    io__png_warning);
    r->info = r->png ? png_create_info_struct(r->png) : NULL;
    if (!r->info) {
        close_reader(r);
        return io__fail(file->log, file->path, "no memory; close other programs");
    }
    if (read_header(r)) {
        close_reader(r);
        return -1;
    }
    return 0;
}

static int allocate_rows(reader *r)
{
    const size_t height = (size_t)r->height;
    if ((uint64_t)r->stored_row_bytes * height / MAX_RATIO > (uint64_t)r->file->size) {
        snprintf(r->message.text, sizeof r->message.text, "too short for its size");
        return damaged(r);
    }
    r->rows = calloc(height, sizeof *r->rows);
    r->pixels = calloc(height, r->row_bytes);
    if (!r->rows || !r->pixels)
        return io__fail(r->file->log, r->file->path,
                        "no memory for %d x %d pixels; use a smaller picture",
                        (int)r->width, (int)r->height);
    for (size_t y = 0; y < height; y++)
        r->rows[y] = r->pixels + y * r->row_bytes;
    return 0;
}

static void tell_row(png_structp png, png_uint_32 row, int pass)
{
    const reader *r = png_get_io_ptr(png);
    io__tell(r->file->watch, (int64_t)pass * r->height + row,
             (int64_t)r->passes * r->height);
}

static int read_rows(reader *r)
{
    if (setjmp(png_jmpbuf(r->png)))
        return damaged(r);
    png_set_read_status_fn(r->png, tell_row);
    png_read_image(r->png, r->rows);
    png_read_end(r->png, NULL);
    io__tell(r->file->watch, 1, 1);
    return 0;
}

static void convert(const reader *r, io_image *image)
{
    const size_t channels = (size_t)r->channels;
    const size_t samples = (size_t)r->width * channels;
    for (size_t y = 0; y < (size_t)r->height; y++) {
        const size_t first = y * (size_t)r->width;
        for (size_t i = 0; i < samples; i++) {
            float value;
            if (r->bytes == 2) {
                uint16_t wide;
                memcpy(&wide, r->rows[y] + 2 * i, sizeof wide);
                value = (float)wide / 65535.0f;
            } else {
                value = (float)r->rows[y][i] / 255.0f;
            }
            image->channels[i % channels].data[first + i / channels] = value;
        }
    }
}

static int read_png(const io__file *file, const char *const *names, int32_t count,
                    io_image *out)
{
    reader r;
    io_image all = {0};
    if (open_reader(file, &r))
        return -1;
    int result = allocate_rows(&r);
    if (!result)
        result = read_rows(&r);
    if (!result)
        result = io__image_init_colour(&all, r.width, r.height, r.channels, file);
    if (!result) {
        convert(&r, &all);
        find_made(&r, all.made);
    }
    close_reader(&r);
    return result ? -1 : io__select_channels(file, &all, names, count, out);
}

static int probe_png(const io__file *file, io_image *out)
{
    reader r;
    if (open_reader(file, &r))
        return -1;
    const int result = io__probe_colour(file, r.width, r.height, r.channels, out);
    if (!result)
        find_made(&r, out->made);
    close_reader(&r);
    return result;
}

static bool recognises_png(const unsigned char *head, size_t size)
{
    return size >= 8 && !memcmp(head, "\x89PNG\r\n\x1a\n", 8);
}

const io__format io__format_png = {.name = "a PNG file",
                                   .extension = ".png",
                                   .recognises = recognises_png,
                                   .probe = probe_png,
                                   .read = read_png,
                                   .write = io__png_write};

/* SPDX-License-Identifier: MIT */
/* exr_chunks.c: from the chunks of an EXR part to floats. */
#include <stdlib.h>
#include <string.h>

#include "exr.h"

/* No lossless method of EXR packs tighter (deflate: 1032 to 1). More is a forged size. */
enum { MAX_RATIO = 2048 };

typedef struct part_layout {
    bool tiled;
    int32_t width, height;
    int32_t columns, rows; /* of chunks */
    int32_t chunk_width, chunk_height;
    int32_t min_y;
} part_layout;

static int damaged(const io__exr *exr, exr_result_t code)
{
    return io__exr_fail(exr, code, "is damaged or cut off");
}

static int forged(const io__exr *exr, const char *how)
{
    return io__fail(exr->file->log, exr->file->path,
                    "is damaged or cut off (%s); write it again", how);
}

static int find_layout(const io__exr *exr, int part, part_layout *layout)
{
    exr_attr_box2i_t window;
    exr_storage_t storage;
    int32_t lines = 0;
    uint32_t tile_width = 0, tile_height = 0;
    exr_tile_level_mode_t levels;
    exr_tile_round_mode_t rounding;
    exr_result_t code = exr_get_data_window(exr->context, part, &window);
    if (!code)
        code = exr_get_storage(exr->context, part, &storage);
    if (code)
        return damaged(exr, code);
    const int32_t width = window.max.x - window.min.x + 1;
    const int32_t height = window.max.y - window.min.y + 1;
    layout->width = width;
    layout->height = height;
    layout->tiled = storage == EXR_STORAGE_TILED;
    layout->min_y = window.min.y;
    if (layout->tiled) {
        code = exr_get_tile_descriptor(exr->context, part, &tile_width, &tile_height,
                                       &levels, &rounding);
        if (code)
            return damaged(exr, code);
        if (tile_width < 1 || tile_height < 1 || tile_width > INT32_MAX / 2
            || tile_height > INT32_MAX / 2)
            return forged(exr, "its tiles have no size");
        layout->chunk_width = (int32_t)tile_width;
        layout->chunk_height = (int32_t)tile_height;
    } else {
        code = exr_get_scanlines_per_chunk(exr->context, part, &lines);
        if (code)
            return damaged(exr, code);
        if (lines < 1)
            return forged(exr, "its chunks have no lines");
        layout->chunk_width = width;
        layout->chunk_height = lines;
    }
    layout->columns = (width - 1) / layout->chunk_width + 1;
    layout->rows = (height - 1) / layout->chunk_height + 1;
    return 0;
}

static exr_result_t find_chunk(const io__exr *exr, int part, const part_layout *layout,
                               int32_t column, int32_t row, exr_chunk_info_t *info)
{
    if (layout->tiled)
        return exr_read_tile_chunk_info(exr->context, part, column, row, 0, 0, info);
    return exr_read_scanline_chunk_info(exr->context, part,
                                        layout->min_y + row * layout->chunk_height, info);
}

/* OpenEXR's C interface unpacks but the first of several float channels wrongly. */
static bool is_misread(const io__exr *exr, int part, exr_compression_t compression)
{
    const exr_attr_chlist_t *channels = NULL;
    int floats = 0;
    if (compression != EXR_COMPRESSION_B44 && compression != EXR_COMPRESSION_B44A)
        return false;
    if (exr_get_channels(exr->context, part, &channels) != EXR_ERR_SUCCESS)
        return true;
    for (int i = 0; i < channels->num_channels; i++)
        floats += channels->entries[i].pixel_type != EXR_PIXEL_HALF;
    return floats > 1;
}

/* OpenEXR itself would fill what an uncompressed file lacks with zeros. */
int io__exr_check_chunks(io__exr *exr, int part)
{
    part_layout layout = {0};
    const uint64_t size = (uint64_t)exr->file->size;
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    uint64_t packed = 0, unpacked = 0;
    if (find_layout(exr, part, &layout))
        return -1;
    exr_get_compression(exr->context, part, &compression);
    const uint64_t chunks = (uint64_t)layout.columns * (uint64_t)layout.rows;
    if (chunks > size / sizeof(uint64_t))
        return forged(exr, "it is shorter than its table");
    for (int32_t row = 0; row < layout.rows; row++) {
        for (int32_t column = 0; column < layout.columns; column++) {
            exr_chunk_info_t info;
            const exr_result_t code = find_chunk(exr, part, &layout, column, row, &info);
            if (code)
                return damaged(exr, code);
            if (info.data_offset > size || info.packed_size > size - info.data_offset)
                return forged(exr, "it ends in the middle");
            packed += info.packed_size;
            unpacked += info.unpacked_size;
        }
    }
    const bool lossy =
        compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB;
    if (unpacked / MAX_RATIO <= packed)
        return 0;
    if (!lossy)
        return forged(exr, "it is too short for its size");
    /* A lossy method packs an empty picture to next to nothing. Unpacked once for nobody,
     * a chunk at a time, it shows whether it is one. */
    float **nobody = calloc((size_t)exr->channel_capacity, sizeof *nobody);
    if (!nobody)
        return io__fail(exr->file->log, exr->file->path,
                        "no memory; close other programs");
    const int result = io__exr_read_part(exr, part, nobody);
    free(nobody);
    return result;
}

int io__exr_check_part(io__exr *exr, int part)
{
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    exr_get_compression(exr->context, part, &compression);
    if (is_misread(exr, part, compression))
        return io__fail(exr->file->log, exr->file->path,
                        "has several 32-bit channels in B44 compression, which OpenEXR's "
                        "C interface misreads; write it with ZIP or PIZ compression");
    return io__exr_check_chunks(exr, part);
}

static uint32_t load_bytes(const unsigned char *p, size_t count)
{
    uint32_t bits = 0;
    for (size_t i = 0; i < count; i++)
        bits |= (uint32_t)p[i] << (8 * i);
    return bits;
}

/* Little-endian values, which is a copy for floats on most machines: the compiler sees it
 * once the type is outside the loop. */
static void unpack_line(const unsigned char *source, exr_pixel_type_t type, size_t width,
                        float *out)
{
    if (type == EXR_PIXEL_HALF) {
        for (size_t i = 0; i < width; i++)
            out[i] = io__float_of_half(load_bytes(source + 2 * i, 2));
    } else if (type == EXR_PIXEL_UINT) {
        for (size_t i = 0; i < width; i++)
            out[i] = (float)load_bytes(source + 4 * i, 4);
    } else {
        for (size_t i = 0; i < width; i++) {
            const uint32_t bits = load_bytes(source + 4 * i, 4);
            memcpy(&out[i], &bits, sizeof bits);
        }
    }
}

/* Where the pixels of the chunk at hand go; the user data of the decoder. */
typedef struct destination {
    float *const *targets; /* of the whole part; NULL for channels nobody wants */
    size_t row_length;
    int32_t x, y;  /* the chunk's first pixel in the picture */
    int32_t min_y; /* of the data window */
} destination;

/*
 * Takes the wanted channels from an unpacked chunk. Instead of the library's own
 * routines, of which those for halves write to channels that nobody wants (seen in
 * OpenEXR 3.1.5).
 */
static exr_result_t unpack(exr_decode_pipeline_t *decode)
{
    const destination *to = decode->decoding_user_data;
    const bool packed = !decode->unpacked_buffer; /* if nothing was packed */
    const unsigned char *source =
        packed ? decode->packed_buffer : decode->unpacked_buffer;
    uint64_t left = packed ? decode->chunk.packed_size : decode->chunk.unpacked_size;
    for (int32_t line = to->y; line < to->y + decode->chunk.height; line++)
        for (int16_t c = 0; c < decode->channel_count; c++) {
            const exr_coding_channel_info_t *channel = &decode->channels[c];
            const size_t width = (size_t)channel->width;
            const uint64_t bytes = (uint64_t)width * (uint64_t)channel->bytes_per_element;
            if (channel->y_samples > 1 && (to->min_y + line) % channel->y_samples != 0)
                continue;
            if (bytes > left)
                return EXR_ERR_CORRUPT_CHUNK;
            if (to->targets[c])
                unpack_line(source, (exr_pixel_type_t)channel->data_type, width,
                            to->targets[c] + (size_t)line * to->row_length
                                + (size_t)to->x);
            source += bytes;
            left -= bytes;
        }
    return EXR_ERR_SUCCESS;
}

static int fail_decode(const io__exr *exr, exr_result_t code)
{
    if (code == EXR_ERR_FEATURE_NOT_IMPLEMENTED)
        return io__fail(exr->file->log, exr->file->path,
                        "is compressed in a way that this OpenEXR library's C interface "
                        "cannot read (DWAA and DWAB need a newer one, 3.1.13 or "
                        "later); write it with ZIP or PIZ compression");
    if (code == EXR_ERR_OUT_OF_MEMORY)
        return io__fail(exr->file->log, exr->file->path,
                        "no memory to unpack it; close other programs");
    return damaged(exr, code);
}

static exr_result_t read_chunk(io__exr *exr, int part, const part_layout *layout,
                               const exr_chunk_info_t *info, destination *to,
                               exr_decode_pipeline_t *decode)
{
    if (info->width < 0 || info->width > layout->width - to->x || info->height < 0
        || info->height > layout->height - to->y)
        return EXR_ERR_CORRUPT_CHUNK;
    exr_result_t code;
    if (decode->channels) {
        code = exr_decoding_update(exr->context, part, info, decode);
    } else {
        code = exr_decoding_initialize(exr->context, part, info, decode);
        if (!code)
            code = exr_decoding_choose_default_routines(exr->context, part, decode);
        decode->unpack_and_convert_fn = unpack;
    }
    decode->decoding_user_data = to;
    return code ? code : exr_decoding_run(exr->context, part, decode);
}

/* What the threads that unpack a part share. The first failure in the order of the chunks
 * is the one that is told, whichever thread comes first. */
typedef struct reading {
    io__exr *exr;
    int part;
    part_layout layout;
    float *const *targets;
    int32_t
        failed; /* the first chunk that did; the number of chunks while there is none */
    exr_result_t code;
} reading;

static void read_chunk_number(reading *r, int32_t number, exr_decode_pipeline_t *decode)
{
    const part_layout *layout = &r->layout;
    const int32_t column = number % layout->columns, row = number / layout->columns;
    exr_chunk_info_t info;
    destination to = {.targets = r->targets,
                      .row_length = (size_t)layout->width,
                      .x = column * layout->chunk_width,
                      .y = row * layout->chunk_height,
                      .min_y = layout->min_y};
    exr_result_t code = find_chunk(r->exr, r->part, layout, column, row, &info);
    if (!code)
        code = read_chunk(r->exr, r->part, layout, &info, &to, decode);
    if (!code)
        return;
    IO__OMP(critical(io__exr_failure))
    if (number < r->failed) {
        IO__OMP(atomic write)
        r->failed = number;
        r->code = code;
    }
}

int io__exr_read_part(io__exr *exr, int part, float *const *targets)
{
    reading r = {.exr = exr, .part = part, .targets = targets};
    if (find_layout(exr, part, &r.layout))
        return -1;
    const int32_t count = r.layout.columns * r.layout.rows;
    int32_t done = 0;
    r.failed = count;
    IO__OMP(parallel)
    {
        exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
        IO__OMP_FOR(schedule(dynamic))
        for (int32_t i = 0; i < count; i++) {
            int32_t failed, now;
            IO__OMP(atomic read)
            failed = r.failed;
            if (i < failed)
                read_chunk_number(&r, i, &decode);
            IO__OMP(atomic capture)
            now = ++done;
            io__tell(exr->file->watch, now, count);
        }
        exr_decoding_destroy(exr->context, &decode);
    }
    io__tell(exr->file->watch, count, count);
    return r.code ? fail_decode(exr, r.code) : 0;
}

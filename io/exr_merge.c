/* SPDX-License-Identifier: MIT */
/*
 * exr_merge.c: pixels of a part that gets further channels, or whose channels are
 * multiplied. A chunk of the input is unpacked, lines of it and of the pictures are laid
 * out anew, byte by byte and without conversion, and packed again.
 */
#include <stdlib.h>
#include <string.h>

#include "exr_copy.h"

typedef struct merge {
    io__exr_copy *copy;
    const io__exr_sink *sink;
    int part;
    const io__exr_copy_part *made;
    bool tiled;
    int32_t columns, count; /* of chunks of the copy */
    int32_t lines;          /* of such a chunk; of a tile its height */
    int32_t tile_width;
    int32_t ratio; /* chunks of the copy in one of the input, as lines */
    exr_attr_box2i_t window;
    exr_result_t code;
} merge;

/* Of one thread. */
typedef struct worker {
    const merge *m;
    exr_decode_pipeline_t decode;
    exr_encode_pipeline_t encode;
    int32_t unpacked;           /* chunk of the input at hand; -1: none */
    const unsigned char **line; /* of each of the input's channels, at the line at hand */
    int32_t x, y; /* of the first pixel of the copy's chunk, in the file's coordinates */
} worker;

bool io__exr_is_lossless(exr_compression_t compression)
{
    return compression == EXR_COMPRESSION_NONE || compression == EXR_COMPRESSION_RLE
           || compression == EXR_COMPRESSION_ZIPS || compression == EXR_COMPRESSION_ZIP
           || compression == EXR_COMPRESSION_PIZ;
}

/* The unpacked bytes stay where they are, for pack(). */
static exr_result_t leave(exr_decode_pipeline_t *decode)
{
    (void)decode;
    return EXR_ERR_SUCCESS;
}

static exr_result_t unpack(worker *w, const io__exr_chunk *chunk)
{
    const io__exr *in = &w->m->copy->in;
    const int source = w->m->made->source;
    exr_chunk_info_t info;
    exr_result_t code = io__exr_find_chunk(in, source, chunk, &info);
    if (code)
        return code;
    if (w->decode.channels)
        code = exr_decoding_update(in->context, source, &info, &w->decode);
    else {
        code = exr_decoding_initialize(in->context, source, &info, &w->decode);
        if (!code)
            code = exr_decoding_choose_default_routines(in->context, source, &w->decode);
        w->decode.unpack_and_convert_fn = leave;
    }
    return code ? code : exr_decoding_run(in->context, source, &w->decode);
}

/* Finds where each channel's pixels begin in a line; false if the chunk ends before. */
static bool find_line(const worker *w, int32_t y)
{
    const exr_decode_pipeline_t *decode = &w->decode;
    const bool packed = !decode->unpacked_buffer; /* if nothing was packed */
    const unsigned char *at = packed ? decode->packed_buffer : decode->unpacked_buffer;
    uint64_t left = packed ? decode->chunk.packed_size : decode->chunk.unpacked_size;
    const int32_t first = w->m->tiled ? w->y : decode->chunk.start_y;
    for (int32_t line = first; line <= y; line++)
        for (int16_t c = 0; c < decode->channel_count; c++) {
            const exr_coding_channel_info_t *channel = &decode->channels[c];
            if (channel->y_samples > 1 && line % channel->y_samples != 0)
                continue;
            const uint64_t bytes =
                (uint64_t)channel->width * (uint64_t)channel->bytes_per_element;
            if (bytes > left)
                return false;
            w->line[c] = at;
            at += bytes;
            left -= bytes;
        }
    return true;
}

/* What the plane's picture holds at a pixel of the file. */
static float value_at(const io__exr_plane *plane, int64_t x, int64_t y)
{
    const int64_t column = x - plane->layer->x, row = y - plane->layer->y;
    const io_image *picture = plane->layer->picture;
    if (column < 0 || row < 0 || column >= picture->width || row >= picture->height)
        return plane->outside;
    const int64_t at = row * picture->width + column;
    const io_channel *channels = picture->channels;
    if (plane->channel >= 0)
        return channels[plane->channel].data[at];
    return (channels[0].data[at] + channels[1].data[at] + channels[2].data[at]) / 3.0f;
}

static void store(unsigned char *at, uint32_t bits, int32_t size)
{
    for (int32_t i = 0; i < size; i++)
        at[i] = (unsigned char)(bits >> (8 * i));
}

static uint32_t load(const unsigned char *at, int32_t size)
{
    uint32_t bits = 0;
    for (int32_t i = 0; i < size; i++)
        bits |= (uint32_t)at[i] << (8 * i);
    return bits;
}

static uint32_t bits_of(float value, exr_pixel_type_t type)
{
    uint32_t bits;
    if (type == EXR_PIXEL_HALF)
        return io__half_of_float(value);
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Pixels that nothing darkens keep their bits; nothing is left of those in the dark, even
 * of infinite ones. */
static uint32_t multiplied(uint32_t bits, exr_pixel_type_t type, float factor)
{
    float value;
    if (!(factor < 1.0f))
        return bits;
    if (type == EXR_PIXEL_HALF)
        value = io__float_of_half(bits);
    else
        memcpy(&value, &bits, sizeof value);
    return bits_of(factor > 0.0f ? value * factor : 0.0f, type);
}

/* One line of a plane; `from` is the input's, if it has one. */
static void fill(const worker *w, const io__exr_plane *plane, int32_t y, int32_t width,
                 const unsigned char *from, unsigned char *to)
{
    const int32_t size = plane->type == EXR_PIXEL_HALF ? 2 : 4;
    if (!plane->layer) {
        memcpy(to, from, (size_t)width * (size_t)size);
        return;
    }
    for (int32_t x = 0; x < width; x++) {
        const float value = value_at(plane, (int64_t)w->x + x, y);
        const uint32_t bits =
            plane->source < 0
                ? bits_of(value, plane->type)
                : multiplied(load(from + (size_t)x * (size_t)size, size), plane->type,
                             plane->tint + (1.0f - plane->tint) * value);
        store(to + (size_t)x * (size_t)size, bits, size);
    }
}

/* In place of the library's routine: fills encode->packed_buffer. */
static exr_result_t pack(exr_encode_pipeline_t *encode)
{
    const worker *w = encode->encoding_user_data;
    const io__exr_copy_part *made = w->m->made;
    unsigned char *to = encode->packed_buffer;
    for (int32_t row = 0; row < encode->chunk.height; row++) {
        const int32_t y = w->y + row;
        if (made->source >= 0 && !find_line(w, y))
            return EXR_ERR_CORRUPT_CHUNK;
        for (int16_t c = 0; c < encode->channel_count; c++) {
            const exr_coding_channel_info_t *channel = &encode->channels[c];
            const io__exr_plane *plane = &made->planes[c];
            if (channel->y_samples > 1 && y % channel->y_samples != 0)
                continue;
            fill(w, plane, y, channel->width,
                 plane->source >= 0 ? w->line[plane->source] : NULL, to);
            to += (size_t)channel->width * (size_t)channel->bytes_per_element;
        }
    }
    encode->packed_bytes = (uint64_t)(to - (unsigned char *)encode->packed_buffer);
    return EXR_ERR_SUCCESS;
}

/* The library asks for sources that pack() does not need. */
static void pretend(worker *w)
{
    for (int16_t c = 0; c < w->encode.channel_count; c++) {
        exr_coding_channel_info_t *channel = &w->encode.channels[c];
        channel->encode_from_ptr = (const uint8_t *)w;
        channel->user_bytes_per_element = channel->bytes_per_element;
        channel->user_data_type = channel->data_type;
        channel->user_pixel_stride = channel->bytes_per_element;
        channel->user_line_stride = channel->width * channel->bytes_per_element;
    }
}

static io__exr_chunk chunk_at(const merge *m, int32_t number)
{
    if (m->tiled)
        return (io__exr_chunk){.x = number % m->columns, .y = number / m->columns};
    return (io__exr_chunk){.y = m->window.min.y + number * m->lines};
}

static exr_result_t encode(worker *w, const io__exr_chunk *chunk)
{
    const exr_context_t out = w->m->sink->context;
    const int part = w->m->part;
    exr_chunk_info_t info;
    exr_result_t code =
        w->m->tiled
            ? exr_write_tile_chunk_info(out, part, chunk->x, chunk->y, 0, 0, &info)
            : exr_write_scanline_chunk_info(out, part, chunk->y, &info);
    const bool first = !w->encode.channels;
    if (!code)
        code = first ? exr_encoding_initialize(out, part, &info, &w->encode)
                     : exr_encoding_update(out, part, &info, &w->encode);
    if (code)
        return code;
    if (first)
        code = exr_encoding_choose_default_routines(out, part, &w->encode);
    w->encode.convert_and_pack_fn = pack;
    w->encode.encoding_user_data = w;
    /* Writing waits for its turn. */
    w->encode.yield_until_ready_fn = NULL;
    w->encode.write_fn = NULL;
    pretend(w);
    return code ? code : exr_encoding_run(out, part, &w->encode);
}

static exr_result_t make_chunk(worker *w, int32_t number)
{
    const merge *m = w->m;
    const io__exr_chunk chunk = chunk_at(m, number);
    const int32_t source = number / m->ratio;
    exr_result_t code = EXR_ERR_SUCCESS;
    if (io__output_stops(m->sink->output))
        return EXR_ERR_UNKNOWN;
    w->x = m->window.min.x + (m->tiled ? chunk.x * m->tile_width : 0);
    w->y = m->tiled ? m->window.min.y + chunk.y * m->lines : chunk.y;
    if (m->made->source >= 0 && w->unpacked != source) {
        const io__exr_chunk from = chunk_at(m, source * m->ratio);
        code = unpack(w, &from);
        w->unpacked = code ? -1 : source;
    }
    return code ? code : encode(w, &chunk);
}

static exr_result_t find_layout(merge *m)
{
    const exr_context_t out = m->sink->context;
    int32_t source_lines = 0;
    exr_storage_t storage;
    exr_result_t code = exr_get_storage(out, m->part, &storage);
    if (!code)
        code = exr_get_data_window(out, m->part, &m->window);
    if (code)
        return code;
    m->tiled = storage == EXR_STORAGE_TILED;
    m->columns = m->ratio = 1;
    if (m->tiled)
        code = exr_get_tile_sizes(out, m->part, 0, 0, &m->tile_width, &m->lines);
    else
        code = exr_get_scanlines_per_chunk(out, m->part, &m->lines);
    if (!code && !m->tiled && m->made->source >= 0) {
        code = exr_get_scanlines_per_chunk(m->copy->in.context, m->made->source,
                                           &source_lines);
        m->ratio = source_lines / m->lines;
    }
    if (m->tiled)
        m->columns = (m->window.max.x - m->window.min.x) / m->tile_width + 1;
    m->count = ((m->window.max.y - m->window.min.y) / m->lines + 1) * m->columns;
    return code;
}

static void close_worker(worker *w)
{
    if (w->decode.channels)
        exr_decoding_destroy(w->m->copy->in.context, &w->decode);
    if (w->encode.channels)
        exr_encoding_destroy(w->m->sink->context, &w->encode);
    free(w->line);
}

exr_result_t io__exr_merge_part(io__exr_copy *copy, int part, const io__exr_sink *sink)
{
    merge m = {.copy = copy, .sink = sink, .part = part, .made = &copy->parts[part]};
    const exr_result_t known = find_layout(&m);
    if (known)
        return known;
    IO__OMP(parallel)
    {
        worker w = {.m = &m,
                    .decode = EXR_DECODE_PIPELINE_INITIALIZER,
                    .encode = EXR_ENCODE_PIPELINE_INITIALIZER,
                    .unpacked = -1};
        w.line = calloc((size_t)copy->in.channel_capacity + 1, sizeof *w.line);
        IO__OMP_FOR(ordered schedule(dynamic, m.ratio))
        for (int32_t i = 0; i < m.count; i++) {
            const io__exr_chunk chunk = chunk_at(&m, i);
            const exr_result_t code = w.line ? make_chunk(&w, i) : EXR_ERR_OUT_OF_MEMORY;
            IO__OMP(ordered)
            if (!m.code)
                m.code =
                    code ? code : io__exr_write_packed(sink, part, &chunk, &w.encode);
            io__tell(sink->output->watch, i, m.count);
        }
        close_worker(&w);
    }
    io__tell(sink->output->watch, 1, 1);
    return m.code;
}

/* SPDX-License-Identifier: MIT */
/* exr_copy.c: headers of a copy of an EXR file, and the parts that stay as they are. */
#include "exr_copy.h"

#include <stdlib.h>
#include <string.h>

enum { SHORT_NAME = 31, ZIP_LINES = 16 };

exr_result_t io__exr_find_chunk(const io__exr *exr, int part, const io__exr_chunk *chunk,
                                exr_chunk_info_t *info)
{
    exr_storage_t storage;
    const uint64_t size = (uint64_t)exr->file->size;
    exr_result_t code = exr_get_storage(exr->context, part, &storage);
    if (code)
        return code;
    if (storage == EXR_STORAGE_TILED || storage == EXR_STORAGE_DEEP_TILED)
        code = exr_read_tile_chunk_info(exr->context, part, chunk->x, chunk->y,
                                        chunk->level_x, chunk->level_y, info);
    else
        code = exr_read_scanline_chunk_info(exr->context, part, chunk->y, info);
    if (!code
        && (info->data_offset > size || info->packed_size > size - info->data_offset
            || info->sample_count_data_offset > size
            || info->sample_count_table_size > size - info->sample_count_data_offset))
        code = EXR_ERR_CORRUPT_CHUNK;
    return code;
}

/* Names of more than 31 bytes need a flag in the header, before they are set. */
static bool has_long_names(const io__exr_copy *copy)
{
    for (int part = 0; part < copy->in.part_count; part++) {
        int32_t count = 0;
        const exr_attr_chlist_t *channels = NULL;
        exr_get_attribute_count(copy->in.context, part, &count);
        for (int32_t i = 0; i < count; i++) {
            const exr_attribute_t *attribute = NULL;
            if (!exr_get_attribute_by_index(copy->in.context, part,
                                            EXR_ATTR_LIST_FILE_ORDER, i, &attribute)
                && (attribute->name_length > SHORT_NAME
                    || attribute->type_name_length > SHORT_NAME))
                return true;
        }
        if (!exr_get_channels(copy->in.context, part, &channels))
            for (int i = 0; i < channels->num_channels; i++)
                if (channels->entries[i].name.length > SHORT_NAME)
                    return true;
    }
    for (int32_t i = 0; i < copy->note_count; i++) /* longer than the channel's */
        if (strlen(copy->notes[i].name) > SHORT_NAME)
            return true;
    return false;
}

/* Chunks are written in the order of their numbers. Those of mip-maps are numbered as
 * nobody needs to know if any order is allowed. */
static exr_result_t set_order(const io__exr_copy *copy, const io__exr_sink *sink,
                              int part, int source)
{
    exr_lineorder_t order = EXR_LINEORDER_INCREASING_Y;
    int32_t levels_x = 1, levels_y = 1;
    exr_get_lineorder(copy->in.context, source, &order);
    exr_get_tile_levels(copy->in.context, source, &levels_x, &levels_y);
    if (levels_x > 1 || levels_y > 1)
        order = EXR_LINEORDER_RANDOM_Y;
    else if (order == EXR_LINEORDER_DECREASING_Y)
        order = EXR_LINEORDER_INCREASING_Y;
    return exr_set_lineorder(sink->context, part, order);
}

static exr_result_t declare_planes(const io__exr_copy_part *made,
                                   const io__exr_sink *sink, int part)
{
    exr_result_t code = EXR_ERR_SUCCESS;
    for (int32_t i = 0; !code && i < made->plane_count; i++) {
        const io__exr_plane *plane = &made->planes[i];
        code = exr_add_channel(sink->context, part, plane->name, plane->type,
                               plane->treatment, plane->x_sampling, plane->y_sampling);
    }
    return code;
}

/* What all parts of a file must agree on, and whose eye it is; the other attributes are
 * of other parts. */
static exr_result_t resemble(const io__exr_copy *copy, const io__exr_sink *sink, int part,
                             int other)
{
    const exr_const_context_t in = copy->in.context;
    exr_attr_timecode_t time;
    exr_attr_chromaticities_t colours;
    exr_attr_m44f_t matrix;
    const char *view = NULL;
    int32_t length = 0;
    static const char *const matrices[] = {"worldToCamera", "worldToNDC"};
    exr_result_t code = EXR_ERR_SUCCESS;
    if (!exr_attr_get_timecode(in, other, "timeCode", &time))
        code = exr_attr_set_timecode(sink->context, part, "timeCode", &time);
    if (!code && !exr_attr_get_chromaticities(in, other, "chromaticities", &colours))
        code =
            exr_attr_set_chromaticities(sink->context, part, "chromaticities", &colours);
    if (!code && !exr_attr_get_string(in, other, "view", &length, &view) && view)
        code = exr_attr_set_string(sink->context, part, "view", view);
    for (int i = 0; !code && i < 2; i++)
        if (!exr_attr_get_m44f(in, other, matrices[i], &matrix))
            code = exr_attr_set_m44f(sink->context, part, matrices[i], &matrix);
    return code;
}

/* A new part of scanlines, as large as its picture. */
static exr_result_t declare_new(const io__exr_copy *copy, const io__exr_sink *sink,
                                int part)
{
    const io__exr_copy_part *made = &copy->parts[part];
    const io__exr_layer *layer = made->planes[0].layer;
    const exr_const_context_t in = copy->in.context;
    exr_attr_box2i_t display;
    exr_attr_v2f_t centre = {.x = 0.0f, .y = 0.0f};
    float aspect = 1.0f, width = 1.0f;
    int index;
    const exr_attr_box2i_t data = {
        .min = {.x = (int32_t)layer->x, .y = (int32_t)layer->y},
        .max = {.x = (int32_t)layer->x + layer->picture->width - 1,
                .y = (int32_t)layer->y + layer->picture->height - 1}};
    exr_get_pixel_aspect_ratio(in, made->beside, &aspect);
    exr_get_screen_window_center(in, made->beside, &centre);
    exr_get_screen_window_width(in, made->beside, &width);
    exr_result_t code = exr_get_display_window(in, made->beside, &display);
    if (!code)
        code = exr_add_part(sink->context, made->name, EXR_STORAGE_SCANLINE, &index);
    if (!code)
        code = exr_initialize_required_attr(sink->context, part, &display, &data, aspect,
                                            &centre, width, EXR_LINEORDER_INCREASING_Y,
                                            made->compression);
    /* OpenEXR's C interface wants it of all parts beside a deep one. */
    if (!code && copy->in.has_deep_parts)
        code = exr_set_version(sink->context, part, 1);
    if (!code)
        code = declare_planes(made, sink, part);
    return code ? code : resemble(copy, sink, part, made->beside);
}

/* Attributes of types that are not OpenEXR's own, which its function for copying drops
 * (seen in 3.1.5). Empty ones are left out: the library leaks a byte for each. */
static exr_result_t copy_foreign(const io__exr_copy *copy, const io__exr_sink *sink,
                                 int part, int source)
{
    int32_t count = 0;
    exr_result_t code = exr_get_attribute_count(copy->in.context, source, &count);
    for (int32_t i = 0; !code && i < count; i++) {
        const exr_attribute_t *attribute = NULL;
        code = exr_get_attribute_by_index(copy->in.context, source,
                                          EXR_ATTR_LIST_FILE_ORDER, i, &attribute);
        if (!code && attribute->type == EXR_ATTR_OPAQUE && attribute->opaque->size > 0)
            code = exr_attr_set_user(sink->context, part, attribute->name,
                                     attribute->type_name, attribute->opaque->size,
                                     attribute->opaque->packed_data);
    }
    return code;
}

/* A part of the input with all its attributes; those that differ are set first. */
static exr_result_t declare_old(const io__exr_copy *copy, const io__exr_sink *sink,
                                int part)
{
    const io__exr_copy_part *made = &copy->parts[part];
    const exr_const_context_t in = copy->in.context;
    const char *name = NULL;
    exr_storage_t storage;
    exr_compression_t before = made->compression;
    exr_attr_box2i_t data;
    int index;
    exr_get_name(in, made->source, &name);
    exr_result_t code = exr_get_storage(in, made->source, &storage);
    if (!code)
        code = exr_add_part(sink->context, name, storage, &index);
    if (!code)
        code = set_order(copy, sink, part, made->source);
    if (!code && made->is_changed) {
        code = exr_set_compression(sink->context, part, made->compression);
        if (!code)
            code = declare_planes(made, sink, part);
        exr_get_compression(in, made->source, &before);
    }
    if (!code && before != made->compression && storage == EXR_STORAGE_SCANLINE
        && !exr_get_data_window(in, made->source, &data))
        code = exr_attr_set_int(sink->context, part, "chunkCount",
                                (data.max.y - data.min.y) / ZIP_LINES + 1);
    return code;
}

static exr_result_t write_header(const io__exr_copy *copy, const io__exr_sink *sink)
{
    exr_result_t code = EXR_ERR_SUCCESS;
    if (has_long_names(copy))
        code = exr_set_longname_support(sink->context, 1);
    for (int part = 0; !code && part < copy->part_count; part++) {
        const int source = copy->parts[part].source;
        code = source < 0 ? declare_new(copy, sink, part) : declare_old(copy, sink, part);
        for (int32_t i = 0; !code && i < copy->note_count; i++)
            if (copy->notes[i].part == part)
                code = exr_attr_set_string(sink->context, part, copy->notes[i].name,
                                           copy->notes[i].text);
        if (!code && source >= 0)
            code = copy_foreign(copy, sink, part, source);
        if (!code && source >= 0)
            code =
                exr_copy_unset_attributes(sink->context, part, copy->in.context, source);
        if (!code)
            code = io__exr_set_level(sink, part);
    }
    return code ? code : exr_write_header(sink->context);
}

/* The packed bytes of a chunk, from one file to the other. */
typedef struct carrier {
    const io__exr_copy *copy;
    const io__exr_sink *sink;
    int part, source;
    exr_storage_t storage;
    void *packed, *samples; /* owned */
    uint64_t packed_room, samples_room;
} carrier;

static bool make_room(void **buffer, uint64_t *room, uint64_t size)
{
    if (*buffer && *room >= size)
        return true;
    void *grown = realloc(*buffer, (size_t)size + 1);
    if (!grown)
        return false;
    *buffer = grown;
    *room = size;
    return true;
}

static exr_result_t carry_deep(const carrier *c, const io__exr_chunk *chunk,
                               const exr_chunk_info_t *info)
{
    const exr_result_t code =
        exr_read_deep_chunk(c->copy->in.context, c->source, info, c->packed, c->samples);
    if (code)
        return code;
    if (c->storage == EXR_STORAGE_DEEP_TILED)
        return exr_write_deep_tile_chunk(c->sink->context, c->part, chunk->x, chunk->y,
                                         chunk->level_x, chunk->level_y, c->packed,
                                         info->packed_size, info->unpacked_size,
                                         c->samples, info->sample_count_table_size);
    return exr_write_deep_scanline_chunk(c->sink->context, c->part, chunk->y, c->packed,
                                         info->packed_size, info->unpacked_size,
                                         c->samples, info->sample_count_table_size);
}

static exr_result_t carry(carrier *c, const io__exr_chunk *chunk)
{
    exr_chunk_info_t info;
    if (io__output_stops(c->sink->output))
        return EXR_ERR_UNKNOWN;
    exr_result_t code = io__exr_find_chunk(&c->copy->in, c->source, chunk, &info);
    if (code)
        return code;
    if (!make_room(&c->packed, &c->packed_room, info.packed_size)
        || !make_room(&c->samples, &c->samples_room, info.sample_count_table_size))
        return EXR_ERR_OUT_OF_MEMORY;
    if (c->storage == EXR_STORAGE_DEEP_SCANLINE || c->storage == EXR_STORAGE_DEEP_TILED)
        return carry_deep(c, chunk, &info);
    code = exr_read_chunk(c->copy->in.context, c->source, &info, c->packed);
    if (code)
        return code;
    if (c->storage == EXR_STORAGE_TILED)
        return exr_write_tile_chunk(c->sink->context, c->part, chunk->x, chunk->y,
                                    chunk->level_x, chunk->level_y, c->packed,
                                    info.packed_size);
    return exr_write_scanline_chunk(c->sink->context, c->part, chunk->y, c->packed,
                                    info.packed_size);
}

static exr_result_t carry_level(carrier *c, int32_t level_x, int32_t level_y)
{
    const exr_const_context_t in = c->copy->in.context;
    int32_t width, height, tile_width, tile_height;
    exr_result_t code =
        exr_get_level_sizes(in, c->source, level_x, level_y, &width, &height);
    if (!code)
        code = exr_get_tile_sizes(in, c->source, level_x, level_y, &tile_width,
                                  &tile_height);
    if (!code && (tile_width < 1 || tile_height < 1))
        code = EXR_ERR_CORRUPT_CHUNK;
    for (int32_t y = 0; !code && (int64_t)y * tile_height < height; y++) {
        for (int32_t x = 0; !code && (int64_t)x * tile_width < width; x++)
            code = carry(c, &(io__exr_chunk){
                                .x = x, .y = y, .level_x = level_x, .level_y = level_y});
        if (level_x == 0 && level_y == 0) /* most of the work */
            io__tell(c->sink->output->watch, (int64_t)y * tile_height, height);
    }
    return code;
}

static exr_result_t carry_tiles(carrier *c)
{
    const exr_const_context_t in = c->copy->in.context;
    uint32_t width, height;
    int32_t levels_x = 0, levels_y = 0;
    exr_tile_level_mode_t mode;
    exr_tile_round_mode_t rounding;
    exr_result_t code =
        exr_get_tile_descriptor(in, c->source, &width, &height, &mode, &rounding);
    if (!code)
        code = exr_get_tile_levels(in, c->source, &levels_x, &levels_y);
    for (int32_t y = 0; !code && y < levels_y; y++)
        for (int32_t x = 0; !code && x < levels_x; x++)
            if (mode == EXR_TILE_RIPMAP_LEVELS || x == y)
                code = carry_level(c, x, y);
    return code;
}

static exr_result_t carry_lines(carrier *c)
{
    const exr_const_context_t in = c->copy->in.context;
    exr_attr_box2i_t data;
    int32_t lines = 0;
    exr_result_t code = exr_get_data_window(in, c->source, &data);
    if (!code)
        code = exr_get_scanlines_per_chunk(in, c->source, &lines);
    if (!code && lines < 1)
        code = EXR_ERR_CORRUPT_CHUNK;
    for (int64_t y = data.min.y; !code && y <= data.max.y; y += lines) {
        code = carry(c, &(io__exr_chunk){.y = (int32_t)y});
        io__tell(c->sink->output->watch, y - data.min.y,
                 (int64_t)data.max.y - data.min.y + 1);
    }
    return code;
}

static exr_result_t copy_part(const io__exr_copy *copy, int part,
                              const io__exr_sink *sink)
{
    carrier c = {
        .copy = copy, .sink = sink, .part = part, .source = copy->parts[part].source};
    exr_result_t code = exr_get_storage(copy->in.context, c.source, &c.storage);
    if (!code && (c.storage == EXR_STORAGE_TILED || c.storage == EXR_STORAGE_DEEP_TILED))
        code = carry_tiles(&c);
    else if (!code)
        code = carry_lines(&c);
    io__tell(sink->output->watch, 1, 1);
    free(c.packed);
    free(c.samples);
    return code;
}

int io__exr_copy_write(io__exr_copy *copy, io__output *output)
{
    io__exr_sink sink;
    exr_result_t code = io__exr_sink_open(&sink, output);
    if (!code)
        code = write_header(copy, &sink);
    for (int part = 0; !code && part < copy->part_count; part++)
        code = copy->parts[part].is_changed ? io__exr_merge_part(copy, part, &sink)
                                            : copy_part(copy, part, &sink);
    return io__exr_sink_close(&sink, code, "write the picture to a file of its own");
}

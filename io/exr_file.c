/* SPDX-License-Identifier: MIT */
/* exr_file.c: headers of EXR files: parts, channels, windows, camera. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "exr.h"

/* Renderers write hundreds of channels (Cryptomatte, light groups), never this many. */
enum { MAX_CHANNELS = 4096 };

/* OpenEXR prints its errors to stderr unless somebody takes them. What it says in its own
 * words is given up: the context may be locked, so that its user data are out of reach.
 */
void io__exr_say_nothing(exr_const_context_t context, exr_result_t code, const char *text)
{
    (void)context;
    (void)code;
    (void)text;
}

int io__exr_fail(const io__exr *exr, exr_result_t code, const char *what)
{
    const int reason = exr->io_error;
    if (reason)
        return io__fail(exr->file->log, exr->file->path,
                        "cannot be read (%s); copy it to another disk", strerror(reason));
    return io__fail(exr->file->log, exr->file->path, "%s (%s); write it again", what,
                    exr_get_default_error_message(code));
}

/* `fail` is left alone, see io__exr_say_nothing(). */
static int64_t read_at(exr_const_context_t context, void *user, void *buffer,
                       uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    io__exr *exr = user;
    (void)context;
    (void)fail;
    const int64_t done = file_read_at(exr->file->stream, buffer, size, offset);
    if (done < 0) {
        IO__OMP(atomic write) /* chunks are read by several threads */
        exr->io_error = errno;
    }
    return done;
}

static int64_t file_size(exr_const_context_t context, void *user)
{
    (void)context;
    const io__exr *exr = user;
    return exr->file->size;
}

static bool part_is_deep(const io__exr *exr, int part)
{
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    exr_get_storage(exr->context, part, &storage);
    return storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED;
}

/* "part.channel", unless the file has one part or the channel's name says it already. */
static bool channel_name(const io__exr *exr, const char *part, const char *channel,
                         char out[IO_NAME_SIZE])
{
    const size_t length = part ? strlen(part) : 0;
    const bool prefixed = length && text_is_same_start(channel, part, length)
                          && (channel[length] == '.' || channel[length] == '\0');
    int n;
    if (exr->part_count == 1 || !length || prefixed)
        n = snprintf(out, IO_NAME_SIZE, "%s", channel);
    else
        n = snprintf(out, IO_NAME_SIZE, "%s.%s", part, channel);
    return n > 0 && n < IO_NAME_SIZE;
}

static bool channel_is_listed(const io__exr *exr, const char *name)
{
    for (int32_t i = 0; i < exr->channel_count; i++)
        if (!strcmp(exr->channels[i].name, name))
            return true;
    return false;
}

static int list_part(io__exr *exr, int part)
{
    const exr_attr_chlist_t *list = NULL;
    const char *part_name = NULL;
    if (part_is_deep(exr, part)) {
        exr->has_deep_parts = true;
        return 0;
    }
    exr_get_name(exr->context, part, &part_name);
    const exr_result_t code = exr_get_channels(exr->context, part, &list);
    if (code || !list)
        return io__exr_fail(exr, code, "a part has no list of channels");
    if (list->num_channels < 0 || exr->channel_count + list->num_channels > MAX_CHANNELS)
        return io__fail(exr->file->log, exr->file->path,
                        "has more than %d channels; keep the ones that are needed",
                        MAX_CHANNELS);
    const size_t total = (size_t)(exr->channel_count + list->num_channels);
    io__exr_channel *grown = realloc(exr->channels, (total + 1) * sizeof *grown);
    if (!grown)
        return io__fail(exr->file->log, exr->file->path,
                        "no memory for its list of channels; close other programs");
    exr->channels = grown;
    if (list->num_channels > exr->channel_capacity)
        exr->channel_capacity = list->num_channels;
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        io__exr_channel *channel = &exr->channels[exr->channel_count];
        *channel = (io__exr_channel){.part = part,
                                     .index = i,
                                     .is_half = entry->pixel_type == EXR_PIXEL_HALF,
                                     .subsampled = entry->x_sampling != 1
                                                   || entry->y_sampling != 1};
        if (!entry->name.str
            || !channel_name(exr, part_name, entry->name.str, channel->name)
            || channel_is_listed(exr, channel->name))
            io__warn(exr->file->log, exr->file->path,
                     "channel \"%s\" of part %d is left out: its name is too long or "
                     "occurs twice",
                     entry->name.str ? entry->name.str : "", part);
        else
            exr->channel_count++;
    }
    return 0;
}

int io__exr_open(const io__file *file, io__exr *exr)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    memset(exr, 0, sizeof *exr);
    exr->file = file;
    initializer.error_handler_fn = io__exr_say_nothing;
    initializer.user_data = exr;
    initializer.read_fn = read_at;
    initializer.size_fn = file_size;
#ifdef EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION
    /* A file without its table of chunks was cut off: refused, not guessed at. */
    initializer.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
#endif
    exr_result_t code = exr_start_read(&exr->context, file->path, &initializer);
    if (code) {
        exr->context = NULL;
        return io__exr_fail(exr, code, "its EXR header is damaged or cut off");
    }
    int result = 0;
    code = exr_get_count(exr->context, &exr->part_count);
    if (code)
        result = io__exr_fail(exr, code, "its EXR header is damaged");
    for (int part = 0; !result && part < exr->part_count; part++)
        result = list_part(exr, part);
    if (!result && exr->channel_count == 0)
        result = io__fail(file->log, file->path,
                          exr->has_deep_parts
                              ? "holds deep pixels only, which are not read; flatten it"
                              : "has no channels; write it again");
    if (result)
        io__exr_close(exr);
    return result;
}

void io__exr_close(io__exr *exr)
{
    if (exr->context)
        exr_finish(&exr->context);
    free(exr->channels);
    exr->channels = NULL;
    exr->channel_count = 0;
}

/* Reads a matrix of floats or doubles of one part. */
static bool read_matrix(const io__exr *exr, int part, const char *name, float out[16])
{
    const exr_attribute_t *found = NULL;
    exr_attr_m44f_t single;
    exr_attr_m44d_t twice;
    if (exr_get_attribute_by_name(exr->context, part, name, &found) != EXR_ERR_SUCCESS
        || !found)
        return false;
    if (found->type == EXR_ATTR_M44F
        && exr_attr_get_m44f(exr->context, part, name, &single) == EXR_ERR_SUCCESS)
        memcpy(out, single.m, sizeof single.m);
    else if (found->type == EXR_ATTR_M44D
             && exr_attr_get_m44d(exr->context, part, name, &twice) == EXR_ERR_SUCCESS)
        for (int i = 0; i < 16; i++)
            out[i] = (float)twice.m[i];
    else
        return false;
    return true;
}

/* The eye that a part belongs to; "" if it does not say. */
static const char *view_of(const io__exr *exr, int part)
{
    int32_t length = 0;
    const char *view = NULL;
    if (exr_attr_get_string(exr->context, part, "view", &length, &view) != EXR_ERR_SUCCESS
        || !view)
        return "";
    return view;
}

/* A part's own matrix, or that of another part of the same eye. */
static bool find_matrix(const io__exr *exr, int own, const char *name, float out[16])
{
    if (read_matrix(exr, own, name, out))
        return true;
    for (int part = 0; part < exr->part_count; part++) {
        const char *view = view_of(exr, part);
        if ((!view[0] || !strcmp(view, view_of(exr, own)))
            && read_matrix(exr, part, name, out))
            return true;
    }
    return false;
}

int io__exr_metadata(const io__exr *exr, int part, io_image *image)
{
    exr_attr_box2i_t data, display;
    float aspect = 1.0f;
    exr_result_t code = exr_get_data_window(exr->context, part, &data);
    if (!code)
        code = exr_get_display_window(exr->context, part, &display);
    if (code)
        return io__exr_fail(exr, code, "its windows are missing from the header");
    const int64_t width = (int64_t)data.max.x - data.min.x + 1;
    const int64_t height = (int64_t)data.max.y - data.min.y + 1;
    const int64_t display_width = (int64_t)display.max.x - display.min.x + 1;
    const int64_t display_height = (int64_t)display.max.y - display.min.y + 1;
    const int64_t x = (int64_t)data.min.x - display.min.x;
    const int64_t y = (int64_t)data.min.y - display.min.y;
    if (io__check_size(exr->file->log, exr->file->path, width, height)
        || io__check_size(exr->file->log, exr->file->path, display_width, display_height))
        return -1;
    if (x != (int32_t)x || y != (int32_t)y)
        return io__fail(exr->file->log, exr->file->path,
                        "its data window lies too far from its display window; crop it");
    exr_get_pixel_aspect_ratio(exr->context, part, &aspect);
    if (!isfinite(aspect) || !(aspect > 0.0f)) {
        io__warn(exr->file->log, exr->file->path,
                 "its pixel aspect ratio is not a positive number; 1 is used");
        aspect = 1.0f;
    }
    image->width = (int32_t)width;
    image->height = (int32_t)height;
    image->data_x = (int32_t)x;
    image->data_y = (int32_t)y;
    image->display_width = (int32_t)display_width;
    image->display_height = (int32_t)display_height;
    image->pixel_aspect = aspect;
    io__exr_find_lens(exr, part, &image->lens);
    const char *made = NULL;
    int32_t length = 0;
    if (exr_attr_get_string(exr->context, part, "crevice", &length, &made)
            == EXR_ERR_SUCCESS
        && made)
        snprintf(image->made, sizeof image->made, "%s", made);
    image->camera.has_world_to_camera =
        find_matrix(exr, part, "worldToCamera", image->camera.world_to_camera);
    image->camera.has_world_to_ndc =
        find_matrix(exr, part, "worldToNDC", image->camera.world_to_ndc);
    return 0;
}

int io__exr_list(const io__exr *exr, io_image *image)
{
    image->channels = calloc((size_t)exr->channel_count, sizeof *image->channels);
    if (!image->channels)
        return io__fail(exr->file->log, exr->file->path,
                        "no memory for its list of channels; close other programs");
    image->channel_count = exr->channel_count;
    for (int32_t i = 0; i < exr->channel_count; i++) {
        memcpy(image->channels[i].name, exr->channels[i].name, IO_NAME_SIZE);
        image->channels[i].is_half = exr->channels[i].is_half;
        snprintf(image->channels[i].view, IO_VIEW_SIZE, "%s",
                 view_of(exr, exr->channels[i].part));
    }
    return 0;
}

const io__exr_channel *io__exr_find_channel(const io__exr *exr, const char *name)
{
    for (int32_t i = 0; i < exr->channel_count; i++)
        if (!strcmp(exr->channels[i].name, name))
            return &exr->channels[i];
    return NULL;
}

int io__exr_fail_channel(const io__exr *exr, const char *name)
{
    io_image all = {0};
    if (io__exr_list(exr, &all))
        return -1;
    io__fail_channel(exr->file->log, exr->file->path, name, &all);
    io_image_free(&all);
    return -1;
}

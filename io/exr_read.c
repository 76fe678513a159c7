/* SPDX-License-Identifier: MIT */
/* exr_read.c: reads the wanted channels; the format's row in the table. */
#include <stdlib.h>
#include <string.h>

#include "exr.h"

/* The channels to read, and where they go. */
typedef struct selection {
    int32_t count;
    const io__exr_channel **channels; /* owned */
    io_image image;                   /* owned */
} selection;

/* Sends each chosen channel of a part to its place. */
static int read_part(io__exr *exr, int part, const selection *chosen)
{
    float **targets = calloc((size_t)exr->channel_capacity, sizeof *targets);
    if (!targets)
        return io__fail(exr->file->log, exr->file->path,
                        "no memory; close other programs");
    for (int32_t i = 0; i < chosen->count; i++)
        if (chosen->channels[i]->part == part)
            targets[chosen->channels[i]->index] = chosen->image.channels[i].data;
    const int result = io__exr_read_part(exr, part, targets);
    free(targets);
    return result;
}

static bool part_is_chosen(const selection *chosen, int part)
{
    for (int32_t i = 0; i < chosen->count; i++)
        if (chosen->channels[i]->part == part)
            return true;
    return false;
}

static int choose(const io__exr *exr, const char *const *names, int32_t count,
                  selection *chosen)
{
    const io__file *file = exr->file;
    if (!names && exr->has_deep_parts)
        return io__fail(file->log, file->path,
                        "has deep parts, which are not read; flatten it, or name the "
                        "channels that are wanted");
    chosen->count = names ? count : exr->channel_count;
    chosen->channels = calloc((size_t)chosen->count, sizeof *chosen->channels);
    if (!chosen->channels)
        return io__fail(file->log, file->path, "no memory; close other programs");
    for (int32_t i = 0; i < chosen->count; i++) {
        const io__exr_channel *channel =
            names ? io__exr_find_channel(exr, names[i]) : &exr->channels[i];
        if (!channel)
            return io__exr_fail_channel(exr, names[i]);
        if (channel->subsampled)
            return io__fail(file->log, file->path,
                            "channel \"%s\" has fewer samples than pixels (chroma "
                            "subsampling); write it in full resolution",
                            channel->name);
        for (int32_t j = 0; j < i; j++)
            if (chosen->channels[j] == channel)
                return io__fail(file->log, file->path,
                                "channel \"%s\" is asked for twice; name it once",
                                channel->name);
        chosen->channels[i] = channel;
    }
    return 0;
}

/* All chosen parts must have one data window, and must be in the file as a whole. */
static int check_parts(io__exr *exr, const selection *chosen, io_image *metadata)
{
    const int first = chosen->channels[0]->part;
    if (io__exr_metadata(exr, first, metadata))
        return -1;
    for (int part = 0; part < exr->part_count; part++) {
        io_image other = {0};
        if (!part_is_chosen(chosen, part))
            continue;
        if (io__exr_metadata(exr, part, &other) || io__exr_check_part(exr, part))
            return -1;
        if (other.width != metadata->width || other.height != metadata->height
            || other.data_x != metadata->data_x || other.data_y != metadata->data_y)
            return io__fail(exr->file->log, exr->file->path,
                            "the channels that are wanted lie in parts with different "
                            "data windows; name channels of one part");
    }
    return 0;
}

static int allocate(const io__exr *exr, const io_image *metadata, selection *chosen)
{
    const char **names = calloc((size_t)chosen->count, sizeof *names);
    if (!names)
        return io__fail(exr->file->log, exr->file->path,
                        "no memory; close other programs");
    for (int32_t i = 0; i < chosen->count; i++)
        names[i] = chosen->channels[i]->name;
    io_image *image = &chosen->image;
    const int result = io_image_init(image, metadata->width, metadata->height, names,
                                     chosen->count, exr->file->log);
    free(names);
    if (result)
        return -1;
    io_image described = *metadata;
    described.channels = image->channels;
    described.channel_count = image->channel_count;
    *image = described;
    return 0;
}

static int read_chosen(io__exr *exr, selection *chosen)
{
    io_image metadata = {0};
    if (check_parts(exr, chosen, &metadata) || allocate(exr, &metadata, chosen))
        return -1;
    for (int part = 0; part < exr->part_count; part++)
        if (part_is_chosen(chosen, part) && read_part(exr, part, chosen))
            return -1;
    return 0;
}

static int read_exr(const io__file *file, const char *const *names, int32_t count,
                    io_image *out)
{
    io__exr exr;
    selection chosen = {0};
    if (io__exr_open(file, &exr))
        return -1;
    int result = choose(&exr, names, count, &chosen);
    if (!result)
        result = read_chosen(&exr, &chosen);
    if (result)
        io_image_free(&chosen.image);
    else
        *out = chosen.image;
    free(chosen.channels);
    io__exr_close(&exr);
    return result;
}

static int probe_exr(const io__file *file, io_image *out)
{
    io__exr exr;
    io_image image = {0};
    if (io__exr_open(file, &exr))
        return -1;
    int result = io__exr_metadata(&exr, exr.channels[0].part, &image);
    if (!result)
        result = io__exr_list(&exr, &image);
    if (!result)
        *out = image;
    io__exr_close(&exr);
    return result;
}

static bool recognises_exr(const unsigned char *head, size_t size)
{
    return size >= 4 && !memcmp(head, "\x76\x2f\x31\x01", 4);
}

const io__format io__format_exr = {.name = "an OpenEXR file",
                                   .extension = ".exr",
                                   .recognises = recognises_exr,
                                   .probe = probe_exr,
                                   .read = read_exr,
                                   .write = io__exr_write};

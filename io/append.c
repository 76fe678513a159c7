/* SPDX-License-Identifier: MIT */
/* append.c: decides what a copy of an EXR file holds, part by part. */
#include "append.h"

#include <stdlib.h>
#include <string.h>

#include "exr_copy.h"

#define NOTE_PREFIX "crevice."

enum { NOTE_SIZE = IO_NAME_SIZE + sizeof NOTE_PREFIX };

/* What is being decided. */
typedef struct planner {
    const io__file *file;
    const io_append_options *options;
    const io_addition *additions;
    int32_t count;
    io__exr_copy copy;
    io__exr_layer *layers; /* the additions' pictures, then their factors; owned */
    char (*note_names)[NOTE_SIZE];
} planner;

static int fail_memory(const io__file *file)
{
    return io__fail(file->log, file->path, "no memory to copy it; close other programs");
}

static bool part_is_named(const io__exr *exr, const char *name)
{
    for (int part = 0; part < exr->part_count; part++) {
        const char *given = NULL;
        if (!exr_get_name(exr->context, part, &given) && given && !strcmp(given, name))
            return true;
    }
    return false;
}

/* Whether the pixels of a part can be laid out anew. */
static int check_storage(const io__file *file, const io__exr *exr, int part)
{
    exr_storage_t storage;
    int32_t levels_x = 1, levels_y = 1;
    const exr_result_t code = exr_get_storage(exr->context, part, &storage);
    if (code)
        return io__exr_fail(exr, code, "its EXR header is damaged");
    exr_get_tile_levels(exr->context, part, &levels_x, &levels_y);
    if (levels_x > 1 || levels_y > 1)
        return io__fail(file->log, file->path,
                        "its tiles have mip-map levels, which cannot get a further "
                        "channel; write it without levels");
    return 0;
}

/* What lossy compression left of the pixels must not be packed by it again. */
static exr_compression_t settle_compression(const io__file *file, const io__exr *exr,
                                            int part)
{
    exr_compression_t compression = EXR_COMPRESSION_ZIP;
    exr_get_compression(exr->context, part, &compression);
    if (io__exr_is_lossless(compression))
        return compression;
    io__info(file->log, file->path,
             "its compression is lossy; the copy holds the same pixels, in ZIP");
    return EXR_COMPRESSION_ZIP;
}

/* From here on the part is written anew; its channels are listed. */
static int change_part(planner *p, int part)
{
    io__exr_copy_part *made = &p->copy.parts[part];
    const exr_attr_chlist_t *list = NULL;
    if (made->is_changed)
        return 0;
    if (check_storage(p->file, &p->copy.in, part))
        return -1;
    const exr_result_t code = exr_get_channels(p->copy.in.context, part, &list);
    if (code)
        return io__exr_fail(&p->copy.in, code, "a part has no list of channels");
    made->planes = calloc((size_t)(list->num_channels + p->count), sizeof *made->planes);
    if (!made->planes)
        return fail_memory(p->file);
    for (int i = 0; i < list->num_channels; i++)
        made->planes[i] = (io__exr_plane){.name = list->entries[i].name.str,
                                          .type = list->entries[i].pixel_type,
                                          .treatment = list->entries[i].p_linear
                                                           ? EXR_PERCEPTUALLY_LINEAR
                                                           : EXR_PERCEPTUALLY_LOGARITHMIC,
                                          .x_sampling = list->entries[i].x_sampling,
                                          .y_sampling = list->entries[i].y_sampling,
                                          .source = i};
    made->plane_count = list->num_channels;
    made->is_changed = true;
    made->compression = settle_compression(p->file, &p->copy.in, part);
    return 0;
}

static io__exr_plane make_plane(const planner *p, int32_t index)
{
    return (io__exr_plane){.name = p->additions[index].name,
                           .type = p->options->half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
                           .treatment = EXR_PERCEPTUALLY_LOGARITHMIC,
                           .x_sampling = 1,
                           .y_sampling = 1,
                           .source = -1,
                           .layer = &p->layers[index],
                           .channel = p->additions[index].channel,
                           .outside = p->additions[index].zero_outside ? 0.0f : 1.0f};
}

static const char *part_name(const io_addition *addition)
{
    return addition->part ? addition->part : addition->name;
}

/* The channel is of a new part, which an addition before it may have made. Returns the
 * part, or -1. */
static int add_to_new_part(planner *p, int32_t index, int beside)
{
    io__exr_copy *copy = &p->copy;
    const char *name = part_name(&p->additions[index]);
    int part = copy->in.part_count;
    while (part < copy->part_count && strcmp(copy->parts[part].name, name) != 0)
        part++;
    io__exr_copy_part *made = &copy->parts[part];
    if (part == copy->part_count) {
        *made = (io__exr_copy_part){.source = -1,
                                    .name = name,
                                    .beside = beside,
                                    .is_changed = true,
                                    .compression = EXR_COMPRESSION_ZIP};
        made->planes = calloc((size_t)p->count, sizeof *made->planes);
        if (!made->planes)
            return fail_memory(p->file);
        copy->part_count++;
    }
    made->planes[made->plane_count++] = make_plane(p, index);
    return part;
}

/* A clash of names; the channel that is there, or NULL, in *there. */
static int check_name(const planner *p, const io_addition *addition,
                      const io__exr_channel **there)
{
    const io__file *file = p->file;
    *there = io__exr_find_channel(&p->copy.in, addition->name);
    if (!addition->name[0] || strlen(addition->name) >= IO_NAME_SIZE)
        return io__fail(file->log, file->path,
                        "the name of the new channel is empty or longer than %d bytes; "
                        "choose another",
                        IO_NAME_SIZE - 1);
    if (*there && !p->options->replace)
        return io__fail(file->log, file->path,
                        "has a channel \"%s\" already; choose another name, or ask for "
                        "it to be replaced",
                        addition->name);
    if (!*there && p->copy.in.part_count > 1
        && part_is_named(&p->copy.in, part_name(addition)))
        return io__fail(file->log, file->path,
                        "has a part \"%s\" already; choose another name",
                        part_name(addition));
    for (const io_addition *other = p->additions; other < addition; other++)
        if (other->is_added && !strcmp(other->name, addition->name))
            return io__fail(file->log, file->path,
                            "the channel \"%s\" would be added twice; choose two names",
                            addition->name);
    return 0;
}

/* Places the new channel. Returns the part of the copy that it is in, or -1. */
static int plan_channel(planner *p, int32_t index, int beside)
{
    const io_addition *addition = &p->additions[index];
    const io__exr_channel *there;
    if (check_name(p, addition, &there))
        return -1;
    if (!there && p->copy.in.part_count > 1)
        return add_to_new_part(p, index, beside);
    const int part = there ? there->part : beside;
    if (change_part(p, part))
        return -1;
    io__exr_copy_part *made = &p->copy.parts[part];
    io__exr_plane *plane = &made->planes[made->plane_count];
    if (there) {
        plane = &made->planes[there->index];
        const char *name = plane->name;
        *plane = make_plane(p, index);
        plane->name = name;
    } else {
        *plane = make_plane(p, index);
        made->plane_count++;
    }
    return part;
}

/* 0: red, 1: green, 2: blue, -1: another channel. */
static int colour_of(const char *channel)
{
    static const char *const names[] = {"r", "red", "g", "green", "b", "blue"};
    const char *dot = strrchr(channel, '.');
    for (int i = 0; i < 6; i++)
        if (text_is_same(dot ? dot + 1 : channel, names[i]))
            return i / 2;
    return -1;
}

static int plan_multiplied(planner *p, int32_t index, const char *name)
{
    const io__file *file = p->file;
    const io__exr_channel *channel = io__exr_find_channel(&p->copy.in, name);
    if (!channel)
        return io__exr_fail_channel(&p->copy.in, name);
    if (change_part(p, channel->part))
        return -1;
    io__exr_plane *plane = &p->copy.parts[channel->part].planes[channel->index];
    if (plane->type == EXR_PIXEL_UINT || channel->subsampled)
        return io__fail(file->log, file->path,
                        "channel \"%s\" holds %s and cannot be multiplied; name colours",
                        name,
                        channel->subsampled ? "fewer samples than pixels" : "integers");
    if (plane->layer)
        return io__fail(file->log, file->path,
                        "channel \"%s\" is to be multiplied twice, or replaced; name it "
                        "once",
                        name);
    const int colour = colour_of(name);
    const float *tint = p->options->tint;
    const bool by_factors = p->additions[index].factors;
    plane->layer = &p->layers[by_factors ? p->count + index : index];
    plane->channel = by_factors ? colour : p->additions[index].channel;
    plane->outside = 1.0f;
    plane->tint = colour >= 0 ? tint[colour] : (tint[0] + tint[1] + tint[2]) / 3.0f;
    return 0;
}

/* Where the pictures lie in the coordinates of the file. */
static int place(planner *p, int32_t index, int beside)
{
    const io_image *pictures[] = {p->additions[index].picture,
                                  p->additions[index].factors};
    exr_attr_box2i_t display;
    const exr_result_t code =
        exr_get_display_window(p->copy.in.context, beside, &display);
    if (code)
        return io__exr_fail(&p->copy.in, code, "its windows are missing from the header");
    for (int i = 0; i < 2; i++)
        if (pictures[i])
            p->layers[i * p->count + index] =
                (io__exr_layer){.picture = pictures[i],
                                .x = (int64_t)display.min.x + pictures[i]->data_x,
                                .y = (int64_t)display.min.y + pictures[i]->data_y};
    return 0;
}

static void add_note(planner *p, int32_t index, int part)
{
    io__exr_copy *copy = &p->copy;
    if (!p->additions[index].made)
        return;
    snprintf(p->note_names[index], NOTE_SIZE, NOTE_PREFIX "%s", p->additions[index].name);
    copy->notes[copy->note_count++] =
        (io__exr_note){part, p->note_names[index], p->additions[index].made};
}

static int plan_addition(planner *p, int32_t index)
{
    const io_addition *addition = &p->additions[index];
    const io__exr_channel *beside = io__exr_find_channel(&p->copy.in, addition->beside);
    if (!beside)
        return io__fail(p->file->log, p->file->path,
                        "channel \"%s\" is there no more; start again", addition->beside);
    int part = beside->part;
    if (place(p, index, part))
        return -1;
    if (addition->is_added)
        part = plan_channel(p, index, part);
    for (int32_t i = 0; part >= 0 && i < addition->multiplied_count; i++)
        if (plan_multiplied(p, index, addition->multiplied[i]))
            return -1;
    if (part < 0)
        return -1;
    add_note(p, index, part);
    return 0;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const io__exr_plane *)a)->name, ((const io__exr_plane *)b)->name);
}

static int plan(planner *p)
{
    io__exr_copy *copy = &p->copy;
    const size_t parts = (size_t)(copy->in.part_count + p->count);
    copy->parts = calloc(parts, sizeof *copy->parts);
    copy->notes = calloc((size_t)p->count, sizeof *copy->notes);
    p->layers = calloc(2 * (size_t)p->count, sizeof *p->layers);
    p->note_names = calloc((size_t)p->count, sizeof *p->note_names);
    if (!copy->parts || !copy->notes || !p->layers || !p->note_names)
        return fail_memory(p->file);
    copy->part_count = copy->in.part_count;
    for (int part = 0; part < copy->part_count; part++)
        copy->parts[part].source = part;
    for (int32_t i = 0; i < p->count; i++)
        if (plan_addition(p, i))
            return -1;
    /* As in the file. */
    for (int part = 0; part < copy->part_count; part++)
        if (copy->parts[part].is_changed)
            qsort(copy->parts[part].planes, (size_t)copy->parts[part].plane_count,
                  sizeof(io__exr_plane), by_name);
    return 0;
}

static void discard(planner *p)
{
    for (int part = 0; p->copy.parts && part < p->copy.part_count; part++)
        free(p->copy.parts[part].planes);
    free(p->copy.parts);
    free(p->copy.notes);
    free(p->layers);
    free(p->note_names);
    io__exr_close(&p->copy.in);
}

/* Finds a part that is copied as it is and of which chunks lie beyond the file. Those of
 * deep and lossy parts show it when they are copied: to be sure before, they would have
 * to be unpacked. */
static int check_whole(io__exr *exr, int part)
{
    exr_storage_t storage;
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    const exr_result_t code = exr_get_storage(exr->context, part, &storage);
    if (code)
        return io__exr_fail(exr, code, "its EXR header is damaged");
    exr_get_compression(exr->context, part, &compression);
    if (storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED
        || !io__exr_is_lossless(compression))
        return 0;
    return io__exr_check_chunks(exr, part);
}

static int write_copy(planner *p, const char *output)
{
    io__output opened;
    if (io__output_open(&opened, output, p->file->log))
        return -1;
    opened.stop = p->options->stop;
    opened.watch = p->options->watch;
    if (!io__exr_copy_write(&p->copy, &opened))
        return io__output_commit(&opened);
    io__output_discard(&opened);
    return -1;
}

/* Opens the input, plans and, if there is an output, writes. */
static int run(const char *input, const char *output, const io_addition *additions,
               int32_t count, const io_append_options *options, const crv_logger *log)
{
    io__file file;
    if (io__file_open(input, log, &file))
        return -1;
    planner p = {
        .file = &file, .options = options, .additions = additions, .count = count};
    int result = io__exr_open(&file, &p.copy.in);
    if (!result) {
        result = plan(&p);
        for (int part = 0; !result && part < p.copy.in.part_count; part++)
            if (p.copy.parts[part].is_changed)
                result = io__exr_check_part(&p.copy.in, part);
            else
                result = check_whole(&p.copy.in, part);
        if (!result && output)
            result = write_copy(&p, output);
        discard(&p);
    }
    fclose(file.stream);
    return result;
}

int io_append(const char *input, const char *output, const io_addition *additions,
              int32_t count, const io_append_options *options, const crv_logger *log)
{
    return run(input, output, additions, count, options, log);
}

int io_append_check(const char *input, const io_addition *additions, int32_t count,
                    const io_append_options *options, const crv_logger *log)
{
    return run(input, NULL, additions, count, options, log);
}

void io_append_made(const char *path, const char *name, char made[IO_MADE_SIZE])
{
    io__file file;
    io__exr exr;
    char attribute[NOTE_SIZE];
    made[0] = '\0';
    snprintf(attribute, sizeof attribute, NOTE_PREFIX "%s", name);
    if (io__file_open(path, NULL, &file))
        return;
    if (!io__exr_open(&file, &exr)) {
        bool whole = true;
        for (int part = 0; part < exr.part_count; part++) {
            int32_t length = 0;
            const char *text = NULL;
            whole = whole && !check_whole(&exr, part);
            if (!exr_attr_get_string(exr.context, part, attribute, &length, &text)
                && text)
                snprintf(made, IO_MADE_SIZE, "%s", text);
        }
        if (!whole)
            made[0] = '\0';
        io__exr_close(&exr);
    }
    fclose(file.stream);
}

/* SPDX-License-Identifier: MIT */
#include "camera_file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "camera_parse.h"
#include "system/file.h"
#include "system/text.h"

enum { LARGEST = 64 << 20 /* bytes; a camera takes a few hundred */ };

const char *const camera_file_orders[] = {"zxy", "xyz", "xzy", "yxz", "yzx", "zyx", NULL};

bool camera_file_is_named(const char *path)
{
    return text_ends_with(path, ".json") || text_ends_with(path, ".chan");
}

bool camera_is_frame(double number)
{
    return fabs(number) <= 99999999.0 && floor(number) >= number;
}

int camera_file_add(camera_file *file, const camera_entry *entry, report *r)
{
    if (file->count == file->capacity) {
        const int32_t capacity = file->capacity ? 2 * file->capacity : 16;
        camera_entry *more =
            realloc(file->entries, (size_t)capacity * sizeof *file->entries);
        if (!more)
            return report_no_memory(r);
        file->entries = more;
        file->capacity = capacity;
    }
    file->entries[file->count++] = *entry;
    return EXIT_DONE;
}

static int refuse(const char *path, const char *what, report *r)
{
    report_error(r, "%s: %s", path, what);
    return EXIT_FAILED;
}

/* The whole file with a zero behind it; the caller frees it. */
static int read_text(const char *path, char **text, size_t *size, report *r)
{
    file_facts facts;
    if (!file_look(path, &facts))
        return refuse(path, strerror(errno), r);
    if (!facts.is_regular)
        return refuse(path, "is no regular file; name a file of cameras", r);
    if (facts.size > LARGEST)
        return refuse(path, "is larger than any file of cameras; name another", r);
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return refuse(path, strerror(errno), r);
    *text = malloc((size_t)facts.size + 1);
    *size = *text ? fread(*text, 1, (size_t)facts.size, stream) : 0;
    const bool whole = *text && *size == (size_t)facts.size;
    fclose(stream);
    if (!*text)
        return report_no_memory(r);
    (*text)[*size] = '\0';
    if (whole)
        return EXIT_DONE;
    free(*text);
    return refuse(path, "cannot be read to its end; copy it again", r);
}

/* FNV-1a, of Fowler, Noll and Vo. */
static uint64_t checksum_of(const char *text, size_t size)
{
    uint64_t sum = 14695981039346656037u;
    for (size_t i = 0; i < size; i++)
        sum = (sum ^ (unsigned char)text[i]) * 1099511628211u;
    return sum;
}

int camera_file_load(const char *path, int order, camera_file *out, report *r)
{
    char *text = NULL;
    size_t size = 0;
    *out = (camera_file){.path = path};
    int result = read_text(path, &text, &size, r);
    if (result != EXIT_DONE)
        return result;
    out->checksum = checksum_of(text, size);
    const char first = text[strspn(text, " \t\r\n\xef\xbb\xbf")];
    result = first == '{' || first == '[' ? camera_parse_json(text, size, out, r)
                                          : camera_parse_chan(text, order, out, r);
    free(text);
    if (result == EXIT_DONE && out->count == 0)
        result = refuse(path, "holds no camera; export it again", r);
    if (result != EXIT_DONE)
        camera_file_free(out);
    return result;
}

void camera_file_free(camera_file *file)
{
    free(file->entries);
    *file = (camera_file){0};
}

const camera_entry *camera_file_find(const camera_file *file, bool has_frame,
                                     int32_t frame, const char *of, report *r)
{
    int32_t first = INT32_MAX, last = INT32_MIN;
    for (int32_t i = 0; i < file->count; i++) {
        const camera_entry *entry = &file->entries[i];
        if (!entry->has_frame || (has_frame && entry->frame == frame)
            || (!has_frame && file->count == 1))
            return entry;
        first = entry->frame < first ? entry->frame : first;
        last = entry->frame > last ? entry->frame : last;
    }
    if (!r)
        return NULL;
    if (has_frame)
        report_error(r,
                     "%s: has no camera for frame %d of %s; it holds frames from %d to "
                     "%d: export that one, too",
                     file->path, (int)frame, of, (int)first, (int)last);
    else
        report_error(r,
                     "%s: holds cameras of several frames, and %s has no number; name it "
                     "with its frame's number, such as shot.0008.exr",
                     file->path, of);
    return NULL;
}

/* SPDX-License-Identifier: MIT */
#include "ao_camera.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

int ao_camera_set(const ao_settings *s, const camera_file *file, const ao_frame *frame,
                  io_passes_request *request, report *r)
{
    const camera_entry *entry =
        camera_file_find(file, frame->has_number, frame->number, frame->path, r);
    if (!entry)
        return EXIT_FAILED;
    const bool has_lens =
        entry->vfov_rad > 0.0 || entry->hfov_rad > 0.0 || entry->view_height > 0.0;
    const bool given =
        s->vfov_deg.given || s->hfov_deg.given || s->lens_mm.given || s->ortho.given;
    if (has_lens && given && !r)
        return EXIT_USAGE;
    if (has_lens && given) {
        report_error(r,
                     "--camera: %s holds the field of view; leave out --vfov, --hfov, "
                     "--lens and --ortho",
                     file->path);
        return EXIT_USAGE;
    }
    if (has_lens) {
        request->vfov_rad = (float)entry->vfov_rad;
        request->hfov_rad = (float)entry->hfov_rad;
        request->view_height = (float)entry->view_height;
    }
    request->pose.given = entry->has_pose;
    memcpy(request->pose.to_view, entry->to_view, sizeof entry->to_view);
    memcpy(request->pose.eye, entry->eye, sizeof entry->eye);
    return EXIT_DONE;
}

bool ao_camera_number(const char *path, int32_t *number)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    const char *end = dot ? dot : name + strlen(name);
    while (end > name && !isdigit((unsigned char)end[-1]))
        end--;
    const char *begin = end;
    while (begin > name && isdigit((unsigned char)begin[-1]))
        begin--;
    if (begin == end || end - begin > 8)
        return false;
    *number = (int32_t)strtol(begin, NULL, 10);
    /* "shot.-3.exr", not "shot-3.exr". */
    if (begin > name && begin[-1] == '-' && (begin - 1 == name || begin[-2] == '.'))
        *number = -*number;
    return true;
}

/* SPDX-License-Identifier: MIT */
#include "frame_camera.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180.0;

const char *const frame_camera_found[] = {"fit", NULL};

const char *frame_camera_mistake(const frame_camera_settings *s)
{
    if (s->ortho.given && (s->vfov_deg.given || s->hfov_deg.given || s->lens_mm.given))
        return "--ortho: contradicts --vfov, --hfov and --lens; give one of them";
    if (s->vfov_deg.given + s->hfov_deg.given + s->lens_mm.given > 1)
        return "--vfov: contradicts --hfov and --lens; give one of them";
    if (s->order.given && !s->file)
        return "--camera-order: is for --camera; add that";
    if (s->sensor_mm.given && !s->lens_mm.given)
        return "--sensor: is for --lens; add that";
    return NULL;
}

/* A view as narrow as that is rare; angles in radians are not. */
static void doubt_angle(const char *flag, bool given, double value, report *r)
{
    const double largest_rad = 3.2;
    if (given && value < largest_rad)
        report_warning(r, "%s: %g is taken as degrees; %g radians are %.4g degrees", flag,
                       value, value, value / degree);
}

void frame_camera_doubt(const frame_camera_settings *s, report *r)
{
    doubt_angle("--vfov", s->vfov_deg.given, s->vfov_deg.value, r);
    doubt_angle("--hfov", s->hfov_deg.given, s->hfov_deg.value, r);
}

void frame_camera_share(const frame_camera_settings *s, io_passes_request *request)
{
    request->fit_vfov = s->vfov_deg.given && isnan(s->vfov_deg.value);
    if (s->vfov_deg.given && !request->fit_vfov)
        request->vfov_rad = (float)(s->vfov_deg.value * degree);
    if (s->hfov_deg.given)
        request->hfov_rad = (float)(s->hfov_deg.value * degree);
    if (s->lens_mm.given)
        request->hfov_rad =
            (float)(2.0 * atan(0.5 * s->sensor_mm.value / s->lens_mm.value));
    if (s->ortho.given)
        request->view_height = (float)s->ortho.value;
}

int frame_camera_set(const frame_camera_settings *s, const camera_file *file,
                     const camera_frame *frame, io_passes_request *request, report *r)
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

bool frame_camera_number(const char *path, int32_t *number)
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

/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include <math.h>

#include "common/frame_camera.h"

static void check_entry(const camera_entry *e)
{
    double length = 0.0;
    for (int i = 0; i < 3; i++) {
        FUZZ_CHECK(isfinite(e->eye[i]) && isfinite(e->target[i]) && isfinite(e->up[i]),
                   "axis %d", i);
        length += e->to_view[i] * e->to_view[i];
    }
    /* Rounding of a row of doubles. */
    FUZZ_CHECK(!e->has_pose || fabs(length - 1.0) < 1e-9, "squared length %g", length);
    FUZZ_CHECK(e->vfov_rad >= 0.0 && e->vfov_rad < 3.2 && e->hfov_rad >= 0.0
                   && e->hfov_rad < 3.2 && e->view_height >= 0.0
                   && isfinite(e->view_height),
               "%g, %g rad, %g", e->vfov_rad, e->hfov_rad, e->view_height);
}

/* The first byte chooses the order of angles; the rest is the file. */
void fuzz_cameras(const uint8_t *data, size_t size)
{
    report r;
    camera_file file = {0};
    if (size < 2)
        return;
    report_init(&r);
    r.logger = fuzz_logger;
    r.quiet = true;
    const char *path = fuzz_file("input", data + 1, size - 1);
    const int result = camera_file_load(path, data[0] % 6, &file, &r);
    FUZZ_CHECK(r.errors == (result != EXIT_DONE), "exit code %d, %d lines", result,
               r.errors);
    if (result != EXIT_DONE)
        return;
    FUZZ_CHECK(file.count > 0, "no camera");
    for (int32_t i = 0; i < file.count; i++)
        check_entry(&file.entries[i]);
    const camera_frame frame = {
        .has_number = true, .number = file.entries[0].frame, .path = "shot.1.exr"};
    const frame_camera_settings settings = {0};
    io_passes_request request = {.depth_format = crv_depth_format_planar()};
    const int set = frame_camera_set(&settings, &file, &frame, &request, &r);
    FUZZ_CHECK(r.errors == (set != EXIT_DONE), "exit code %d, %d lines", set, r.errors);
    camera_file_free(&file);
}

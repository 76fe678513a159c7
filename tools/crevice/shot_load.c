/* SPDX-License-Identifier: MIT */
/* shot_load.c: frames, read as their shot reads them. */
#include "shot_state.h"

#include "common/reading.h"
#include "masks.h"

enum { LOOKED_AT = 5 };

/* What is known of a frame before it is read. */
static int request_frame(const shot *t, const frame_paths *paths,
                         io_passes_request *request, report *r)
{
    const camera_frame frame = {paths->has_number, paths->number, paths->input};
    *request = t->request;
    const frame_camera_settings *camera = &t->settings->camera;
    return camera->file ? frame_camera_set(camera, &t->cameras, &frame, request, r)
                        : EXIT_DONE;
}

static int load(const shot *t, const frame_paths *paths, io_frame *frame, report *r)
{
    io_passes_request request;
    const int result = request_frame(t, paths, &request, r);
    if (result != EXIT_DONE)
        return result;
    if (reading_frame(paths->input, &request, frame, &r->logger, r) != 0)
        return EXIT_FAILED;
    if (t->settings->layer_kind.given)
        frame->desc.layer_kind = (crv_layers)t->settings->layer_kind.value;
    return EXIT_DONE;
}

/* The i-th of some frames that are spread over the shot, the first included. */
static int32_t spread_frame(const shot *t, int32_t i)
{
    const int32_t last = frames_count(t->list) - 1;
    const int32_t parts = last < LOOKED_AT ? last : LOOKED_AT;
    return frames_at(t->list, i < parts ? (int32_t)((int64_t)i * last / parts) : last);
}

/* Lets other frames of the shot decide how normals are read, if the first cannot. */
static void ask_the_shot(shot *t, report *r)
{
    const int32_t count = t->list ? frames_count(t->list) : 0;
    frame_paths paths;
    for (int32_t i = 1; i <= LOOKED_AT && i < count; i++) {
        const int32_t number = spread_frame(t, i);
        io_frame frame = {0};
        io_passes_request request;
        if (shot_name_frame(t, number, &paths, r) != EXIT_DONE
            || request_frame(t, &paths, &request, NULL) != EXIT_DONE
            || io_frame_load(paths.input, &request, &frame, NULL) != 0)
            continue;
        const int reading = frame.reading_decided ? frame.reading : 0;
        io_frame_free(&frame);
        if (!reading)
            continue;
        t->request.usual_reading = reading;
        report_info(r, "normals: %s decides how they are read, for the whole shot",
                    paths.input);
        return;
    }
}

/* Loads a frame, and again if the shot reads its normals otherwise. */
int shot_load(shot *t, const frame_paths *paths, io_frame *frame, report *r)
{
    int result = load(t, paths, frame, r);
    if (result != EXIT_DONE)
        return result;
    if (frame->reading && frame->reading_decided && !t->request.is_later)
        t->request.usual_reading = frame->reading;
    if (frame->reading && !frame->reading_decided && !t->request.is_later
        && !t->request.usual_reading) {
        ask_the_shot(t, r);
        if (t->request.usual_reading && t->request.usual_reading != frame->reading) {
            io_frame_free(frame);
            result = load(t, paths, frame, r);
        }
    }
    if (result != EXIT_DONE)
        return result;
    if (!t->request.is_later)
        t->request.usual_deviation = frame->deviation;
    t->request.is_later = true;
    t->request.zoom_told |= frame->zooms;
    t->request.depth_format.encoding = frame->encoding;
    return masks_take_out(t->settings, paths->input, frame, r);
}

/* --vfov fit: the first frame that decides it, for all. */
int shot_find_lens(shot *t, report *r)
{
    frame_paths paths;
    io_passes_request request;
    io_frame frame = {0};
    int result = EXIT_FAILED;
    for (int32_t i = 0; i <= LOOKED_AT + 1 && result == EXIT_FAILED; i++) {
        /* In the end the first again, for its error line. */
        const bool speak = i == LOOKED_AT + 1;
        result = shot_name_frame(t, spread_frame(t, speak ? 0 : i), &paths, r);
        if (result == EXIT_DONE)
            result = request_frame(t, &paths, &request, speak ? r : NULL);
        if (result == EXIT_DONE
            && io_frame_load(paths.input, &request, &frame, speak ? &r->logger : NULL))
            result = EXIT_FAILED;
    }
    /* Positions tell the camera of each frame. */
    if (result == EXIT_DONE && frame.fitted_vfov_rad > 0.0f) {
        t->request.fit_vfov = false;
        t->request.vfov_rad = frame.fitted_vfov_rad;
        report_info(r, "field of view: --vfov %.4f, found from %s for the whole shot",
                    (double)frame.fitted_vfov_rad * 57.29577951308232, paths.input);
    }
    io_frame_free(&frame);
    return result;
}

/* SPDX-License-Identifier: MIT */
#include "tune_work.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ao_pass.h"
#include "common/radius.h"
#include "common/reading.h"

/* A renderer's picture of accessibility holds no more than 1, but for rounding. */
#define WHITE_MAX 1.01f

static const char *const cure = "--truth FILE:CHANNEL";

/* FILE:CHANNEL taken apart, unless the whole is the name of a file. *channel: in path. */
static void take_apart(char *path, const char **channel)
{
    io_image probe = {0};
    char *colon = strrchr(path, ':');
    *channel = NULL;
    if (!colon || colon[1] == '\0' || io_probe(path, &probe, NULL) == 0) {
        io_image_free(&probe);
        return;
    }
    *colon = '\0';
    *channel = colon + 1;
}

/* The channel's name, of a file that may be the frame itself. */
static int choose(const char *path, const char *wanted, bool is_frame,
                  char name[IO_NAME_SIZE], report *r)
{
    io_image probe = {0};
    const char *found[3];
    if (io_probe(path, &probe, &r->logger) != 0)
        return EXIT_FAILED;
    const char *chosen = NULL;
    /* The only channel of a frame is its depth. */
    if (!is_frame || wanted || io_find_pass(&probe, IO_PASS_AO, found))
        chosen = ao_pass_choose(path, &probe, wanted, cure, r);
    else
        report_error(r,
                     "%s: has no pass of ambient occlusion to fit to; give one with "
                     "--truth FILE[:CHANNEL]",
                     path);
    if (chosen)
        snprintf(name, IO_NAME_SIZE, "%s", chosen);
    io_image_free(&probe);
    return chosen ? EXIT_DONE : EXIT_USAGE;
}

/* Whether the picture holds all pixels of the window: it is of the same size, or larger
 * where both lie in the same display window. */
static bool covers(const io_image *image, const io_image *window)
{
    if (image->width == window->width && image->height == window->height)
        return true;
    return image->display_width == window->display_width
           && image->display_height == window->display_height
           && image->data_x <= window->data_x && image->data_y <= window->data_y
           && image->data_x + image->width >= window->data_x + window->width
           && image->data_y + image->height >= window->data_y + window->height;
}

/* The window's part of the truth into the view. */
static int take_truth(tune_view *v, const char *path, const io_image *image,
                      const io_image *window, report *r)
{
    const float *values = image->channels[0].data;
    const bool same = image->width == v->width && image->height == v->height;
    float *part = malloc((size_t)v->width * (size_t)v->height * sizeof *part);
    if (!part)
        return report_no_memory(r);
    if (!covers(image, window)) {
        report_error(r, "%s: is %dx%d, but the result is %dx%d; give a truth of its size",
                     path, image->width, image->height, v->width, v->height);
        free(part);
        return EXIT_FAILED;
    }
    if (!same)
        io_copy_window(image, values, window, part);
    tune_view_take(v, same ? values : part);
    free(part);
    for (int32_t i = 0; i < v->count; i++) {
        if (v->truth[i] >= 0.0f && v->truth[i] <= WHITE_MAX)
            continue;
        report_error(r,
                     "%s: \"%s\" holds %g at (%d, %d), which is no accessibility; give a "
                     "channel from 0, occluded, to 1, open",
                     path, image->channels[0].name, (double)v->truth[i],
                     v->pixel[i] % v->width, v->pixel[i] / v->width);
        return EXIT_FAILED;
    }
    return EXIT_DONE;
}

/* truth: FILE[:CHANNEL], NULL for the frame's own pass. window: of the result. */
static int read_truth(tune_work *w, int index, const char *frame, const char *truth,
                      const io_image *window)
{
    report *r = w->r;
    tune_view *v = &w->view[index];
    const char *wanted = NULL, *source = truth ? truth : frame;
    char name[IO_NAME_SIZE] = "";
    const char *const names[] = {name};
    const size_t length = strlen(source);
    io_image image = {0};
    char *path = malloc(length + 1);
    if (!path)
        return report_no_memory(r);
    memcpy(path, source, length + 1);
    if (truth)
        take_apart(path, &wanted);
    int result = choose(path, wanted, io_is_same_file(path, frame), name, r);
    if (result == EXIT_DONE
        && reading_picture(path, names, 1, &image, &r->logger, r) != 0)
        result = EXIT_FAILED;
    if (result == EXIT_DONE)
        result = take_truth(v, path, &image, window, r);
    if (result == EXIT_DONE && v->count > 0 && tune_view_is_open(v)) {
        report_error(r, "%s: \"%s\" is white: there is nothing to fit to; choose with %s",
                     path, name, cure);
        result = EXIT_FAILED;
    }
    io_image_free(&image);
    free(path);
    return result;
}

/* Reads a frame with its own camera, if a file has one of each. */
static int read_frame(const tune_work *w, const char *path, io_frame *out)
{
    const frame_camera_settings camera = viewer_frame_camera(&w->s->in);
    camera_frame frame = {.path = path};
    camera_file cameras = {0};
    io_passes_request request = pass_request(&w->s->in.passes);
    int result = EXIT_DONE;
    request.keep_overscan = true; /* as `crevice ao` does */
    frame_camera_share(&camera, &request);
    frame.has_number = frame_camera_number(path, &frame.number);
    if (camera.file)
        result = camera_file_load(camera.file, camera.order.value, &cameras, w->r);
    if (result == EXIT_DONE && camera.file)
        result = frame_camera_set(&camera, &cameras, &frame, &request, w->r);
    camera_file_free(&cameras);
    if (result != EXIT_DONE)
        return result;
    if (reading_frame(path, &request, out, &w->r->logger, w->r) != 0)
        return EXIT_FAILED;
    if (w->s->in.view.layer_kind.given)
        out->desc.layer_kind = (crv_layers)w->s->in.view.layer_kind.value;
    return EXIT_DONE;
}

/* The frame into a view without its truth. *window: of the result, without pixels. */
static int load(tune_work *w, int index, const char *path, io_image *window)
{
    const view_settings *s = &w->s->in.view;
    estimator *e = &w->e;
    io_frame frame = {0};
    float *depth = NULL;
    int result = read_frame(w, path, &frame);
    if (result != EXIT_DONE)
        return result;
    estimate_fit(e, &frame.desc);
    if (!report_ok(w->r, io_frame_to_gbuffer(&frame, e->context, &e->gbuffer),
                   "G-buffer"))
        result = EXIT_FAILED;
    if (result == EXIT_DONE && index == TUNE_FITTED && !s->common.radius_given) {
        result = radius_suggest(e, &frame, &w->start.radius, w->r);
        report_info(w->r, "radius: --radius %g, chosen to suit the view",
                    (double)w->start.radius);
    }
    if (result == EXIT_DONE)
        result = estimate_depth(e, &depth, w->r);
    /* The estimator makes another one for the next frame. */
    w->gbuffer[index] = e->gbuffer;
    e->gbuffer = NULL;
    if (result == EXIT_DONE
        && !tune_view_open(&w->view[index], e->context, w->gbuffer[index], &frame.desc,
                           depth, 0))
        result = report_no_memory(w->r);
    *window = (io_image){.width = w->view[index].width,
                         .height = w->view[index].height,
                         .data_x = frame.image.data_x + frame.desc.guard_left,
                         .data_y = frame.image.data_y + frame.desc.guard_top,
                         .display_width = frame.image.display_width,
                         .display_height = frame.image.display_height};
    free(depth);
    io_frame_free(&frame);
    return result;
}

int tune_frame_load(tune_work *w)
{
    const char *frame = w->s->in.view.model;
    io_image window;
    const int result = load(w, TUNE_FITTED, frame, &window);
    return result == EXIT_DONE ? read_truth(w, TUNE_FITTED, frame, w->s->truth, &window)
                               : result;
}

int tune_frame_other(tune_work *w, bool *shows)
{
    const char *frame = w->s->check;
    if (!frame)
        return EXIT_DONE;
    io_image window;
    int result = load(w, TUNE_OTHER, frame, &window);
    *shows = result == EXIT_DONE && w->view[TUNE_OTHER].count > 0;
    if (*shows)
        result = read_truth(w, TUNE_OTHER, frame, w->s->check_truth, &window);
    return result;
}

/* SPDX-License-Identifier: MIT */
#include "source.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/radius.h"

/* Frames of a shot that are asked for its field of view. */
enum { LENS_TRIED = 6 };

const char *source_frame_name(const source *s, int32_t index, char *out, size_t size)
{
    const char *input = s->settings->model;
    if (s->list.ranges > 0)
        return frames_name(input, frames_at(&s->list, index), out, size) ? out : NULL;
    return (size_t)snprintf(out, size, "%s", input) < size ? out : NULL;
}

static int open_shot(source *s, const char *frames, report *r)
{
    const char *input = s->settings->model;
    s->frame_count = 1;
    if (!frames && frames_places(input) == 0)
        return EXIT_DONE;
    if (!frames || !frames_parse(frames, &s->list) || frames_places(input) != 1) {
        report_error(r, "--frames: give the range and one place for the frame's number "
                        "in INPUT, as in shot.####.exr --frames 1-240");
        return EXIT_USAGE;
    }
    s->frame_count = frames_count(&s->list);
    return EXIT_DONE;
}

/* Reads the frame at this place of the list with its own camera. r NULL: without lines.
 */
static bool load_frame(source *s, int32_t index, io_frame *out, report *r)
{
    char path[4096];
    camera_frame frame = {.path = source_frame_name(s, index, path, sizeof path)};
    io_passes_request request = s->request;
    if (!frame.path) {
        if (r)
            report_error(r, "%s: is too long a name", s->settings->model);
        return false;
    }
    frame.has_number = frame_camera_number(frame.path, &frame.number);
    if (s->list.ranges > 0) {
        frame.has_number = true;
        frame.number = frames_at(&s->list, index);
    }
    if (s->camera.file
        && frame_camera_set(&s->camera, &s->cameras, &frame, &request, r) != EXIT_DONE)
        return false;
    return io_frame_load(frame.path, &request, out, r ? &r->logger : NULL) == 0;
}

/* --vfov fit: the first frame that decides it, for all. */
static bool find_lens(source *s, report *r)
{
    bool found = false;
    for (int32_t i = 0; i <= LENS_TRIED && !found; i++) {
        /* In the end the first again, for its error line. */
        const bool speak = i == LENS_TRIED;
        const int32_t place =
            speak ? 0 : (int32_t)((int64_t)i * s->frame_count / LENS_TRIED);
        io_frame frame = {0};
        if (!load_frame(s, place, &frame, speak ? r : NULL))
            continue;
        found = true;
        /* Positions tell the camera of each frame. */
        if (frame.fitted_vfov_rad > 0.0f) {
            s->request.fit_vfov = false;
            s->request.vfov_rad = frame.fitted_vfov_rad;
        }
        io_frame_free(&frame);
    }
    return found;
}

/* Whether the first frame has a picture that occlusion can be multiplied into. */
static void find_beauty(source *s)
{
    char path[4096];
    const char *name = source_frame_name(s, 0, path, sizeof path), *found[3];
    io_image probed = {0};
    if (!name || io_probe(name, &probed, NULL) != 0)
        return; /* who reads the frame will say so */
    s->has_beauty = io_find_pass(&probed, IO_PASS_BEAUTY, found) == 3;
    for (int i = 0; i < 3 && s->has_beauty; i++)
        snprintf(s->beauty[i], sizeof s->beauty[i], "%s", found[i]);
    io_image_free(&probed);
}

/* Without a picture there is none to be lit. */
static void read_beauty(const source *s, const char *path, const io_frame *frame,
                        buffers *b)
{
    const crv_gbuffer_desc *d = &frame->desc;
    const char *const names[] = {s->beauty[0], s->beauty[1], s->beauty[2]};
    const size_t inner = (size_t)b->width * (size_t)b->height;
    const size_t whole = (size_t)d->width * (size_t)d->height;
    io_image image = {0};
    if (!s->has_beauty || frame->image.width != d->width
        || frame->image.height != d->height || io_read(path, names, 3, &image, NULL) != 0)
        return;
    float *plane = calloc(whole, sizeof *plane);
    b->beauty = malloc(3 * inner * sizeof *b->beauty);
    for (size_t c = 0; c < 3 && plane && b->beauty; c++) {
        float *out = b->beauty + c;
        io_copy_window(&image, image.channels[c].data, &frame->image, plane);
        for (int32_t y = 0; y < b->height; y++)
            for (int32_t x = 0; x < b->width; x++, out += 3)
                *out = plane[buffers_index(b, x, y)];
    }
    if (!plane) {
        free(b->beauty);
        b->beauty = NULL;
    }
    free(plane);
    io_image_free(&image);
}

static int open_frames(source *s, const char *frames, report *r)
{
    s->request = pass_request(s->passes);
    s->request.keep_overscan = true; /* as `crevice ao` does */
    frame_camera_share(&s->camera, &s->request);
    int result = open_shot(s, frames, r);
    if (result == EXIT_DONE && s->camera.file)
        result = camera_file_load(s->camera.file, s->camera.order.value, &s->cameras, r);
    if (result == EXIT_DONE && s->request.fit_vfov && !find_lens(s, r))
        result = EXIT_FAILED;
    if (result == EXIT_DONE)
        find_beauty(s);
    return result;
}

int source_open(source *s, const viewer_settings *settings, report *r)
{
    *s = (source){.settings = &settings->view,
                  .passes = &settings->passes,
                  .camera = viewer_frame_camera(settings)};
    const char *mistake = viewer_mistake(settings);
    if (mistake) {
        report_error(r, "%s", mistake);
        return EXIT_USAGE;
    }
    if (pass_is_frame(settings->view.model))
        return open_frames(s, settings->frames, r);
    const int result = view_check(&settings->view, r);
    return result == EXIT_DONE ? view_load(&settings->view, &s->model, r) : result;
}

void source_free(source *s)
{
    scene_free(s->model);
    camera_file_free(&s->cameras);
    s->model = NULL;
}

buffers *source_cast(source *s, const scene_view *view, int32_t width, int32_t height,
                     int32_t guard_px, const crv_logger *log)
{
    const view_settings *v = s->settings;
    const scene_gbuffer_request request = {
        .view = *view,
        .width = width,
        .height = height,
        .guard_px = guard_px,
        .layers = v->layers.value,
        .layer_kind = (crv_layers)v->layer_kind.value,
        .normals =
            v->normals_from.value == 0 ? SCENE_NORMALS_INTERPOLATED : SCENE_NORMALS_FACE,
        .threads = v->common.threads.value,
        .stop = &s->stop,
    };
    scene_gbuffer g = {0};
    return scene_render_gbuffer(s->model, &request, &g, log) == 0 ? buffers_make(&g)
                                                                  : NULL;
}

/* What the library made of the frame: planar depth, normals in view space. The camera
 * looks from the origin along -Z. */
static bool copy_out(const io_frame *frame, crv_gbuffer *from, scene_gbuffer *g)
{
    const size_t count = (size_t)g->desc.width * (size_t)g->desc.height;
    bool done = true;
    for (int32_t i = 0; i < g->desc.layers && done; i++) {
        g->depth[i] = malloc(count * sizeof(float));
        const crv_image view =
            crv_image_packed(g->depth[i], g->desc.width, g->desc.height, 1);
        done = g->depth[i] && crv_gbuffer_get_depth(from, i, &view) == CRV_OK;
    }
    g->normals = malloc(3 * count * sizeof(float));
    const crv_image normals =
        crv_image_packed(g->normals, g->desc.width, g->desc.height, 3);
    done = done && g->normals && crv_gbuffer_get_normals(from, &normals) == CRV_OK;
    g->camera = frame->camera;
    memset(g->camera.world_to_view, 0, sizeof g->camera.world_to_view);
    for (int i = 0; i < 3; i++)
        g->camera.world_to_view[4 * i] = 1.0f;
    g->view = (scene_view){.projection = frame->camera.projection,
                           .target = {0.0, 0.0, -1.0},
                           .up = {0.0, 1.0, 0.0}};
    return done;
}

static buffers *take_frame(const io_frame *frame, estimator *e, report *r)
{
    scene_gbuffer g = {.desc = frame->desc};
    estimate_fit(e, &frame->desc);
    if (!report_ok(r, io_frame_to_gbuffer(frame, e->context, &e->gbuffer), "G-buffer"))
        return NULL;
    if (copy_out(frame, e->gbuffer, &g))
        return buffers_make(&g);
    scene_gbuffer_free(&g);
    report_no_memory(r);
    return NULL;
}

buffers *source_read(source *s, int32_t index, estimator *e, report *r)
{
    char path[4096];
    io_frame frame = {0};
    if (!load_frame(s, index, &frame, r))
        return NULL;
    if (s->settings->layer_kind.given)
        frame.desc.layer_kind = (crv_layers)s->settings->layer_kind.value;
    buffers *b = take_frame(&frame, e, r);
    if (b)
        read_beauty(s, source_frame_name(s, index, path, sizeof path), &frame, b);
    if (b && !(s->radius > 0.0f))
        radius_suggest(e, &frame, &s->radius, r);
    s->request.is_later = true;
    s->request.depth_format.encoding = frame.encoding;
    io_frame_free(&frame);
    return b;
}

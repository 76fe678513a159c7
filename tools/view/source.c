/* SPDX-License-Identifier: MIT */
#include "source.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/radius.h"

const char *source_frame_name(const source *s, int32_t index, char *out, size_t size)
{
    const char *input = s->settings->model;
    if (s->list.ranges > 0)
        return frames_name(input, frames_at(&s->list, index), out, size) ? out : NULL;
    return (size_t)snprintf(out, size, "%s", input) < size ? out : NULL;
}

static int open_frames(source *s, const char *frames, report *r)
{
    const view_settings *v = s->settings;
    const int result =
        pass_view_request(s->passes, &v->vfov_deg, &v->ortho, &s->request, r);
    if (result != EXIT_DONE)
        return result;
    s->frame_count = 1;
    if (!frames && frames_places(v->model) == 0)
        return EXIT_DONE;
    if (!frames || !frames_parse(frames, &s->list) || frames_places(v->model) != 1) {
        report_error(r, "--frames: give the range and one place for the frame's number "
                        "in INPUT, as in shot.####.exr --frames 1-240");
        return EXIT_USAGE;
    }
    s->frame_count = frames_count(&s->list);
    return EXIT_DONE;
}

int source_open(source *s, const viewer_settings *settings, report *r)
{
    *s = (source){.settings = &settings->view, .passes = &settings->passes};
    if (pass_is_frame(settings->view.model))
        return open_frames(s, settings->frames, r);
    if (settings->frames) {
        report_error(r, "--frames: is for .exr frames, not for a mesh; leave it out");
        return EXIT_USAGE;
    }
    const int result = view_check(&settings->view, r);
    return result == EXIT_DONE ? view_load(&settings->view, &s->model, r) : result;
}

void source_free(source *s)
{
    scene_free(s->model);
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
    const char *name = source_frame_name(s, index, path, sizeof path);
    if (!name) {
        report_error(r, "%s: is too long a name", s->settings->model);
        return NULL;
    }
    if (io_frame_load(name, &s->request, &frame, &r->logger) != 0)
        return NULL;
    if (s->settings->layer_kind.given)
        frame.desc.layer_kind = (crv_layers)s->settings->layer_kind.value;
    buffers *b = take_frame(&frame, e, r);
    if (b && !(s->radius > 0.0f))
        radius_suggest(e, &frame, &s->radius, r);
    s->request.is_later = true;
    s->request.depth_format.encoding = frame.encoding;
    io_frame_free(&frame);
    return b;
}

/* SPDX-License-Identifier: MIT */
#include "stability_frames.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void cross_of(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = a[j] * b[k] - a[k] * b[j];
    }
}

/* Eye and target go to the right by so much and half as far up in the picture, so that
 * points cross both rows and columns of pixels. */
static scene_view moved(const scene_view *view, double distance)
{
    double ahead[3], up[3], right[3], above[3], length = 0.0, length_above = 0.0;
    scene_view out = *view;

    for (int i = 0; i < 3; i++) {
        ahead[i] = view->target[i] - (double)view->eye[i];
        up[i] = view->up[i];
    }
    cross_of(ahead, up, right);
    cross_of(right, ahead, above);
    for (int i = 0; i < 3; i++) {
        length += right[i] * right[i];
        length_above += above[i] * above[i];
    }
    for (int i = 0; i < 3; i++) {
        double by = distance
                    * (right[i] / sqrt(length) + 0.5 * above[i] / sqrt(length_above))
                    / sqrt(1.25);
        out.eye[i] = view->eye[i] + by;
        out.target[i] = (float)(view->target[i] + by);
    }
    return out;
}

static void close_frame(camera_move *o, int32_t k)
{
    study_view_free(&o->views[k]);
    free(o->planes[k]);
    o->views[k] = (study_view){0};
    o->planes[k] = NULL;
}

/* Depth and normals without the guard band. */
static void crop(const scene_gbuffer *g, const stability_frame *f, float *depth,
                 float *normals)
{
    for (int32_t y = 0; y < f->height; y++) {
        size_t from = (size_t)(y + g->desc.guard_top) * (size_t)g->desc.width
                      + (size_t)g->desc.guard_left;
        size_t to = (size_t)y * (size_t)f->width, count = (size_t)f->width;
        memcpy(depth + to, g->depth[0] + from, count * sizeof *depth);
        memcpy(normals + 3 * to, g->normals + 3 * from, 3 * count * sizeof *normals);
    }
}

static int make_frame(study *s, camera_move *o, int32_t k, double distance)
{
    const scene_gbuffer *g = NULL;
    scene_view camera = moved(&o->base.camera, distance);
    stability_frame *f = &o->frames[k];
    size_t pixels = (size_t)o->base.width * (size_t)o->base.height;
    int code = study_view_moved(s, &o->base, &camera, &o->views[k]);

    if (code == EXIT_DONE)
        code = study_gbuffer(s, &o->views[k], STUDY_ONE_LAYER, &g);
    if (code != EXIT_DONE)
        return code;
    o->gbuffers[k] = g;
    o->planes[k] = malloc(4 * pixels * sizeof *o->planes[k]);
    if (o->planes[k] == NULL)
        return report_no_memory(s->r);
    *f = (stability_frame){
        .camera = crv_camera_crop(&g->camera, g->desc.guard_left, g->desc.guard_top),
        .width = o->base.width,
        .height = o->base.height,
        .depth = o->planes[k],
        .normals = o->planes[k] + pixels};
    memcpy(f->eye, g->view.eye, sizeof f->eye);
    crop(g, f, o->planes[k], o->planes[k] + pixels);
    return EXIT_DONE;
}

/* RMS motion between the first two frames; NAN where nothing is seen in both. */
static double measure_motion(const study *s, camera_move *o, int *code)
{
    size_t pixels = (size_t)o->base.width * (size_t)o->base.height;
    float *nothing = calloc(pixels, sizeof *nothing);
    stability sum = {0};

    if (nothing == NULL) {
        *code = report_no_memory(s->r);
        return NAN;
    }
    o->frames[0].accessibility = o->frames[1].accessibility = nothing;
    stability_add(&sum, &o->frames[0], &o->frames[1]);
    o->frames[0].accessibility = o->frames[1].accessibility = NULL;
    free(nothing);
    return sqrt(sum.motion2_px / (double)sum.points);
}

/* Motion is proportional to the distance. */
static int find_step(study *s, camera_move *o, double wanted_px)
{
    const double trial = 0.02 * (double)o->base.radius;
    int code = make_frame(s, o, 0, 0.0);
    double found;

    if (code == EXIT_DONE)
        code = make_frame(s, o, 1, trial);
    if (code != EXIT_DONE)
        return code;
    found = measure_motion(s, o, &code);
    close_frame(o, 1);
    o->step = found > 0.0 ? trial * wanted_px / found : trial;
    o->motion_px = found > 0.0 ? wanted_px : 0.0;
    return code;
}

int camera_move_open(study *s, double wanted_px, camera_move *out)
{
    int32_t width = s->main->width / 2, height = s->main->height / 2;
    int code;

    *out = (camera_move){0};
    code = study_view_resized(s, s->main, width > 0 ? width : 1, height > 0 ? height : 1,
                              &out->base);
    if (code == EXIT_DONE)
        code = find_step(s, out, wanted_px);
    for (int32_t k = 1; k < MOVE_FRAMES && code == EXIT_DONE; k++)
        code = make_frame(s, out, k, k * out->step);
    return code;
}

void camera_move_close(camera_move *o)
{
    for (int32_t k = 0; k < MOVE_FRAMES; k++)
        close_frame(o, k);
    study_view_free(&o->base);
}

/* SPDX-License-Identifier: MIT */
/* scenes.c: what is measured on: meshes in any size, renderers' frames in their own. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "bench/bench.h"
#include "common/radius.h"
#include "common/view.h"

static const double degree = 3.14159265358979323846 / 180.0;

/* Of meshes, which are framed by themselves. */
#define VFOV_DEG 45.0

bool bench_is_frame(const char *input)
{
    const size_t length = strlen(input);
    return length > 4 && strcmp(input + length - 4, ".exr") == 0;
}

int bench_load_model(const char *input, scene **out, report *r)
{
    const view_settings settings = {.model = input, .size = {true, 16, 16}};
    return view_load(&settings, out, r);
}

static int render(const scene *model, const arg_size *size, report *r, bench_scene *out)
{
    const crv_logger log = report_errors_only(r);
    scene_gbuffer_request request = {.width = size->width,
                                     .height = size->height,
                                     .layers = 1,
                                     .normals = SCENE_NORMALS_INTERPOLATED};
    scene_frame(model, (float)(VFOV_DEG * degree),
                (float)size->width / (float)size->height, &request.view);
    out->radius = scene_suggest_radius(model, &request.view);
    if (scene_render_gbuffer(model, &request, &out->cast, &log) != 0)
        return EXIT_FAILED;
    out->desc = out->cast.desc;
    return EXIT_DONE;
}

/* The radius that `crevice ao` takes. */
static int suggest_radius(const char *input, bench_scene *b, report *r)
{
    const crv_logger log = report_errors_only(r);
    estimator e = {.desc = b->file.desc};
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = log;
    int result = EXIT_FAILED;
    if (report_ok(r, crv_context_create(&desc, &e.context), "context")
        && report_ok(r, bench_upload(b, e.context, &e.gbuffer), "G-buffer"))
        result = radius_suggest(&e, &b->file, &b->radius, r);
    estimate_close(&e);
    if (result == EXIT_DONE && !(b->radius > 0.0f)) {
        report_error(r, "%s: shows no surface; choose another frame", input);
        return EXIT_FAILED;
    }
    return result;
}

static int load(const bench_settings *s, const char *input, report *r, bench_scene *out)
{
    const crv_logger log = report_errors_only(r);
    const io_passes_request request = {.depth_format = crv_depth_format_planar(),
                                       .vfov_rad = (float)(s->vfov_deg.value * degree)};
    if (io_frame_load(input, &request, &out->file, &log) != 0)
        return EXIT_FAILED;
    out->desc = out->file.desc;
    return suggest_radius(input, out, r);
}

int bench_scene_make(const bench_settings *s, const char *input, const scene *model,
                     const arg_size *size, report *r, bench_scene *out)
{
    *out = (bench_scene){.name = input, .is_frame = bench_is_frame(input)};
    const int result =
        out->is_frame ? load(s, input, r, out) : render(model, size, r, out);
    out->width = out->desc.width - out->desc.guard_left - out->desc.guard_right;
    out->height = out->desc.height - out->desc.guard_top - out->desc.guard_bottom;
    return result;
}

int bench_check_input(const bench_settings *s, const char *input, report *r)
{
    const view_settings settings = {.model = input, .size = {true, 16, 16}};
    if (bench_is_frame(input)) {
        bench_scene frame;
        const int result = bench_scene_make(s, input, NULL, NULL, r, &frame);
        bench_scene_free(&frame);
        return result;
    }
    if (strncmp(input, "builtin:", strlen("builtin:")) == 0)
        return view_check(&settings, r);
    FILE *file = fopen(input, "rb");
    if (file)
        fclose(file);
    else
        report_error(r, "%s: cannot be read (%s); check its name", input,
                     strerror(errno));
    return file ? EXIT_DONE : EXIT_FAILED;
}

void bench_scene_free(bench_scene *b)
{
    scene_gbuffer_free(&b->cast);
    io_frame_free(&b->file);
}

crv_status bench_upload(const bench_scene *b, crv_context *context, crv_gbuffer **gbuffer)
{
    return b->is_frame ? io_frame_to_gbuffer(&b->file, context, gbuffer)
                       : scene_gbuffer_upload(&b->cast, context, gbuffer);
}

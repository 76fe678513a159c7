/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "common/estimate.h"
#include "common/output.h"
#include "common/progress.h"
#include "reference.h"
#include "render.h"

/* In the order of SHADE_AO ... */
static const char *const shades[] = {"ao", "lit", "lit-no-ao", NULL};

static const arg render_rows[] = {
    VIEW_MODEL_ROW,
    VIEW_IMPORT_ROW,
    ARG_OUTPUT_ROW(view_settings, output, "picture to write: .png, .exr or .pfm"),
    {.name = "--shade",
     .value = "KIND",
     .choices = shades,
     .initial = "ao",
     ARG_INTO(ARG_CHOICE, render_settings, shade),
     .help = "what OUT shows: accessibility alone (EXR: channel AO; PNG: grey, linear), "
             "or the lit scene with or without it (EXR: R, G, B, linear; PNG: sRGB)"},
    {.name = "--lit",
     .value = "FILE",
     ARG_INTO(ARG_TEXT, render_settings, lit),
     .help = "also write the lit scene with ambient occlusion"},
    {.name = "--unlit",
     .value = "FILE",
     ARG_INTO(ARG_TEXT, render_settings, unlit),
     .help = "also write the lit scene without ambient occlusion"},
    {.name = "--aa",
     .value = "N",
     ARG_RANGE(1, 16),
     .initial = "1",
     ARG_INTO(ARG_INT, render_settings, aa),
     .help =
         "antialiased: NxN samples for each pixel, each a pixel of a picture that is N "
         "times larger; their mean, background being open. 2 to 4 are enough"},
    {.name = "--bits",
     .value = "N",
     .choices = args_png_bits,
     .initial = "8",
     ARG_INTO(ARG_CHOICE, render_settings, bits),
     .help = "depth of a PNG"},
    {.name = "--half",
     ARG_INTO(ARG_FLAG, render_settings, half),
     .help = "half floats in an EXR"},
    BENT_ROWS(render_settings, bent, "world"),
};
static const arg_table render_table = ARG_TABLE("Pictures", render_rows);

static const arg_table *const tables[] = {
    &render_table, &lighting_table, &relief_table,      &view_camera, &view_buffers,
    &args_threads, &args_device,    &args_output_lines, NULL};

static const char *const examples[] = {
    "ambient occlusion of a mesh, framed by itself",
    "crevice render model.glb -o ao.png",
    "one run, three pictures",
    "crevice render builtin:courtyard -o ao.png --lit lit.png --unlit plain.png",
    "a chosen camera and radius, two depth layers",
    "crevice render hall.glb -o ao.exr --eye -8.5,1.2,-0.3 --target 0,2.8,0.3 --vfov 60 "
    "--radius 1 --layers 2",
    "relief from a height map, lit by a picture of a sky alone",
    "crevice render wall.glb -o ao.png --height-map bricks.png --height-scale 0.02 --lit "
    "lit.png --sky sky.exr --key-light none",
    NULL,
};

static int check_bent(const render_settings *s, report *r)
{
    const bool lit = s->shade.value == SHADE_LIT || s->lit;
    if (s->view.common.options.bent_normal && !lit && !s->bent.output
        && !(s->shade.value == SHADE_AO && io_keeps_windows(s->view.output))) {
        report_error(r,
                     "--bent-normal: only an .exr holds them beside AO; write .exr, or "
                     "add --bent-output FILE or --lit FILE");
        return EXIT_USAGE;
    }
    return bent_check(&s->bent, &s->view.common.options, s->view.output, r);
}

static int check(const render_settings *s, report *r)
{
    const char *paths[] = {s->view.output, s->lit, s->unlit, s->bent.output};
    int result = view_check(&s->view, r);
    if (result == EXIT_DONE)
        result = check_bent(s, r);
    if (result == EXIT_DONE)
        result = relief_check(s, r);
    if (result == EXIT_DONE)
        result = lighting_check(s, r);
    for (int i = 0; i < 4 && result == EXIT_DONE; i++) {
        if (!paths[i])
            continue;
        for (int j = 0; j < i && result == EXIT_DONE; j++) {
            if (paths[j] && io_is_same_file(paths[i], paths[j])) {
                report_error(r, "%s: is named for two pictures; choose another name",
                             paths[i]);
                result = EXIT_USAGE;
            }
        }
        if (result == EXIT_DONE)
            result = output_check(paths[i], s->view.model, r);
        if (result == EXIT_DONE)
            result = output_spare(paths[i], s->height_map, r);
        if (result == EXIT_DONE)
            result = output_spare(paths[i], s->sky, r);
    }
    return result;
}

/* A picture that shows nothing but white is told of: of a surface in view no pixel is as
 * dark as one step of an 8-bit picture. What shows no surface was told of before. */
static void check_open(const render_settings *s, const scene_gbuffer *g,
                       const io_image *ao, double radius, report *r)
{
    const size_t count = (size_t)ao->width * (size_t)ao->height;
    for (size_t i = 0; i < count; i++)
        if (!((double)ao->channels[0].data[i] > 1.0 - 0.5 / 255.0))
            return;
    if (view_shows_something(g))
        report_warning(r,
                       "%s: nothing in view is occluded within the radius %g; give a "
                       "larger --radius if something should be",
                       s->view.model, radius);
}

static float radius_of(const render_settings *s, const scene *model,
                       const scene_gbuffer *g)
{
    return s->view.common.radius_given ? s->view.common.options.radius
                                       : scene_suggest_radius(model, &g->view);
}

static int estimate(const render_settings *s, const scene *model, const scene_gbuffer *g,
                    const io_image *map, io_image *ao, report *r)
{
    crv_options options = s->view.common.options;
    estimator e;
    options.radius = radius_of(s, model, g);
    if (!s->view.common.radius_given)
        report_info(r, "radius: --radius %g, chosen to suit the view",
                    (double)options.radius);
    int result = estimate_open(&e, &s->view.common, r);
    if (result == EXIT_DONE) {
        estimate_fit(&e, &g->desc);
        if (!report_ok(r, scene_gbuffer_upload(g, e.context, &e.gbuffer), "G-buffer"))
            result = EXIT_FAILED;
    }
    if (result == EXIT_DONE)
        result = relief_apply(s, map, g, e.gbuffer, r);
    if (result == EXIT_DONE)
        result = estimate_plan(&e, &options, r);
    if (result == EXIT_DONE)
        result = estimate_run(&e, ao, r);
    if (result == EXIT_DONE)
        check_open(s, g, ao, (double)options.radius, r);
    estimate_close(&e);
    return result;
}

/* Means of directions are directions again. */
static void normalise(io_image *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    float *const v[3] = {image->channels[1].data, image->channels[2].data,
                         image->channels[3].data};
    for (size_t i = 0; i < count; i++) {
        const double x = (double)v[0][i], y = (double)v[1][i], z = (double)v[2][i];
        const double length = sqrt(x * x + y * y + z * z);
        for (int k = 0; k < 3 && length > 0.0; k++)
            v[k][i] = (float)((double)v[k][i] / length);
    }
}

/* The mean of each n x n pixels. */
static int reduce(const io_image *image, int32_t n, io_image *out, report *r)
{
    const char *names[4] = {NULL};
    const int32_t width = image->width / n, height = image->height / n;
    for (int32_t c = 0; c < image->channel_count; c++)
        names[c] = image->channels[c].name;
    if (io_image_init(out, width, height, names, image->channel_count, &r->logger) != 0)
        return EXIT_FAILED;
    for (int32_t c = 0; c < image->channel_count; c++) {
        const float *from = image->channels[c].data;
        float *to = io_image_find(out, names[c])->data;
        for (int32_t y = 0; y < height; y++) {
            for (int32_t x = 0; x < width; x++) {
                double sum = 0.0;
                for (int32_t i = 0; i < n * n; i++)
                    sum += (double)from[(size_t)(y * n + i / n) * (size_t)image->width
                                        + (size_t)(x * n + i % n)];
                to[(size_t)y * (size_t)width + (size_t)x] = (float)(sum / (n * n));
            }
        }
    }
    if (bent_is_there(out))
        normalise(out);
    return EXIT_DONE;
}

static int write_lit_image(const render_settings *s, const char *path,
                           const io_image *image, report *r)
{
    const io_write_options options = {
        .half = s->half, .bits = s->bits.value == 0 ? 8 : 16, .srgb = true};
    io_image small = {0};
    if (s->aa.value <= 1)
        return output_write(path, image, &options, r);
    int result = reduce(image, s->aa.value, &small, r);
    if (result == EXIT_DONE)
        result = output_write(path, &small, &options, r);
    io_image_free(&small);
    return result;
}

/* What lit pictures are made of. */
typedef struct stage {
    const scene *model;
    const scene_gbuffer *buffers;
    const lighting *light;
} stage;

/* bounced: to be freed by the caller. */
static int occlude(const stage *lit, const io_image *ao, io_image *bounced,
                   scene_occlusion *out, report *r)
{
    *out = (scene_occlusion){.accessibility = crv_image_const(io_image_view(ao, 0, 1))};
    if (bent_is_there(ao))
        out->bent_normal = crv_image_const(io_image_view(ao, 1, 3));
    if (!lit->light->bounces)
        return EXIT_DONE;
    const int result = lighting_bounce(lit->light, lit->buffers, ao, bounced, r);
    if (result == EXIT_DONE)
        out->accessibility = crv_image_const(io_image_view(bounced, 0, 3));
    return result;
}

/* The rays of --sky-rays; NULL without it. Freed by reference_free(). */
static int trace_sky(const render_settings *s, const stage *lit, reference **out,
                     report *r)
{
    const reference_options o = {.weighting = CRV_WEIGHTING_COSINE,
                                 .falloff = CRV_FALLOFF_NONE,
                                 .u = 1.0f, /* of another falloff, but must be valid */
                                 .radius = radius_of(s, lit->model, lit->buffers),
                                 .rays = s->sky_rays.value,
                                 .seed = (uint32_t)s->view.common.options.seed,
                                 .normals = s->view.normals_from.value == 0
                                                ? SCENE_NORMALS_INTERPOLATED
                                                : SCENE_NORMALS_FACE};
    if (s->sky_rays.value == 0)
        return EXIT_DONE;
    return reference_create(lit->model, lit->buffers, &o, out, &r->logger) == 0
               ? EXIT_DONE
               : EXIT_FAILED;
}

/* ao NULL: without ambient occlusion. */
static int write_lit(const render_settings *s, const char *path, const stage *lit,
                     const io_image *ao, report *r)
{
    static const char *const names[] = {"R", "G", "B"};
    io_image image = {0}, bounced = {0};
    scene_occlusion occlusion = {0};
    reference *traced = NULL;
    int result = ao ? occlude(lit, ao, &bounced, &occlusion, r) : EXIT_DONE;
    if (result == EXIT_DONE && ao)
        result = trace_sky(s, lit, &traced, r);
    if (result == EXIT_DONE
        && io_image_init(&image, s->view.size.width, s->view.size.height, names, 3,
                         &r->logger)
               != 0)
        result = EXIT_FAILED;
    if (result == EXIT_DONE) {
        const crv_image rgb = io_image_view(&image, 0, 3);
        progress p = progress_begin(r, "shading", 0, rgb.height);
        scene_lighting light = lit->light->scene;
        light.watch = progress_rows;
        light.user = &p;
        occlusion.traced = traced;
        if (scene_shade(lit->model, lit->buffers, &light, ao ? &occlusion : NULL, &rgb,
                        s->view.common.threads.value, &r->logger)
            != 0)
            result = EXIT_FAILED;
        progress_end(&p);
    }
    if (result == EXIT_DONE)
        result = write_lit_image(s, path, &image, r);
    reference_free(traced);
    io_image_free(&image);
    io_image_free(&bounced);
    return result;
}

/* Brings bent normals to the space that is wanted. */
static void choose_space(const render_settings *s, const scene_gbuffer *g, io_image *ao)
{
    const bool world = !s->bent.space.given || s->bent.space.value == BENT_WORLD;
    double to_view[9];
    for (int i = 0; i < 9; i++)
        to_view[i] = (double)g->camera.world_to_view[i];
    if (world)
        bent_turn(ao, to_view);
    snprintf(ao->made, sizeof ao->made, "crevice %s render: bent=%s", crv_version(),
             bent_spaces[world ? BENT_WORLD : BENT_VIEW]);
}

/* Accessibility and bent normals, which are turned in place. */
static int write_ao(const render_settings *s, const scene_gbuffer *g, io_image *ao,
                    report *r)
{
    const char *output = s->view.output;
    const io_write_options options = {.half = s->half,
                                      .bits = s->bits.value == 0 ? 8 : 16};
    io_image small = {0};
    int result = EXIT_DONE;
    if (s->aa.value > 1) {
        result = reduce(ao, s->aa.value, &small, r);
        ao = &small;
    }
    if (result == EXIT_DONE && bent_is_there(ao))
        choose_space(s, g, ao);
    if (result == EXIT_DONE && s->shade.value == SHADE_AO) {
        const io_image alone = io_keeps_windows(output) ? *ao : bent_left_out(ao);
        result = output_write(output, &alone, &options, r);
    }
    if (result == EXIT_DONE && s->bent.output)
        result = bent_write(s->bent.output, ao, &options, r);
    io_image_free(&small);
    return result;
}

/* Lit pictures first, which want view space. */
static int write_all(const render_settings *s, const stage *lit, io_image *ao, report *r)
{
    const bool occluded = s->shade.value == SHADE_LIT;
    int result = EXIT_DONE;
    if (s->shade.value != SHADE_AO)
        result = write_lit(s, s->view.output, lit, occluded ? ao : NULL, r);
    if (result == EXIT_DONE && s->lit)
        result = write_lit(s, s->lit, lit, ao, r);
    if (result == EXIT_DONE && s->unlit)
        result = write_lit(s, s->unlit, lit, NULL, r);
    if (result == EXIT_DONE && ao->channel_count)
        result = write_ao(s, lit->buffers, ao, r);
    return result;
}

/* All that render reads and makes on its way. */
typedef struct work {
    scene *model;
    scene_gbuffer buffers;
    io_image map, ao;
    lighting light;
} work;

static void free_work(work *w)
{
    lighting_free(&w->light);
    io_image_free(&w->ao);
    io_image_free(&w->map);
    scene_gbuffer_free(&w->buffers);
    scene_free(w->model);
}

/* Lengths in pixels that the method does not read stay as they are: it would be said that
 * they are not used. */
static void enlarge(float *value_px, const char *key, const crv_options *o, int32_t n)
{
    if (crv_option_applies(crv_option_find(key), o->method, NULL))
        *value_px = fminf(*value_px * (float)n, (float)CRV_MAX_SIZE);
}

/* The settings of the larger picture that antialiasing takes the mean of. */
static render_settings enlarged(const render_settings *given)
{
    render_settings s = *given;
    const int32_t n = s.aa.value;
    crv_options *o = &s.view.common.options;
    if (n == 1)
        return s;
    s.view.guard_px = (arg_int){.given = true, .value = n * view_guard_px(&given->view)};
    s.view.size.width *= n;
    s.view.size.height *= n;
    enlarge(&o->max_radius_px, "max_radius_px", o, n);
    enlarge(&o->band_px, "band_px", o, n);
    return s;
}

static int run(const void *settings, report *r)
{
    const render_settings large = enlarged(settings), *s = &large;
    bool needs_ao = s->shade.value != SHADE_LIT_NO_AO || s->lit || s->bent.output;
    work w = {0};
    stage lit;
    int result = check(s, r);
    if (result == EXIT_DONE)
        result = lighting_load(s, &w.light, r);
    if (result == EXIT_DONE)
        result = relief_load(s, &w.map, r);
    if (result == EXIT_DONE)
        result = view_load(&s->view, &w.model, r);
    if (result == EXIT_DONE)
        result = view_render(&s->view, w.model, s->height_map, &w.buffers, r);
    if (result == EXIT_DONE)
        result = relief_check_mesh(s, &w.buffers, r);
    if (result == EXIT_DONE && needs_ao)
        result = estimate(s, w.model, &w.buffers, &w.map, &w.ao, r);
    if (result == EXIT_DONE) {
        relief_bend_normals(s, &w.map, &w.buffers);
        lit = (stage){w.model, &w.buffers, &w.light};
        result = write_all(s, &lit, &w.ao, r);
    }
    free_work(&w);
    return result;
}

const command command_render = {
    .name = "render",
    .summary = "draw the ambient occlusion of a mesh",
    .synopsis = "MODEL -o FILE [options]",
    .details =
        "The mesh is drawn by ray casting, so no GPU is needed. Without a camera the "
        "view is chosen to hold the mesh; without --radius a radius is chosen and "
        "printed. A height map gives relief that the mesh does not have; lit pictures "
        "show it, but shadows fall as on the mesh.",
    .tables = tables,
    .library_options = true,
    .method_flag = "--height-map",
    .method_of_flag = "vao",
    .examples = examples,
    .settings_size = sizeof(render_settings),
    .run = run,
};

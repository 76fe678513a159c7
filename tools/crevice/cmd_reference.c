/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "gbuffer_image.h"
#include "common/output.h"
#include "common/target.h"
#include "reference_run.h"
#include "common/view.h"

typedef struct reference_settings {
    view_settings view;
    arg_int rays, weighting, falloff, definition, kind, seed;
    arg_number radius, tau, u, thickness, max_error;
    bool resume;
} reference_settings;

/* In the order of reference.h. */
static const char *const definitions[] = {"hemisphere", "tangent-sphere", NULL};
static const char *const kinds[] = {"full", "visible", NULL};

static const arg file_rows[] = {
    VIEW_MODEL_ROW,
    VIEW_IMPORT_ROW,
    ARG_OUTPUT_ROW(view_settings, output, "EXR file to write"),
    {.name = "--resume",
     ARG_INTO(ARG_FLAG, reference_settings, resume),
     .help = "go on from FILE.checkpoint if there is one"},
};
static const arg_table file_table = ARG_TABLE("Files", file_rows);

static const arg integral_rows[] = {
    {.name = "--radius",
     .value = "R",
     ARG_RANGE(1e-9, 1e12),
     .unit = "scene units",
     ARG_INTO(ARG_NUMBER, reference_settings, radius),
     .computed = "chosen to suit the view",
     .help = "distance beyond which nothing occludes"},
    {.name = "--weighting",
     .value = "KIND",
     .choices = target_weightings,
     .initial = "cosine",
     ARG_INTO(ARG_CHOICE, reference_settings, weighting),
     .help = "how directions count; `crevice methods` says what each method estimates"},
    {.name = "--falloff",
     .value = "KIND",
     .choices = target_falloffs,
     .initial = "none",
     ARG_INTO(ARG_CHOICE, reference_settings, falloff),
     .help = "how occluders fade with distance"},
    {.name = "--tau",
     .value = "X",
     ARG_RANGE(0.0, 1000.0),
     .initial = "3",
     ARG_INTO(ARG_NUMBER, reference_settings, tau),
     .help = "exponential falloff: decay over one radius"},
    {.name = "--u",
     .value = "X",
     ARG_RANGE(1e-3, 1.0),
     .unit = "radius",
     .initial = "0.1",
     ARG_INTO(ARG_NUMBER, reference_settings, u),
     .help = "distance at which the alchemy falloff peaks"},
    {.name = "--definition",
     .value = "KIND",
     .choices = definitions,
     .initial = "hemisphere",
     ARG_INTO(ARG_CHOICE, reference_settings, definition),
     .help =
         "tangent-sphere: the open share of the sphere of radius R/2 that touches the "
         "surface, as vao estimates it; without weighting and falloff"},
    {.name = "--kind",
     .value = "KIND",
     .choices = kinds,
     .initial = "full",
     ARG_INTO(ARG_CHOICE, reference_settings, kind),
     .help = "visible: only what the depth layers hold occludes, closed at silhouettes"},
    {.name = "--thickness",
     .value = "X",
     ARG_RANGE(1e-3, 1e3),
     .unit = "radius",
     .initial = "0.5",
     ARG_INTO(ARG_NUMBER, reference_settings, thickness),
     .help = "visible: how far behind its front a silhouette is closed"},
};
static const arg_table integral_table = ARG_TABLE("Occlusion", integral_rows);

static const arg ray_rows[] = {
    {.name = "--rays",
     .value = "N",
     ARG_RANGE(1, REFERENCE_MAX_RAYS),
     .initial = "256",
     ARG_INTO(ARG_INT, reference_settings, rays),
     .help = "rays for each pixel, at most. 256 leave a standard error of 0.03 at most; "
             "four times as many halve it"},
    {.name = "--max-error",
     .value = "E",
     ARG_RANGE(0.0, 1.0),
     .initial = "0",
     ARG_INTO(ARG_NUMBER, reference_settings, max_error),
     .help = "a pixel is done when its standard error is that small, after 64 rays and "
             "1/E of them at least; 0: always take all. 0.005 is enough to compare with"},
    {.name = "--seed",
     .value = "N",
     ARG_RANGE(0, 2147483647),
     .initial = "0",
     ARG_INTO(ARG_INT, reference_settings, seed),
     .help = "other random numbers: the difference of two seeds shows the noise"},
};
static const arg_table ray_table = ARG_TABLE("Rays", ray_rows);

static const arg_table *const tables[] = {
    &file_table,   &integral_table, &ray_table,         &view_camera,
    &view_buffers, &args_threads,   &args_output_lines, NULL};

static const char *const examples[] = {
    "what hsao, raymarch and containment should give",
    "crevice reference model.glb -o truth.exr --radius 0.5 --rays 1024",
    "what hbao should give, to an error of 0.002",
    "crevice reference model.glb -o truth.exr --radius 0.5 --weighting uniform "
    "--falloff linear --rays 65536 --max-error 0.002",
    "go on with it after an interrupt",
    "crevice reference model.glb -o truth.exr --radius 0.5 --weighting uniform "
    "--falloff linear --rays 65536 --max-error 0.002 --resume",
    NULL,
};

static int check(const reference_settings *s, reference_run *run, report *r)
{
    const char *output = s->view.output;
    size_t length = strlen(output);
    bool sphere = s->definition.value == REFERENCE_TANGENT_SPHERE;
    int result = view_check(&s->view, r);
    if (result != EXIT_DONE)
        return result;
    if (length < 4 || strcmp(output + length - 4, ".exr") != 0) {
        report_error(r, "%s: cannot hold a reference; name it with .exr at the end",
                     output);
        return EXIT_USAGE;
    }
    if (sphere && (s->weighting.given || s->falloff.given)) {
        report_error(r, "--definition: tangent-sphere has no weighting or falloff; leave "
                        "out one or the other");
        return EXIT_USAGE;
    }
    if (s->tau.given && s->falloff.value != CRV_FALLOFF_EXPONENTIAL) {
        report_error(r,
                     "--tau: is of the exponential falloff; add --falloff exponential");
        return EXIT_USAGE;
    }
    if (s->u.given && s->falloff.value != CRV_FALLOFF_ALCHEMY) {
        report_error(r, "--u: is of the alchemy falloff; add --falloff alchemy");
        return EXIT_USAGE;
    }
    if (s->thickness.given && s->kind.value != REFERENCE_VISIBLE) {
        report_error(r, "--thickness: is of what the layers hold; add --kind visible");
        return EXIT_USAGE;
    }
    result = output_check(output, s->view.model, r);
    return result == EXIT_DONE ? reference_run_check(run, output, s->resume, r) : result;
}

static reference_options options_of(const reference_settings *s, const scene *model,
                                    const scene_gbuffer *g, report *r)
{
    reference_options o = {
        .definition = (reference_definition)s->definition.value,
        .kind = (reference_kind)s->kind.value,
        .weighting = (crv_weighting)s->weighting.value,
        .falloff = (crv_falloff)s->falloff.value,
        .tau = (float)s->tau.value,
        .u = (float)s->u.value,
        .radius = (float)s->radius.value,
        .thickness = (float)s->thickness.value,
        .rays = s->rays.value,
        .max_error = (float)s->max_error.value,
        .normals = s->view.normals_from.value == 0 ? SCENE_NORMALS_INTERPOLATED
                                                   : SCENE_NORMALS_FACE,
        .seed = (uint32_t)s->seed.value,
    };
    if (!s->radius.given) {
        o.radius = scene_suggest_radius(model, &g->view);
        report_info(r, "radius: --radius %g, chosen to suit the view", (double)o.radius);
    }
    return o;
}

/* The part of a plane that lies inside the guard band. */
static void copy_inside(const scene_gbuffer *g, const float *from, io_image *image,
                        const char *name)
{
    const crv_gbuffer_desc *d = &g->desc;
    float *to = io_image_find(image, name)->data;
    for (int32_t y = 0; y < image->height; y++)
        memcpy(to + (size_t)y * (size_t)image->width,
               from + (size_t)(y + d->guard_top) * (size_t)d->width
                   + (size_t)d->guard_left,
               (size_t)image->width * sizeof *to);
}

static int copy_normals(const scene_gbuffer *g, const char *const names[3],
                        io_image *image, report *r)
{
    size_t count = (size_t)g->desc.width * (size_t)g->desc.height;
    float *block = malloc(3 * count * sizeof *block);
    if (!block)
        return report_no_memory(r);
    gbuffer_world_normals(g, (float *const[]){block, block + count, block + 2 * count});
    for (size_t k = 0; k < 3; k++)
        copy_inside(g, block + k * count, image, names[k]);
    free(block);
    return EXIT_DONE;
}

static int write_result(const reference_settings *s, const reference *work,
                        const scene_gbuffer *g, report *r)
{
    static const char *const names[] = {"AO",  "AO.stderr", "bent.X", "bent.Y", "bent.Z",
                                        "N.X", "N.Y",       "N.Z",    "Z"};
    const size_t count = (size_t)reference_total(work), size = count * sizeof(float);
    io_image image = {0};
    if (io_image_init(&image, s->view.size.width, s->view.size.height, names, 9,
                      &r->logger)
        != 0)
        return EXIT_FAILED;
    memcpy(image.channels[0].data, reference_accessibility(work), size);
    memcpy(image.channels[1].data, reference_error(work), size);
    gbuffer_to_world(g, reference_bent_normal(work), count,
                     (float *const[]){image.channels[2].data, image.channels[3].data,
                                      image.channels[4].data});
    copy_inside(g, g->depth[0], &image, "Z");
    int result = copy_normals(g, names + 5, &image, r);
    gbuffer_describe_camera(g, &image);
    snprintf(image.made, sizeof image.made, "crevice %s reference: bent=world",
             crv_version());
    if (result == EXIT_DONE)
        result = output_write(s->view.output, &image, NULL, r);
    io_image_free(&image);
    return result;
}

static int trace(const reference_settings *s, const scene *model, const scene_gbuffer *g,
                 reference_run *run, report *r)
{
    reference_options o = options_of(s, model, g, r);
    double start = report_seconds();
    if (reference_create(model, g, &o, &run->work, &r->logger) != 0)
        return EXIT_FAILED;
    int result = reference_run_all(run, s->view.output, s->resume, o.rays,
                                   s->view.common.threads.value, r);
    if (result != EXIT_DONE)
        return result;
    report_info(r, "reference, radius %g, up to %d rays: %.2f s", (double)o.radius,
                o.rays, report_seconds() - start);
    result = write_result(s, run->work, g, r);
    if (result == EXIT_DONE)
        reference_run_finish(run);
    else
        reference_run_keep(run, r);
    return result;
}

static int run(const void *settings, report *r)
{
    const reference_settings *s = settings;
    scene *model = NULL;
    scene_gbuffer g = {0};
    reference_run state = {0};
    int result = check(s, &state, r);
    if (result == EXIT_DONE)
        result = view_load(&s->view, &model, r);
    if (result == EXIT_DONE)
        result = view_render(&s->view, model, false, &g, r);
    if (result == EXIT_DONE)
        result = trace(s, model, &g, &state, r);
    reference_free(state.work);
    free(state.checkpoint);
    scene_gbuffer_free(&g);
    scene_free(model);
    return result;
}

const command command_reference = {
    .name = "reference",
    .summary = "ray-trace the ambient occlusion of a mesh, to measure methods against",
    .synopsis = "MODEL -o FILE.exr [options]",
    .details =
        "Channels: AO, AO.stderr (its estimated standard error), bent.X bent.Y bent.Z "
        "(the bent normal: the mean open direction, with AO's weighting and falloff), Z "
        "and N.X N.Y N.Z, all in world space. Both sides of triangles occlude. If an "
        "interpolated normal deviates from its "
        "triangle, "
        "rays below the triangle are blocked by it, so the result is that of the "
        "triangles "
        "as they are. An interrupted run leaves FILE.checkpoint, from which --resume "
        "goes "
        "on to the same picture, bit by bit.",
    .tables = tables,
    .examples = examples,
    .settings_size = sizeof(reference_settings),
    .run = run,
};

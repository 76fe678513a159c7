/* SPDX-License-Identifier: MIT */
#include "bench/frames.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/radius.h"
#include "common/view.h"

static const double degree = 3.14159265358979323846 / 180.0;

/* Of models whose cameras are not given. */
#define VFOV_DEG 45.0

static bool is_frame(const char *path)
{
    size_t length = strlen(path);

    return length > 4 && strcmp(path + length - 4, ".exr") == 0;
}

static bool is_named(const arg_texts *names, const char *name)
{
    for (int32_t i = 0; i < names->count; i++)
        if (strcmp(names->value[i], name) == 0)
            return true;
    return names->count == 0;
}

static int load_models(views_list *views, const bench_source *sources, int32_t count,
                       report *r)
{
    int result = EXIT_DONE;

    for (int32_t i = 0; i < views->model_count && result == EXIT_DONE; i++) {
        view_settings settings = {.model = views->models[i].path, .size = {true, 64, 36}};
        bool is_wanted = false;

        for (int32_t k = 0; k < count; k++)
            is_wanted =
                is_wanted || (sources[k].entry != NULL && sources[k].entry->model == i);
        if (is_wanted)
            result = view_check(&settings, r);
        if (is_wanted && result == EXIT_DONE)
            result = view_load(&settings, &views->models[i].model, r);
    }
    return result;
}

static int unknown_view(const views_list *views, const char *name, report *r)
{
    const char *names[ARG_TEXTS_MAX], *nearest;
    int32_t count = 0;

    for (; count < views->entry_count && count < ARG_TEXTS_MAX; count++)
        names[count] = views->entries[count].name;
    nearest = crv_nearest_name(name, names, count);
    if (nearest != NULL)
        report_error(r, "--view: no view \"%s\"; did you mean %s?", name, nearest);
    else
        report_error(r, "--view: no view \"%s\"; choose one of --views or a model's name",
                     name);
    return EXIT_USAGE;
}

static int check_names(const views_list *views, const arg_texts *names, report *r)
{
    for (int32_t i = 0; i < names->count; i++) {
        bool found = false;
        for (int32_t k = 0; k < views->entry_count; k++)
            found = found || strcmp(views->entries[k].name, names->value[i]) == 0;
        if (!found)
            return unknown_view(views, names->value[i], r);
    }
    return EXIT_DONE;
}

/* Scenes first, then frames. */
static void fill_sources(const arg_texts *inputs, const arg_texts *names, double vfov_deg,
                         views_list *views, bench_source *out, int32_t *count)
{
    for (int32_t i = 0; i < views->entry_count; i++)
        if (is_named(names, views->entries[i].name))
            out[(*count)++] = (bench_source){.name = views->entries[i].name,
                                             .entry = &views->entries[i]};
    for (int32_t i = 0; i < inputs->count; i++)
        if (is_frame(inputs->value[i]))
            out[(*count)++] = (bench_source){.name = inputs->value[i],
                                             .path = inputs->value[i],
                                             .vfov_rad = (float)(vfov_deg * degree)};
}

int bench_sources_open(const arg_texts *inputs, const char *views_file,
                       const arg_texts *names, double vfov_deg, views_list *views,
                       bench_source **out, int32_t *count, report *r)
{
    arg_texts models = {0};
    int result = EXIT_DONE;

    *count = 0;
    for (int32_t i = 0; i < inputs->count; i++)
        if (!is_frame(inputs->value[i]))
            models.value[models.count++] = inputs->value[i];
    if (inputs->count == 0 && views_file == NULL)
        models.value[models.count++] = "builtin:courtyard";
    if (models.count > 0 || views_file != NULL)
        result = views_collect(views, &models, views_file, r);
    if (result == EXIT_DONE)
        result = check_names(views, names, r);
    if (result != EXIT_DONE)
        return result;
    *out = calloc((size_t)views->entry_count + (size_t)inputs->count + 1, sizeof **out);
    if (*out == NULL)
        return report_no_memory(r);
    fill_sources(inputs, names, vfov_deg, views, *out, count);
    result = load_models(views, *out, *count, r);
    for (int32_t i = 0; i < *count && result == EXIT_DONE; i++)
        if ((*out)[i].entry != NULL)
            (*out)[i].model = views->models[(*out)[i].entry->model].model;
    return result;
}

void bench_sources_close(views_list *views, bench_source *sources)
{
    for (int32_t i = 0; i < views->model_count; i++) {
        scene_free(views->models[i].model);
        free(views->models[i].path);
    }
    for (int32_t i = 0; i < views->entry_count; i++)
        free(views->entries[i].name);
    free(views->models);
    free(views->entries);
    free(sources);
    *views = (views_list){0};
}

static int render(const bench_source *source, int32_t width, int32_t height,
                  int32_t threads, const crv_logger *log, bench_frame *out)
{
    scene_gbuffer_request request = {.width = width,
                                     .height = height,
                                     .layers = 1,
                                     .normals = SCENE_NORMALS_INTERPOLATED,
                                     .threads = threads};

    request.view = source->entry->camera;
    if (!source->entry->has_camera)
        scene_frame(source->model, (float)(VFOV_DEG * degree),
                    (float)width / (float)height, &request.view);
    out->radius = source->entry->radius;
    if (!(out->radius > 0.0f))
        out->radius = scene_suggest_radius(source->model, &request.view);
    if (scene_render_gbuffer(source->model, &request, &out->cast, log) != 0)
        return EXIT_FAILED;
    /* Nothing here looks at it, and large pictures need the room. */
    free(out->cast.albedo);
    out->cast.albedo = NULL;
    out->desc = out->cast.desc;
    return EXIT_DONE;
}

/* The radius that `crevice ao` takes. */
static int suggest_radius(bench_frame *f, const crv_logger *log, report *r)
{
    estimator e = {.desc = f->file.desc};
    crv_context_desc desc;
    int result;

    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = *log;
    result = report_ok(r, crv_context_create(&desc, &e.context), "context")
                     && report_ok(r, io_frame_to_gbuffer(&f->file, e.context, &e.gbuffer),
                                  "G-buffer")
                 ? radius_suggest(&e, &f->file, &f->radius, r)
                 : EXIT_FAILED;
    estimate_close(&e);
    if (result == EXIT_DONE && !(f->radius > 0.0f)) {
        report_error(r, "%s: shows no surface; choose another frame", f->source->path);
        return EXIT_FAILED;
    }
    return result;
}

static int load(const bench_source *source, const crv_logger *log, report *r,
                bench_frame *out)
{
    io_passes_request request = {.depth_format = crv_depth_format_planar(),
                                 .vfov_rad = source->vfov_rad};

    if (io_frame_load(source->path, &request, &out->file, log) != 0)
        return EXIT_FAILED;
    out->desc = out->file.desc;
    return suggest_radius(out, log, r);
}

int bench_sources_check(const bench_source *sources, int32_t count, report *r)
{
    int result = EXIT_DONE;

    for (int32_t i = 0; i < count && result == EXIT_DONE; i++) {
        bench_frame frame = {.source = &sources[i]};
        if (sources[i].path == NULL)
            continue;
        result = load(&sources[i], &r->logger, r, &frame);
        bench_frame_free(&frame);
    }
    return result;
}

int bench_frame_make(const bench_source *source, int32_t width, int32_t height,
                     int32_t threads, const crv_logger *log, report *r, bench_frame *out)
{
    int result;

    *out = (bench_frame){.source = source};
    result = source->path != NULL ? load(source, log, r, out)
                                  : render(source, width, height, threads, log, out);
    out->width = out->desc.width - out->desc.guard_left - out->desc.guard_right;
    out->height = out->desc.height - out->desc.guard_top - out->desc.guard_bottom;
    return result;
}

void bench_frame_free(bench_frame *f)
{
    scene_gbuffer_free(&f->cast);
    io_frame_free(&f->file);
}

crv_status bench_frame_upload(const bench_frame *f, crv_context *context,
                              crv_gbuffer **gbuffer)
{
    return f->source->path != NULL ? io_frame_to_gbuffer(&f->file, context, gbuffer)
                                   : scene_gbuffer_upload(&f->cast, context, gbuffer);
}

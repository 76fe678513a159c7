/* SPDX-License-Identifier: MIT */
#include "study.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/device.h"
#include "study_cache.h"

int study_open(study *s)
{
    /* Filters come and go in a study; that their options are then unused is no news. */
    s->quiet_logger = report_errors_only(s->r);
    s->started = report_seconds();
    s->results = cJSON_CreateObject();
    if (s->results == NULL)
        return report_no_memory(s->r);
    return device_context(s->common, &s->quiet_logger, s->r, &s->context);
}

void study_close(study *s)
{
    crv_context_destroy(s->context);
    cJSON_Delete(s->results);
    s->context = NULL;
    s->results = NULL;
}

void study_progress(study *s, const char *format, ...)
{
    char line[512];
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    report_info(s->r, "[%5.1f s] %s", report_seconds() - s->started, line);
}

void study_add_number(cJSON *object, const char *key, double value)
{
    if (isfinite(value))
        cJSON_AddNumberToObject(object, key, value);
    else
        cJSON_AddNullToObject(object, key);
}

int study_compare(study *s, const study_view *v, const float *a, const float *b,
                  metrics *out)
{
    return metrics_compare(a, b, v->mask, v->width, v->height, out)
               ? EXIT_DONE
               : report_no_memory(s->r);
}

const crv_logger *study_quiet_logger(study *s)
{
    return s->r->verbose ? &s->r->logger : &s->quiet_logger;
}

bool study_same_buffers(study_buffers a, study_buffers b)
{
    return a.layers == b.layers && (a.layers == 1 || a.kind == b.kind);
}

int study_cached_gbuffer(study *s, study_view *v, study_buffers buffers,
                         const study_gbuffer_entry **out)
{
    struct study_cache *cache = v->cache;
    study_gbuffer_entry *entry;
    scene_gbuffer_request request = {
        .view = v->camera,
        .width = v->width,
        .height = v->height,
        .guard_px = (v->height + 9) / 10,
        .layers = buffers.layers,
        .layer_kind = buffers.kind,
        .normals = SCENE_NORMALS_INTERPOLATED,
        .threads = s->threads,
    };

    for (int32_t i = 0; i < cache->gbuffer_count; i++) {
        *out = &cache->gbuffers[i];
        if (study_same_buffers(cache->gbuffers[i].buffers, buffers))
            return EXIT_DONE;
    }
    if (cache->gbuffer_count == STUDY_GBUFFERS_MAX) {
        report_error(s->r, "%s: too many kinds of buffers", v->name);
        return EXIT_FAILED;
    }
    entry = &cache->gbuffers[cache->gbuffer_count];
    *entry = (study_gbuffer_entry){.buffers = buffers};
    if (scene_render_gbuffer(v->model, &request, &entry->cast, study_quiet_logger(s))
        != 0)
        return EXIT_FAILED;
    if (!report_ok(s->r, scene_gbuffer_upload(&entry->cast, s->context, &entry->uploaded),
                   "G-buffer")) {
        scene_gbuffer_free(&entry->cast);
        return EXIT_FAILED;
    }
    cache->gbuffer_count++;
    *out = entry;
    return EXIT_DONE;
}

int study_gbuffer(study *s, study_view *v, study_buffers buffers,
                  const scene_gbuffer **out)
{
    const study_gbuffer_entry *entry;
    int result = study_cached_gbuffer(s, v, buffers, &entry);

    if (result == EXIT_DONE)
        *out = &entry->cast;
    return result;
}

static int make_mask(study *s, study_view *v)
{
    const scene_gbuffer *g;
    int result = study_gbuffer(s, v, STUDY_ONE_LAYER, &g);

    if (result != EXIT_DONE)
        return result;
    v->mask = malloc((size_t)v->width * (size_t)v->height);
    if (v->mask == NULL)
        return report_no_memory(s->r);
    for (int32_t y = 0; y < v->height; y++) {
        for (int32_t x = 0; x < v->width; x++) {
            size_t from = (size_t)(y + g->desc.guard_top) * (size_t)g->desc.width
                          + (size_t)(x + g->desc.guard_left);
            bool surface = isfinite(g->depth[0][from]) && g->depth[0][from] > 0.0f;
            v->mask[(size_t)y * (size_t)v->width + (size_t)x] = surface;
            v->pixels += surface;
        }
    }
    return EXIT_DONE;
}

int study_view_make(study *s, const char *name, scene *model, const scene_view *camera,
                    float radius, int32_t width, int32_t height, study_view *out)
{
    int result;

    *out = (study_view){.name = name,
                        .model = model,
                        .camera = *camera,
                        .radius = radius,
                        .width = width,
                        .height = height,
                        .cache = calloc(1, sizeof(struct study_cache))};
    result = out->cache != NULL ? make_mask(s, out) : report_no_memory(s->r);
    if (result != EXIT_DONE)
        study_view_free(out);
    return result;
}

int study_view_resized(study *s, const study_view *v, int32_t width, int32_t height,
                       study_view *out)
{
    return study_view_make(s, v->name, v->model, &v->camera, v->radius, width, height,
                           out);
}

int study_view_moved(study *s, const study_view *v, const scene_view *camera,
                     study_view *out)
{
    return study_view_make(s, v->name, v->model, camera, v->radius, v->width, v->height,
                           out);
}

void study_view_free(study_view *v)
{
    struct study_cache *cache = v->cache;

    for (int32_t i = 0; cache != NULL && i < cache->gbuffer_count; i++) {
        crv_gbuffer_destroy(cache->gbuffers[i].uploaded);
        scene_gbuffer_free(&cache->gbuffers[i].cast);
    }
    for (int32_t i = 0; cache != NULL && i < cache->reference_count; i++)
        free(cache->references[i].accessibility);
    if (cache != NULL)
        free(cache->references);
    free(cache);
    free(v->mask);
    *v = (study_view){0};
}

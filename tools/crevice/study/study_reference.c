/* SPDX-License-Identifier: MIT */
/* study_reference.c: the ray-traced pictures that a view keeps. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study_cache.h"

/* What does not matter to the integral must not make two of one. */
static study_target plain_target(const study_target *target)
{
    study_target plain = *target;

    if (plain.definition == REFERENCE_TANGENT_SPHERE) {
        plain.weighting = CRV_WEIGHTING_COSINE;
        plain.falloff = CRV_FALLOFF_NONE;
    }
    if (plain.falloff != CRV_FALLOFF_EXPONENTIAL)
        plain.tau = 3.0f;
    if (plain.falloff != CRV_FALLOFF_ALCHEMY)
        plain.u = 0.1f;
    return plain;
}

static bool same_number(float a, float b)
{
    return !(a < b) && !(a > b);
}

static study_reference_entry *find_reference(const study_view *v,
                                             const study_target *target,
                                             reference_kind kind, study_buffers buffers)
{
    study_target plain = plain_target(target);

    for (int32_t i = 0; i < v->cache->reference_count; i++) {
        study_reference_entry *e = &v->cache->references[i];
        if (e->target.definition == plain.definition
            && e->target.weighting == plain.weighting
            && e->target.falloff == plain.falloff && same_number(e->target.tau, plain.tau)
            && same_number(e->target.u, plain.u) && e->kind == kind
            && (kind == REFERENCE_FULL || study_same_buffers(e->buffers, buffers)))
            return e;
    }
    return NULL;
}

bool study_reference_is(const study_view *v, const study_target *target,
                        reference_kind kind, study_buffers buffers,
                        study_reference_facts *out)
{
    const study_reference_entry *e = find_reference(v, target, kind, buffers);

    if (e != NULL)
        *out = e->facts;
    return e != NULL;
}

static double rms_error(const study_view *v, const float *error)
{
    double sum = 0.0;

    for (int64_t i = 0; i < (int64_t)v->width * v->height; i++)
        if (v->mask[i])
            sum += (double)error[i] * (double)error[i];
    return v->pixels > 0 ? sqrt(sum / (double)v->pixels) : NAN;
}

/* A quarter of what as many independent rays would leave at worst, a standard error of
 * 0.5 / sqrt(rays): evenly spread rays do better. */
double study_reference_stop(const study *s)
{
    return 0.125 / sqrt((double)s->rays);
}

static study_reference_entry *new_entry(struct study_cache *cache)
{
    if (cache->reference_count == cache->reference_capacity) {
        int32_t capacity =
            cache->reference_capacity == 0 ? 8 : 2 * cache->reference_capacity;
        study_reference_entry *entries =
            realloc(cache->references, (size_t)capacity * sizeof *entries);

        if (entries == NULL)
            return NULL;
        cache->references = entries;
        cache->reference_capacity = capacity;
    }
    return &cache->references[cache->reference_count];
}

/* Keeps a copy of one picture that was traced. */
static int keep(study *s, study_view *v, const study_reference_entry *like,
                const float *accessibility, const float *error)
{
    size_t size = (size_t)v->width * (size_t)v->height * sizeof *accessibility;
    study_reference_entry *entry = new_entry(v->cache);
    float *copy = malloc(size);

    if (entry == NULL || copy == NULL) {
        free(copy);
        return report_no_memory(s->r);
    }
    memcpy(copy, accessibility, size);
    *entry = *like;
    entry->accessibility = copy;
    entry->facts.error = rms_error(v, error);
    v->cache->reference_count++;
    return EXIT_DONE;
}

/* One set of rays gives all falloffs of a weighting; those that are there already stay.
 */
static int keep_all(study *s, study_view *v, const study_reference_entry *like,
                    const reference *work)
{
    int result = EXIT_DONE;

    if (like->target.definition == REFERENCE_TANGENT_SPHERE)
        return keep(s, v, like, reference_accessibility(work), reference_error(work));
    for (int f = 0; f < REFERENCE_FALLOFFS && result == EXIT_DONE; f++) {
        study_reference_entry one = *like;

        one.target.falloff = (crv_falloff)f;
        one.target = plain_target(&one.target);
        if (find_reference(v, &one.target, one.kind, one.buffers) == NULL)
            result =
                keep(s, v, &one, reference_falloff_accessibility(work, (crv_falloff)f),
                     reference_falloff_error(work, (crv_falloff)f));
    }
    return result;
}

static int trace(study *s, study_view *v, const scene_gbuffer *g,
                 study_reference_entry *entry)
{
    enum { ROWS = 16 };
    reference_options o = {
        .definition = entry->target.definition,
        .kind = entry->kind,
        .weighting = entry->target.weighting,
        .falloff = entry->target.falloff,
        .tau = entry->target.tau,
        .u = entry->target.u,
        .radius = v->radius,
        .thickness = STUDY_THICKNESS,
        .rays = s->rays,
        .max_error = (float)study_reference_stop(s),
        .normals = SCENE_NORMALS_INTERPOLATED,
        .all_falloffs = entry->target.definition == REFERENCE_HEMISPHERE,
    };
    double start = report_seconds();
    reference *work = NULL;
    int result;

    if (reference_create(v->model, g, &o, &work, study_quiet_logger(s)) != 0)
        return EXIT_FAILED;
    while (reference_done(work) < reference_total(work))
        reference_advance(work, (int64_t)ROWS * v->width, s->threads);
    entry->facts.seconds = report_seconds() - start;
    result = keep_all(s, v, entry, work);
    reference_free(work);
    return result;
}

/* "reference, cosine", "reference, tangent sphere" */
static void tell_trace(study *s, const study_view *v, const study_reference_entry *e)
{
    const char *name = e->target.definition == REFERENCE_TANGENT_SPHERE ? "tangent sphere"
                       : e->target.weighting == CRV_WEIGHTING_COSINE    ? "cosine"
                                                                        : "uniform";

    study_progress(s, "%s: reference, %s%s: %.1f s", v->name, name,
                   e->kind == REFERENCE_VISIBLE ? ", of what the buffers hold" : "",
                   e->facts.seconds);
}

int study_reference(study *s, study_view *v, const study_target *target,
                    reference_kind kind, study_buffers buffers, const float **out)
{
    study_reference_entry *found = find_reference(v, target, kind, buffers);
    study_reference_entry wanted = {
        .target = plain_target(target), .kind = kind, .buffers = buffers};
    const scene_gbuffer *g;
    int result = page_failed(s->page) ? EXIT_FAILED : EXIT_DONE;

    if (found == NULL) {
        if (result == EXIT_DONE)
            result = study_gbuffer(
                s, v, kind == REFERENCE_FULL ? STUDY_ONE_LAYER : buffers, &g);
        if (result == EXIT_DONE)
            result = trace(s, v, g, &wanted);
        if (result != EXIT_DONE)
            return result;
        tell_trace(s, v, &wanted);
        found = find_reference(v, target, kind, buffers);
    }
    found->is_used = true;
    *out = found->accessibility;
    return EXIT_DONE;
}

void study_references_table(study *s)
{
    static const char *const headers[] = {"View", "Integral", "Scene", "Standard error",
                                          "Trace, s"};
    cJSON *list = cJSON_AddArrayToObject(s->results, "references");

    page_table_begin(s->page,
                     "The references that this page compares with. All falloffs of a "
                     "weighting come from the same rays.",
                     headers, 5);
    for (int32_t i = 0; i < s->view_count; i++) {
        const study_view *v = &s->views[i];
        for (int32_t k = 0; k < v->cache->reference_count; k++) {
            const study_reference_entry *e = &v->cache->references[k];
            char occluders[64] = "all of it";
            cJSON *item;

            if (!e->is_used)
                continue;
            item = cJSON_CreateObject();
            if (e->kind == REFERENCE_VISIBLE)
                snprintf(occluders, sizeof occluders, "what %d layer%s hold%s",
                         e->buffers.layers, e->buffers.layers == 1 ? "" : "s",
                         e->buffers.layers == 1 ? "s" : "");
            page_cell(s->page, "%s", v->name);
            page_cell(s->page, "%s", study_target_name(&e->target));
            page_cell(s->page, "%s", occluders);
            page_cell(s->page, "%.5f", e->facts.error);
            page_cell(s->page, "%.2f", e->facts.seconds);
            cJSON_AddStringToObject(item, "view", v->name);
            cJSON_AddStringToObject(item, "target", study_target_name(&e->target));
            cJSON_AddStringToObject(item, "scene", occluders);
            study_add_number(item, "standard_error", e->facts.error);
            study_add_number(item, "seconds", e->facts.seconds);
            cJSON_AddItemToArray(list, item);
        }
    }
    page_table_end(s->page);
}

/* SPDX-License-Identifier: MIT */
/* shot_frame.c: from a frame to its results. */
#include "shot_state.h"

#include <string.h>

#include "common/output.h"
#include "common/radius.h"
#include "made.h"
#include "masks.h"
#include "results.h"
#include "shrink.h"

/* Turns bent normals to the space that is wanted. */
static int choose_space(const ao_settings *s, const char *input, ao_result *result,
                        report *r)
{
    const io_frame *frame = &result->frame;
    const bool given = s->bent.space.given;
    const bool world =
        given ? s->bent.space.value == BENT_WORLD : frame->normals_in_world;
    if (given && world && !frame->has_world) {
        report_error(r,
                     "%s: does not say how its camera is turned, which --bent-space "
                     "world needs; give --camera FILE, or --bent-space view",
                     input);
        return EXIT_FAILED;
    }
    if (!given || world)
        bent_turn(&result->ao, given ? frame->world_to_view : frame->normals_to_view);
    result->bent_space = world ? BENT_WORLD : BENT_VIEW;
    return EXIT_DONE;
}

/* The result of the view at hand. so_far: those of the frame that will be written with
 * it, itself included. */
static int compute(shot *t, const frame_paths *paths, ao_result *result, int32_t so_far,
                   report *r)
{
    const char *input = paths->input;
    const bool is_first = !t->request.is_later;
    result->view = t->view;
    shot_name_channel(t, result->channel);
    shot_name_bent(t, result->bent_layer);
    result->bent_output = paths->bent;
    int code = shot_load(t, paths, &result->frame, r);
    if (code == EXIT_DONE)
        code = append_check(t->settings, input, result + 1 - so_far, so_far, r);
    if (code == EXIT_DONE)
        code = shrink_check(&result->frame, t->settings->aa.value, input, r);
    if (code == EXIT_DONE)
        facts_compare(&t->first, &result->frame, input, r);
    if (code == EXIT_DONE)
        code = shot_upload(&t->estimator, &result->frame, r);
    if (code == EXIT_DONE && !t->has_radius)
        code = shot_fix_radius(t, &result->frame, r);
    else if (code == EXIT_DONE && is_first)
        code = radius_check(&t->estimator, &result->frame, t->options.radius, input, r);
    if (code == EXIT_DONE)
        code = estimate_plan(&t->estimator, &t->options, r);
    if (code == EXIT_DONE)
        code = estimate_run(&t->estimator, &result->ao, r);
    if (code == EXIT_DONE)
        code = facts_check_surface(&t->estimator, &result->ao, input, r);
    if (code == EXIT_DONE)
        code = masks_open(t->settings, input, &result->frame, t->estimator.gbuffer,
                          &result->ao, r);
    if (code == EXIT_DONE && bent_is_there(&result->ao))
        code = choose_space(t->settings, input, result, r);
    return code;
}

static int write_results(const shot *t, const frame_paths *paths, ao_result *results,
                         report *r)
{
    const made_state state = {.has_radius = t->has_radius && !t->is_before_radius,
                              .radius = t->options.radius,
                              .reading = t->request.usual_reading,
                              .encoding = t->request.depth_format.encoding};
    const bool together = shot_is_together(t);
    int code = EXIT_DONE;
    for (int32_t i = 0; i < (together ? 1 : t->views.count) && code == EXIT_DONE; i++)
        code = results_write(t->settings, paths[i].input, paths[i].output, &results[i],
                             together ? t->views.count : 1, t->made, &state, r);
    return code;
}

/* Whether all files of a frame are there; NULL for the number: a single frame. */
static int prepare(shot *t, const int32_t *number, frame_paths paths[MAX_VIEWS],
                   bool *is_there, report *r)
{
    const ao_settings *s = t->settings;
    *is_there = s->skip_existing;
    for (int32_t i = 0; i < t->views.count; i++) {
        shot_use_view(t, i);
        int code = number ? shot_name_frame(t, *number, &paths[i], r)
                          : shot_name_single(t, &paths[i], r);
        if (code == EXIT_DONE)
            code = output_check(paths[i].output, paths[i].input, r);
        if (code == EXIT_DONE && paths[i].bent[0])
            code = output_check(paths[i].bent, paths[i].input, r);
        if (code != EXIT_DONE)
            return code;
        if (i == 0 || !shot_is_together(t))
            *is_there = *is_there && shot_is_done(t, &paths[i], r);
    }
    return EXIT_DONE;
}

int shot_process(shot *t, const int32_t *number, report *r)
{
    frame_paths paths[MAX_VIEWS];
    ao_result results[MAX_VIEWS];
    bool is_there;
    int code = prepare(t, number, paths, &is_there, r);
    if (code != EXIT_DONE || is_there)
        return code;
    memset(results, 0, sizeof results);
    for (int32_t i = 0; i < t->views.count && code == EXIT_DONE; i++) {
        shot_use_view(t, i);
        code = compute(t, &paths[i], &results[i], shot_is_together(t) ? i + 1 : 1, r);
    }
    if (code == EXIT_DONE)
        code = write_results(t, paths, results, r);
    results_free(results, t->views.count);
    return code;
}

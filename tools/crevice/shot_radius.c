/* SPDX-License-Identifier: MIT */
/* shot_radius.c: the radius that a shot chooses. */
#include "shot_state.h"

#include "common/radius.h"
#include "system/file.h"

int shot_upload(estimator *e, const io_frame *frame, report *r)
{
    estimate_fit(e, &frame->desc);
    return report_ok(r, io_frame_to_gbuffer(frame, e->context, &e->gbuffer), "G-buffer")
               ? EXIT_DONE
               : EXIT_FAILED;
}

/* A part of a shot chooses its own radius, which another part would not. */
static void warn_of_part(const shot *t, report *r)
{
    frame_paths paths;
    if (!t->list)
        return;
    const int32_t first = frames_at(t->list, 0);
    const int32_t last = frames_at(t->list, frames_count(t->list) - 1);
    const int32_t outside[] = {first - 1, last + 1};
    for (int i = 0; i < 2; i++) {
        if (shot_name_frame(t, outside[i], &paths, r) == EXIT_DONE
            && file_exists(paths.input)) {
            report_warning(r,
                           "--radius: these frames choose their own, and %s is not of "
                           "them; give --radius, or --radius-frame to all parts of a "
                           "shot",
                           paths.input);
            return;
        }
    }
}

int shot_fix_radius(shot *t, const io_frame *frame, report *r)
{
    float radius;
    const int result = radius_suggest(&t->estimator, frame, &radius, r);
    if (result != EXIT_DONE || !(radius > 0.0f))
        return result;
    t->options.radius = radius;
    t->has_radius = true;
    report_info(r, "radius: --radius %g, 5 %% of the view's height at the median depth",
                (double)radius);
    if (!t->settings->radius_frame.given)
        warn_of_part(t, r);
    return EXIT_DONE;
}

/* The radius of the frame that the user names. */
int shot_find_radius(shot *t, report *r)
{
    frame_paths paths;
    io_frame frame = {0};
    if (!t->settings->radius_frame.given)
        return shot_find_made_state(t, r);
    int result = shot_name_frame(t, t->settings->radius_frame.value, &paths, r);
    if (result == EXIT_DONE)
        result = shot_load(t, &paths, &frame, r);
    if (result == EXIT_DONE)
        result = shot_upload(&t->estimator, &frame, r);
    if (result == EXIT_DONE)
        result = shot_fix_radius(t, &frame, r);
    io_frame_free(&frame);
    if (result == EXIT_DONE && !t->has_radius) {
        report_error(r, "--radius-frame: %s shows nothing; name another frame",
                     paths.input);
        result = EXIT_FAILED;
    }
    return result;
}

/* With --jobs each process finds out for itself what the first frames decide for all. */
void shot_decide(shot *t, report *r)
{
    report mute = *r;
    mute.quiet = mute.brief = true;
    mute.logger = (crv_logger){0};
    const int32_t total = frames_count(t->list);
    for (int32_t i = 0; i < total && !(t->has_radius && t->request.is_later); i++) {
        frame_paths paths;
        io_frame frame = {0};
        if (shot_name_frame(t, frames_at(t->list, i), &paths, &mute) == EXIT_DONE
            && shot_load(t, &paths, &frame, &mute) == EXIT_DONE && !t->has_radius
            && shot_upload(&t->estimator, &frame, &mute) == EXIT_DONE) {
            shot_fix_radius(t, &frame, t->part.slice ? &mute : r);
            t->radius_from = i;
        }
        io_frame_free(&frame);
    }
}

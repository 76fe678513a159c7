/* SPDX-License-Identifier: MIT */
/* shot_resume.c: results that are there already. */
#include "shot_state.h"

#include <math.h>

#include "frame_copy.h"
#include "made.h"
#include "system/file.h"

/* What the frame of a result has left to those after it. */
static void take_up(shot *t, const made_state *state)
{
    if (state->has_radius) {
        t->options.radius = state->radius;
        t->has_radius = true;
    }
    t->request.usual_reading = state->reading;
    t->request.depth_format.encoding = state->encoding;
    t->request.is_later = true;
}

static bool is_same_radius(const shot *t, const made_state *state)
{
    return !t->has_radius || !state->has_radius
           || fabsf(state->radius - t->options.radius) <= 1e-6f * t->options.radius;
}

/* Whether a result is there, whole, and made with these settings. */
bool shot_is_done(shot *t, const frame_paths *paths, report *r)
{
    const char *output = paths->output;
    char made[IO_MADE_SIZE], channel[IO_NAME_SIZE];
    made_state state;
    if (!file_exists(output) || (paths->bent[0] && !file_exists(paths->bent)))
        return false;
    shot_name_channel(t, channel);
    const bool whole =
        made_read(output, append_is_wanted(t->settings) ? channel : NULL, made);
    const bool same =
        whole && made_matches(t->made, made, &state) && is_same_radius(t, &state);
    if (!same) {
        report_info(r, "%s: is %s; it is made again", output,
                    whole ? "made with other settings" : "not whole");
        return false;
    }
    take_up(t, &state);
    report_info(r, "%s: is there, and made with these settings", output);
    return true;
}

/* The first result that is there gives the radius and the rest, so that frames before it,
 * which failed or were lost, do not choose another. */
int shot_find_made_state(shot *t, report *r)
{
    frame_paths paths;
    char made[IO_MADE_SIZE], channel[IO_NAME_SIZE];
    made_state state;
    if (!t->settings->skip_existing || !t->list)
        return EXIT_DONE;
    for (int32_t i = 0; i < frames_count(t->list); i++) {
        const int result = shot_name_frame(t, frames_at(t->list, i), &paths, r);
        if (result != EXIT_DONE)
            return result;
        shot_name_channel(t, channel);
        made_glance(paths.output, append_is_wanted(t->settings) ? channel : NULL, made);
        if (!made_matches(t->made, made, &state) || !state.has_radius
            || !is_same_radius(t, &state))
            continue;
        if (!t->has_radius)
            report_info(r, "radius: %g, of %s", (double)state.radius, paths.output);
        take_up(t, &state);
        break;
    }
    return EXIT_DONE;
}

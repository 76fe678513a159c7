/* SPDX-License-Identifier: MIT */
/* shot_names.c: what files and channels of a shot are called. */
#include "shot_state.h"

#include <stdio.h>
#include <string.h>

#include "common/frame_camera.h"
#include "frame_copy.h"

/* Fills the place of the view in a name, which is there or not. */
static bool name_view(const shot *t, char path[PATH_SIZE])
{
    char pattern[PATH_SIZE];
    memcpy(pattern, path, PATH_SIZE);
    return views_name(pattern, t->view, path, PATH_SIZE);
}

int shot_name_frame(const shot *t, int32_t frame, frame_paths *paths, report *r)
{
    const ao_settings *s = t->settings;
    paths->has_number = true;
    paths->number = frame;
    paths->bent[0] = '\0';
    if (frames_name(s->input, frame, paths->input, sizeof paths->input)
        && frames_name(s->output, frame, paths->output, sizeof paths->output)
        && name_view(t, paths->input) && name_view(t, paths->output)
        && (!s->bent.output
            || (frames_name(s->bent.output, frame, paths->bent, sizeof paths->bent)
                && name_view(t, paths->bent))))
        return EXIT_DONE;
    report_error(r, "--frames: the names of frame %d are too long", (int)frame);
    return EXIT_USAGE;
}

int shot_name_single(const shot *t, frame_paths *paths, report *r)
{
    const ao_settings *s = t->settings;
    const bool fits = views_name(s->input, t->view, paths->input, sizeof paths->input);
    paths->bent[0] = '\0';
    if (fits && views_name(s->output, t->view, paths->output, sizeof paths->output)
        && (!s->bent.output
            || views_name(s->bent.output, t->view, paths->bent, sizeof paths->bent))) {
        paths->has_number = frame_camera_number(paths->input, &paths->number);
        return EXIT_DONE;
    }
    report_error(r, "%s: the name is too long; shorten it", fits ? "-o" : "IN");
    return EXIT_USAGE;
}

/* From here on the passes of this view are read. */
void shot_use_view(shot *t, int32_t index)
{
    t->view = t->views.name[index];
    t->request.views = t->settings->views;
    t->request.view =
        t->settings->views && !views_have_place(t->settings->input) ? t->view : NULL;
}

/* Whether all views of a frame share a file. */
bool shot_is_together(const shot *t)
{
    return t->views.count > 1 && !views_have_place(t->settings->output);
}

/* The name of the view's channel. */
void shot_name_channel(const shot *t, char channel[IO_NAME_SIZE])
{
    views_channel(append_channel(t->settings), shot_is_together(t) ? t->view : "",
                  channel);
}

/* Beside the channel of accessibility. */
void shot_name_bent(const shot *t, char layer[IO_NAME_SIZE])
{
    const ao_settings *s = t->settings;
    const char *view = shot_is_together(t) ? t->view : "";
    const char *channel = append_is_wanted(s) ? append_channel(s) : "AO";
    const char *dot = strrchr(channel, '.');
    char beside[IO_NAME_SIZE];
    snprintf(beside, sizeof beside, "%.*sbent", dot ? (int)(dot + 1 - channel) : 0,
             channel);
    views_channel(s->bent_channel ? s->bent_channel : beside, view, layer);
}

/* SPDX-License-Identifier: MIT */
/* shot_state.h: what lasts from frame to frame of a shot, for the files shot*.c. All
 * functions that return int return an exit code, after an error line if it is none of
 * EXIT_DONE. */
#ifndef TOOL_SHOT_STATE_H
#define TOOL_SHOT_STATE_H

#include "ao_settings.h"
#include "common/camera_file.h"
#include "common/estimate.h"
#include "common/frames.h"
#include "frame_facts.h"
#include "jobs.h"
#include "passes/passes.h"
#include "views.h"

enum { PATH_SIZE = 4096 };

typedef struct shot {
    const ao_settings *settings;
    const frame_list *list; /* NULL: a single frame */
    view_list views;
    const char *view; /* at hand */
    io_passes_request request;
    camera_file cameras; /* of --camera */
    crv_options options;
    bool has_radius;   /* the user's, or that of the first frame that shows anything */
    frame_facts first; /* of the first frame */
    char made[IO_MADE_SIZE]; /* the settings, without the state */
    job part;                /* of the frames, with --jobs */
    int32_t radius_from;     /* place of the frame that decided the radius; 0: any */
    bool is_before_radius;   /* the frame at hand lies before that, and shows nothing */
    estimator estimator;
} shot;

typedef struct frame_paths {
    bool has_number;
    int32_t number;
    char input[PATH_SIZE], output[PATH_SIZE];
    char bent[PATH_SIZE]; /* of --bent-output, or "" */
} frame_paths;

/* From here on the passes of this view are read, and names are those of its files. */
void shot_use_view(shot *t, int32_t index);
/* The files of a frame of the list, or of the single one, in the view at hand. */
int shot_name_frame(const shot *t, int32_t frame, frame_paths *paths, report *r);
int shot_name_single(const shot *t, frame_paths *paths, report *r);
/* Whether all views of a frame are written to one file. */
bool shot_is_together(const shot *t);
/* The name of the channel of the view at hand. */
void shot_name_channel(const shot *t, char channel[IO_NAME_SIZE]);
/* The name of the layer of bent normals of the view at hand. */
void shot_name_bent(const shot *t, char layer[IO_NAME_SIZE]);

/* Whether a result is there, whole, and made with these settings; then its state is taken
 * up. */
bool shot_is_done(shot *t, const frame_paths *paths, report *r);
/* With --skip-existing: takes up the state of the first result that is there. */
int shot_find_made_state(shot *t, report *r);

/* Loads a frame as the shot reads its passes, the view and the masks at hand. */
int shot_load(shot *t, const frame_paths *paths, io_frame *frame, report *r);
/* --vfov fit: the field of view of the first frame that decides it, for all. */
int shot_find_lens(shot *t, report *r);

/* Brings a frame into the estimator's G-buffer. */
int shot_upload(estimator *e, const io_frame *frame, report *r);
/* Takes the radius of the frame that was uploaded, if that shows anything. */
int shot_fix_radius(shot *t, const io_frame *frame, report *r);
/* The radius before any frame: that of --radius-frame, or of results that are there. */
int shot_find_radius(shot *t, report *r);
/* What the first frames decide for all, for a process that will not compute them. */
void shot_decide(shot *t, report *r);

/* Computes and writes a frame, or leaves it if it is there. number NULL: the single one.
 */
int shot_process(shot *t, const int32_t *number, report *r);

#endif

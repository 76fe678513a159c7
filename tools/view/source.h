/* SPDX-License-Identifier: MIT */
/* source.h: where the viewer's G-buffers come from: a mesh, or the frames of a shot. */
#ifndef VIEW_SOURCE_H
#define VIEW_SOURCE_H

#include "buffers.h"
#include "common/estimate.h"
#include "common/frames.h"
#include "common/viewer_args.h"
#include "passes/passes.h"

typedef struct source {
    const view_settings *settings;
    const pass_settings *passes; /* of frames */
    frame_camera_settings camera;
    camera_file cameras; /* of frames; empty: no file was given */
    scene *model;        /* NULL: frames */
    io_passes_request request;
    bool has_beauty; /* frames: the first has a picture, in these channels */
    char beauty[3][IO_NAME_SIZE];
    frame_list list; /* of a shot; empty: one frame */
    int32_t frame_count;
    float radius; /* of the first frame or view: what suits it */
    atomic_bool stop;
} source;

/* Loads the mesh, or sees to it that there are frames; settings must outlive it. Returns
 * an exit code; free it in any case. */
int source_open(source *s, const viewer_settings *settings, report *r);
void source_free(source *s);

/* Ray-casts a view of the mesh; NULL if it fails or s->stop was set. */
buffers *source_cast(source *s, const scene_view *view, int32_t width, int32_t height,
                     int32_t guard_px, const crv_logger *log);

/* Reads the frame at this place of the list into e's G-buffer, whose size it fits. NULL
 * after an error line. */
buffers *source_read(source *s, int32_t index, estimator *e, report *r);

/* The file of a frame; NULL if its name is too long. */
const char *source_frame_name(const source *s, int32_t index, char *out, size_t size);

#endif

/* SPDX-License-Identifier: MIT */
/* frames.h: what is measured on: scenes from cameras, in any size, and renderers' frames,
 * in their own. */
#ifndef TOOL_BENCH_FRAMES_H
#define TOOL_BENCH_FRAMES_H

#include "common/args.h"
#include "passes/passes.h"
#include "scene.h"
#include "study/views.h"

/* A scene with a camera, or the path of a frame. */
typedef struct bench_source {
    const char *name;
    const char *path;   /* of an EXR frame; NULL: a scene */
    const scene *model; /* not owned */
    views_entry *entry;
    float vfov_rad; /* frames without a camera; 0: none was given */
} bench_source;

typedef struct bench_frame {
    const bench_source *source;
    crv_gbuffer_desc desc;
    int32_t width, height; /* of the result */
    float radius;          /* scene units */
    scene_gbuffer cast;    /* scenes */
    io_frame file;         /* frames */
} bench_frame;

/* The views (models framed by themselves, and those of the list) and frames that the
 * arguments name; of none: the built-in courtyard. inputs that end in .exr are frames.
 * views keeps what sources point to. */
int bench_sources_open(const arg_texts *inputs, const char *views_file,
                       const arg_texts *names, double vfov_deg, views_list *views,
                       bench_source **out, int32_t *count, report *r);

/* Before the work: whether every frame can be read and has a camera. */
int bench_sources_check(const bench_source *sources, int32_t count, report *r);
void bench_sources_close(views_list *views, bench_source *sources);

/* Renders or loads; free it also after an error. Frames keep their own size. */
int bench_frame_make(const bench_source *source, int32_t width, int32_t height,
                     int32_t threads, const crv_logger *log, report *r, bench_frame *out);
void bench_frame_free(bench_frame *f);

/* Makes (when *gbuffer is NULL) or refills a G-buffer. */
crv_status bench_frame_upload(const bench_frame *f, crv_context *context,
                              crv_gbuffer **gbuffer);

#endif

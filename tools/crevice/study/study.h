/* SPDX-License-Identifier: MIT */
/*
 * study.h: what the sections of `crevice report` measure with: views with their
 * G-buffers and ray-traced references, made once and kept, and estimates with their time
 * and error. All calls that can fail return an exit code after an error line.
 */
#ifndef TOOL_STUDY_STUDY_H
#define TOOL_STUDY_STUDY_H

#include <cjson/cJSON.h>

#include "common/args.h"
#include "common/metrics.h"
#include "common/metrics_fit.h"
#include "page.h"
#include "reference.h"
#include "scene.h"

/* What references of the buffers take for solid behind a front, in radii: the default of
 * the option `thickness`. */
#define STUDY_THICKNESS 0.5f

/* The integral that an estimate is held to. */
typedef struct study_target {
    reference_definition definition;
    crv_weighting weighting;
    crv_falloff falloff;
    float tau, u;
} study_target;

/* Which buffers an estimate sees. */
typedef struct study_buffers {
    int32_t layers; /* 1 to CRV_MAX_LAYERS */
    crv_layers kind;
} study_buffers;

#define STUDY_ONE_LAYER ((study_buffers){1, CRV_LAYERS_SURFACES})

typedef struct study_view study_view;
struct study_view {
    const char *name; /* a word; owned by the study */
    scene *model;
    scene_view camera;
    float radius;          /* scene units */
    int32_t width, height; /* px, of the picture; the guard band is a tenth of height */
    uint8_t *mask;         /* width * height bytes: 1 where there is a surface */
    int64_t pixels;        /* how many of these */
    struct study_cache *cache;
};

typedef struct study {
    report *r;
    page *page;
    cJSON *results; /* what is measured, a member for each section; report.json */
    study_view *views;
    int32_t view_count;
    study_view *main; /* the view that the papers' statements are measured on */
    const common_settings *common; /* the device; the caller owns them */
    int32_t threads;               /* 0: all */
    int32_t rays;                  /* of the references, for each pixel at most */
    crv_context *context;
    double started;          /* on the clock of report_seconds() */
    crv_logger quiet_logger; /* errors only */
} study;

/* What the ray-cast G-buffer of a view holds for these buffers; kept by the view. */
int study_gbuffer(study *s, study_view *v, study_buffers buffers,
                  const scene_gbuffer **out);

/* The ray-traced picture, width * height floats; kept by the view. buffers matter to
 * REFERENCE_VISIBLE only. */
int study_reference(study *s, study_view *v, const study_target *target,
                    reference_kind kind, study_buffers buffers, const float **out);

/* What is known of a reference that was traced: its rays at most, its root mean square
 * standard error over the surface, and the seconds that it took. False where it was not.
 */
typedef struct study_reference_facts {
    double error, seconds;
} study_reference_facts;
bool study_reference_is(const study_view *v, const study_target *target,
                        reference_kind kind, study_buffers buffers,
                        study_reference_facts *out);

/* The standard error from which on a pixel of a reference gets no more rays. */
double study_reference_stop(const study *s);

/* A table of all references that the views of the study hold. */
void study_references_table(study *s);

/* The integral that the options' method estimates: its weighting and falloff; vao the
 * tangent sphere, alchemy its own falloff, vo and ssao (uniform, cubic and none) the
 * nearest there is. */
study_target study_target_of(const crv_options *options);

/* "cosine, linear", "tangent sphere". Static storage. */
const char *study_target_name(const study_target *target);

typedef struct study_estimate {
    float *accessibility; /* width * height; owned, free() */
    double ms;            /* median time of a run, filter included; NAN unless timed */
    double samples;       /* looked up in the buffers for each pixel, at most */
} study_estimate;

/* Runs these options (radius set by the caller) on the view. repeats: 0 runs once
 * untimed; otherwise one run to warm up and so many timed ones. Long runs need neither: a
 * first one of half a second is taken as the time, and none is begun after two seconds.
 */
int study_run(study *s, study_view *v, const crv_options *options, study_buffers buffers,
              int32_t repeats, study_estimate *out);

/* Runs the filter alone on a picture of accessibility. */
int study_filter(study *s, study_view *v, const crv_options *options, const float *input,
                 float *output);

/* The options of a method at a preset with the view's radius. filter: the preset's. */
crv_options study_options(const study_view *v, const char *method, crv_preset preset);

/* Buffer look-ups for each pixel that these options may cause: of hsao Nd Ns (1 + Nn), of
 * hbao Nd Ns, of the others n or Nd Nn Ns. */
double study_samples(const crv_options *options);

/* RMSE and the others over the view's mask. */
int study_compare(study *s, const study_view *v, const float *a, const float *b,
                  metrics *out);

/* The view of a scene: what all others are made of; free it. The name must outlive it. */
int study_view_make(study *s, const char *name, scene *model, const scene_view *camera,
                    float radius, int32_t width, int32_t height, study_view *out);

/* A view of the same scene and camera in another size; free it. */
int study_view_resized(study *s, const study_view *v, int32_t width, int32_t height,
                       study_view *out);

/* The same scene, size and radius from another camera; free it. */
int study_view_moved(study *s, const study_view *v, const scene_view *camera,
                     study_view *out);

/* Frees what the view keeps, not the scene. */
void study_view_free(study_view *v);

/* Estimates of depth and normals given as pictures rather than a scene: those of the
 * closed forms. Packed planes of width * height. accessibility: the caller's. */
int study_run_buffers(study *s, const crv_camera *camera, const float *depth,
                      const float *normals, int32_t width, int32_t height,
                      const crv_options *options, float *accessibility);

/* Says what is being done ("claims: error over rays"), with the time so far. */
void study_progress(study *s, const char *format, ...) REPORT_PRINTF;

/* A number of the results; null where it is not finite. */
void study_add_number(cJSON *object, const char *key, double value);

/* The context and the results; close it also after an error. */
int study_open(study *s);
void study_close(study *s);

#endif

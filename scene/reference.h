/* SPDX-License-Identifier: MIT */
/*
 * reference.h: ambient occlusion by ray tracing, the truth that estimators are measured
 * against.
 *
 * A = 1 - E[V W] over directions w about the normal that are drawn with the weighting's
 * own density, W the falloff at the nearest hit. The bent normal is the direction of
 * E[(1 - V W) w]. Both sides of triangles block. The normal is that of the G-buffer: if
 * an interpolated one deviates from its facet, rays below the facet start under the
 * surface and are blocked by it, so A is that of the triangles as they are.
 */
#ifndef CREVICE_SCENE_REFERENCE_H
#define CREVICE_SCENE_REFERENCE_H

#include "scene.h"

#define REFERENCE_MAX_RAYS 65536
#define REFERENCE_FALLOFFS 6 /* values of crv_falloff */

typedef enum reference_definition {
    REFERENCE_HEMISPHERE = 0,
    /* The share of the tangent sphere's volume (radius R/2, centre P + n R/2) whose
     * points are seen from P. Weighting and falloff do not matter. */
    REFERENCE_TANGENT_SPHERE = 1
} reference_definition;

typedef enum reference_kind {
    REFERENCE_FULL = 0, /* the whole scene occludes */
    REFERENCE_VISIBLE =
        1 /* only what the G-buffer's layers hold: see reference_sheets.c */
} reference_kind;

typedef struct reference_options {
    reference_definition definition;
    reference_kind kind;
    crv_weighting weighting;
    crv_falloff falloff;
    float tau, u; /* of the falloffs, as in crv_options */
    float radius; /* R, scene units, > 0 */
    /* Visible kind: how far behind its front a silhouette is closed, in radii; 0: one
     * radius. crv_options has an assumption of the same name. */
    float thickness;
    int32_t rays;    /* 1 to REFERENCE_MAX_RAYS, the most that a pixel gets */
    float max_error; /* standard error from which a pixel is done; 0: take all rays */
    scene_normals normals; /* full kind: as the G-buffer was made */
    uint32_t seed;
    /* Compute every falloff of this weighting from the same rays, which costs little more
     * than one; a pixel is done when all are. Such a reference has no checkpoint. */
    bool all_falloffs;
} reference_options;

/* What is known of one pixel. */
typedef struct reference_value {
    float accessibility; /* background: 1 */
    float error;         /* estimated standard error, 1/rays at least; background: 0 */
    /* Unit, view space. If nothing is open: the normal; background: 0. */
    float bent_normal[3];
    int32_t rays;
} reference_value;

typedef struct reference reference;

/* Both s and g must outlive the reference. s may be NULL for the visible kind, if there
 * is no mesh; such a reference has no checkpoint. Errors: options out of range, no
 * memory. */
int reference_create(const scene *s, const scene_gbuffer *g, const reference_options *o,
                     reference **out, const crv_logger *log);

/* NULL does nothing. */
void reference_free(reference *r);

/* Begins again with other random numbers; what was prepared is kept. */
void reference_restart(reference *r, uint32_t seed);

/* One pixel by its position inside the guard band, stored nowhere. Thread-safe. */
reference_value reference_pixel(const reference *r, int32_t x, int32_t y);

/* The radiance that comes from a unit direction of world space. */
typedef void (*reference_radiance)(const void *user, const float direction[3],
                                   float rgb[3]);

/* The irradiance of one pixel by the same rays, all of them: pi times the mean of the
 * radiance, each direction's as far as it is open. Background: 0. Needs cosine weighting.
 * Thread-safe if `radiance` is. */
void reference_irradiance(const reference *r, int32_t x, int32_t y,
                          reference_radiance radiance, const void *user, float rgb[3]);

/* The pixels inside the guard band, row by row, and how many of them are done. */
int64_t reference_total(const reference *r);
int64_t reference_done(const reference *r);

/* Computes the next `pixels` pixels with this number of threads; 0: OpenMP's choice. The
 * result has the same bits for any number of threads and any parts. */
void reference_advance(reference *r, int64_t pixels, int32_t threads);

/* One float for each pixel inside the guard band, zero if it is not done. */
const float *reference_accessibility(const reference *r);
const float *reference_error(const reference *r);

/* Three floats for each pixel inside the guard band, as in reference_value. */
const float *reference_bent_normal(const reference *r);

/* The same of another falloff; only where all_falloffs was asked for. */
const float *reference_falloff_accessibility(const reference *r, crv_falloff falloff);
const float *reference_falloff_error(const reference *r, crv_falloff falloff);

/*
 * Checkpoints. reference_save() writes through a temporary file beside it and a rename,
 * always the same number of bytes: where one can take another's place, so can the next.
 * reference_load() refuses files that are damaged or of another scene, view or option.
 */
int reference_save(reference *r, const char *path, const crv_logger *log);
int reference_load(reference *r, const char *path, const crv_logger *log);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * reference_internal.h: what the files of the ray-traced reference share.
 */
#ifndef CREVICE_SCENE_REFERENCE_INTERNAL_H
#define CREVICE_SCENE_REFERENCE_INTERNAL_H

#include "raycast.h"
#include "reference.h"

#define REFERENCE_FLOATS 5

struct reference {
    const scene *scene;     /* where the visible points are */
    const scene *occluders; /* `scene`, or the sheets of the G-buffer's layers;
                               NULL where these are empty */
    scene *sheets;          /* owned; NULL for the full kind */
    const scene_gbuffer *gbuffer;
    scene_axes axes;
    reference_options options;
    int32_t width, height; /* inside the guard band */
    float offset;          /* how far rays begin off the surface, at least */
    uint64_t fingerprint;  /* of all that the result depends on; 0 until a checkpoint
                              wants it, since large meshes take a while */
    int64_t done;
    /* One block of REFERENCE_FLOATS for each pixel, in this order. */
    float *accessibility, *error, *bent_normal;
    float *falloffs; /* of all falloffs, in order: accessibility, error; or NULL */
};

/* Where rays begin, and the axis of their hemisphere, world space. */
typedef struct reference_point {
    vec3 origin, normal;
} reference_point;

/* Estimates one point with the random numbers of this stream, for these falloffs. Bent
 * normals are in world space. */
void reference_trace(const reference *r, const reference_point *point, uint64_t stream,
                     const crv_falloff *falloffs, int32_t count, reference_value *out);

/* The same of pi times the mean of openness times radiance. */
vec3 reference_trace_light(const reference *r, const reference_point *point,
                           uint64_t stream, reference_radiance radiance,
                           const void *user);

/* FNV-1a, to be begun with REFERENCE_HASH. */
#define REFERENCE_HASH 0xcbf29ce484222325u
uint64_t reference_hash(uint64_t hash, const void *data, size_t size);

#endif

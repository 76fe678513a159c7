/* SPDX-License-Identifier: MIT */
/*
 * internal.h: what the files of this room share: the scene itself, how it is made, and
 * messages.
 */
#ifndef CREVICE_SCENE_INTERNAL_H
#define CREVICE_SCENE_INTERNAL_H

#include "embree.h"
#include "mesh.h"
#include "scene.h"

struct scene {
    mesh mesh;
    float lower[3], upper[3]; /* from the mesh's origin, as all positions */
    RTCDevice device;
    RTCScene rtc;
    bool has_view; /* a view that it was made for, at this field of view and aspect */
    scene_view view;
    float view_aspect;
    scene_camera *cameras;
    int32_t camera_count;
};

/* Takes the mesh (also on failure) and prepares it for ray casting. */
int scene_from_mesh(mesh *m, const char *name, scene **out, const crv_logger *log);

/* Where the camera is, from the scene's origin, and how it is turned: rows of the
 * rotation from world to view. */
typedef struct scene_axes {
    vec3 eye, right, up, back;
} scene_axes;

/* False if the view's numbers make no camera. */
bool scene_axes_of_view(const scene_view *view, const double origin[3], scene_axes *out);

#ifdef __GNUC__
#define SCENE_PRINTF(f, a) __attribute__((format(printf, f, a)))
#else
#define SCENE_PRINTF(f, a)
#endif

/* Logs "NAME: text" as one clean line. */
void scene_log(const crv_logger *log, crv_log_level level, const char *name,
               const char *format, ...) SCENE_PRINTF(4, 5);

/* Counts another row that a parallel loop is done with, and tells `watch`, NULL: nobody,
 * in the calling thread. */
void scene_tell_row(void (*watch)(void *user, int32_t rows), void *user, int32_t *done);

/* The number of threads for a loop: 0 leaves the choice to OpenMP. */
int scene_thread_count(int32_t requested);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * scene.h: triangles from a file or made in code, cameras that frame them, and G-buffers
 * of them by ray casting.
 *
 * World space is right-handed. Functions that can fail return 0 when done and -1 after
 * they have logged one error line "FILE: what is wrong; what to do". A scene is immutable
 * once made and may be used by several threads.
 */
#ifndef CREVICE_SCENE_H
#define CREVICE_SCENE_H

#include <stdbool.h>

#include "crevice/crevice.h"

typedef struct scene scene;

/*
 * Loads what assimp can read: node transforms and instances applied, missing normals
 * computed (smooth, crease angle 60 degrees), degenerate and non-finite triangles dropped
 * (a warning counts them), points and lines ignored. A file without triangles is an
 * error.
 */
int scene_load(const char *path, scene **out, const crv_logger *log);

/* A scene made in code. Names: scene_builtin_name(0 ...), NULL beyond. "courtyard" is the
 * demo: columns, steps, spheres in contact, a gear-like machine, thin grass. */
int scene_builtin(const char *name, scene **out, const crv_logger *log);
const char *scene_builtin_name(int32_t index);

/* NULL does nothing. */
void scene_free(scene *s);

int64_t scene_triangle_count(const scene *s);

/* The axis-aligned bounds of all triangles. */
void scene_bounds(const scene *s, float lower[3], float upper[3]);

typedef struct scene_view {
    crv_projection projection;
    float eye[3], target[3], up[3];
    float vfov_rad;    /* perspective: full vertical field of view */
    float view_height; /* orthographic: scene units */
} scene_view;

/* A view that shows the whole scene from a little above (built-in scenes: the view that
 * they were made for), +Y up, with this field of view and aspect = width / height. */
void scene_frame(const scene *s, float vfov_rad, float aspect, scene_view *out);

/* A radius of influence that suits the view: a twentieth of the visible scene's extent at
 * the target, rounded to two digits. */
float scene_suggest_radius(const scene *s, const scene_view *view);

typedef enum scene_layers {
    SCENE_LAYERS_NEXT = 0, /* each further layer is the next surface along the ray */
    SCENE_LAYERS_BACK = 1  /* each further layer is the next surface that faces away */
} scene_layers;

typedef enum scene_normals {
    SCENE_NORMALS_INTERPOLATED =
        0, /* of the vertices, turned with the triangle to the viewer */
    SCENE_NORMALS_FACE = 1
} scene_normals;

typedef struct scene_gbuffer_request {
    scene_view view;
    int32_t width, height; /* px, without the guard band */
    int32_t guard_px;      /* on each side; 0 or more */
    int32_t layers;        /* 1 to CRV_MAX_LAYERS */
    scene_layers layer_kind;
    scene_normals normals;
    int32_t threads; /* 0: OpenMP's choice */
} scene_gbuffer_request;

/* Pixels are packed, guard band included. */
typedef struct scene_gbuffer {
    crv_gbuffer_desc desc;
    crv_camera camera; /* world_to_view set */
    scene_view view;
    float *depth[CRV_MAX_LAYERS]; /* planar; background INFINITY; owned */
    float *normals; /* width * height * 3, view space; background 0; owned */
    float *albedo;  /* width * height * 3, linear; background 0; owned */
} scene_gbuffer;

/* Ray-casts a G-buffer; every ray goes through the pixel's centre. Errors: sizes out of
 * range, eye equal to target, no memory. */
int scene_render_gbuffer(const scene *s, const scene_gbuffer_request *request,
                         scene_gbuffer *out, const crv_logger *log);

/* Frees what the G-buffer owns and zeroes it. */
void scene_gbuffer_free(scene_gbuffer *g);

/* Makes (when *gbuffer is NULL) or refills a library G-buffer from a ray-cast one. */
crv_status scene_gbuffer_upload(const scene_gbuffer *g, struct crv_context *context,
                                crv_gbuffer **gbuffer);

/*
 * Lights the picture inside the guard band: sky light (constant gradient from zenith to
 * ground) times accessibility, plus one key light with ray-cast shadows that
 * accessibility does not darken. accessibility: one channel, or NULL for a picture
 * without ambient occlusion. rgb: three channels, linear; background gets the sky.
 */
int scene_shade(const scene *s, const scene_gbuffer *g, const crv_image *accessibility,
                const crv_image *rgb, int32_t threads, const crv_logger *log);

#endif

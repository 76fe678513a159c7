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

#include <stdatomic.h>
#include <stdbool.h>

#include "crevice/crevice.h"

typedef struct scene scene;

/*
 * Loads what assimp can read: node transforms and instances applied, missing normals
 * computed (smooth, crease angle 60 degrees), the first set of texture coordinates kept,
 * degenerate and non-finite triangles dropped (a warning counts them), points and lines
 * ignored. A file without triangles is an error.
 */
int scene_load(const char *path, scene **out, const crv_logger *log);

/* Files are read in a child process, so that a reader which crashes or hangs on a damaged
 * file ends as an error line. What the child may take: */
typedef struct scene_limits {
    double timeout_s;     /* 0: ten minutes */
    int64_t memory_bytes; /* 0: the machine's memory */
    /* Told about once a second how long it has been waited for. NULL: nobody. */
    void (*waits)(void *user, double seconds);
    void *user; /* handed to waits */
} scene_limits;

/* scene_load() with limits of one's own; NULL: the defaults. */
int scene_load_limited(const char *path, const scene_limits *limits, scene **out,
                       const crv_logger *log);

/*
 * A scene made in code: "NAME" or "NAME,KEY=VALUE". Names: scene_builtin_name(0 ...),
 * NULL beyond. "courtyard" is the demo: columns, steps, spheres in contact, a gear-like
 * machine, thin grass. "corner", "plane", "sphere" and "groove" have depth and occlusion
 * in closed form, "relief" is for height maps, "blades", "leaves" and "bars" are thin.
 * Flat faces and spheres have texture coordinates.
 */
int scene_builtin(const char *name, scene **out, const crv_logger *log);
const char *scene_builtin_name(int32_t index);
const char *scene_builtin_help(int32_t index); /* what it shows */

/* Whether scene_builtin() knows the name and its parameters: 0, or -1 after an error
 * line. */
int scene_builtin_check(const char *name, const crv_logger *log);

typedef struct scene_parameter {
    const char *key;
    double initial, min, max; /* initial may lie outside: not given */
    const char *help;
} scene_parameter;

/* The parameters of a built-in scene, by its index and theirs; NULL beyond the last. */
const scene_parameter *scene_builtin_parameter(int32_t scene_index, int32_t index);

/* NULL does nothing. */
void scene_free(scene *s);

int64_t scene_triangle_count(const scene *s);

/* The axis-aligned bounds of all triangles, world space. */
void scene_bounds(const scene *s, double lower[3], double upper[3]);

/* A point of world space as the scene keeps it: rounded to floats, from the scene's own
 * origin, which is near its centre if that is far from zero. Views whose numbers are
 * the same by this are the same view. */
void scene_local_point(const scene *s, const double world[3], float local[3]);

typedef struct scene_view {
    crv_projection projection;
    double eye[3], target[3], up[3]; /* world space */
    float vfov_rad;                  /* perspective: full vertical field of view */
    float view_height;               /* orthographic: scene units */
} scene_view;

/* A camera of the file. Its target lies before the scene's centre. */
typedef struct scene_camera {
    char name[64]; /* of its node, else its own; may be empty, or another's, too */
    scene_view view;
    float aspect;   /* width / height; 0: not told */
    float hfov_rad; /* perspective, if the file tells the horizontal field of view: the
                       vertical one follows from the picture; 0: view.vfov_rad, and if
                       that is 0, too, the file does not say */
} scene_camera;

/* In the order of the file; NULL beyond the last. */
int32_t scene_camera_count(const scene *s);
const scene_camera *scene_camera_at(const scene *s, int32_t index);

/* A view that shows the whole scene from a little above (built-in scenes: the view that
 * they were made for), +Y up, with this field of view and aspect = width / height. */
void scene_frame(const scene *s, float vfov_rad, float aspect, scene_view *out);

/* A radius of influence that suits the view: a twentieth of the visible scene's extent at
 * the target, rounded to two digits. */
float scene_suggest_radius(const scene *s, const scene_view *view);

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
    /* CRV_LAYERS_SURFACES: each further layer is the next surface along the ray.
     * CRV_LAYERS_SOLID: fronts and backs of solids: layer 1 is the next surface after
     * layer 0 that faces away, layer 2 the next after layer 1 that faces the viewer,
     * layer 3 the next after that which faces away. Depths do not fall from layer to
     * layer; they are equal where solids touch. Once there is none, further layers are
     * empty. */
    crv_layers layer_kind;
    scene_normals normals;
    int32_t threads;     /* 0: OpenMP's choice */
    bool texture_frames; /* also fill uv, tangent and bitangent */
    /* Another thread may set it to true to have the work given up: the result is -1, and
     * nothing is logged. NULL: nobody does. */
    const atomic_bool *stop;
    /* Told by the calling thread now and then how many rows of the G-buffer are done.
     * NULL: nobody. */
    void (*watch)(void *user, int32_t rows);
    void *user; /* handed to watch */
} scene_gbuffer_request;

/* Pixels are packed, guard band included. */
typedef struct scene_gbuffer {
    crv_gbuffer_desc desc;
    crv_camera camera; /* world_to_view set */
    scene_view view;
    double origin[3];             /* the scene's own; see scene_local_point() */
    float *depth[CRV_MAX_LAYERS]; /* planar; background INFINITY; owned */
    float *normals; /* width * height * 3, view space; background 0; owned */
    float *albedo;  /* width * height * 3, linear; background 0; owned */
    /* What crv_height_field wants of layer 0; NULL unless texture_frames. uv is NaN and
     * the others are 0 in the background and if the mesh has no texture coordinates,
     * or none that span its surface. */
    float *uv;        /* width * height * 2: u to the right, v down over the map; owned */
    float *tangent;   /* width * height * 3, view space: dP/du of the pixel's triangle,
                         scene units, not of unit length; owned */
    float *bitangent; /* the same, dP/dv */
} scene_gbuffer;

/* Ray-casts a G-buffer; every ray goes through the pixel's centre. Errors: sizes out of
 * range, eye equal to target, no memory. */
int scene_render_gbuffer(const scene *s, const scene_gbuffer_request *request,
                         scene_gbuffer *out, const crv_logger *log);

/* Frees what the G-buffer owns and zeroes it. */
void scene_gbuffer_free(scene_gbuffer *g);

/* Makes (when *gbuffer is NULL) or refills a library G-buffer from a ray-cast one: depth,
 * layer kind and normals. A height field, which the camera clears, is set after this. */
crv_status scene_gbuffer_upload(const scene_gbuffer *g, struct crv_context *context,
                                crv_gbuffer **gbuffer);

/*
 * Lighting. Everything is linear radiance. The sky has a space of its own, +Y at the
 * zenith: world space where sky_up is +Y, else turned from it by the shortest way.
 */
typedef enum scene_sky {
    /* The default: even light from above and from the ground, before a painted backdrop.
     * Has no settings. */
    SCENE_SKY_PAINTED = 0,
    SCENE_SKY_CONSTANT = 1, /* `constant` from everywhere */
    /* Above the horizon from `horizon` to `zenith` with the square root of the sine of
     * the elevation; `ground` below. */
    SCENE_SKY_GRADIENT = 2,
    SCENE_SKY_ENVIRONMENT = 3 /* `environment`; see scene_sky_from_equirect() */
} scene_sky;

typedef struct scene_lighting {
    scene_sky sky;
    float sky_up[3]; /* the zenith, world space, any length; zero: the view's up */
    float constant[3];
    float zenith[3], horizon[3], ground[3];
    /* Radiance as real spherical harmonics, RGB each, in the order Y00, Y1-1 (y), Y10
     * (z), Y11 (x), Y2-2 (xy), Y2-1 (yz), Y20 (3z^2 - 1), Y21 (xz), Y22 (x^2 - y^2). */
    float environment[9][3];
    /* The environment's picture for the background, laid out as
     * scene_sky_from_equirect() takes it; not owned. NULL: the harmonics are shown. */
    const float *picture;
    int32_t picture_width, picture_height;
    /* Key light. A white surface that faces it gets radiance key_colour. */
    float key_direction[3]; /* towards it, world space, any length; zero: over the
                               viewer's left shoulder */
    float key_colour[3];    /* zero: none */
    /* While a picture is lit: told now and then, in the calling thread, how many rows are
     * done. NULL: nobody. */
    void (*watch)(void *user, int32_t rows);
    void *user; /* handed to watch */
} scene_lighting;

/* The painted sky with a warm key light over the viewer's left shoulder. The members of
 * the other kinds have usable values, too, so that only `sky` need be changed. */
scene_lighting scene_lighting_default(void);

/*
 * Sets the sky to an environment: projects an equirectangular picture to `environment`,
 * remembers it in `picture` (it must outlive the lighting, or set picture to NULL) and
 * leaves the key light alone. rgb: packed, row 0 on top. The top edge is +Y and the
 * bottom edge -Y; the picture's centre is -Z, and to the right of it comes +X (the left
 * and right edges are +Z): pixel centre (i, j) has azimuth p = 2 pi (i + 0.5) / width -
 * pi and polar angle t = pi (j + 0.5) / height, direction (sin t sin p, cos t, -sin t cos
 * p). NaN and negative values count as 0 and infinite ones as 65504, after a warning.
 * Errors: no pixels, or more than CRV_MAX_SIZE on a side; *lighting is then unchanged.
 * name: the picture's, for messages.
 */
int scene_sky_from_equirect(const float *rgb, int32_t width, int32_t height,
                            const char *name, scene_lighting *lighting,
                            const crv_logger *log);

/* What a surface with this unit normal gets from the sky, all of it visible: pi times the
 * radiance of a constant sky. For an environment the order-2 approximation (Ramamoorthi
 * and Hanrahan 2001), not below 0. The direction is in the sky's space. */
void scene_sky_irradiance(const scene_lighting *lighting, const float normal[3],
                          float rgb[3]);

/* What a surface gets if only a part of the sky is visible: of a share `accessibility` of
 * red, green and blue light (0 to 1, cosine weighting), around the mean open direction
 * bent_normal, unit. All open it is scene_sky_irradiance(); the less is open, the less
 * the sky is blurred (sky_opening.c). The direction is in the sky's space. */
void scene_sky_open_irradiance(const scene_lighting *lighting, const float bent_normal[3],
                               const float accessibility[3], float rgb[3]);

/* What the background shows in this unit direction of the sky's space. */
void scene_sky_radiance(const scene_lighting *lighting, const float direction[3],
                        float rgb[3]);

/* What darkens the sky's light; images lie inside the guard band. */
typedef struct scene_occlusion {
    /* One channel, or three: of red, green and blue light. data NULL: all open. */
    crv_const_image accessibility;
    /* Three channels, view space: around it the sky is seen, as by
     * scene_sky_open_irradiance(). data NULL: the normals, with the irradiance of the
     * whole sky times accessibility. */
    crv_const_image bent_normal;
    /* Instead of both: the sky is seen as far as this reference's rays are open; of the
     * same G-buffer, cosine weighting. NULL: none. */
    const struct reference *traced;
} scene_occlusion;

/*
 * Lights the picture inside the guard band:
 * albedo (irradiance / pi + key_colour max(0, n.l) shadow), the irradiance being that of
 * the part of the sky that is visible. Accessibility does not darken the key light, whose
 * shadows are ray-cast. lighting NULL: the default. occlusion NULL: a picture without
 * ambient occlusion. rgb: three channels, linear; background gets the sky.
 */
int scene_shade(const scene *s, const scene_gbuffer *g, const scene_lighting *lighting,
                const scene_occlusion *occlusion, const crv_image *rgb, int32_t threads,
                const crv_logger *log);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * gbuffer.h: what an estimator sees of the scene: camera, one to four depth layers,
 * normals.
 *
 * Depth and normals are converted once, on entry, to planar depth and unit view-space
 * normals. A depth that is NaN, infinite, zero or negative is background: it gets
 * accessibility 1 and never occludes. Nothing outside the buffers occludes either.
 */
#ifndef CREVICE_GBUFFER_H
#define CREVICE_GBUFFER_H

#include "camera.h"
#include "image.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CRV_MAX_LAYERS 4

struct crv_context;

/* What the numbers in a depth image mean. */
typedef enum crv_depth_encoding {
    CRV_DEPTH_PLANAR = 0, /* distance along the viewing axis, scene units */
    CRV_DEPTH_RADIAL = 1, /* distance from the eye (orthographic: as planar) */
    /* A depth buffer in [0, 1], 0 at near, 1 at far. An OpenGL depth texture holds the
     * same with the default glDepthRange. */
    CRV_DEPTH_HARDWARE = 2,
    CRV_DEPTH_REVERSED = 3,            /* a depth buffer in [0, 1], 1 at near, 0 at far */
    CRV_DEPTH_DISPARITY = 4,           /* 1 / planar depth; 0 is background */
    CRV_DEPTH_NORMALISED = 5,          /* planar depth, in [0, 1] from near to far */
    CRV_DEPTH_NORMALISED_REVERSED = 6, /* the same, 1 at near, 0 at far */
    CRV_DEPTH_GL = 7, /* OpenGL's clip space: a depth buffer in [-1, 1], 1 at far */
    /* log2(1 + planar depth) / log2(1 + far), as logarithmic depth buffers have it. */
    CRV_DEPTH_LOGARITHMIC = 8
} crv_depth_encoding;

/* "planar", "radial", "hardware", "reversed", "disparity", "normalised",
 * "normalised-reversed", "gl", "logarithmic"; NULL for no such encoding. Thread-safe. */
CRV_API const char *crv_depth_encoding_name(crv_depth_encoding encoding);
/* The encoding of that name into *encoding; false for an unknown name or NULL.
 * Thread-safe. */
CRV_API bool crv_depth_encoding_find(const char *name, crv_depth_encoding *encoding);

/* Fill it with crv_depth_format_planar(), with crv_depth_format_from_projection() for a
 * depth buffer, or by hand. Reversed with an infinite far plane: CRV_DEPTH_REVERSED,
 * z_near of the projection, z_far INFINITY. */
typedef struct crv_depth_format {
    crv_depth_encoding encoding;
    /* Scene units. All but planar, radial and disparity have a far plane, at which there
     * is nothing; all of them but logarithmic have a near plane. */
    float
        z_near;  /* > 0 for hardware, reversed and GL of a perspective camera, else any */
    float z_far; /* > z_near and > 0; INFINITY for an infinite projection: hardware,
                    reversed and GL of a perspective camera only */
    /* Planar and radial: this depth and all beyond is background. > 0; INFINITY if only
     * non-finite depth is background. Some renderers write 1e10. */
    float background;
} crv_depth_format;

/* Planar depth without a background threshold: what most callers want. Thread-safe. */
CRV_API crv_depth_format crv_depth_format_planar(void);

/* What clip-space z / w is between near and far. */
typedef enum crv_clip_depth {
    CRV_CLIP_ZERO_TO_ONE = 0,     /* Vulkan, Direct3D, Metal, glClipControl */
    CRV_CLIP_MINUS_ONE_TO_ONE = 1 /* OpenGL, Unity's Camera.projectionMatrix */
} crv_clip_depth;

/*
 * The format of a depth buffer in [0, 1] that was rendered with a projection matrix:
 * hardware or reversed, near and far, infinite far included. An orthographic matrix is
 * taken for right-handed unless all that it shows would lie behind the eye. logger: gets
 * the reason for a failure; NULL: nobody. Errors: INVALID_ARGUMENT if an argument is not
 * valid, or the matrix has an oblique near plane or maps z otherwise. Thread-safe.
 */
CRV_API crv_status crv_depth_format_from_projection(crv_depth_format *out,
                                                    const float m[16],
                                                    crv_matrix_layout layout,
                                                    crv_clip_depth range,
                                                    const crv_logger *logger);

/*
 * Converts depth of any encoding to planar depth, background as +INFINITY, without a
 * G-buffer. depth and planar: one channel, of the same size; they may be the same image.
 * format NULL: planar. camera: of the image; its kind of projection counts, and for
 * radial depth all of it. logger: gets the reason for a failure; NULL: nobody. Errors:
 * INVALID_ARGUMENT. Thread-safe.
 */
CRV_API crv_status crv_depth_convert(const crv_const_image *depth,
                                     const crv_depth_format *format,
                                     const crv_camera *camera, const crv_image *planar,
                                     const crv_logger *logger);

/* The space in which normals are given. */
typedef enum crv_normal_space {
    CRV_NORMAL_VIEW = 0, /* as camera.h defines it */
    CRV_NORMAL_WORLD = 1 /* turned to view space by the camera's world_to_view */
} crv_normal_space;

/* What depth layers mean to the methods that march or test points. */
typedef enum crv_layers {
    /* Every layer may block what lies behind it; nothing is known of thickness. */
    CRV_LAYERS_SURFACES = 0,
    /* Layers come in pairs, 0 and 1, 2 and 3: the front and the back of a solid, which
     * blocks in between. */
    CRV_LAYERS_SOLID = 1
} crv_layers;

/* Sizes of a G-buffer. Fill it with crv_gbuffer_desc_init(), then change what differs. */
typedef struct crv_gbuffer_desc {
    size_t struct_size; /* set by crv_gbuffer_desc_init() */
    int32_t width;      /* px, of all buffers, guard band included; 1 to CRV_MAX_SIZE */
    int32_t height;     /* px */
    int32_t layers;     /* 1 to CRV_MAX_LAYERS; layer 0 is what the camera sees */
    crv_layers layer_kind; /* default CRV_LAYERS_SURFACES */
    /* Guard band: pixels on each side that occlude but get no result. 0 or more; the
     * rectangle that is left must not be empty. Without a guard band the border of the
     * result is too bright. crv_guard_px() computes how wide it should be. Default 0. */
    int32_t guard_left, guard_top, guard_right, guard_bottom;
    /* Position of the result's first pixel in the whole picture, any value. It keeps the
     * noise pattern continuous if a picture is computed in tiles. Default 0, 0. */
    int32_t origin_x, origin_y;
} crv_gbuffer_desc;

/* Sets everything: one layer of width x height, no guard band. Pass sizeof *desc as
 * struct_size (base.h). Errors: INVALID_ARGUMENT. Thread-safe. */
CRV_API crv_status crv_gbuffer_desc_init(crv_gbuffer_desc *desc, size_t struct_size,
                                         int32_t width, int32_t height);

/* Whether plans made with one fit G-buffers made with the other: all sizes and kinds are
 * the same. False for NULL or what is not initialised. Thread-safe. */
CRV_API bool crv_gbuffer_desc_equal(const crv_gbuffer_desc *a, const crv_gbuffer_desc *b);

/* Owns converted buffers. Make it once, and fill it for each frame in this order: camera,
 * depth of every layer, normals. Only the thread that uses its context may use it. */
typedef struct crv_gbuffer crv_gbuffer;

/* Makes an empty G-buffer in *out; the caller destroys it, before its context. Errors:
 * INVALID_ARGUMENT (logged), OUT_OF_MEMORY. */
CRV_API crv_status crv_gbuffer_create(struct crv_context *context,
                                      const crv_gbuffer_desc *desc, crv_gbuffer **out);

/* NULL does nothing. */
CRV_API void crv_gbuffer_destroy(crv_gbuffer *gbuffer);

/* Begins a frame: copies the camera and forgets depth and normals of the frame before.
 * Errors: INVALID_ARGUMENT if a number is not finite, fx_px or fy_px is not positive, or
 * world_to_view is neither a rotation nor a reflection (tolerance 1e-3). */
CRV_API crv_status crv_gbuffer_set_camera(crv_gbuffer *gbuffer, const crv_camera *camera);

/*
 * Converts one depth layer. image: one channel, the G-buffer's size; read during the call
 * only. format NULL: planar. A hardware depth equal to the far value is background. If
 * layer 0 cannot be right, such as metres that are given as a depth buffer, or all of it
 * background, one warning for each G-buffer says so, with the share of the pixels.
 * Errors: NOT_READY before crv_gbuffer_set_camera(), INVALID_ARGUMENT.
 */
CRV_API crv_status crv_gbuffer_set_depth(crv_gbuffer *gbuffer, int32_t layer,
                                         const crv_const_image *image,
                                         const crv_depth_format *format);

/* The same for pixels of another type: half floats, 16-bit depth buffers (scale 1 /
 * 65535.0). scale and offset are rounded to floats. */
CRV_API crv_status crv_gbuffer_set_depth_texels(crv_gbuffer *gbuffer, int32_t layer,
                                                const crv_texels *texels,
                                                const crv_depth_format *format);

/*
 * Takes the normals of layer 0. image: three channels, the G-buffer's size, any length
 * but zero; read during the call only. NULL, or no call at all: normals are reconstructed
 * from depth, as they are in pixels whose normal is zero or not finite. Normals that face
 * away from the camera are turned or bent towards it. Errors: NOT_READY,
 * INVALID_ARGUMENT.
 */
CRV_API crv_status crv_gbuffer_set_normals(crv_gbuffer *gbuffer,
                                           const crv_const_image *image,
                                           crv_normal_space space);

/* The same for pixels of another type. channels: 3; of pixels with four, leave
 * pixel_stride as crv_texels_packed() sets it for four. */
CRV_API crv_status crv_gbuffer_set_normals_texels(crv_gbuffer *gbuffer,
                                                  const crv_texels *texels,
                                                  crv_normal_space space);

/*
 * An implicit surface in view space: the value at a point, >= 0 outside and on the
 * surface, < 0 inside, and its gradient in gradient[3]. Called from several threads at
 * once during a run.
 */
typedef float (*crv_implicit_fn)(void *user, const float point_view[3],
                                 float gradient[3]);

/* Adds an implicit surface to the frame, for the methods that test points: vao and
 * containment (crv_characteristic). It replaces a height field and is forgotten with the
 * next camera. function NULL removes it. user is passed to it, and not owned. CPU only:
 * crv_plan_run() refuses it on a Vulkan device. Errors: NOT_READY, INVALID_ARGUMENT. */
CRV_API crv_status crv_gbuffer_set_implicit(crv_gbuffer *gbuffer,
                                            crv_implicit_fn function, void *user);

/* What lies beyond the edge of a height map. */
typedef enum crv_wrap { CRV_WRAP_REPEAT = 0, CRV_WRAP_CLAMP = 1 } crv_wrap;

/* Relief that the mesh does not have: a height field over the tangent plane of every
 * pixel. uv, tangent and bitangent have the G-buffer's size, height may have any. All are
 * read during the call only. */
typedef struct crv_height_field {
    /* 2 channels: texture coordinates, u to the right and v down over the map, 0 to 1;
     * NaN if a pixel has none. */
    crv_const_image uv;
    /* 3 channels each, view space: change of the point with u and with v, scene units. */
    crv_const_image tangent, bitangent;
    crv_const_image height; /* 1 channel */
    /* Scene units for a height of 1, along the surface's outer normal; finite. */
    float scale;
    crv_wrap wrap;
} crv_height_field;

/* Adds a height field to the frame, for vao and containment. It replaces an implicit
 * surface and is forgotten with the next camera. field NULL removes it. The first call
 * takes memory. CPU only: crv_plan_run() refuses it on a Vulkan device. Errors:
 * NOT_READY, INVALID_ARGUMENT, OUT_OF_MEMORY. */
CRV_API crv_status crv_gbuffer_set_height_field(crv_gbuffer *gbuffer,
                                                const crv_height_field *field);

/* Writes a layer as planar depth, background as +INFINITY, to a one-channel image of the
 * G-buffer's size. Errors: NOT_READY, INVALID_ARGUMENT. */
CRV_API crv_status crv_gbuffer_get_depth(crv_gbuffer *gbuffer, int32_t layer,
                                         const crv_image *image);

/* Writes the unit view-space normals that estimators use, reconstructed ones included and
 * background as (0, 0, 0), to a three-channel image of the G-buffer's size. Errors:
 * NOT_READY, INVALID_ARGUMENT. */
CRV_API crv_status crv_gbuffer_get_normals(crv_gbuffer *gbuffer, const crv_image *image);

#ifdef __cplusplus
}
#endif
#endif

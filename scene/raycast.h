/* SPDX-License-Identifier: MIT */
/*
 * raycast.h: rays through pixel centres, and what they meet.
 */
#ifndef CREVICE_SCENE_RAYCAST_H
#define CREVICE_SCENE_RAYCAST_H

#include "internal.h"

/* A ray whose parameter is planar depth: its direction has length 1 along the viewing
 * axis. */
typedef struct pixel_ray {
    vec3 origin, direction;
} pixel_ray;

/* The ray through the centre of pixel (x, y); row 0 is the top. */
pixel_ray ray_through_pixel(const crv_camera *camera, const scene_axes *axes, int32_t x,
                            int32_t y);

/* What a ray met. */
typedef struct surface_hit {
    uint32_t triangle;
    float found;    /* the ray caster's depth: where to go on from */
    double depth;   /* of the triangle's plane along the exact ray */
    vec3 face;      /* unit normal of the triangle's front */
    bool from_back; /* the triangle's back is seen */
} surface_hit;

/* The nearest surface farther than `beyond`. False: background. */
bool find_surface(const scene *s, const pixel_ray *ray, float beyond, surface_hit *hit);

/* The next surface along the ray that is not the one of `hit`, which is replaced. */
bool find_next_surface(const scene *s, const pixel_ray *ray, surface_hit *hit);

/* The next surface whose back (or else front) is seen; it may lie in the very place of
 * the one before if that shows its other side. past: the layers' triangles so far, whose
 * last is that of `hit`. Replaces *hit. */
bool find_facing_surface(const scene *s, const pixel_ray *ray, bool back,
                         const uint32_t *past, int past_count, surface_hit *hit);

/* Of a sheet with fronts on both sides the ray caster may tell either: this replaces a
 * back by the front in the same place. */
void prefer_front(const scene *s, const pixel_ray *ray, surface_hit *hit);

/* The triangle's corners, and their weights in the point that was hit. */
void surface_weights(const scene *s, const pixel_ray *ray, const surface_hit *hit,
                     vec3 corner[3], double weight[3]);

/* The unit normal, world space, turned to the side that is seen. */
vec3 surface_normal(const scene *s, const pixel_ray *ray, const surface_hit *hit,
                    scene_normals kind);

/* Texture coordinates in the point that was hit, and how the point changes with them,
 * world space. */
typedef struct texture_frame {
    double u, v;
    vec3 tangent, bitangent;
} texture_frame;

/* False if the triangle has no texture coordinates or they do not span it. */
bool surface_texture(const scene *s, const pixel_ray *ray, const surface_hit *hit,
                     texture_frame *out);

#endif

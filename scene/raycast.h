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

/* The next surface along the ray that is not the one of `hit`; with only_back one whose
 * back is seen. Replaces *hit. */
bool find_next_surface(const scene *s, const pixel_ray *ray, bool only_back,
                       surface_hit *hit);

/* The unit normal, world space, turned to the side that is seen. */
vec3 surface_normal(const scene *s, const pixel_ray *ray, const surface_hit *hit,
                    scene_normals kind);

#endif

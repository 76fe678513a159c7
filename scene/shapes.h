/* SPDX-License-Identifier: MIT */
/*
 * shapes.h: solids for scenes made in code. Every shape is closed or stands on its base,
 * has outward normals, smooth where the surface is, and is placed by a frame. Triangles
 * and quads have texture coordinates in the plane of two local axes, the map SHAPE_TILE
 * units large and, seen from the front, not mirrored.
 */
#ifndef CREVICE_SCENE_SHAPES_H
#define CREVICE_SCENE_SHAPES_H

#include "mesh.h"

#define SHAPE_TILE 2.0

/* A right-handed orthonormal frame: local (x, y, z) is origin + x X + y Y + z Z. */
typedef struct place {
    vec3 origin, x, y, z;
} place;

place place_at(double x, double y, double z);

/* The frame at a local point of `base`, turned about base's Y axis, counter-clockwise
 * seen from above. */
place place_turned(const place *base, vec3 at, double yaw_rad);

/* The same axes at another local point. */
place place_moved(const place *base, vec3 at);

vec3 place_point(const place *at, vec3 local);
vec3 place_direction(const place *at, vec3 local);

/* Flat faces; counter-clockwise seen from the front. Local points. */
void shape_triangle(mesh *m, const place *at, vec3 a, vec3 b, vec3 c);
void shape_quad(mesh *m, const place *at, vec3 a, vec3 b, vec3 c, vec3 d);

/* With edges cut off at 45 degrees; bevel 0 leaves them sharp. */
void shape_box(mesh *m, const place *at, vec3 lower, vec3 upper, double bevel);

/* The map goes once around, eastwards, and from pole to pole. */
void shape_sphere(mesh *m, const place *at, vec3 centre, double radius, int segments);

typedef struct profile_point {
    double radius, y;
    bool sharp; /* an edge; otherwise the surface is smooth here */
} profile_point;

/* The surface that the profile, from bottom to top, sweeps around local Y. */
void shape_lathe(mesh *m, const place *at, const profile_point *profile, int count,
                 int segments);

/* A column's shaft around local Y from y = 0, with hollow flutes and closed ends. */
void shape_fluted_shaft(mesh *m, const place *at, double bottom_radius, double top_radius,
                        double height, int flutes);

/* A round bar along local points, with closed ends. At most SHAPE_MAX_TUBE points. */
#define SHAPE_MAX_TUBE 64
void shape_tube(mesh *m, const place *at, const vec3 *points, int count, double radius,
                int segments);

/* A plate between z0 and z1 with this outline about the local Z axis, counter-clockwise;
 * outline[i] = (x, y). bore: the radius of a round hole, or 0. */
void shape_plate(mesh *m, const place *at, const double (*outline)[2], int count,
                 double bore, double z0, double z1);

/* A regular prism around local Z; the head of a bolt has 6 sides. */
void shape_prism(mesh *m, const place *at, int sides, double radius, double z0,
                 double z1);

/* An involute spur gear around local Z, pressure angle 20 degrees: toothed rim, web, hub.
 * Two gears of one module mesh at a distance of module * (teeth + teeth) / 2. */
typedef struct gear {
    int teeth;
    double module;
    double width; /* of the rim; centred on z = 0 */
    double bore;
    double phase_rad; /* where the middle of tooth 0 points */
} gear;

void shape_gear(mesh *m, const place *at, const gear *g);

double gear_pitch_radius(const gear *g);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * builtin.h: the parts of the built-in scenes.
 */
#ifndef CREVICE_SCENE_BUILTIN_H
#define CREVICE_SCENE_BUILTIN_H

#include "scene.h"
#include "shapes.h"

/* Each adds a scene's triangles and sets the view that it was made for. `p`: the values
 * of the scene's parameters, in the order of its row in builtin.c. */
void builtin_courtyard(mesh *m, scene_view *view, const double *p);
void builtin_corner(mesh *m, scene_view *view, const double *p);
void builtin_plane(mesh *m, scene_view *view, const double *p);  /* tilt_deg, or < 0 */
void builtin_sphere(mesh *m, scene_view *view, const double *p); /* floor: 0 or 1 */
void builtin_groove(mesh *m, scene_view *view, const double *p); /* angle_deg */
void builtin_relief(mesh *m, scene_view *view, const double *p);
void builtin_blades(mesh *m, scene_view *view, const double *p); /* seed */
void builtin_leaves(mesh *m, scene_view *view, const double *p); /* seed */
void builtin_bars(mesh *m, scene_view *view, const double *p);   /* seed */

/* A perspective view with +Y up. */
scene_view builtin_perspective(vec3 eye, vec3 target, double vfov_deg);

/* Parts of the courtyard: gears on a housing with bolts and pipes, about 2.4 wide, front
 * along local +Z, standing on y = 0. */
void builtin_machine(mesh *m, const place *at);

/* A tuft of curved blades that grow from a disk of this radius around the frame's
 * origin. The same seed gives the same tuft. */
void builtin_tuft(mesh *m, const place *at, double radius, double height, int blades,
                  uint64_t seed);

/* The next of a sequence of uniform numbers in [0, 1): the same on every machine. */
double builtin_random(uint64_t *state);

#endif

/* SPDX-License-Identifier: MIT */
/* motion.h: how a camera moves. */
#ifndef TOOL_MOTION_H
#define TOOL_MOTION_H

#include "scene.h"

/* Turns the eye around the target: to the right by `azimuth`, upwards by `elevation`,
 * radians. It stops a degree before the poles of `up`. */
void motion_orbit(scene_view *v, double azimuth, double elevation);

/* Moves eye and target so that what lies at the target's depth follows the mouse: `right`
 * and `down` are shares of the picture's height. */
void motion_pan(scene_view *v, double right, double down);

/* Moves the eye to the target: its distance becomes `factor` times what it was.
 * Orthographic: so does what is seen. */
void motion_dolly(scene_view *v, double factor);

/* Makes a point the target, and moves the eye to it as above. p: view space. */
void motion_focus(scene_view *v, const double p[3], double factor);

/* Moves eye and target along the view's axes: shares of the distance between them. */
void motion_fly(scene_view *v, double right, double up, double forward);

/* Turns the view about the eye: the target moves. Radians, as motion_orbit(). */
void motion_look(scene_view *v, double azimuth, double elevation);

#endif

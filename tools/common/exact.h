/* SPDX-License-Identifier: MIT */
/* exact.h: numbers as text with as few digits as give the same number when it is read. */
#ifndef TOOL_EXACT_H
#define TOOL_EXACT_H

#include "scene.h"

/* A number that is kept as a float, in `unit`s; 1 for as it is. */
const char *exact_number(float value, double unit, char out[32]);

/* "X,Y,Z" of a point that gives the same point of the scene, or of a direction if model
 * is NULL. */
const char *exact_vector(const scene *model, const double p[3], char out[96]);

/* The camera as flags of the tool that give the same picture, bit by bit: "--eye X,Y,Z
 * --target ... --up ... --vfov DEG". Returns out. */
const char *exact_view(const scene *model, const scene_view *v, char out[384]);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * reference_sheets.h: the surfaces that depth layers hold, as triangles.
 */
#ifndef CREVICE_SCENE_REFERENCE_SHEETS_H
#define CREVICE_SCENE_REFERENCE_SHEETS_H

#include "internal.h"

/* Makes a scene of the G-buffer's layers; NULL where they are empty. thickness:
 * how deep, in radii, what is seen reaches behind its silhouette, where no layer says
 * more. */
int reference_make_sheets(const scene_gbuffer *g, double radius, double thickness,
                          scene **out, const crv_logger *log);

#endif

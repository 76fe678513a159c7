/* SPDX-License-Identifier: MIT */
#include "core/gbuffer.h"

const crv__conversions crv__conversions_specified = {.depth_row = crv__depth_row,
                                                     .rotated_row = crv__rotated_row,
                                                     .normals_row = crv__normals_row};

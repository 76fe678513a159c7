/* SPDX-License-Identifier: MIT */
/* settle_depth.h: what the numbers of depth mean before they are converted. */
#ifndef CREVICE_IO_PASSES_SETTLE_DEPTH_H
#define CREVICE_IO_PASSES_SETTLE_DEPTH_H

#include "depth.h"
#include "evidence.h"

/* The format that depth is read in, with the background that its numbers tell. Negative
 * depth is negated, half floats are smoothed. *settled: its facts after that. */
crv_depth_format io__settle_format(const char *path, const io_passes_request *request,
                                   io_frame *frame, bool has_normals,
                                   io__depth_facts *settled, const crv_logger *log);

/* Warns of depth from 0 to 1 that is read as distances, after the verdict. */
void io__tell_of_unit_range(const char *path, const io_passes_request *request,
                            const io__depth_facts *facts, bool has_normals,
                            const io__verdict *verdict, const crv_logger *log);

#endif

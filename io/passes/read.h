/* SPDX-License-Identifier: MIT */
/* read.h: the channels of the chosen passes. */
#ifndef CREVICE_IO_PASSES_READ_H
#define CREVICE_IO_PASSES_READ_H

#include "names.h"

/* How many channels of the image depth or positions take. */
int32_t io__depth_channels(const io__pass_names *chosen);

/* Reads depth or positions, then normals. Returns 0, or -1 after an error line. */
int io__read_passes(const char *path, const io__pass_names *chosen, const io_watch *watch,
                    io_image *out, const crv_logger *log);

#endif

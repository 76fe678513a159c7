/* SPDX-License-Identifier: MIT */
/*
 * views.h: the eyes of stereo frames. A channel belongs to a view if its part says so
 * (attribute "view"), or if a piece of its name but the last is the view's name, as in
 * "ViewLayer.Depth.left.Z" and "right.R". Channels without a view belong to the default
 * one.
 */
#ifndef CREVICE_IO_PASSES_VIEWS_H
#define CREVICE_IO_PASSES_VIEWS_H

#include "passes.h"

/* Whether the channel belongs to the view; then *plain is its name without it. */
bool io_channel_is_of_view(const io_channel *channel, const char *view,
                           char plain[IO_NAME_SIZE]);

/* Leaves the channels of request->view in a probed image. Returns 0, or -1 after an error
 * line if there are none. */
int io__keep_view(const char *path, const io_passes_request *request, io_image *probed,
                  const crv_logger *log);

#endif

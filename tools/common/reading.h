/* SPDX-License-Identifier: MIT */
/* reading.h: pictures and frames, with a word on how far it is if reading takes long. */
#ifndef TOOL_READING_H
#define TOOL_READING_H

#include "passes/passes.h"
#include "report.h"

/* io_read(), whose messages go to `log`; NULL: to nobody. */
int reading_picture(const char *path, const char *const *names, int32_t count,
                    io_image *out, const crv_logger *log, report *r);

/* io_frame_load(), whose messages go to `log`. */
int reading_frame(const char *path, const io_passes_request *request, io_frame *out,
                  const crv_logger *log, report *r);

#endif

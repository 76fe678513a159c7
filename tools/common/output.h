/* SPDX-License-Identifier: MIT */
/* output.h: pictures out, without half-written files. */
#ifndef TOOL_OUTPUT_H
#define TOOL_OUTPUT_H

#include "append.h"
#include "args.h"
#include "io.h"

/* EXIT_DONE, or an error line if writing there would replace `input` (NULL: none). */
int output_spare(const char *path, const char *input, report *r);

/* Whether the picture could be written there, and would not replace `input` (NULL:
 * there is none). Returns an exit code; meant for before the work. */
int output_check(const char *path, const char *input, report *r);

/* Writes and tells of it. An interrupt waits until the file is whole, or half a second.
 */
int output_write(const char *path, const io_image *image, const io_write_options *options,
                 report *r);

/* The same with a copy of an EXR file. */
int output_append(const char *input, const char *path, const io_addition *additions,
                  int32_t count, const io_append_options *options, report *r);

#endif

/* SPDX-License-Identifier: MIT */
/* frames.h: ranges of frames, and the numbers in their names. */
#ifndef TOOL_FRAMES_H
#define TOOL_FRAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct frame_range {
    int32_t first, last, step; /* 0 <= first <= last, step > 0 */
} frame_range;

/* "12", "1-240" or "1-240x2". False if the text is nothing of that. */
bool frames_parse(const char *text, frame_range *out);

/* How many places for a number there are in the name: runs of #, or %d, %4d, %04d. */
int32_t frames_places(const char *pattern);

/* The name of one frame: the number takes the only place, with leading zeros to its
 * width. False if the name does not fit. */
bool frames_name(const char *pattern, int32_t frame, char *out, size_t size);

#endif

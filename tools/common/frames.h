/* SPDX-License-Identifier: MIT */
/* frames.h: lists of frames, and the numbers in their names. */
#ifndef TOOL_FRAMES_H
#define TOOL_FRAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct frame_range {
    int32_t first, last, step; /* first <= last, step > 0 */
} frame_range;

enum { FRAMES_MAX_RANGES = 64 };

typedef struct frame_list {
    int32_t ranges;
    frame_range range[FRAMES_MAX_RANGES];
} frame_list;

/* "12", "1-240", "1-240x2", "-5--1", or several with commas: "1,3,10-20x2". False if the
 * text is nothing of that. */
bool frames_parse(const char *text, frame_list *out);

int32_t frames_count(const frame_list *list);

/* The frame at this place of the list, counted from 0. */
int32_t frames_at(const frame_list *list, int32_t index);

/* How many places for a number there are in the name: runs of # or @, %d, %4d, %04d, $F,
 * $F4, <frame>. */
int32_t frames_places(const char *pattern);

/* The name of one frame: the number takes the only place, with leading zeros to its
 * width, a minus counted. False if the name does not fit. */
bool frames_name(const char *pattern, int32_t frame, char *out, size_t size);

#endif

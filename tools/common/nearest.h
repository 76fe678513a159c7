/* SPDX-License-Identifier: MIT */
#ifndef TOOL_NEAREST_H
#define TOOL_NEAREST_H

#include <stdint.h>

/* The candidate that a misspelt word most likely means, by edit distance without regard
 * to case, or NULL if none is near. candidates: `count` strings, or up to a NULL if
 * count is -1. */
const char *nearest_name(const char *word, const char *const *candidates, int32_t count);

#endif

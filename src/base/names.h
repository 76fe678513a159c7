/* SPDX-License-Identifier: MIT */
#ifndef CRV_BASE_NAMES_H
#define CRV_BASE_NAMES_H

#include <stdint.h>

/* The candidate that a misspelt word most likely means, by edit distance without regard
 * to case, or NULL if none is near. candidates: `count` strings, or up to a NULL if
 * count is -1. */
const char *crv__nearest_name(const char *word, const char *const *candidates,
                              int32_t count);

#endif

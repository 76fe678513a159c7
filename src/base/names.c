/* SPDX-License-Identifier: MIT */
#include "base/names.h"

#include <stdbool.h>
#include <string.h>

enum { LONGEST = 64 };

static size_t clipped_length(const char *text)
{
    size_t length = strlen(text);
    return length < LONGEST ? length : LONGEST;
}

static char folded(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

/* Levenshtein distance of the first LONGEST characters, letters folded. */
static size_t edit_distance(const char *a, const char *b)
{
    size_t row[LONGEST + 1];
    size_t length_a = clipped_length(a), length_b = clipped_length(b);
    for (size_t j = 0; j <= length_b; j++)
        row[j] = j;
    for (size_t i = 1; i <= length_a; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= length_b; j++) {
            const bool differs = folded(a[i - 1]) != folded(b[j - 1]);
            size_t best = diagonal + (size_t)differs;
            if (row[j] + 1 < best)
                best = row[j] + 1;
            if (row[j - 1] + 1 < best)
                best = row[j - 1] + 1;
            diagonal = row[j];
            row[j] = best;
        }
    }
    return row[length_b];
}

const char *crv__nearest_name(const char *word, const char *const *candidates,
                              int32_t count)
{
    if (!word || !candidates)
        return NULL;
    /* A word of which more than a third would have to change is not a misspelling. */
    const size_t length = clipped_length(word);
    size_t limit = length / 3 + 1;
    const char *nearest = NULL;
    for (int32_t i = 0; count < 0 ? !!candidates[i] : i < count; i++) {
        const size_t other = clipped_length(candidates[i]);
        if ((length > other ? length - other : other - length) > limit)
            continue; /* the distance is at least that */
        const size_t distance = edit_distance(word, candidates[i]);
        if (distance <= limit) {
            nearest = candidates[i];
            limit = distance - (distance > 0);
            if (distance == 0)
                break;
        }
    }
    return nearest;
}

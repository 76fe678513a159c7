/* SPDX-License-Identifier: MIT */
#include "nearest.h"

#include <stdbool.h>
#include <string.h>

#include "system/text.h"

const char *nearest_name(const char *word, const char *const *candidates, int32_t count)
{
    if (!word || !candidates)
        return NULL;
    /* A word of which more than a third would have to change is not a misspelling. */
    const size_t length = strlen(word);
    size_t limit = length / 3 + 1;
    const char *nearest = NULL;
    for (int32_t i = 0; count < 0 ? !!candidates[i] : i < count; i++) {
        const size_t other = strlen(candidates[i]);
        if ((length > other ? length - other : other - length) > limit)
            continue; /* the distance is at least that */
        const size_t distance = text_distance(word, candidates[i]);
        if (distance <= limit) {
            nearest = candidates[i];
            limit = distance - (distance > 0);
            if (distance == 0)
                break;
        }
    }
    return nearest;
}

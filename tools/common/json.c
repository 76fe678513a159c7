/* SPDX-License-Identifier: MIT */
#include "json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/text.h"

/* U+FFFD stands for bytes that are no character. */
#define REPLACEMENT "\xef\xbf\xbd"

void json_add_number(cJSON *object, const char *key, double value)
{
    if (isfinite(value))
        cJSON_AddNumberToObject(object, key, value);
    else
        cJSON_AddNullToObject(object, key);
}

void json_add_text(cJSON *object, const char *key, const char *text)
{
    const size_t replacement = strlen(REPLACEMENT);
    char *valid = text ? malloc(replacement * strlen(text) + 1) : NULL;
    char *to = valid;
    if (!valid) {
        cJSON_AddNullToObject(object, key);
        return;
    }
    while (*text != '\0') {
        const size_t length = text_character_length(text);
        const size_t count = length > 0 ? length : replacement;
        memcpy(to, length > 0 ? text : REPLACEMENT, count);
        to += count;
        text += length > 0 ? length : 1;
    }
    *to = '\0';
    cJSON_AddStringToObject(object, key, valid);
    free(valid);
}

int json_print(cJSON *root, report *r)
{
    char *text = root ? cJSON_Print(root) : NULL;
    cJSON_Delete(root);
    if (!text)
        return report_no_memory(r);
    puts(text);
    cJSON_free(text);
    return EXIT_DONE;
}

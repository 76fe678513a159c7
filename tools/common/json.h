/* SPDX-License-Identifier: MIT */
/* json.h: valid JSON from any number and any name. */
#ifndef TOOL_JSON_H
#define TOOL_JSON_H

#include <cjson/cJSON.h>

#include "report.h"

/* null if the value is not finite, which JSON has no number for. */
void json_add_number(cJSON *object, const char *key, double value);

/* Bytes that are no UTF-8, which a file's name may have, become U+FFFD. null for NULL. */
void json_add_text(cJSON *object, const char *key, const char *text);

/* Writes it to standard output and deletes it. NULL, or no memory: an error line.
 * Returns an exit code. */
int json_print(cJSON *root, report *r);

#endif

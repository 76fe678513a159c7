/* SPDX-License-Identifier: MIT */
/* options_file.h: library options in a file, as `crevice view` copies them: words
 * key=value, any number a line; from a # on a line is a comment. */
#ifndef TOOL_OPTIONS_FILE_H
#define TOOL_OPTIONS_FILE_H

#include "report.h"

enum { OPTIONS_FILE_MAX = 128 };

typedef struct options_file {
    const char *path;
    char *text; /* owned */
    int32_t count;
    const char *key[OPTIONS_FILE_MAX], *value[OPTIONS_FILE_MAX]; /* parts of text */
} options_file;

/* path NULL: an empty one. Returns an exit code; free it in any case. */
int options_file_read(const char *path, options_file *out, report *r);
void options_file_free(options_file *f);

/* The last value of the key; NULL if there is none. */
const char *options_file_find(const options_file *f, const char *key);

/* Sets all but method and preset, which are for the caller to set before. */
int options_file_apply(const options_file *f, crv_options *options, report *r);

#endif

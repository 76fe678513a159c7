/* SPDX-License-Identifier: MIT */
#include "options_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_MAX = 65536 };

static int parse(options_file *f, report *r)
{
    static const char blanks[] = " \t\r\n";
    for (char *p = f->text; *p != '\0';) {
        if (*p == '#') {
            p += strcspn(p, "\n");
            continue;
        }
        const size_t length = strcspn(p, blanks);
        if (length == 0) {
            p++;
            continue;
        }
        char *end = p + length, *equals = memchr(p, '=', length);
        const bool last = *end == '\0';
        *end = '\0';
        if (!equals || equals == p || f->count == OPTIONS_FILE_MAX) {
            report_error(r,
                         "%s: \"%.60s\" is not key=value; write lines such as radius=0.5",
                         f->path, p);
            return EXIT_USAGE;
        }
        *equals = '\0';
        f->key[f->count] = p;
        f->value[f->count++] = equals + 1;
        p = end + !last;
    }
    return EXIT_DONE;
}

int options_file_read(const char *path, options_file *out, report *r)
{
    *out = (options_file){.path = path};
    if (!path)
        return EXIT_DONE;
    FILE *file = fopen(path, "rb");
    if (!file) {
        report_error(r, "%s: %s; name a file of options", path, strerror(errno));
        return EXIT_FAILED;
    }
    out->text = calloc(TEXT_MAX + 1, 1);
    const size_t size = out->text ? fread(out->text, 1, TEXT_MAX + 1, file) : 0;
    const bool bad = ferror(file) != 0;
    fclose(file);
    if (!out->text)
        return report_no_memory(r);
    if (bad || size > TEXT_MAX || memchr(out->text, '\0', size)) {
        report_error(r, "%s: is not a text of options; write lines such as radius=0.5",
                     path);
        return EXIT_FAILED;
    }
    return parse(out, r);
}

void options_file_free(options_file *f)
{
    free(f->text);
    *f = (options_file){0};
}

const char *options_file_find(const options_file *f, const char *key)
{
    for (int32_t i = f->count - 1; i >= 0; i--)
        if (strcmp(f->key[i], key) == 0)
            return f->value[i];
    return NULL;
}

int options_file_apply(const options_file *f, crv_options *options, report *r)
{
    for (int32_t i = 0; i < f->count; i++) {
        if (strcmp(f->key[i], "method") == 0 || strcmp(f->key[i], "preset") == 0
            || crv_options_set(options, f->key[i], f->value[i], &r->logger) == CRV_OK)
            continue;
        if (r->errors == 0)
            report_error(r, "%s: %s=%s is not valid; see `crevice methods`", f->path,
                         f->key[i], f->value[i]);
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}

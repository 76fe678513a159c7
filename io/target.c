/* SPDX-License-Identifier: MIT */
/* target.c: which file a path names, links followed, and whether it can be written. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

enum { MAX_LINKS = 40 };

static int fail_memory(const crv_logger *log, const char *path)
{
    return io__fail(log, path, "no memory to write it; close other programs");
}

/* Follows links one by one, because realpath() refuses a link whose target is yet to be
 * made. The caller frees *target. */
static int follow_links(const char *path, char **target, const crv_logger *log)
{
    char *current = text_copy(path);
    for (int i = 0; i < MAX_LINKS; i++) {
        char link[4096];
        if (!current)
            return fail_memory(log, path);
        if (!file_link(current, link, sizeof link)) {
            *target = current;
            return 0;
        }
        char *next = file_beside(current, link);
        free(current);
        current = next;
    }
    free(current);
    return io__fail(log, path, "is a chain of links without an end; name a file");
}

/* What must hold of the target itself and of its folder. */
static int check_target(const char *target, const char *path, const crv_logger *log)
{
    file_facts facts;
    if (!path[0] || !target[0])
        return io__fail(log, "output", "the file name is empty; give one");
    if (file_look(target, &facts)) {
        if (facts.is_folder)
            return io__fail(log, path, "is a folder; name a file in it");
        if (!facts.is_regular)
            return io__fail(log, path, "is a device or a pipe; name a regular file");
        if (!file_may_be_written(target))
            return io__fail(log, path, "may not be written (%s); choose another name",
                            strerror(errno));
    }
    char *folder = file_beside(target, ".");
    if (!folder)
        return fail_memory(log, path);
    int result = 0;
    if (!folder_may_be_written(folder))
        result =
            file_look(folder, &facts)
                ? io__fail(log, path,
                           "its folder may not be written; choose another place")
                : io__fail(log, path, "its folder cannot be used (%s); make it first",
                           strerror(errno));
    free(folder);
    return result;
}

char *io__writable_target(const char *path, const crv_logger *log)
{
    char *target = NULL;
    if (follow_links(path, &target, log))
        return NULL;
    if (!check_target(target, path, log))
        return target;
    free(target);
    return NULL;
}

/* Whether the files have one name in one folder, there or not. Takes both over. */
static bool is_same_place(char *a, char *b)
{
    char *folder_a = a ? file_beside(a, ".") : NULL;
    char *folder_b = b ? file_beside(b, ".") : NULL;
    const bool same = folder_a && folder_b && file_is_same(folder_a, folder_b)
                      && !strcmp(file_name(a), file_name(b));
    free(folder_a);
    free(folder_b);
    free(a);
    free(b);
    return same;
}

bool io_is_same_file(const char *a, const char *b)
{
    char *target_a = NULL, *target_b = NULL;
    if (file_is_same(a, b))
        return true;
    if (follow_links(a, &target_a, NULL) || follow_links(b, &target_b, NULL)) {
        free(target_a);
        free(target_b);
        return false;
    }
    return is_same_place(target_a, target_b);
}

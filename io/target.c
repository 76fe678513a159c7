/* SPDX-License-Identifier: MIT */
/* target.c: which file a path names, links followed, and whether it can be written. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "internal.h"

enum { MAX_LINKS = 40 };

/* Length of the folder's part of a path, its last slash included. */
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

char *io__beside(const char *path, const char *name)
{
    const size_t length = name[0] == '/' ? 0 : folder_length(path);
    char *joined = malloc(length + strlen(name) + 1);
    if (joined) {
        memcpy(joined, path, length);
        memcpy(joined + length, name, strlen(name) + 1);
    }
    return joined;
}

static int fail_memory(const crv_logger *log, const char *path)
{
    return io__fail(log, path, "no memory to write it; close other programs");
}

/* Follows links one by one, because realpath() refuses a link whose target is yet to be
 * made. The caller frees *target. */
static int follow_links(const char *path, char **target, const crv_logger *log)
{
    char *current = strdup(path);
    for (int i = 0; i < MAX_LINKS; i++) {
        char link[4096];
        if (!current)
            return fail_memory(log, path);
        const ssize_t length = readlink(current, link, sizeof link);
        if (length < 0 || (size_t)length >= sizeof link) {
            *target = current;
            return 0;
        }
        link[length] = '\0';
        char *next = io__beside(current, link);
        free(current);
        current = next;
    }
    free(current);
    return io__fail(log, path, "is a chain of links without an end; name a file");
}

/* What must hold of the target itself and of its folder. */
static int check_target(const char *target, const char *path, const crv_logger *log)
{
    struct stat status;
    if (!path[0] || !target[0])
        return io__fail(log, "output", "the file name is empty; give one");
    if (!stat(target, &status)) {
        if (S_ISDIR(status.st_mode))
            return io__fail(log, path, "is a folder; name a file in it");
        if (!S_ISREG(status.st_mode))
            return io__fail(log, path, "is a device or a pipe; name a regular file");
        if (access(target, W_OK))
            return io__fail(log, path, "may not be written (%s); choose another name",
                            strerror(errno));
    }
    char *folder = io__beside(target, ".");
    if (!folder)
        return fail_memory(log, path);
    int result = 0;
    if (stat(folder, &status))
        result = io__fail(log, path, "its folder cannot be used (%s); make it first",
                          strerror(errno));
    else if (!S_ISDIR(status.st_mode) || access(folder, W_OK | X_OK))
        result =
            io__fail(log, path, "its folder may not be written; choose another place");
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

/* Whether both name one file that is there. */
static bool is_same_file(const char *a, const char *b)
{
    struct stat first, second;
    return !stat(a, &first) && !stat(b, &second) && first.st_dev == second.st_dev
           && first.st_ino == second.st_ino;
}

/* Whether the files have one name in one folder, there or not. Takes both over. */
static bool is_same_place(char *a, char *b)
{
    char *folder_a = a ? io__beside(a, ".") : NULL;
    char *folder_b = b ? io__beside(b, ".") : NULL;
    const bool same = folder_a && folder_b && is_same_file(folder_a, folder_b)
                      && !strcmp(a + folder_length(a), b + folder_length(b));
    free(folder_a);
    free(folder_b);
    free(a);
    free(b);
    return same;
}

bool io_is_same_file(const char *a, const char *b)
{
    char *target_a = NULL, *target_b = NULL;
    if (is_same_file(a, b))
        return true;
    if (follow_links(a, &target_a, NULL) || follow_links(b, &target_b, NULL)) {
        free(target_a);
        free(target_b);
        return false;
    }
    return is_same_place(target_a, target_b);
}

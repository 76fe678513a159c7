/* SPDX-License-Identifier: MIT */
/* file.h: files and folders as the operating system has them. What fails sets errno. */
#ifndef CREVICE_SYSTEM_FILE_H
#define CREVICE_SYSTEM_FILE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct file_facts {
    bool is_folder, is_regular; /* neither: a device or a pipe */
    int64_t size;               /* bytes */
} file_facts;

/* What lies under a name, links followed; false: nothing that can be seen. */
bool file_look(const char *path, file_facts *facts);
bool file_exists(const char *path);
/* Whether both names are of one file, which is there. */
bool file_is_same(const char *a, const char *b);
bool file_may_be_written(const char *path);
/* Whether it is a folder in which files can be made. */
bool folder_may_be_written(const char *path);

/* `name` in the folder of `path`, or just `name` if it is absolute. The caller frees it;
 * NULL: no memory. */
char *file_beside(const char *path, const char *name);
/* What follows the folders of a path. */
const char *file_name(const char *path);
/* The text of a link; false if it is none, or its text is longer. */
bool file_link(const char *path, char *out, size_t size);

/* Opens a regular file for reading, without waiting for anybody. NULL with errno, EINVAL
 * for what is not regular. */
FILE *file_open(const char *path);
/* The bytes as a file for reading; NULL with errno. They outlive it. */
FILE *file_of_bytes(const void *bytes, size_t size);

/* Reads `size` bytes at `offset` or up to the file's end; several threads may. The number
 * of bytes, or -1. */
int64_t file_read_at(FILE *file, void *bytes, uint64_t size, uint64_t offset);
/* Writes all bytes at `offset`. */
bool file_write_at(FILE *file, const void *bytes, uint64_t size, uint64_t offset);
/* Brings what was written to disk. */
bool file_sync(FILE *file);

/* Whether somebody sees at once what is written there. */
bool file_is_terminal(FILE *file);
/* From here on a write beyond the limit on file sizes fails instead of ending the
 * program. */
void file_limit_fails(void);

#endif

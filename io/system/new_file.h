/* SPDX-License-Identifier: MIT */
/*
 * new_file.h: a file that appears under its name when it is complete and on disk, or not
 * at all. It is written under another name in the same folder and then renamed.
 */
#ifndef CREVICE_SYSTEM_NEW_FILE_H
#define CREVICE_SYSTEM_NEW_FILE_H

#include <stdbool.h>
#include <stdio.h>

typedef struct new_file {
    FILE *stream;
    char *target, *temporary; /* owned */
} new_file;

/* Opens the temporary file, with the permissions of the file that it will replace. After
 * success one of commit or discard must follow. False with errno. */
bool new_file_open(new_file *file, const char *target);
/* Brings the data to disk and puts the file in place of the target. False with errno: the
 * target is as it was, and nothing is left behind. */
bool new_file_commit(new_file *file);
void new_file_discard(new_file *file);

/* What the user can do against errno's `reason`: "free some space". */
const char *new_file_cure(int reason);

/* Removes the temporary files that killed processes left in a folder; returns their
 * number. */
int new_file_remove_leftovers(const char *folder);

#endif

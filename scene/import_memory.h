/* SPDX-License-Identifier: MIT */
/*
 * import_memory.h: files for assimp of which one is in memory.
 */
#ifndef CREVICE_SCENE_IMPORT_MEMORY_H
#define CREVICE_SCENE_IMPORT_MEMORY_H

#include <stddef.h>

#include <assimp/cfileio.h>

typedef struct import_memory {
    const char *path; /* this file has the bytes of `data`; others are on disk */
    const char *data;
    size_t size;
    struct aiFileIO io; /* for aiImportFileEx() */
} import_memory;

/* The other members are set; none of it may move while assimp reads. */
void import_memory_open(import_memory *m);

#endif

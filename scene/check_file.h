/* SPDX-License-Identifier: MIT */
/*
 * check_file.h: what can be said of a mesh file before it is parsed. Importers take
 * truncated binary files for whole ones, or their error says nothing.
 */
#ifndef CREVICE_SCENE_CHECK_FILE_H
#define CREVICE_SCENE_CHECK_FILE_H

#include <stdbool.h>

#include "crevice/crevice.h"

/* False after an error line: missing, a folder, empty, or shorter than its header says.
 */
bool check_mesh_file(const char *path, const crv_logger *log);

/* The whole file with a zero behind it (malloc); NULL: it cannot be read. */
unsigned char *read_whole_file(const char *path, size_t *size);

#endif

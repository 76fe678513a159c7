/* SPDX-License-Identifier: MIT */
/*
 * import_assimp.h: the formats that assimp reads.
 */
#ifndef CREVICE_SCENE_IMPORT_ASSIMP_H
#define CREVICE_SCENE_IMPORT_ASSIMP_H

#include "import.h"

/* Returns 0, or -1 after an error line. Triangles may be none. */
int import_assimp(const char *path, import *out, const crv_logger *log);

#endif

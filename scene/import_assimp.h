/* SPDX-License-Identifier: MIT */
/*
 * import_assimp.h: the formats that assimp reads.
 */
#ifndef CREVICE_SCENE_IMPORT_ASSIMP_H
#define CREVICE_SCENE_IMPORT_ASSIMP_H

#include <assimp/scene.h>

#include "import.h"
#include "part.h"

/* Returns 0, or -1 after an error line. Triangles may be none. */
int import_assimp(const char *path, import *out, const crv_logger *log);

transform import_assimp_matrix(const struct aiMatrix4x4 *m);

/* The world transform of the node of this name at or below `node`, whose parent's is
 * given; false: there is none. */
bool import_assimp_find(const struct aiNode *node, const struct aiString *name,
                        const transform *parent, transform *out);

/* import_assimp_check.c: what a mesh means and we do not show. */
typedef struct import_doubts {
    bool posed, rounded, holes, morphed;
} import_doubts;

import_doubts import_assimp_doubts(const struct aiScene *file, const struct aiMesh *part,
                                   const transform *node, const transform *root);

/* A warning for each. */
void import_assimp_tell(const import_doubts *d, const char *path, const crv_logger *log);

#endif

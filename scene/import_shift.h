/* SPDX-License-Identifier: MIT */
/*
 * import_shift.h: text and double coordinates that are far from zero, made near before
 * assimp rounds them to floats.
 */
#ifndef CREVICE_SCENE_IMPORT_SHIFT_H
#define CREVICE_SCENE_IMPORT_SHIFT_H

#include "mesh.h"

/*
 * If the file is an OBJ or a PLY whose vertices are far from zero for their extent, as
 * mesh_choose_origin() has it: returns its bytes with vertices that are moved by -origin
 * (malloc, *size of them) and sets the mesh's origin. NULL: read the file as it is.
 */
char *import_shift(const char *path, mesh *m, size_t *size);

#endif

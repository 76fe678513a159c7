/* SPDX-License-Identifier: MIT */
/*
 * gltf.h: glTF 2.0 (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html), read as
 * the specification has it: the default scene at rest. What else of it matters to shape:
 * KHR_mesh_quantization, EXT_mesh_gpu_instancing, KHR_texture_transform and
 * KHR_node_visibility. Runs in the child process of import.h.
 */
#ifndef CREVICE_SCENE_GLTF_H
#define CREVICE_SCENE_GLTF_H

#include <cjson/cJSON.h>

#include "import.h"
#include "part.h"

/* Whether the file is glTF 2.x; others of that name are left to assimp. */
bool gltf_is(const char *path);

/* Returns 0, or -1 after an error line. Triangles may be none. */
int gltf_read(const char *path, import *out, const crv_logger *log);

/* A top-level array of the file: cJSON's own are lists, slow to index. */
typedef struct gltf_list {
    const cJSON **item;
    int count;
} gltf_list;

typedef struct gltf_bytes {
    const unsigned char *data; /* NULL: not there */
    size_t size;
    unsigned char *owned;
} gltf_bytes;

typedef struct gltf {
    const char *path;
    const crv_logger *log;
    unsigned char *file; /* the whole of it */
    size_t file_size;
    cJSON *root;
    gltf_list accessors, views, meshes, nodes, skins, materials, textures, images,
        samplers, cameras;
    gltf_bytes binary; /* of a .glb, within file */
    gltf_bytes *buffers;
    int buffer_count;
    bool failed; /* an error line has been written */
    bool told_blend, told_picture;
} gltf;

/* gltf_file.c */

/* Reads the file, then its buffers; false after an error line. Close it in any case. */
bool gltf_open(const char *path, const crv_logger *log, gltf *out);
bool gltf_read_buffers(gltf *g);
void gltf_close(gltf *g);

/* The error line "FILE: is damaged: WHAT; export it again", once. */
void gltf_refuse(gltf *g, const char *what);

/* Members of an object; the default if it is missing. -1: no index. */
int gltf_index(const cJSON *object, const char *key);
double gltf_number(const cJSON *object, const char *key, double initial);
const char *gltf_text(const cJSON *object, const char *key);
const cJSON *gltf_member(const cJSON *object, const char *key);
const cJSON *gltf_extension(const cJSON *object, const char *name);
/* `count` numbers of an array; false: it is not there, out is unchanged. */
bool gltf_numbers(const cJSON *object, const char *key, int count, double *out);
const cJSON *gltf_at(const gltf_list *list, int index);

/* A buffer view's bytes; data NULL after an error line. */
gltf_bytes gltf_view(gltf *g, int view);

/* An image's bytes, wherever it is; free *owned. data NULL: not to be had. */
gltf_bytes gltf_image(gltf *g, const cJSON *image);

/* gltf_accessor.c */

/* The accessor's elements as floats, `components` each: normalised integers are divided
 * as the specification has it, sparse ones filled in; NULL after an error line. */
float *gltf_floats(gltf *g, int accessor, int components, size_t *count);

/* The same as unsigned integers. */
uint32_t *gltf_integers(gltf *g, int accessor, int components, size_t *count);

/* gltf_material.c */

/* Sets the mesh's colour and mask. False: a surface that is not to be seen. *uv_set: the
 * texture coordinates that the mask wants. */
bool gltf_set_material(gltf *g, int material, mesh *m, int *uv_set);

/* gltf_mesh.c */

/* A primitive's triangles; what the part points to is owned by this. */
typedef struct gltf_part {
    mesh_part part;
    int material, uv_set;
    float *positions, *normals, *uvs;
    uint32_t *indices;
} gltf_part;

/* Triangles of a primitive with its morph targets at these weights (NULL: those of its
 * mesh, `object`), and with texture coordinates of this set. No triangles: points or
 * lines. False after an error line. */
bool gltf_read_part(gltf *g, const cJSON *object, const cJSON *primitive,
                    const cJSON *weights, int uv_set, gltf_part *out);
void gltf_free_part(gltf_part *p);

/* gltf_skin.c */

/* Moves the part to where its skin has it, from `origin`. worlds: of all nodes. */
bool gltf_skin_part(gltf *g, const cJSON *primitive, int skin, const transform *worlds,
                    const double origin[3], gltf_part *p);

#endif

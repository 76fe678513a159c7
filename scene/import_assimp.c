/* SPDX-License-Identifier: MIT */
#include "import_assimp.h"

#include <stdlib.h>
#include <string.h>

#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "import_memory.h"
#include "import_shift.h"
#include "internal.h"
#include "normals.h"

#define CREASE_RAD     (60.0 * SCENE_PI / 180.0)
#define DEFAULT_ALBEDO 0.8
#define MAX_NODE_DEPTH 512

/* Rows of the affine map from a node to the world. */
typedef struct transform {
    vec3 row[3];
    vec3 offset;
} transform;

/* The map of normals: the inverse transpose times |determinant|, which has the same
 * direction and needs no division. */
typedef struct normal_map {
    vec3 row[3];
    bool mirrors;
} normal_map;

typedef struct loader {
    const char *path;
    const crv_logger *log;
    const struct aiScene *file;
    mesh mesh;
} loader;

static transform transform_of_node(const struct aiNode *node, const transform *parent)
{
    const struct aiMatrix4x4 *m = &node->mTransformation;
    const vec3 column[4] = {v3((double)m->a1, (double)m->b1, (double)m->c1),
                            v3((double)m->a2, (double)m->b2, (double)m->c2),
                            v3((double)m->a3, (double)m->b3, (double)m->c3),
                            v3((double)m->a4, (double)m->b4, (double)m->c4)};
    transform t;
    for (int i = 0; i < 3; i++)
        t.row[i] =
            v3(v3_dot(parent->row[i], column[0]), v3_dot(parent->row[i], column[1]),
               v3_dot(parent->row[i], column[2]));
    t.offset = v3_add(parent->offset, v3(v3_dot(parent->row[0], column[3]),
                                         v3_dot(parent->row[1], column[3]),
                                         v3_dot(parent->row[2], column[3])));
    return t;
}

static vec3 multiply(const vec3 row[3], vec3 v)
{
    return v3(v3_dot(row[0], v), v3_dot(row[1], v), v3_dot(row[2], v));
}

static normal_map normal_map_of(const transform *t)
{
    normal_map n = {{v3_cross(t->row[1], t->row[2]), v3_cross(t->row[2], t->row[0]),
                     v3_cross(t->row[0], t->row[1])},
                    false};
    n.mirrors = v3_dot(t->row[0], n.row[0]) < 0.0;
    if (n.mirrors)
        for (int i = 0; i < 3; i++)
            n.row[i] = v3_scale(n.row[i], -1.0);
    return n;
}

/* The base or diffuse colour. Files without materials get assimp's own default, which
 * differs from format to format: recognised by its name and replaced. */
static void set_material(loader *l, const struct aiMaterial *material)
{
    struct aiString name;
    struct aiColor4D colour;
    bool unnamed =
        aiGetMaterialString(material, AI_MATKEY_NAME, &name) != aiReturn_SUCCESS
        || name.length == 0 || strcmp(name.data, AI_DEFAULT_MATERIAL_NAME) == 0;
    bool found =
        aiGetMaterialColor(material, AI_MATKEY_BASE_COLOR, &colour) == aiReturn_SUCCESS
        || aiGetMaterialColor(material, AI_MATKEY_COLOR_DIFFUSE, &colour)
               == aiReturn_SUCCESS;
    bool is_default = unnamed && found && colour.r == colour.g && colour.g == colour.b
                      && (colour.r == 1.0f || colour.r == 0.6f);
    if (found && !is_default)
        mesh_set_colour(&l->mesh, (double)colour.r, (double)colour.g, (double)colour.b);
    else
        mesh_set_colour(&l->mesh, DEFAULT_ALBEDO, DEFAULT_ALBEDO, DEFAULT_ALBEDO);
}

/* The triangles' indices, packed; points and lines are left out. NULL: out of memory. */
static uint32_t *pack_indices(const struct aiMesh *part, size_t *triangle_count)
{
    uint32_t *indices = malloc(((size_t)part->mNumFaces * 3 + 1) * sizeof *indices);
    size_t count = 0;
    if (!indices)
        return NULL;
    for (size_t f = 0; f < part->mNumFaces; f++) {
        const struct aiFace *face = &part->mFaces[f];
        if (face->mNumIndices != 3)
            continue;
        for (int i = 0; i < 3; i++)
            indices[3 * count + (size_t)i] = face->mIndices[i];
        count++;
    }
    *triangle_count = count;
    return indices;
}

static uint32_t add_vertex(mesh *m, const struct aiMesh *part, size_t vertex,
                           const float normal[3], const transform *t, const normal_map *n)
{
    const struct aiVector3D *p = &part->mVertices[vertex];
    vec3 position = v3((double)p->x, (double)p->y, (double)p->z);
    uint32_t added = mesh_add_vertex(m, v3_add(multiply(t->row, position), t->offset),
                                     multiply(n->row, v3_from(normal)));
    /* assimp turns every format's coordinates to v up from the picture's lower edge. */
    if (part->mTextureCoords[0])
        mesh_set_uv(m, added, (double)part->mTextureCoords[0][vertex].x,
                    1.0 - (double)part->mTextureCoords[0][vertex].y);
    return added;
}

static void add_triangle(mesh *m, const uint32_t corner[3], bool mirrors)
{
    mesh_add_triangle(m, corner[0], corner[mirrors ? 2 : 1], corner[mirrors ? 1 : 2]);
}

static void add_with_own_normals(mesh *m, const struct aiMesh *part,
                                 const uint32_t *indices, size_t triangle_count,
                                 const transform *t)
{
    normal_map n = normal_map_of(t);
    uint32_t base = (uint32_t)m->vertex_count;
    mesh_reserve(m, part->mNumVertices, triangle_count);
    for (size_t v = 0; v < part->mNumVertices && !m->failed; v++) {
        const struct aiVector3D *normal = &part->mNormals[v];
        add_vertex(m, part, v, (const float[3]){normal->x, normal->y, normal->z}, t, &n);
    }
    for (size_t i = 0; i < triangle_count && !m->failed; i++) {
        const uint32_t corner[3] = {base + indices[3 * i], base + indices[3 * i + 1],
                                    base + indices[3 * i + 2]};
        add_triangle(m, corner, n.mirrors);
    }
}

static void add_with_computed_normals(mesh *m, const struct aiMesh *part,
                                      const uint32_t *indices, size_t triangle_count,
                                      const transform *t)
{
    normal_map n = normal_map_of(t);
    float *normals = malloc((9 * triangle_count + 1) * sizeof *normals);
    if (!normals
        || !smooth_normals(&part->mVertices[0].x, part->mNumVertices, indices,
                           triangle_count, CREASE_RAD, normals)) {
        free(normals);
        m->failed = true;
        return;
    }
    mesh_reserve(m, 3 * triangle_count, triangle_count);
    for (size_t i = 0; i < triangle_count && !m->failed; i++) {
        uint32_t corner[3];
        for (size_t c = 0; c < 3; c++)
            corner[c] =
                add_vertex(m, part, indices[3 * i + c], normals + 9 * i + 3 * c, t, &n);
        add_triangle(m, corner, n.mirrors);
    }
    free(normals);
}

static void add_part(loader *l, const struct aiMesh *part, const transform *t)
{
    mesh *m = &l->mesh;
    size_t triangle_count = 0;
    uint32_t *indices = pack_indices(part, &triangle_count);
    if (!indices) {
        m->failed = true;
        return;
    }
    if (triangle_count > 0) {
        if (part->mMaterialIndex < l->file->mNumMaterials)
            set_material(l, l->file->mMaterials[part->mMaterialIndex]);
        if (part->mNormals)
            add_with_own_normals(m, part, indices, triangle_count, t);
        else
            add_with_computed_normals(m, part, indices, triangle_count, t);
    }
    free(indices);
}

static void add_node(loader *l, const struct aiNode *node, const transform *parent,
                     int depth)
{
    transform t = transform_of_node(node, parent);
    for (unsigned i = 0; node->mMeshes && i < node->mNumMeshes && !l->mesh.failed; i++)
        if (node->mMeshes[i] < l->file->mNumMeshes)
            add_part(l, l->file->mMeshes[node->mMeshes[i]], &t);
    if (depth == MAX_NODE_DEPTH) {
        if (node->mNumChildren > 0)
            scene_log(l->log, CRV_LOG_WARNING, l->path,
                      "nodes nested deeper than %d are left out; flatten the hierarchy",
                      MAX_NODE_DEPTH);
        return;
    }
    /* Some importers count children that they never made. */
    for (unsigned i = 0; node->mChildren && i < node->mNumChildren && !l->mesh.failed;
         i++)
        if (node->mChildren[i])
            add_node(l, node->mChildren[i], &t, depth + 1);
}

/* Grows the bounds by all vertices that nodes show, world space. */
static void bound_node(const loader *l, const struct aiNode *node,
                       const transform *parent, int depth, vec3 *lower, vec3 *upper)
{
    const transform t = transform_of_node(node, parent);
    for (unsigned i = 0; node->mMeshes && i < node->mNumMeshes; i++) {
        const struct aiMesh *part = node->mMeshes[i] < l->file->mNumMeshes
                                        ? l->file->mMeshes[node->mMeshes[i]]
                                        : NULL;
        for (size_t v = 0; part && part->mVertices && v < part->mNumVertices; v++) {
            const struct aiVector3D *p = &part->mVertices[v];
            v3_bound(v3_add(multiply(t.row, v3((double)p->x, (double)p->y, (double)p->z)),
                            t.offset),
                     lower, upper);
        }
    }
    for (unsigned i = 0; node->mChildren && i < node->mNumChildren; i++)
        if (node->mChildren[i] && depth < MAX_NODE_DEPTH)
            bound_node(l, node->mChildren[i], &t, depth + 1, lower, upper);
}

/* Faces without corners, or with corners that are not there, are what importers make of
 * damaged files. assimp's own triangulation would abort or read beyond the vertices. */
static bool is_sound(const struct aiMesh *part, bool *has_polygons)
{
    if (!part->mVertices)
        return part->mNumFaces == 0;
    for (size_t f = 0; f < part->mNumFaces; f++) {
        const struct aiFace *face = &part->mFaces[f];
        if (face->mNumIndices == 0)
            return false;
        for (size_t i = 0; i < face->mNumIndices; i++)
            if (face->mIndices[i] >= part->mNumVertices)
                return false;
        *has_polygons = *has_polygons || face->mNumIndices > 3;
    }
    return true;
}

static const struct aiScene *read_file(const char *path, mesh *m, const crv_logger *log)
{
    bool sound = true, has_polygons = false;
    import_memory moved = {.path = path};
    char *data = import_shift(path, m, &moved.size);
    moved.data = data;
    import_memory_open(&moved);
    const struct aiScene *file =
        data ? aiImportFileEx(path, 0, &moved.io) : aiImportFile(path, 0);
    for (unsigned i = 0; file && sound && i < file->mNumMeshes; i++)
        sound = is_sound(file->mMeshes[i], &has_polygons);
    if (!sound) {
        scene_log(log, CRV_LOG_ERROR, path,
                  "is truncated or damaged: faces lack their vertices; copy or export it "
                  "again");
        aiReleaseImport(file);
        free(data);
        return NULL;
    }
    if (has_polygons)
        file = aiApplyPostProcessing(file, aiProcess_Triangulate);
    if (!file)
        scene_log(
            log, CRV_LOG_ERROR, path,
            "cannot be read as a mesh (%.300s); give a complete glTF, OBJ, PLY, STL or "
            "FBX file",
            aiGetErrorString());
    free(data);
    return file;
}

int import_assimp(const char *path, import *out, const crv_logger *log)
{
    transform root = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
    loader l = {.path = path, .log = log};
    l.file = read_file(path, &l.mesh, log);
    if (!l.file)
        return -1;
    root.offset = v3_from_double(l.mesh.origin);
    if (l.file->mRootNode) {
        vec3 lower = v3(INFINITY, INFINITY, INFINITY), upper = v3_scale(lower, -1.0);
        bound_node(&l, l.file->mRootNode, &root, 0, &lower, &upper);
        if (!(v3_length(root.offset) > 0.0))
            mesh_choose_origin(&l.mesh, lower, upper);
        add_node(&l, l.file->mRootNode, &root, 0);
    }
    aiReleaseImport(l.file);
    out->mesh = l.mesh;
    return 0;
}

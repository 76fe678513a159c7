/* SPDX-License-Identifier: MIT */
#include "import_assimp.h"

#include <stdlib.h>
#include <string.h>

#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>

#include "import_memory.h"
#include "import_shift.h"
#include "internal.h"
#include "system/text.h"

#define DEFAULT_ALBEDO 0.8
#define MAX_NODE_DEPTH 512

typedef struct loader {
    const char *path;
    const crv_logger *log;
    const struct aiScene *file;
    mesh mesh;
    transform root;
    import_doubts doubts;
} loader;

transform import_assimp_matrix(const struct aiMatrix4x4 *m)
{
    return (transform){{v3((double)m->a1, (double)m->a2, (double)m->a3),
                        v3((double)m->b1, (double)m->b2, (double)m->b3),
                        v3((double)m->c1, (double)m->c2, (double)m->c3)},
                       v3((double)m->a4, (double)m->b4, (double)m->c4)};
}

static transform transform_of_node(const struct aiNode *node, const transform *parent)
{
    const transform own = import_assimp_matrix(&node->mTransformation);
    return transform_compose(parent, &own);
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

/* assimp turns every format's coordinates to v up from the picture's lower edge. NULL:
 * out of memory. */
static float *pack_uvs(const struct aiMesh *part)
{
    float *uvs = malloc((2 * (size_t)part->mNumVertices + 1) * sizeof *uvs);
    for (size_t v = 0; uvs && v < part->mNumVertices; v++) {
        uvs[2 * v] = part->mTextureCoords[0][v].x;
        uvs[2 * v + 1] = (float)(1.0 - (double)part->mTextureCoords[0][v].y);
    }
    return uvs;
}

static void add_part(loader *l, const struct aiMesh *part, const transform *t)
{
    mesh *m = &l->mesh;
    size_t triangle_count = 0;
    uint32_t *indices = pack_indices(part, &triangle_count);
    float *uvs = part->mTextureCoords[0] ? pack_uvs(part) : NULL;
    if (!indices || (part->mTextureCoords[0] && !uvs))
        m->failed = true;
    if (!m->failed && triangle_count > 0) {
        const import_doubts doubts = import_assimp_doubts(l->file, part, t, &l->root);
        l->doubts.posed |= doubts.posed;
        l->doubts.rounded |= doubts.rounded;
        l->doubts.holes |= doubts.holes;
        l->doubts.morphed |= doubts.morphed;
        const mesh_part triangles = {.vertex_count = part->mNumVertices,
                                     .triangle_count = triangle_count,
                                     .positions = &part->mVertices[0].x,
                                     .normals =
                                         part->mNormals ? &part->mNormals[0].x : NULL,
                                     .uvs = uvs,
                                     .indices = indices};
        if (part->mMaterialIndex < l->file->mNumMaterials)
            set_material(l, l->file->mMaterials[part->mMaterialIndex]);
        mesh_add_part(m, &triangles, t);
    }
    free(uvs);
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
        if (part && part->mVertices)
            mesh_part_bound(&(mesh_part){.vertex_count = part->mNumVertices,
                                         .positions = &part->mVertices[0].x},
                            &t, lower, upper);
    }
    for (unsigned i = 0; node->mChildren && i < node->mNumChildren; i++)
        if (node->mChildren[i] && depth < MAX_NODE_DEPTH)
            bound_node(l, node->mChildren[i], &t, depth + 1, lower, upper);
}

static bool find_below(const struct aiNode *node, const struct aiString *name,
                       const transform *parent, int depth, transform *out)
{
    const transform t = transform_of_node(node, parent);
    if (node->mName.length == name->length
        && memcmp(node->mName.data, name->data, name->length) == 0) {
        *out = t;
        return true;
    }
    for (unsigned i = 0; node->mChildren && i < node->mNumChildren; i++)
        if (node->mChildren[i] && depth < MAX_NODE_DEPTH
            && find_below(node->mChildren[i], name, &t, depth + 1, out))
            return true;
    return false;
}

bool import_assimp_find(const struct aiNode *node, const struct aiString *name,
                        const transform *parent, transform *out)
{
    return find_below(node, name, parent, 0, out);
}

static vec3 vector_of(const struct aiVector3D *v)
{
    return v3((double)v->x, (double)v->y, (double)v->z);
}

/* 0 if the file does not say. assimp has 1 degree for an FBX camera that is described by
 * its focal length alone, which it does not hand on. */
static float hfov_of(const loader *l, const struct aiCamera *c)
{
    const bool unsaid =
        text_ends_with(l->path, ".fbx")
        && fabs((double)c->mHorizontalFOV * 180.0 / SCENE_PI - 1.0) < 1e-4;
    return c->mHorizontalFOV > 0.0f && !unsaid ? c->mHorizontalFOV : 0.0f;
}

static void add_cameras(const loader *l, const transform *root, import *out)
{
    for (unsigned i = 0; l->file->mCameras && i < l->file->mNumCameras; i++) {
        const struct aiCamera *c = l->file->mCameras[i];
        transform t = *root;
        if (!c)
            continue;
        import_assimp_find(l->file->mRootNode, &c->mName, root, &t);
        const bool ortho = c->mOrthographicWidth > 0.0f;
        const double aspect = c->mAspect > 0.0f ? (double)c->mAspect : 16.0 / 9.0;
        const scene_camera like = {
            .view = {.projection = ortho ? CRV_ORTHOGRAPHIC : CRV_PERSPECTIVE,
                     .view_height =
                         (float)(2.0 * (double)c->mOrthographicWidth / aspect)},
            .aspect = c->mAspect > 0.0f ? c->mAspect : 0.0f,
            .hfov_rad = ortho ? 0.0f : hfov_of(l, c),
        };
        const vec3 ahead = transform_direction(&t, vector_of(&c->mLookAt));
        if (!import_add_camera(
                out, c->mName.data, &like, transform_point(&t, vector_of(&c->mPosition)),
                v3_scale(ahead, -1.0), transform_direction(&t, vector_of(&c->mUp))))
            return;
    }
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
    loader l = {.path = path, .log = log, .root = transform_identity()};
    l.file = read_file(path, &l.mesh, log);
    if (!l.file)
        return -1;
    l.root.offset = v3_from_double(l.mesh.origin);
    if (l.file->mRootNode) {
        vec3 lower = v3(INFINITY, INFINITY, INFINITY), upper = v3_scale(lower, -1.0);
        bound_node(&l, l.file->mRootNode, &l.root, 0, &lower, &upper);
        if (!(v3_length(l.root.offset) > 0.0))
            mesh_choose_origin(&l.mesh, lower, upper);
        add_node(&l, l.file->mRootNode, &l.root, 0);
    }
    if (l.file->mRootNode)
        add_cameras(&l, &l.root, out);
    import_assimp_tell(&l.doubts, path, log);
    aiReleaseImport(l.file);
    out->mesh = l.mesh;
    return 0;
}

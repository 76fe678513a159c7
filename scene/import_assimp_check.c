/* SPDX-License-Identifier: MIT */
/*
 * What assimp reads and we do not show as the file means it: told, not passed over.
 */
#include "import_assimp.h"

#include <assimp/material.h>
#include <assimp/scene.h>

#include "internal.h"

/* Relative to a mesh's size; a pose that differs by less is the same to the eye. */
#define SAME_POSE 1e-3
/* Coordinates this many times the size of their mesh have lost it to rounding: floats
 * there are 5e-4 of the size apart. */
#define LOST 4096.0

static vec3 vector_of(const struct aiVector3D *v)
{
    return v3((double)v->x, (double)v->y, (double)v->z);
}

/* Whether a bone, at rest, takes vertices elsewhere than the mesh's own node. */
static bool is_posed(const struct aiMesh *part, const transform *node,
                     const struct aiNode *root, const transform *root_transform)
{
    for (unsigned b = 0; part->mBones && b < part->mNumBones; b++) {
        const struct aiBone *bone = part->mBones[b];
        transform world;
        if (!bone || !bone->mWeights
            || !import_assimp_find(root, &bone->mName, root_transform, &world))
            continue;
        const transform offset = import_assimp_matrix(&bone->mOffsetMatrix);
        const transform posed = transform_compose(&world, &offset);
        for (unsigned i = 0; i < bone->mNumWeights; i += 1 + bone->mNumWeights / 16) {
            const unsigned vertex = bone->mWeights[i].mVertexId;
            if (vertex >= part->mNumVertices)
                continue;
            const vec3 p = vector_of(&part->mVertices[vertex]);
            const vec3 here = transform_point(node, p),
                       there = transform_point(&posed, p);
            if (v3_length(v3_sub(here, there)) > SAME_POSE * (v3_length(here) + 1e-30))
                return true;
        }
    }
    return false;
}

static bool is_rounded(const struct aiMesh *part)
{
    vec3 lower = v3(INFINITY, INFINITY, INFINITY), upper = v3_scale(lower, -1.0);
    for (unsigned v = 0; part->mVertices && v < part->mNumVertices; v++)
        v3_bound(vector_of(&part->mVertices[v]), &lower, &upper);
    const double extent = v3_length(v3_sub(upper, lower));
    const double farthest = fmax(v3_length(lower), v3_length(upper));
    return extent > 0.0 && isfinite(farthest) && farthest > LOST * extent;
}

static bool has_holes(const struct aiScene *file, const struct aiMesh *part)
{
    return part->mMaterialIndex < file->mNumMaterials
           && aiGetMaterialTextureCount(file->mMaterials[part->mMaterialIndex],
                                        aiTextureType_OPACITY)
                  > 0;
}

import_doubts import_assimp_doubts(const struct aiScene *file, const struct aiMesh *part,
                                   const transform *node, const transform *root)
{
    return (import_doubts){
        .posed = is_posed(part, node, file->mRootNode, root),
        .rounded = is_rounded(part),
        .holes = has_holes(file, part),
        .morphed = part->mNumAnimMeshes > 0,
    };
}

void import_assimp_tell(const import_doubts *d, const char *path, const crv_logger *log)
{
    if (d->posed)
        scene_log(
            log, CRV_LOG_WARNING, path,
            "has a skin that poses it otherwise than its vertices are stored, which is "
            "how it is shown; export it as glTF to have the pose");
    if (d->morphed)
        scene_log(log, CRV_LOG_WARNING, path,
                  "has morph targets, which this format's reader does not apply; export "
                  "it as glTF to have them");
    if (d->rounded)
        scene_log(
            log, CRV_LOG_WARNING, path,
            "has coordinates so far from zero that its reader rounded them; move it "
            "near zero, or export it as glTF, OBJ or PLY");
    if (d->holes)
        scene_log(log, CRV_LOG_WARNING, path,
                  "has opacity textures, whose holes are not read in this format; export "
                  "it as glTF to have them");
}

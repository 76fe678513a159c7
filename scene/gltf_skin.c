/* SPDX-License-Identifier: MIT */
/*
 * Skins in the pose of the file: a vertex goes where its joints' nodes are, by their
 * weights; the transform of the node that shows the mesh does not count (3.7.3.2).
 */
#include "gltf.h"

#include <stdio.h>
#include <stdlib.h>

/* Where each joint takes a vertex; NULL after an error line. */
static transform *joint_transforms(gltf *g, const cJSON *skin, const transform *worlds,
                                   const double origin[3], int *count)
{
    const cJSON *joints = gltf_member(skin, "joints");
    const cJSON *joint;
    const int inverse = gltf_index(skin, "inverseBindMatrices");
    size_t inverse_count = 0;
    int i = 0;
    *count = cJSON_GetArraySize(joints);
    float *matrices = inverse >= 0 ? gltf_floats(g, inverse, 16, &inverse_count) : NULL;
    transform *out = malloc(((size_t)*count + 1) * sizeof *out);
    if (inverse >= 0 && inverse_count < (size_t)*count)
        gltf_refuse(g, "a skin has no matrix for each joint");
    if (!out)
        gltf_refuse(g, "there is no memory for it");
    cJSON_ArrayForEach(joint, joints)
    {
        const int node = cJSON_IsNumber(joint) && joint->valuedouble >= 0.0
                                 && joint->valuedouble < g->nodes.count
                             ? (int)joint->valuedouble
                             : -1;
        if (node < 0)
            gltf_refuse(g, "a skin has joints that are not there");
        if (g->failed)
            break;
        transform bind = transform_identity();
        if (matrices) {
            const float *m = matrices + 16 * (size_t)i; /* column by column */
            for (int row = 0; row < 3; row++)
                bind.row[row] =
                    v3((double)m[row], (double)m[4 + row], (double)m[8 + row]);
            bind.offset = v3((double)m[12], (double)m[13], (double)m[14]);
        }
        out[i] = transform_compose(&worlds[node], &bind);
        out[i].offset = v3_sub(out[i].offset, v3_from_double(origin));
        i++;
    }
    free(matrices);
    if (!g->failed)
        return out;
    free(out);
    return NULL;
}

/* The weighted sum of the joints' transforms for each vertex, one set of four after the
 * other. */
static bool add_influences(gltf *g, const cJSON *attributes, int set,
                           const transform *joints, int joint_count, size_t vertex_count,
                           transform *sums, double *totals)
{
    char joint_name[32], weight_name[32];
    size_t joint_rows = 0, weight_rows = 0;
    snprintf(joint_name, sizeof joint_name, "JOINTS_%d", set);
    snprintf(weight_name, sizeof weight_name, "WEIGHTS_%d", set);
    uint32_t *indices =
        gltf_integers(g, gltf_index(attributes, joint_name), 4, &joint_rows);
    float *weights = gltf_floats(g, gltf_index(attributes, weight_name), 4, &weight_rows);
    if (!g->failed && (joint_rows < vertex_count || weight_rows < vertex_count))
        gltf_refuse(g, "a skin has weights for some vertices only");
    for (size_t i = 0; i < 4 * vertex_count && !g->failed; i++) {
        const double w = (double)weights[i];
        if (!(w > 0.0))
            continue;
        if (indices[i] >= (uint32_t)joint_count) {
            gltf_refuse(g, "a mesh wants joints that its skin does not have");
            break;
        }
        const transform *joint = &joints[indices[i]];
        transform *sum = &sums[i / 4];
        for (int row = 0; row < 3; row++)
            sum->row[row] = v3_along(sum->row[row], joint->row[row], w);
        sum->offset = v3_along(sum->offset, joint->offset, w);
        totals[i / 4] += w;
    }
    free(indices);
    free(weights);
    return !g->failed;
}

static void move_vertex(gltf_part *p, size_t vertex, const transform *sum, double total)
{
    transform t = *sum;
    for (int row = 0; row < 3; row++)
        t.row[row] = v3_scale(t.row[row], 1.0 / total);
    t.offset = v3_scale(t.offset, 1.0 / total);
    float *position = p->positions + 3 * vertex;
    v3_store(transform_point(&t, v3_from(position)), position);
    if (!p->normals)
        return;
    const normal_map n = normal_map_of(&t);
    float *normal = p->normals + 3 * vertex;
    v3_store(v3_normalise(normal_map_apply(&n, v3_from(normal))), normal);
}

bool gltf_skin_part(gltf *g, const cJSON *primitive, int skin, const transform *worlds,
                    const double origin[3], gltf_part *p)
{
    const cJSON *attributes = gltf_member(primitive, "attributes");
    const size_t count = p->part.vertex_count;
    int joint_count = 0;
    transform *joints =
        joint_transforms(g, gltf_at(&g->skins, skin), worlds, origin, &joint_count);
    transform *sums = calloc(count + 1, sizeof *sums);
    double *totals = calloc(count + 1, sizeof *totals);
    char name[32] = "JOINTS_0";
    bool done = joints && sums && totals;
    if (!done)
        gltf_refuse(g, "there is no memory for it");
    for (int set = 0; done && gltf_index(attributes, name) >= 0; set++) {
        done =
            add_influences(g, attributes, set, joints, joint_count, count, sums, totals);
        snprintf(name, sizeof name, "JOINTS_%d", set + 1);
    }
    for (size_t v = 0; v < count && done; v++) {
        if (totals[v] > 0.0) {
            move_vertex(p, v, &sums[v], totals[v]);
        } else {
            const vec3 at = v3_sub(v3_from(p->positions + 3 * v), v3_from_double(origin));
            v3_store(at, p->positions + 3 * v);
        }
    }
    free(joints);
    free(sums);
    free(totals);
    return done;
}

/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include "scene.h"

/* Every reader of assimp. Others go by their content. */
const char *const fuzz_mesh_extensions[] = {
    "obj",    "ply",  "stl", "gltf", "glb",  "fbx",     "dae", "3ds", "x",    "off",
    "assbin", "pbrt", "bin", "3d",   "3mf",  "ac",      "amf", "ase", "b3d",  "blend",
    "bvh",    "cob",  "csm", "dxf",  "enff", "hmp",     "ifc", "iqm", "irr",  "irrmesh",
    "lwo",    "lws",  "m3d", "md2",  "md3",  "md5mesh", "mdc", "mdl", "mesh", "mesh.xml",
    "ms3d",   "ndo",  "nff", "ogex", "pk3",  "pmx",     "q3o", "raw", "sib",  "smd",
    "stp",    "ter",  "x3d", "x3db", "xgl",  NULL};
enum { COUNT = sizeof fuzz_mesh_extensions / sizeof *fuzz_mesh_extensions - 1 };

const char *fuzz_mesh_extension(uint8_t letter)
{
    return fuzz_mesh_extensions[(uint8_t)(letter - 'a') % COUNT];
}

static void look_at(const scene *s)
{
    scene_gbuffer_request q = {.width = 8,
                               .height = 8,
                               .layers = CRV_MAX_LAYERS,
                               .threads = 1,
                               .texture_frames = true};
    scene_gbuffer g = {0};
    double lower[3], upper[3];
    scene_bounds(s, lower, upper);
    for (int i = 0; i < 3; i++)
        FUZZ_CHECK(lower[i] <= upper[i], "bounds %g to %g", lower[i], upper[i]);
    FUZZ_CHECK(scene_triangle_count(s) > 0, "no triangles");
    scene_frame(s, 1.0f, 1.0f, &q.view);
    FUZZ_CHECK(scene_suggest_radius(s, &q.view) > 0.0f, "no radius");
    if (!scene_render_gbuffer(s, &q, &g, &fuzz_logger))
        scene_gbuffer_free(&g);
}

void fuzz_mesh(const uint8_t *data, size_t size)
{
    static const scene_limits limits = {.timeout_s = 2.0, .memory_bytes = 256 << 20};
    char name[32];
    scene *s = NULL;
    if (size < 2)
        return;
    fuzz_share_edges();
    snprintf(name, sizeof name, "input.%s", fuzz_mesh_extension(data[0]));
    fuzz_file(name, data + 1, size - 1);
    const int before = fuzz_errors;
    const int result = scene_load_limited(name, &limits, &s, &fuzz_logger);
    fuzz_add_edges();
    FUZZ_CHECK(fuzz_errors == before + (result ? 1 : 0), "%d lines",
               fuzz_errors - before);
    if (!result)
        look_at(s);
    scene_free(s);
    remove(name);
}

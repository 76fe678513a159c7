/* SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE
#include "fuzz.h"

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "import.h"
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

/* The edges that libFuzzer counts, in its programs. */
extern uint8_t __start___sancov_cntrs[] __attribute__((weak));
extern uint8_t __stop___sancov_cntrs[] __attribute__((weak));
static uint8_t *child_edges; /* in memory that both processes share */

static size_t edge_count(void)
{
    return (size_t)(__stop___sancov_cntrs - __start___sancov_cntrs);
}

static void share_edges(void)
{
    if (child_edges || !__start___sancov_cntrs)
        return;
    void *shared = mmap(NULL, edge_count(), PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    FUZZ_CHECK(shared != MAP_FAILED, "no shared memory");
    child_edges = shared;
}

static void tell_edges(void)
{
    if (child_edges)
        memcpy(child_edges, __start___sancov_cntrs, edge_count());
}

/* The child's edges count, too. */
static void add_child_edges(void)
{
    for (size_t i = 0; child_edges && i < edge_count(); i++)
        if (child_edges[i] > __start___sancov_cntrs[i])
            __start___sancov_cntrs[i] = child_edges[i];
    if (child_edges)
        memset(child_edges, 0, edge_count());
}

/* What the linker hands over (--wrap): before its result the child tells its edges, for
 * then it may be killed, or else when it ends. */
bool __real_import_pipe_send(int to, const import *found);
bool __wrap_import_pipe_send(int to, const import *found);
bool __wrap_import_pipe_send(int to, const import *found)
{
    tell_edges();
    return __real_import_pipe_send(to, found);
}

void __real__exit(int code) __attribute__((noreturn));
void __wrap__exit(int code) __attribute__((noreturn));
void __wrap__exit(int code)
{
    tell_edges();
    __real__exit(code);
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
    share_edges();
    snprintf(name, sizeof name, "input.%s", fuzz_mesh_extension(data[0]));
    fuzz_file(name, data + 1, size - 1);
    const int before = fuzz_errors;
    const int result = scene_load_limited(name, &limits, &s, &fuzz_logger);
    add_child_edges();
    FUZZ_CHECK(fuzz_errors == before + (result ? 1 : 0), "%d lines",
               fuzz_errors - before);
    if (!result)
        look_at(s);
    scene_free(s);
    remove(name);
}

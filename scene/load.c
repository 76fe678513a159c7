/* SPDX-License-Identifier: MIT */
#include "check_file.h"
#include "import.h"
#include "internal.h"

static int finish(import *found, const char *path, scene **out, const crv_logger *log)
{
    const size_t dropped = found->mesh.dropped_triangles;
    if (found->mesh.triangle_count == 0) {
        if (dropped > 0)
            scene_log(
                log, CRV_LOG_ERROR, path,
                "all its %zu triangles are degenerate or not finite; repair the model",
                dropped);
        else
            scene_log(log, CRV_LOG_ERROR, path,
                      "has no triangles; export the model as a polygon mesh");
        import_free(found);
        return -1;
    }
    if (scene_from_mesh(&found->mesh, path, out, log))
        return -1;
    if (dropped > 0)
        scene_log(
            log, CRV_LOG_WARNING, path,
            "left out %zu degenerate or non-finite triangles of %zu; repair the model "
            "if parts are missing",
            dropped, dropped + (*out)->mesh.triangle_count);
    return 0;
}

int scene_load_limited(const char *path, const scene_limits *limits, scene **out,
                       const crv_logger *log)
{
import found = {0 };
    if (!check_mesh_file(path, log) || import_file(path, limits, &found, log))
        return -1;
    return finish(&found, path, out, log);
}

int scene_load(const char *path, scene **out, const crv_logger *log)
{
    return scene_load_limited(path, NULL, out, log);
}

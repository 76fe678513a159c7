/* SPDX-License-Identifier: MIT */
#include "check_file.h"
#include "import.h"
#include "internal.h"

/* Moves the target along the view to before the scene's centre, which says how large what
 * is seen is. */
static void place_target(const scene *s, scene_view *v)
{
    double lower[3], upper[3];
    scene_bounds(s, lower, upper);
    const vec3 low = v3_from_double(lower), high = v3_from_double(upper);
    const vec3 eye = v3_from_double(v->eye);
    const vec3 ahead = v3_normalise(v3_sub(v3_from_double(v->target), eye));
    const double middle = v3_dot(ahead, v3_sub(v3_scale(v3_add(low, high), 0.5), eye));
    const double extent = v3_length(v3_sub(high, low));
    v3_store_double(v3_along(eye, ahead, middle > 0.01 * extent ? middle : 0.5 * extent),
                    v->target);
}

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
    if (scene_from_mesh(&found->mesh, path, out, log)) {
        import_free(found);
        return -1;
    }
    (*out)->cameras = found->cameras;
    (*out)->camera_count = (int32_t)found->camera_count;
    for (size_t i = 0; i < found->camera_count; i++)
        place_target(*out, &found->cameras[i].view);
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

/* SPDX-License-Identifier: MIT */
#include "names.h"

#include <string.h>

#include "internal.h"

int io__choose_passes(const char *path, const io_image *probed,
                      const io_passes_request *request, io__pass_names *out,
                      const crv_logger *log)
{
    memset(out, 0, sizeof *out);
    if (io__choose_depth(path, probed, request, out, log)
        || io__choose_normals(path, probed, request, out, log))
        return -1;
    if (out->position[0])
        io__info(log, path, "positions: \"%s\" and so on; normals: %s%s%s",
                 out->position[0], out->normal[0] ? "\"" : "",
                 out->normal[0] ? out->normal_base : "from depth",
                 out->normal[0] ? "\"" : "");
    else
        io__info(log, path, "depth: \"%s\" (%d layer%s%s); normals: %s%s%s",
                 out->depth[0], (int)out->layers, out->layers > 1 ? "s" : "",
                 out->layer_kind == CRV_LAYERS_SOLID ? " of solids" : "",
                 out->normal[0] ? "\"" : "",
                 out->normal[0] ? out->normal_base : "from depth",
                 out->normal[0] ? "\"" : "");
    return 0;
}

/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "claims_alchemy.h"

/* Whether one of 32 pixels on four rings within reach_px shows a surface nearer than
 * `nearer`. */
static bool is_beside(const scene_gbuffer *g, int32_t x, int32_t y, double reach_px,
                      double nearer)
{
    enum { RINGS = 4, SPOKES = 8 };
    const double turn = 0.78539816339744831; /* an eighth */

    for (int ring = 1; ring <= RINGS; ring++) {
        double radius = reach_px * ring / RINGS;

        for (int spoke = 0; spoke < SPOKES; spoke++) {
            double u = x + 0.5 + radius * cos(turn * spoke);
            double w = y + 0.5 + radius * sin(turn * spoke);

            if (u >= 0.0 && u < g->desc.width && w >= 0.0 && w < g->desc.height
                && (double)g->depth[0][(size_t)w * (size_t)g->desc.width + (size_t)u]
                       < nearer)
                return true;
        }
    }
    return false;
}

int claims_silhouettes(study *s, study_view *v, uint8_t **out)
{
    const scene_gbuffer *g;
    int result = study_gbuffer(s, v, STUDY_ONE_LAYER, &g);

    *out = NULL;
    if (result != EXIT_DONE)
        return result;
    *out = calloc((size_t)v->width * (size_t)v->height, 1);
    if (*out == NULL)
        return report_no_memory(s->r);
    for (int32_t y = 0; y < v->height; y++) {
        for (int32_t x = 0; x < v->width; x++) {
            size_t i = (size_t)y * (size_t)v->width + (size_t)x;
            int32_t column = x + g->desc.guard_left, row = y + g->desc.guard_top;
            double d =
                (double)g->depth[0][(size_t)row * (size_t)g->desc.width + (size_t)column];
            double unit = g->camera.projection == CRV_ORTHOGRAPHIC ? 1.0 : d;

            if (v->mask[i] != 0)
                (*out)[i] =
                    is_beside(g, column, row,
                              0.5 * (double)v->radius * (double)g->camera.fy_px / unit,
                              d - (double)v->radius);
        }
    }
    return EXIT_DONE;
}

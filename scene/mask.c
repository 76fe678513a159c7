/* SPDX-License-Identifier: MIT */
#include "mesh.h"

/* A texel's index along one axis. */
static int32_t wrapped(double index, int32_t size, int32_t wrap)
{
    const double period = wrap == MESH_WRAP_MIRROR ? 2.0 * size : (double)size;
    if (wrap == MESH_WRAP_CLAMP)
        return (int32_t)fmin(fmax(index, 0.0), (double)size - 1.0);
    const double folded = index - period * floor(index / period);
    const int32_t whole = (int32_t)fmin(folded, period - 1.0);
    return whole < size ? whole : 2 * size - 1 - whole;
}

static double alpha_at(const mesh_mask *m, double x, double y)
{
    const int32_t column = wrapped(x, m->width, m->wrap[0]);
    const int32_t row = wrapped(y, m->height, m->wrap[1]);
    return (double)m->alpha[(size_t)row * (size_t)m->width + (size_t)column];
}

bool mesh_mask_covers(const mesh_mask *m, double u, double v)
{
    const double x =
        ((double)m->map[0] * u + (double)m->map[1] * v + (double)m->map[2]) * m->width
        - 0.5;
    const double y =
        ((double)m->map[3] * u + (double)m->map[4] * v + (double)m->map[5]) * m->height
        - 0.5;
    if (!(fabs(x) < 1e9 && fabs(y) < 1e9))
        return true;
    const double column = floor(x), row = floor(y), s = x - column, t = y - row;
    const double above =
        (1.0 - s) * alpha_at(m, column, row) + s * alpha_at(m, column + 1.0, row);
    const double below = (1.0 - s) * alpha_at(m, column, row + 1.0)
                         + s * alpha_at(m, column + 1.0, row + 1.0);
    return (1.0 - t) * above + t * below >= 255.0 * (double)m->cutoff;
}

/* SPDX-License-Identifier: MIT */
/* core/normals.c for the lanes of a vector: the same operations in the same order, and to
 * the bit the same numbers. */
#include "core/conversions.h"
#include "cpu/kernels/texels.h"
#include "cpu/kernels/window.h"

enum { CHUNK = 256 };

typedef struct pixels {
    const crv__params *params;
    const crv__plane *depth;
    int32_t x, y;
    vf d;
    crv__v3 P;
} pixels;

CRV__INLINE crv__v3 cross(crv__v3 a, crv__v3 b)
{
    return (crv__v3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

CRV__INLINE crv__v3 select3(vm mask, crv__v3 a, crv__v3 b)
{
    return (crv__v3){vf_select(mask, a.x, b.x), vf_select(mask, a.y, b.y),
                     vf_select(mask, a.z, b.z)};
}

CRV__INLINE crv__v3 normalized(crv__v3 v)
{
    const vf largest = vf_max(vf_abs(v.x), vf_max(vf_abs(v.y), vf_abs(v.z)));
    const vm numbers = vm_and(vf_le(v.x, v.x), vm_and(vf_le(v.y, v.y), vf_le(v.z, v.z)));
    const vm good = vm_and(
        numbers, vm_and(vf_lt(vf_zero(), largest), vf_lt(largest, vf_set(INFINITY))));
    const vf by = vf_select(good, largest, vf_set(1));
    const crv__v3 u = {v.x / by, v.y / by, v.z / by};
    const vf scale = vf_set(1) / vf_sqrt(crv__v3_dot(u, u));
    return (crv__v3){vf_where(good, u.x * scale), vf_where(good, u.y * scale),
                     vf_where(good, u.z * scale)};
}

CRV__INLINE crv__v3 unprojected(const pixels *at, int32_t step_x, int32_t step_y, vf d)
{
    return crv__lanes_unproject(at->params, vi_set(at->x + step_x) + vi_iota(),
                                vi_set(at->y + step_y), d);
}

/* edge() */
CRV__INLINE crv__v3 edge(const pixels *at, int32_t step_x, int32_t step_y)
{
    vf best = vf_set(INFINITY);
    crv__v3 result = crv__v3_sub(unprojected(at, step_x, step_y, at->d), at->P);
    for (int32_t sign = -1; sign <= 1; sign += 2) {
        vm inside;
        const vf neighbour = crv__row_read(at->depth, at->x + sign * step_x,
                                           at->y + sign * step_y, &inside);
        const vf difference = vf_abs(neighbour - at->d);
        const vm nearer = vm_and(inside, vf_lt(difference, best));
        const vf one = vf_set((float)sign);
        crv__v3 v =
            crv__v3_sub(unprojected(at, sign * step_x, sign * step_y, neighbour), at->P);
        v = (crv__v3){v.x * one, v.y * one, v.z * one};
        best = vf_select(nearer, difference, best);
        result = select3(nearer, v, result);
    }
    return result;
}

CRV__NOINLINE crv__v3 from_depth(const pixels *at)
{
    return normalized(cross(normalized(edge(at, 1, 0)), normalized(edge(at, 0, -1))));
}

/* Whether all lanes of `active` face the camera by far more than rounding could change:
 * twice face_camera()'s least cosine, told without a root or a division. */
CRV__INLINE int faces_clearly(const pixels *at, crv__v3 n, vm active)
{
    const vf cosine = -crv__v3_dot(n, at->P), square = crv__v3_dot(at->P, at->P);
    const vm steep = vf_lt(square * vf_set(4e-6f), cosine * cosine);
    const vm fits = vm_and(vf_lt(vf_set(1e-30f), square), vf_lt(vf_zero(), cosine));
    return !vm_any(vm_and(active, vm_not(vm_and(steep, fits))));
}

/* face_camera(), of the lanes of `active`. */
CRV__INLINE crv__v3 face_camera(const pixels *at, crv__v3 n, vm active)
{
    if (!at->params->orthographic && faces_clearly(at, n, active))
        return n;
    const vf least = vf_set(1e-3f), enough = vf_set(0.1f), zero = vf_zero();
    const crv__v3 view = at->params->orthographic
                             ? (crv__v3){zero, zero, vf_set(1)}
                             : normalized((crv__v3){-at->P.x, -at->P.y, -at->P.z});
    vf facing = crv__v3_dot(n, view);
    if (!vm_any(vm_and(active, vm_not(vf_le(least, facing)))))
        return n;
    const vm away = vm_and(active, vf_lt(facing, zero));
    if (vm_any(away)) {
        const vm back = vm_and(away, vf_lt(crv__v3_dot(n, from_depth(at)), zero));
        n = select3(back, (crv__v3){-n.x, -n.y, -n.z}, n);
        facing = vf_select(back, -facing, facing);
    }
    const vf add = vf_select(vf_lt(facing, zero), enough, least) - facing;
    const crv__v3 bent = normalized(crv__v3_add_scaled(n, view, add));
    const crv__v3 turned = select3(vf_lt(zero, crv__v3_dot(bent, view)), bent, view);
    return select3(vf_le(least, facing), n, turned);
}

CRV__INLINE crv__v3 given(const crv__plane *normal, int32_t x, int32_t y)
{
    vm inside;
    return normalized((crv__v3){crv__row_read(&normal[0], x, y, &inside),
                                crv__row_read(&normal[1], x, y, &inside),
                                crv__row_read(&normal[2], x, y, &inside)});
}

/* A loop that the compiler turns into vectors; a pixel has `step` numbers. */
CRV__INLINE void rotated(const float m[9], const float *restrict v, int32_t step,
                         int32_t count, float *restrict x, float *restrict y,
                         float *restrict z)
{
    const float m0 = m[0], m1 = m[1], m2 = m[2], m3 = m[3], m4 = m[4], m5 = m[5],
                m6 = m[6], m7 = m[7], m8 = m[8];
    for (int32_t i = 0; i < count; i++) {
        const float a = v[step * i], b = v[step * i + 1], c = v[step * i + 2];
        x[i] = m0 * a + m1 * b + m2 * c;
        y[i] = m3 * a + m4 * b + m5 * c;
        z[i] = m6 * a + m7 * b + m8 * c;
    }
}

static void rotated3(const float m[9], const float *v, int32_t count, float *x, float *y,
                     float *z)
{
    rotated(m, v, 3, count, x, y, z);
}

static void rotated4(const float m[9], const float *v, int32_t count, float *x, float *y,
                     float *z)
{
    rotated(m, v, 4, count, x, y, z);
}

void CRV__NAME(rotated_row)(const float rotation[9], const crv__texel_row *from,
                            int32_t count, float *const out[3]);
void CRV__NAME(rotated_row)(const float rotation[9], const crv__texel_row *from,
                            int32_t count, float *const out[3])
{
    /* Three or four numbers a pixel, side by side: a row of numbers. */
    const ptrdiff_t size = crv__texel_size(from->type);
    const int32_t step = from->stride == 4 * size ? 4 : 3;
    const bool packed = from->channel == size && from->stride == step * size;
    const bool direct = packed && crv__row_is_plain(from);
    float chunk[4 * CHUNK];
    for (int32_t x = 0; x < count; x += CHUNK) {
        const int32_t n = count - x < CHUNK ? count - x : CHUNK;
        const int32_t numbers = packed ? step * n - (step - 3) : 3 * n;
        const char *at = (const char *)from->at + x * from->stride;
        if (packed && !direct)
            crv__texels_take(at, from->type, size, numbers, chunk, 1);
        for (int i = 0; i < 3 && !packed; i++)
            crv__texels_take(at + i * from->channel, from->type, from->stride, n,
                             chunk + i, 3);
        if (!direct)
            crv__texels_scale(from, chunk, numbers);
        const float *v = direct ? (const float *)(const void *)at : chunk;
        (packed && step == 4 ? rotated4 : rotated3)(rotation, v, n, out[0] + x,
                                                    out[1] + x, out[2] + x);
    }
}

void CRV__NAME(normals_row)(const crv__params *p, const crv__plane *depth,
                            const crv__plane *normal, int32_t has_normals, int32_t y);
void CRV__NAME(normals_row)(const crv__params *p, const crv__plane *depth,
                            const crv__plane *normal, int32_t has_normals, int32_t y)
{
    for (int32_t x = 0; x < p->width; x += CRV__LANES) {
        const int32_t count = p->width - x < CRV__LANES ? p->width - x : CRV__LANES;
        vm surface;
        const vf read = crv__row_read(depth, x, y, &surface);
        surface = vm_and(surface, vf_lt(read, vf_set(INFINITY)));
        crv__v3 n = {vf_zero(), vf_zero(), vf_zero()};
        if (vm_any(surface)) {
            pixels at = {.params = p, .depth = depth, .x = x, .y = y};
            at.d = vf_select(surface, read, vf_set(1));
            at.P = unprojected(&at, 0, 0, at.d);
            if (has_normals)
                n = given(normal, x, y);
            const vm none = vm_and(surface, vf_le(crv__v3_dot(n, n), vf_zero()));
            if (vm_any(none))
                n = select3(none, from_depth(&at), n);
            n = face_camera(&at, n, surface);
        }
        vf_store_n(crv__plane_at(&normal[0], x, y), vf_where(surface, n.x), count);
        vf_store_n(crv__plane_at(&normal[1], x, y), vf_where(surface, n.y), count);
        vf_store_n(crv__plane_at(&normal[2], x, y), vf_where(surface, n.z), count);
    }
}

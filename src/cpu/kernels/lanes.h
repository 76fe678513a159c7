/* SPDX-License-Identifier: MIT */
/*
 * What the scalar specification has in core/frame.h and core/falloff.h, for the lanes of
 * a vector: adjacent pixels of one row. Positions are computed by the same operations in
 * the same order as there, so that every lane reads the texels that the scalar code
 * reads.
 */
#ifndef CRV_CPU_KERNELS_LANES_H
#define CRV_CPU_KERNELS_LANES_H

#include "cpu/kernels/kernel.h"
#include "cpu/simd/vector.h"

#include "crevice/options.h"

typedef struct crv__v3 {
    vf x, y, z;
} crv__v3;

CRV__INLINE crv__v3 crv__v3_sub(crv__v3 a, crv__v3 b)
{
    return (crv__v3){a.x - b.x, a.y - b.y, a.z - b.z};
}

CRV__INLINE vf crv__v3_dot(crv__v3 a, crv__v3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

CRV__INLINE crv__v3 crv__v3_add_scaled(crv__v3 a, crv__v3 b, vf scale)
{
    return (crv__v3){a.x + b.x * scale, a.y + b.y * scale, a.z + b.z * scale};
}

/* What a kernel is specialised by: passed as constants where they are common. */
typedef struct crv__shape {
    int32_t layers, solid, orthographic; /* as in crv__params */
    int32_t within; /* no sample of these pixels leaves the buffers or gets behind the
                       eye, so that none need be tested */
} crv__shape;

/* A pattern's points, or the directions, as the lanes of a row turn them. */
enum { CRV__TURNED_POINTS = 64 };
typedef struct crv__turned_points {
    int32_t count; /* that are there; the others are turned when they are needed */
    vf x[CRV__TURNED_POINTS], y[CRV__TURNED_POINTS];
} crv__turned_points;

/* The pixels that a vector stands for. */
typedef struct crv__pixels {
    int32_t y;
    vi x;
    vm active;    /* lanes whose result counts; the others hold no surface */
    vf depth;     /* layer 0; 1 where not active */
    crv__v3 P, n; /* surface point and normal; n = (0, 0, 1) where not active */
    vf cos_alpha, sin_alpha, beta, sector_offset; /* of the noise tile */
    const float
        *points; /* the pattern's points, or the directions, `stride` floats each */
    int32_t stride;
    float scale; /* of points and directions, where a method wants them as lengths */
    const crv__turned_points *turned;
} crv__pixels;

/* crv__unproject() for pixel coordinates and depths by lane. */
CRV__INLINE crv__v3 crv__lanes_unproject_at(const crv__params *p, crv__shape shape, vi x,
                                            vi y, vf d)
{
    const vf half = vf_set(0.5f), scale = shape.orthographic ? vf_set(1) : d;
    const vf up = (vf_of(y) + half - vf_set(p->cy)) * vf_set(p->inv_fy) * scale;
    return (crv__v3){(vf_of(x) + half - vf_set(p->cx)) * vf_set(p->inv_fx) * scale, -up,
                     -d};
}

CRV__INLINE crv__v3 crv__lanes_unproject(const crv__params *p, vi x, vi y, vf d)
{
    return crv__lanes_unproject_at(p, (crv__shape){.orthographic = p->orthographic}, x, y,
                                   d);
}

/* Where a plane that holds all buffers' pixels has those texels; any number where they
 * are outside. */
CRV__INLINE vi crv__lanes_index(const crv__plane *plane, vi u, vi v)
{
    return vi_add(vi_mul(v, vi_set((int32_t)plane->pitch)), u);
}

CRV__INLINE void crv__lanes_noise(const crv__frame *f, crv__pixels *at, int32_t x,
                                  int32_t y)
{
    const crv__params *p = f->params;
    const crv__noise_texel *row =
        f->noise + (y + p->noise_y) % p->noise_size * p->noise_size;
    float lanes[4][CRV__LANES];
    int32_t column = (x + p->noise_x) % p->noise_size;
    for (int32_t i = 0; i < CRV__LANES; i++) {
        lanes[0][i] = row[column].cos_alpha;
        lanes[1][i] = row[column].sin_alpha;
        lanes[2][i] = row[column].beta;
        lanes[3][i] = row[column].sector_offset;
        column = column + 1 < p->noise_size ? column + 1 : 0;
    }
    at->cos_alpha = vf_load(lanes[0]);
    at->sin_alpha = vf_load(lanes[1]);
    at->beta = vf_load(lanes[2]);
    at->sector_offset = vf_load(lanes[3]);
}

/* Surface and normals of the pixels from (x, y) on, `count` of them, at most
 * CRV__LANES. Asks for the normals two rows down: tiles are too narrow to be foreseen. */
CRV__INLINE void crv__lanes_surface(const crv__frame *f, crv__pixels *pixels, int32_t x,
                                    int32_t y, int32_t count)
{
    crv__pixels at = *pixels;
    at.y = y;
    at.x = vi_set(x) + vi_iota();
    const vf depth = vf_load_n(crv__plane_at(&f->depth[0], x, y), count);
    at.active = vm_and(vm_first(count), vf_lt(depth, vf_set(INFINITY)));
    at.depth = vf_select(at.active, depth, vf_set(1));
    at.P = crv__lanes_unproject(f->params, at.x, vi_set(y), at.depth);
    at.n.x = vf_where(at.active, vf_load_n(crv__plane_at(&f->normal[0], x, y), count));
    at.n.y = vf_where(at.active, vf_load_n(crv__plane_at(&f->normal[1], x, y), count));
    at.n.z = vf_select(at.active, vf_load_n(crv__plane_at(&f->normal[2], x, y), count),
                       vf_set(1));
    for (int32_t i = 0; i < 3; i++)
        __builtin_prefetch(crv__plane_at(&f->normal[i], x, y) + 2 * f->normal[i].pitch);
    *pixels = at;
}

/* crv__turned(). */
CRV__INLINE void crv__lanes_turned(const crv__pixels *at, float x, float y, vf *turned_x,
                                   vf *turned_y)
{
    *turned_x = vf_set(x) * at->cos_alpha - vf_set(y) * at->sin_alpha;
    *turned_y = vf_set(x) * at->sin_alpha + vf_set(y) * at->cos_alpha;
}

/* The k-th point of the pattern, or direction, turned and scaled. */
CRV__INLINE void crv__lanes_point(const crv__pixels *at, int32_t k, vf *x, vf *y)
{
    if (k < at->turned->count) {
        *x = at->turned->x[k];
        *y = at->turned->y[k];
        return;
    }
    const float *point = at->points + at->stride * k;
    crv__lanes_turned(at, point[0], point[1], x, y);
    *x = *x * vf_set(at->scale);
    *y = *y * vf_set(at->scale);
}

/* crv__stratum(). */
CRV__INLINE vf crv__lanes_stratum(const crv__pixels *at, int32_t k)
{
    const vf x = vf_set(0.5f) + vf_set(0.5f) * at->beta + vf_set(0.618034f * (float)k);
    return x - vf_floor(x);
}

/* The square root, relative error < 2e-6 but for denormal numbers; a NaN at infinity. */
CRV__INLINE vf crv__lanes_root(vf a)
{
    const vf least_normal = vf_set(0x1p-126f);
    return a * vf_rsqrt(vf_max(a, least_normal));
}

/* crv__falloff(): q >= 0; 0 from q = 1 on. */
CRV__INLINE vf crv__lanes_falloff(const crv__params *p, vf q)
{
    const vf one = vf_set(1);
    vf w = one;
    switch ((crv_falloff)p->falloff) {
    case CRV_FALLOFF_NONE:
        break;
    case CRV_FALLOFF_LINEAR:
        w = one - q;
        break;
    case CRV_FALLOFF_SQRT:
        w = one - vf_sqrt(q);
        break;
    case CRV_FALLOFF_CUBIC:
        w = one - q * q * q;
        break;
    case CRV_FALLOFF_EXPONENTIAL:
        w = vf_exp(vf_set(-p->tau) * q);
        break;
    case CRV_FALLOFF_ALCHEMY: {
        const vf m = vf_max(q, vf_set(p->u));
        w = vf_set(p->u) * q / (m * m);
        break;
    }
    }
    return vf_where(vf_lt(q, one), w);
}

/* Whether the rectangles of these half sizes in pixels around the active pixels lie on
 * the buffers. */
CRV__INLINE int crv__lanes_disk_within(const crv__params *p, const crv__pixels *at,
                                       vf radius_x, vf radius_y)
{
    /* A pixel more for all rounding. */
    const vf one = vf_set(1), x = vf_of(at->x), y = vf_set((float)at->y);
    const vf left = x - radius_x - one, right = x + radius_x + one;
    const vf top = y - radius_y - one, bottom = y + radius_y + one;
    const vm inside = vm_and(vm_and(vf_le(vf_zero(), left), vf_le(vf_zero(), top)),
                             vm_and(vf_lt(right, vf_set((float)p->width - 1)),
                                    vf_lt(bottom, vf_set((float)p->height - 1))));
    return !vm_any(vm_and(at->active, vm_not(inside)));
}

/* Begins a row of which (x, y) is the first pixel. Returns whether the noise is the same
 * in all its vectors; then it is there, and the points are turned once for all. */
CRV__INLINE int crv__lanes_begin(const crv__frame *f, crv__pixels *at,
                                 crv__turned_points *turned, int32_t x, int32_t y)
{
    const crv__params *p = f->params;
    const int steady = CRV__LANES % p->noise_size == 0;
    const int32_t count = f->pattern ? p->samples : p->directions;
    at->points = f->pattern ? f->pattern : f->directions;
    at->stride = f->pattern ? 4 : 2;
    at->turned = turned;
    turned->count = 0;
    if (!steady)
        return 0;
    crv__lanes_noise(f, at, x, y);
    turned->count = count < CRV__TURNED_POINTS ? count : CRV__TURNED_POINTS;
    for (int32_t k = 0; k < turned->count; k++) {
        const float *point = at->points + at->stride * k;
        vf px, py;
        crv__lanes_turned(at, point[0], point[1], &px, &py);
        turned->x[k] = px * vf_set(at->scale);
        turned->y[k] = py * vf_set(at->scale);
    }
    return 1;
}

/* A method's kernel for one shape, and whether no sample of these pixels can leave the
 * buffers or get behind the eye. */
typedef vf (*crv__lanes_method)(const crv__frame *, const crv__pixels *);
typedef int (*crv__lanes_within_test)(const crv__frame *, const crv__pixels *);

/* Runs a method over a row: see crv__estimate_kernel. */
CRV__INLINE void crv__estimate_row(const crv__frame *f, int32_t x0, int32_t x1, int32_t y,
                                   float *out, float scale, crv__lanes_within_test within,
                                   crv__lanes_method inner, crv__lanes_method border,
                                   crv__lanes_method general)
{
    const crv__params *p = f->params;
    const vf one = vf_set(1), intensity = vf_set(p->intensity);
    const int common = p->layers == 1 && !p->orthographic;
    crv__pixels at = {.scale = scale};
    crv__turned_points turned;
    const int steady = crv__lanes_begin(f, &at, &turned, x0, y);
    for (int32_t x = x0; x < x1; x += CRV__LANES) {
        const int32_t count = x1 - x < CRV__LANES ? x1 - x : CRV__LANES;
        crv__lanes_surface(f, &at, x, y, count);
        vf result = one;
        if (vm_any(at.active)) {
            if (!steady)
                crv__lanes_noise(f, &at, x, y);
            const vf a = !common          ? general(f, &at)
                         : within(f, &at) ? inner(f, &at)
                                          : border(f, &at);
            result = vf_select(at.active, vf_clamp01(one - intensity * (one - a)), one);
        }
        vf_store_n(out + (x - x0), result, count);
    }
}

typedef vf (*crv__lanes_bent_method)(const crv__frame *, const crv__pixels *,
                                     crv__v3 *bent);

/* Runs a method over a row: see crv__bent_kernel. */
CRV__INLINE void crv__bent_row(const crv__frame *f, int32_t x0, int32_t x1, int32_t y,
                               float *out, float *const bent[3],
                               crv__lanes_within_test within,
                               crv__lanes_bent_method inner,
                               crv__lanes_bent_method general)
{
    const crv__params *p = f->params;
    const vf one = vf_set(1), zero = vf_zero(), intensity = vf_set(p->intensity);
    const int common = p->layers == 1 && !p->orthographic;
    crv__pixels at = {.scale = 1};
    crv__turned_points turned;
    const int steady = crv__lanes_begin(f, &at, &turned, x0, y);
    for (int32_t x = x0; x < x1; x += CRV__LANES) {
        const int32_t count = x1 - x < CRV__LANES ? x1 - x : CRV__LANES;
        crv__lanes_surface(f, &at, x, y, count);
        vf result = one;
        crv__v3 B = {zero, zero, zero};
        if (vm_any(at.active)) {
            if (!steady)
                crv__lanes_noise(f, &at, x, y);
            const vf a =
                common && within(f, &at) ? inner(f, &at, &B) : general(f, &at, &B);
            result = vf_select(at.active, vf_clamp01(one - intensity * (one - a)), one);
        }
        vf_store_n(out + (x - x0), result, count);
        vf_store_n(bent[0] + (x - x0), vf_where(at.active, B.x), count);
        vf_store_n(bent[1] + (x - x0), vf_where(at.active, B.y), count);
        vf_store_n(bent[2] + (x - x0), vf_where(at.active, B.z), count);
    }
}

/* Defines the kernel of a method from its static functions accessibility() and within().
 * What is common, one layer in perspective, is compiled for itself. scale: of the points,
 * an expression of the frame f. */
#define CRV__ESTIMATE_KERNEL(name, scale)                                                \
    CRV__NOINLINE vf inner(const crv__frame *f, const crv__pixels *at)                   \
    {                                                                                    \
        return accessibility(f, (crv__shape){.layers = 1, .within = 1}, at);             \
    }                                                                                    \
    CRV__NOINLINE vf border(const crv__frame *f, const crv__pixels *at)                  \
    {                                                                                    \
        return accessibility(f, (crv__shape){.layers = 1}, at);                          \
    }                                                                                    \
    CRV__NOINLINE vf general(const crv__frame *f, const crv__pixels *at)                 \
    {                                                                                    \
        const crv__params *p = f->params;                                                \
        return accessibility(f,                                                          \
                             (crv__shape){.layers = p->layers,                           \
                                          .solid = p->layers_solid,                      \
                                          .orthographic = p->orthographic},              \
                             at);                                                        \
    }                                                                                    \
    void CRV__NAME(name)(const crv__frame *f, int32_t x0, int32_t x1, int32_t y,         \
                         float *out);                                                    \
    void CRV__NAME(name)(const crv__frame *f, int32_t x0, int32_t x1, int32_t y,         \
                         float *out)                                                     \
    {                                                                                    \
        crv__estimate_row(f, x0, x1, y, out, scale, within, inner, border, general);     \
    }

/* Defines the kernel that computes bent normals as well, from estimate(), which is
 * accessibility() with a place for them, and within(). */
#define CRV__BENT_KERNEL(name)                                                           \
    CRV__NOINLINE vf inner_bent(const crv__frame *f, const crv__pixels *at,              \
                                crv__v3 *bent)                                           \
    {                                                                                    \
        return estimate(f, (crv__shape){.layers = 1, .within = 1}, at, bent);            \
    }                                                                                    \
    CRV__NOINLINE vf general_bent(const crv__frame *f, const crv__pixels *at,            \
                                  crv__v3 *bent)                                         \
    {                                                                                    \
        const crv__params *p = f->params;                                                \
        return estimate(f,                                                               \
                        (crv__shape){.layers = p->layers,                                \
                                     .solid = p->layers_solid,                           \
                                     .orthographic = p->orthographic},                   \
                        at, bent);                                                       \
    }                                                                                    \
    void CRV__NAME(name##_bent)(const crv__frame *f, int32_t x0, int32_t x1, int32_t y,  \
                                float *out, float *const bent[3]);                       \
    void CRV__NAME(name##_bent)(const crv__frame *f, int32_t x0, int32_t x1, int32_t y,  \
                                float *out, float *const bent[3])                        \
    {                                                                                    \
        crv__bent_row(f, x0, x1, y, out, bent, within, inner_bent, general_bent);        \
    }

#endif

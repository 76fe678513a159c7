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

/* The pixels that a vector stands for. */
typedef struct crv__pixels {
    int32_t y;
    vi x;
    vm active;    /* lanes whose result counts; the others hold no surface */
    vf depth;     /* layer 0; 1 where not active */
    crv__v3 P, n; /* surface point and normal; n = (0, 0, 1) where not active */
    vf cos_alpha, sin_alpha, beta; /* of the noise tile */
} crv__pixels;

/* crv__unproject() for pixel coordinates and depths by lane. */
CRV__INLINE crv__v3 crv__lanes_unproject(const crv__params *p, vi x, vi y, vf d)
{
    const vf half = vf_set(0.5f), scale = p->orthographic ? vf_set(1) : d;
    const vf up = (vf_of(y) + half - vf_set(p->cy)) * vf_set(p->inv_fy) * scale;
    return (crv__v3){(vf_of(x) + half - vf_set(p->cx)) * vf_set(p->inv_fx) * scale, -up,
                     -d};
}

/* Texels of a plane that holds all buffers' pixels. u, v: inside where the mask is set.
 */
CRV__INLINE vf crv__lanes_read(const crv__plane *plane, vi u, vi v, vm mask)
{
    return vf_gather(plane->data, v * vi_set((int32_t)plane->pitch) + u, mask);
}

CRV__INLINE void crv__lanes_noise(const crv__frame *f, crv__pixels *at, int32_t x,
                                  int32_t y)
{
    const crv__params *p = f->params;
    const crv__noise_texel *row =
        f->noise + (y + p->noise_y) % p->noise_size * p->noise_size;
    float lanes[3][CRV__LANES];
    int32_t column = (x + p->noise_x) % p->noise_size;
    for (int32_t i = 0; i < CRV__LANES; i++) {
        lanes[0][i] = row[column].cos_alpha;
        lanes[1][i] = row[column].sin_alpha;
        lanes[2][i] = row[column].beta;
        column = column + 1 < p->noise_size ? column + 1 : 0;
    }
    at->cos_alpha = vf_load(lanes[0]);
    at->sin_alpha = vf_load(lanes[1]);
    at->beta = vf_load(lanes[2]);
}

/* The pixels from (x, y) on, `count` of them, at most CRV__LANES. */
CRV__INLINE crv__pixels crv__pixels_at(const crv__frame *f, int32_t x, int32_t y,
                                       int32_t count)
{
    crv__pixels at = {.y = y, .x = vi_set(x) + vi_iota()};
    const vf depth = vf_load_n(crv__plane_at(&f->depth[0], x, y), count);
    at.active = vm_and(vm_first(count), vf_lt(depth, vf_set(INFINITY)));
    at.depth = vf_select(at.active, depth, vf_set(1));
    at.P = crv__lanes_unproject(f->params, at.x, vi_set(y), at.depth);
    at.n.x = vf_where(at.active, vf_load_n(crv__plane_at(&f->normal[0], x, y), count));
    at.n.y = vf_where(at.active, vf_load_n(crv__plane_at(&f->normal[1], x, y), count));
    at.n.z = vf_select(at.active, vf_load_n(crv__plane_at(&f->normal[2], x, y), count),
                       vf_set(1));
    crv__lanes_noise(f, &at, x, y);
    return at;
}

/* crv__turned(). */
CRV__INLINE void crv__lanes_turned(const crv__pixels *at, float x, float y, vf *turned_x,
                                   vf *turned_y)
{
    *turned_x = vf_set(x) * at->cos_alpha - vf_set(y) * at->sin_alpha;
    *turned_y = vf_set(x) * at->sin_alpha + vf_set(y) * at->cos_alpha;
}

/* crv__stratum(). */
CRV__INLINE vf crv__lanes_stratum(const crv__pixels *at, int32_t k)
{
    const vf x = vf_set(0.5f) + vf_set(0.5f) * at->beta + vf_set(0.618034f * (float)k);
    return x - vf_floor(x);
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

/* Runs a method over a row: see crv__estimate_kernel. */
CRV__INLINE void crv__estimate_row(const crv__frame *f, int32_t x0, int32_t x1, int32_t y,
                                   float *out,
                                   vf (*accessibility)(const crv__frame *,
                                                       const crv__pixels *))
{
    const vf one = vf_set(1), intensity = vf_set(f->params->intensity);
    for (int32_t x = x0; x < x1; x += CRV__LANES) {
        const int32_t count = x1 - x < CRV__LANES ? x1 - x : CRV__LANES;
        const crv__pixels at = crv__pixels_at(f, x, y, count);
        vf result = one;
        if (vm_any(at.active))
            result = vf_select(
                at.active, vf_clamp01(one - intensity * (one - accessibility(f, &at))),
                one);
        vf_store_n(out + (x - x0), result, count);
    }
}

/* Defines the kernel of a method from its static function accessibility(). */
#define CRV__ESTIMATE_KERNEL(name)                                                       \
    void CRV__NAME(name)(const crv__frame *f, int32_t x0, int32_t x1, int32_t y,         \
                         float *out);                                                    \
    void CRV__NAME(name)(const crv__frame *f, int32_t x0, int32_t x1, int32_t y,         \
                         float *out)                                                     \
    {                                                                                    \
        crv__estimate_row(f, x0, x1, y, out, accessibility);                             \
    }

#endif

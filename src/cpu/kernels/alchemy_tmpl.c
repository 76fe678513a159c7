/* SPDX-License-Identifier: MIT */
/* methods/alchemy.c for the lanes of a vector. */
#include "cpu/kernels/lanes.h"

/* sample_count(), and the largest of them in *most. */
CRV__INLINE vf sample_counts(const crv__params *p, vf radius_px, int32_t *most)
{
    *most = p->samples;
    if (p->bands == 1)
        return vf_set((float)p->samples);
    float lanes[CRV__LANES];
    const vf band = vf_set((float)p->bands) * radius_px / vf_set(p->band_px);
    vf_store(lanes, -vf_floor(-band));
    *most = 1;
    for (int32_t i = 0; i < CRV__LANES; i++) {
        const int32_t used = lanes[i] < (float)p->bands
                                 ? (lanes[i] > 1 ? (int32_t)lanes[i] : 1)
                                 : p->bands;
        const int32_t count = (p->samples * used + p->bands - 1) / p->bands;
        lanes[i] = (float)count;
        *most = count > *most ? count : *most;
    }
    return vf_load(lanes);
}

/* The shaded points. Slopes x / d and y / d of view rays are linear in the pixel: slope *
 * u + start. */
typedef struct view {
    float slope_x, slope_y;
    vf start_x, start_y;
    crv__v3 P; /* rounded as the samples are, so that P's own texel is at no distance */
    vf bias;
} view;

CRV__INLINE view view_of(const crv__params *p, crv__shape shape, const crv__pixels *at)
{
    view eye = {.slope_x = p->inv_fx,
                .slope_y = -p->inv_fy,
                .start_x = vf_set((0.5f - p->cx) * p->inv_fx),
                .start_y = vf_set((p->cy - 0.5f) * p->inv_fy),
                .bias = at->depth * vf_set(p->alchemy_bias)};
    const vf scale = shape.orthographic ? vf_set(1) : at->depth;
    eye.P.x = vf_fma(vf_of(at->x), vf_set(eye.slope_x), eye.start_x) * scale;
    eye.P.y = vf_fma(vf_set((float)at->y), vf_set(eye.slope_y), eye.start_y) * scale;
    return eye;
}

/* The term of eq. 10 for the samples at texels (u, v). */
CRV__INLINE vf terms(const crv__frame *f, crv__shape shape, const crv__pixels *at,
                     const view *eye, vi u, vi v, vm open)
{
    const crv__params *p = f->params;
    const crv__v3 n = at->n;
    const vf radius2 = vf_set(p->radius * p->radius);
    const vf eps = vf_set(p->alchemy_eps * p->radius * p->radius);
    const vi index = crv__lanes_index(&f->depth[0], u, v);
    const vf x = vf_fma(vf_of(u), vf_set(eye->slope_x), eye->start_x);
    const vf y = vf_fma(vf_of(v), vf_set(eye->slope_y), eye->start_y);
    vf sum = vf_zero();
    for (int32_t layer = 0; layer < shape.layers; layer++) {
        const vf d = vf_gather(f->depth[layer].data, index, open);
        crv__v3 to = {x - eye->P.x, y - eye->P.y, at->depth - d};
        if (!shape.orthographic) {
            to.x = x * d - eye->P.x;
            to.y = y * d - eye->P.y;
        }
        const vf squared = vf_fma(to.x, to.x, vf_fma(to.y, to.y, to.z * to.z));
        /* Background is infinitely far away. A layer behind may lie within the radius. */
        const vm in = vm_and(open, vf_le(squared, radius2));
        const vf along =
            vf_fma(to.x, n.x, vf_fma(to.y, n.y, vf_fma(to.z, n.z, -eye->bias)));
        sum = sum + vf_where(in, vf_max(along, vf_zero()) / (squared + eps));
        if (shape.layers == 1)
            break;
        open = vm_and(open, vm_not(in));
    }
    return sum;
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    const crv__params *p = f->params;
    const vf half = vf_set(0.5f), unit = shape.orthographic ? vf_set(1) : at->depth;
    const vf radius_x = vf_set(p->radius * p->fx) / unit;
    const vf radius_y = vf_set(p->radius * p->fy) / unit;
    int32_t most;
    const vf count = sample_counts(p, vf_max(radius_x, radius_y), &most);
    const vf centre_x = vf_of(at->x) + half, centre_y = vf_set((float)at->y + 0.5f);
    const view eye = view_of(p, shape, at);
    const vi width = vi_set(p->width), height = vi_set(p->height);
    vf sum = vf_zero();
    for (int32_t i = 0; i < most; i++) {
        vf x, y;
        crv__lanes_point(at, i, &x, &y);
        const vi u = vi_floor(centre_x + x * radius_x);
        const vi v = vi_floor(centre_y - y * radius_y);
        vm in = at->active;
        if (!shape.within)
            in = vm_and(in, vm_and(vi_below(u, width), vi_below(v, height)));
        if (p->bands > 1)
            in = vm_and(in, vf_lt(vf_set((float)i), count));
        sum = sum + terms(f, shape, at, &eye, u, v, in);
    }
    return vf_set(1) - vf_set(2 * p->radius) * sum / count;
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    const crv__params *p = f->params;
    return crv__lanes_disk_within(p, at, vf_set(p->radius * p->fx) / at->depth,
                                  vf_set(p->radius * p->fy) / at->depth);
}

CRV__ESTIMATE_KERNEL(alchemy, 1)

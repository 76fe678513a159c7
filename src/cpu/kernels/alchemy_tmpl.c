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

/* The term of eq. 10 for the samples at texels (u, v). */
CRV__INLINE vf terms(const crv__frame *f, crv__shape shape, const crv__pixels *at, vi u,
                     vi v, vm open, vf bias)
{
    const crv__params *p = f->params;
    const vf radius2 = vf_set(p->radius * p->radius);
    const vf eps = vf_set(p->alchemy_eps * p->radius * p->radius);
    const vi index = crv__lanes_index(&f->depth[0], u, v);
    vf sum = vf_zero();
    for (int32_t layer = 0; layer < shape.layers; layer++) {
        const vf depth = vf_gather(f->depth[layer].data, index, open);
        const crv__v3 to =
            crv__v3_sub(crv__lanes_unproject_at(p, shape, u, v, depth), at->P);
        const vf squared = crv__v3_dot(to, to);
        /* Background is infinitely far. A layer behind may lie within the radius. */
        const vm in = vm_and(open, vf_le(squared, radius2));
        const vf rise = vf_max(crv__v3_dot(to, at->n) - bias, vf_zero());
        sum = sum + vf_where(in, rise / (squared + eps));
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
    const vf bias = at->depth * vf_set(p->alchemy_bias);
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
        sum = sum + terms(f, shape, at, u, v, in, bias);
    }
    return vf_set(1) - vf_set(2 * p->radius) * sum / count;
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    const crv__params *p = f->params;
    return crv__lanes_disk_within(p, at, vf_set(p->radius * p->fx) / at->depth,
                                  vf_set(p->radius * p->fy) / at->depth);
}

CRV__ESTIMATE_KERNEL(alchemy)

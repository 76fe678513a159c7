/* SPDX-License-Identifier: MIT */
/* methods/hsao.c for the lanes of a vector. */
#include "cpu/kernels/march.h"

/* A slice and its horizon so far. */
typedef struct slice {
    crv__v3 t;            /* the tangent */
    crv__v3 h;            /* the horizon ray's direction */
    vf height, occlusion; /* see the scalar code */
    vf weight;            /* of what raised the horizon last */
    vf below_t, below_n;  /* Z(H) */
    vf blocked_t, blocked_n;
} slice;

/* directions_below() of the scalar code */
CRV__INLINE void directions_below(vf height, vf *along_t, vf *along_n)
{
    const vf mean = vf_set(CRV__BENT_COSINE), one = vf_set(1);
    const vf rest = vf_max(one - height * height, vf_zero());
    *along_t = mean * (one - rest * vf_sqrt(rest));
    *along_n = mean * height * height * height;
}

CRV__INLINE void raise_vectors(slice *s, vf height, vf weight, vm raise)
{
    vf t, n;
    directions_below(height, &t, &n);
    s->blocked_t = s->blocked_t + vf_where(raise, (t - s->below_t) * weight);
    s->blocked_n = s->blocked_n + vf_where(raise, (n - s->below_n) * weight);
    s->below_t = vf_select(raise, t, s->below_t);
    s->below_n = vf_select(raise, n, s->below_n);
}

/* Raises the horizon where the look of step i is blocked. */
CRV__INLINE void raise_horizon(const crv__frame *f, crv__shape shape, crv__v3 origin,
                               crv__v3 n, const crv__lookup *look, int32_t i, slice *s,
                               bool with_vectors)
{
    const crv__params *p = f->params;
    const crv__v3 t = s->t;
    crv__v3 to;
    vf squared;
    vm raise = crv__lanes_blocked(f, shape, origin, look, &to, &squared);
    const vf along_t = crv__v3_dot(to, t), along_n = crv__v3_dot(to, n);
    /* Above the horizon there is only what is above the tangent. */
    raise = vm_and(raise, vm_and(vf_lt(vf_zero(), along_t), vf_lt(vf_zero(), along_n)));
    /* The height turns the next positions: it is rounded as the scalar code's. */
    const vf scale = vf_set(1) / vf_sqrt(along_t * along_t + along_n * along_n);
    const vf height = along_n * scale, along = along_t * scale;
    const vf distance = crv__lanes_root(squared);
    raise = vm_and(raise, vf_lt(s->height, height));
    if (p->growing_sphere)
        raise = vm_and(raise,
                       vf_le(distance, vf_set((float)i * (p->radius / (float)p->steps))));
    const vf W = crv__lanes_falloff(p, distance * vf_set(p->inv_radius));
    const vf gain = height * height - s->height * s->height;
    s->occlusion = s->occlusion + vf_where(raise, gain * W);
    if (with_vectors)
        raise_vectors(s, height, W, raise);
    s->height = vf_select(raise, height, s->height);
    if (p->attenuation == CRV_ATTENUATION_HORIZON)
        s->weight = vf_select(raise, W, s->weight);
    s->h.x = vf_select(raise, height * n.x + along * t.x, s->h.x);
    s->h.y = vf_select(raise, height * n.y + along * t.y, s->h.y);
    s->h.z = vf_select(raise, height * n.z + along * t.z, s->h.z);
}

CRV__INLINE void trace_horizons(const crv__frame *f, crv__shape shape,
                                const crv__pixels *at, crv__v3 origin, int32_t count,
                                slice slices[CRV__MARCHES], bool with_vectors)
{
    const crv__params *p = f->params;
    crv__lookup looks[CRV__MARCHES];
    for (int32_t i = 1; i <= p->steps; i++) {
        const vf step = crv__lanes_step(p, at, i);
        for (int32_t k = 0; k < count; k++)
            crv__lanes_look_up(f, shape, crv__v3_add_scaled(origin, slices[k].h, step),
                               at->active, &looks[k]);
        for (int32_t k = 0; k < count; k++) {
            if (vm_any(looks[k].open))
                raise_horizon(f, shape, origin, at->n, &looks[k], i, &slices[k],
                              with_vectors);
        }
    }
    for (int32_t k = 0; k < count && p->attenuation == CRV_ATTENUATION_HORIZON; k++) {
        slices[k].occlusion = slices[k].height * slices[k].height * slices[k].weight;
        if (with_vectors) {
            slices[k].blocked_t = slices[k].below_t * slices[k].weight;
            slices[k].blocked_n = slices[k].below_n * slices[k].weight;
        }
    }
}

/* What the rays above the horizons hit, added to the slices' occlusion and, if they are
 * not NULL, to the sums. */
CRV__INLINE void add_normal_rays(const crv__frame *f, crv__shape shape,
                                 const crv__pixels *at, crv__v3 origin, int32_t first,
                                 int32_t count, slice slices[CRV__MARCHES],
                                 crv__lanes_sums *sums)
{
    const crv__params *p = f->params;
    const vf rays = vf_set((float)p->normal_rays), one = vf_set(1);
    crv__v3 directions[CRV__MARCHES];
    vf weights[CRV__MARCHES], blocked[CRV__MARCHES];
    for (int32_t k = 0; k < count; k++)
        blocked[k] = vf_zero();
    for (int32_t ray = 0; ray < p->normal_rays; ray++) {
        for (int32_t k = 0; k < count; k++) {
            const vf squared = slices[k].height * slices[k].height;
            const vf stratum = vf_set((float)ray) + crv__lanes_stratum(at, first + k);
            directions[k] = crv__lanes_raised(at->n, slices[k].t,
                                              squared + (one - squared) * stratum / rays);
        }
        crv__lanes_march(f, shape, at, origin, count, directions, weights);
        for (int32_t k = 0; k < count; k++)
            blocked[k] = blocked[k] + weights[k];
        for (int32_t k = 0; sums && k < count; k++) {
            const vf rest = one - slices[k].height * slices[k].height;
            crv__lanes_bent_add(sums, directions[k], rest / rays, weights[k]);
        }
    }
    for (int32_t k = 0; k < count && p->normal_rays > 0; k++) {
        const vf rest = one - slices[k].height * slices[k].height;
        slices[k].occlusion = slices[k].occlusion + rest * blocked[k] / rays;
    }
}

CRV__INLINE crv__v3 in_slice(crv__v3 n, crv__v3 t, vf along_t, vf along_n)
{
    return (crv__v3){along_t * t.x + along_n * n.x, along_t * t.y + along_n * n.y,
                     along_t * t.z + along_n * n.z};
}

/* add_horizon() of the scalar code */
CRV__INLINE void add_horizon(crv__lanes_sums *sums, const crv__params *p, crv__v3 n,
                             const slice *s)
{
    const vf one = vf_set(1);
    vf end_t = s->below_t, end_n = s->below_n;
    if (p->normal_rays <= 0)
        directions_below(one, &end_t, &end_n);
    const crv__v3 blocked = in_slice(n, s->t, s->blocked_t, s->blocked_n);
    const crv__v3 all = in_slice(n, s->t, end_t, end_n);
    sums->blocked = crv__v3_add_scaled(sums->blocked, blocked, one);
    sums->open = crv__v3_add_scaled(sums->open, crv__v3_sub(all, blocked), one);
}

CRV__INLINE vf estimate(const crv__frame *f, crv__shape shape, const crv__pixels *at,
                        crv__v3 *bent)
{
    const crv__params *p = f->params;
    const vf zero = vf_zero();
    const crv__v3 origin = crv__lanes_lift(p, shape, at->P, at->n);
    crv__v3 tangent, bitangent;
    crv__lanes_tangents(at->n, &tangent, &bitangent);
    vf occlusion = zero;
    crv__lanes_sums sums = crv__lanes_no_sums();
    for (int32_t first = 0; first < p->directions; first += CRV__MARCHES) {
        const int32_t rest = p->directions - first;
        const int32_t count = rest < CRV__MARCHES ? rest : CRV__MARCHES;
        slice slices[CRV__MARCHES];
        for (int32_t k = 0; k < count; k++) {
            const crv__v3 t = crv__lanes_slice_tangent(at, first + k, tangent, bitangent);
            slices[k] = (slice){.t = t,
                                .h = t,
                                .height = zero,
                                .occlusion = zero,
                                .weight = zero,
                                .below_t = zero,
                                .below_n = zero,
                                .blocked_t = zero,
                                .blocked_n = zero};
        }
        trace_horizons(f, shape, at, origin, count, slices, bent);
        add_normal_rays(f, shape, at, origin, first, count, slices, bent ? &sums : NULL);
        for (int32_t k = 0; k < count; k++)
            occlusion = occlusion + slices[k].occlusion;
        for (int32_t k = 0; bent && k < count; k++)
            add_horizon(&sums, p, at->n, &slices[k]);
    }
    const vf A = vf_set(1) - occlusion / vf_set((float)p->directions);
    if (bent)
        *bent = crv__lanes_bent_normal(&sums, at->n, A,
                                       vf_set(CRV__BENT_COSINE * (float)p->directions));
    return A;
}

CRV__INLINE vf accessibility(const crv__frame *f, crv__shape shape, const crv__pixels *at)
{
    return estimate(f, shape, at, NULL);
}

CRV__INLINE int within(const crv__frame *f, const crv__pixels *at)
{
    return crv__march_within(f, at);
}

CRV__ESTIMATE_KERNEL(hsao, 1)

CRV__BENT_KERNEL(hsao)

/* SPDX-License-Identifier: MIT */
/*
 * Ground-truth ambient occlusion.
 * Jorge Jimenez, Xian-Chun Wu, Angelo Pesce, Adrian Jarabo: Practical Realtime Strategies
 * for Accurate Indirect Occlusion, SIGGRAPH 2016 courses.
 *
 * In every slice through the eye the horizon is the smallest angle from V under which a
 * surface is seen. Each sample that lowers it blocks the directions between: occ = Sum
 * (u - u') W(r). src/methods/gtao.c is the specification.
 */
#ifndef GTAO_GLSL
#define GTAO_GLSL

#include "slice.glsl"

const int ATTENUATION_SLAB = 0;

/* A slice so far. */
struct Horizon {
    float cosine;
    float open; /* u of the horizon: the share above it */
    float occlusion;
    float weight; /* W of the horizon's own sample */
    vec2 vector;  /* G of the horizon */
    vec2 blocked; /* K */
};

void add_sample(inout Horizon h, SliceSite site, Slice s, vec2 point)
{
    const float x = point.x, z = point.y, r = sqrt(x * x + z * z), cosine = z / r;
    if (!(x > 0 && r < params.radius && cosine > h.cosine))
        return;
    const float open = slice_share(site, s, cosine, x / r);
    const float W = falloff_within(r * params.inv_radius);
    h.occlusion += max(0, h.open - open) * W;
    h.cosine = cosine;
    h.open = min(h.open, open);
    h.weight = W;
    if (BENT_NORMAL != 0) {
        const vec2 vector = slice_vector(site.a, s.b, cosine, x / r);
        h.blocked += (h.vector - vector) * W;
        h.vector = vector;
    }
}

float blocked_share(SliceSite site, Slice s, out SliceVectors vectors)
{
    vec2 all = vec2(0);
    if (BENT_NORMAL != 0)
        all = slice_vector(site.a, s.b, s.cos_tangent, s.sin_tangent);
    Horizon h = Horizon(s.cos_tangent, 1, 0, 0, all, vec2(0));
    for (int i = 0; i < step_count(); i++) {
        SliceTexel texel;
        if (!slice_texel(site, s, i, texel))
            break;
        for (int layer = 0; layer < layer_count(); layer++) {
            const float d = slice_depth(layer, texel);
            if (is_surface(d))
                add_sample(h, site, s, slice_point(site, s, texel, d));
        }
    }
    const vec2 K = attenuation_kind() == ATTENUATION_SLAB ? h.blocked
                                                          : (all - h.vector) * h.weight;
    vectors = SliceVectors(all - K, K);
    return attenuation_kind() == ATTENUATION_SLAB ? h.occlusion
                                                  : (1 - h.open) * h.weight;
}

#endif

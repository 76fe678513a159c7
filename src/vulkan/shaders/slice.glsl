/* SPDX-License-Identifier: MIT */
/*
 * Slices through the eye: what gtao and bitmask share. src/methods/slice.h has the
 * equations and says why.
 */
#ifndef SLICE_GLSL
#define SLICE_GLSL

#include "bent.glsl"
#include "falloff.glsl"
#include "frame.glsl"

const int SLICE_WEIGHTING_UNIFORM = 0; /* crv_weighting */
const int SLICE_BORDER_BACKGROUND = 1; /* crv_border */
const float SLICE_FARTHEST_PX = 131072; /* four times as far as pictures are large */

/* The shaded point. */
struct SliceSite {
    ivec2 at;
    float depth;
    float unit; /* of offsets on the image plane: the depth; orthographic: 1 */
    vec3 n;
    vec3 ray; /* view ray at unit depth */
    vec3 V;
    float a;
    float lift;     /* of P along V, over its depth; orthographic: as it is */
    float nearness; /* 1/unit, less if the radius would project beyond max_radius_px */
};

struct Slice {
    vec3 T;
    float b, weight;
    float cos_tangent, sin_tangent;
    float total;   /* Ft */
    float inverse; /* 1 / Ft */
    vec2 way;      /* unit vector in the image, to the right and down */
    float length_px;
    float jitter;        /* j_k in [0, 1): of the samples */
    float sector_offset; /* zeta_k in [0, 1): of bitmask's sectors */
};

SliceSite slice_site(ivec2 at, float d)
{
    SliceSite s;
    s.at = at;
    s.depth = d;
    s.unit = view_unit(d);
    s.n = normal_at(at);
    s.ray = vec3(0, 0, -1);
    s.V = vec3(0, 0, 1);
    if (!is_orthographic()) {
        s.ray.x = (float(at.x) + 0.5 - params.cx) * params.inv_fx;
        s.ray.y = -(float(at.y) + 0.5 - params.cy) * params.inv_fy;
        const float inverse = 1 / sqrt(dot(s.ray, s.ray));
        s.V = vec3(-s.ray.x * inverse, -s.ray.y * inverse, inverse);
    }
    s.a = max(dot(s.n, s.V), 0.02);
    s.lift = max(params.inv_fx, params.inv_fy) * max(0.0, 0.25 - 0.5 * s.a) / s.a;
    precise float largest = max(params.fx, params.fy) * params.radius / s.unit;
    precise float nearness = 1 / s.unit;
    precise float capped = nearness * (params.max_radius_px / largest);
    s.nearness = largest > params.max_radius_px ? capped : nearness;
    return s;
}

/* theta - sin cos of the angle of these cosine and sine. */
float slice_segment(float cosine, float sine)
{
    const float Q =
        1.57020562 + sine * (0.02568289 + sine * (0.60547927 - sine * 0.20501906));
    return 1.57079633 - cosine * Q;
}

/* F at the angle of these cosine and sine. */
float slice_measure(float a, float b, float cosine, float sine)
{
    if (params.weighting == SLICE_WEIGHTING_UNIFORM)
        return 1 - cosine;
    return 0.5 * (a * sine * sine + b * slice_segment(cosine, sine));
}

/* G at this angle: x along T, y along V. */
vec2 slice_vector(float a, float b, float cosine, float sine)
{
    if (params.weighting == SLICE_WEIGHTING_UNIFORM)
        return 0.5 * vec2(slice_segment(cosine, sine), sine * sine);
    const float sine3 = sine * sine * sine, rest = 1 - cosine;
    /* 2 - 3 c + c^3 and 1 - c^3, without the difference of what is nearly alike. */
    const vec2 along =
        vec2(rest * rest * (2 + cosine), rest * (1 + cosine + cosine * cosine));
    return (vec2(a, b) * sine3 + vec2(b, a) * along) * (1.0 / 3);
}

/* u = F/Ft, in [0, 1]. */
float slice_share(SliceSite site, Slice s, float cosine, float sine)
{
    return clamp(slice_measure(site.a, s.b, cosine, sine) * s.inverse, 0.0, 1.0);
}

/* The k-th slice; false if its measure is nothing. */
bool slice_at(SliceSite site, crv__noise_texel noise, int k, out Slice s)
{
    const vec2 D = direction_at(noise, k);
    const vec3 V = site.V;
    const float DV = dot(D, V.xy), squared = 1 - DV * DV;
    const float scale = 1 / sqrt(squared);
    s.T = vec3((D.x - DV * V.x) * scale, (D.y - DV * V.y) * scale, -DV * V.z * scale);
    s.b = dot(site.n, s.T);
    s.weight = 1 / squared;
    const float inverse = 1 / sqrt(site.a * site.a + s.b * s.b);
    s.cos_tangent = -s.b * inverse;
    s.sin_tangent = site.a * inverse;
    s.total = slice_measure(site.a, s.b, s.cos_tangent, s.sin_tangent);
    s.inverse = 1 / s.total;
    precise vec2 px = vec2(D.x * params.fx, -D.y * params.fy);
    precise float squared_px = px.x * px.x + px.y * px.y;
    precise float length_px = sqrt(squared_px);
    precise vec2 way = px / length_px;
    precise float radius_px = params.radius * site.nearness * length_px;
    s.way = way;
    s.length_px = radius_px;
    s.jitter = stratum_at(noise, k);
    precise float offset = noise.sector_offset + 0.754878 * float(k);
    s.sector_offset = offset - floor(offset);
    return s.total > 1e-7;
}

/* The texel of a sample, and the cell of the spacing that the sample stands for, its ends
 * in units of the sample's distance. */
struct SliceTexel {
    ivec2 texel;
    float near, far;
};

/* crv_spacing: quadratic */
float slice_spaced(float t)
{
    precise float share = t / float(step_count());
    precise float squared = share * share;
    return spacing_kind() == 1 ? squared : share;
}

/* The i-th sample; false if it is farther off than pictures are large. */
bool slice_texel(SliceSite site, Slice s, int i, out SliceTexel t)
{
    precise float distance_px =
        max(1.0, slice_spaced(float(i) + s.jitter) * s.length_px);
    t = SliceTexel(site.at, 1, 1);
    if (!(distance_px < SLICE_FARTHEST_PX))
        return false;
    precise vec2 place = vec2(site.at) + 0.5 + distance_px * s.way;
    t.texel = ivec2(floor(place));
    t.near = min(1.0, max(0.5, slice_spaced(float(i)) * s.length_px) / distance_px);
    t.far = max(1.0, slice_spaced(float(i + 1)) * s.length_px / distance_px);
    return true;
}

/* What is linear over the image of a plane: 1/d, orthographic d. */
float slice_linear(ivec2 texel)
{
    const float d = depth_at(texel, 0);
    return is_orthographic() ? d : 1 / d;
}

/* Its change over one texel outwards at a border, from four texels inwards; 0 if the
 * surface is not planar or the picture is smaller. */
float slice_outward(ivec2 texel, ivec2 inwards, float own)
{
    if (!in_buffers(texel + 4 * inwards))
        return 0;
    const float middle = slice_linear(texel + 2 * inwards);
    const float inner = slice_linear(texel + 4 * inwards);
    const bool is_planar = inner > 0 && abs(own - 2 * middle + inner) < 0.01 * own;
    return is_planar ? 0.25 * (own - inner) : 0;
}

/* The first layer's depth beyond the borders: planes go on, up to a third of the border's
 * own; beyond three times that there is nothing. A loop, since few samples lie beyond two
 * borders. */
float slice_beyond(ivec2 texel, ivec2 by)
{
    const float own = slice_linear(texel);
    float w = own;
    for (int axis = by.x != 0 ? 0 : 1; axis < 2; axis++) {
        const ivec2 along = axis == 0 ? ivec2(by.x, 0) : ivec2(0, by.y);
        if (along == ivec2(0))
            break;
        w += slice_outward(texel, -sign(along), own) * float(abs(along.x + along.y));
    }
    if (is_orthographic())
        return w > 3 * own ? INFINITY : max(own / 3, w);
    return w < own / 3 ? INFINITY : 1 / min(3 * own, w);
}

/* The depth of a layer at a texel; INFINITY: background. */
float slice_depth(int layer, SliceTexel t)
{
    const ivec2 last = ivec2(params.width - 1, params.height - 1);
    const ivec2 texel = clamp(t.texel, ivec2(0), last);
    const float d = depth_at(texel, layer);
    if (texel == t.texel)
        return d;
    if (layer > 0 || params.border == SLICE_BORDER_BACKGROUND || !is_surface(d))
        return INFINITY;
    return slice_beyond(texel, t.texel - texel);
}

/* The surface at a texel and depth, on the slice: x from P along T, z towards the eye. */
vec2 slice_point(SliceSite site, Slice s, SliceTexel t, float depth)
{
    const vec2 offset = image_offset(site.at, t.texel);
    const vec2 ray = is_orthographic() ? site.ray.xy : site.ray.xy + offset;
    /* Small differences first: depth is large. */
    const float behind = depth - site.depth;
    const vec3 v = vec3(behind * ray + site.unit * offset, -behind);
    const float x = dot(v, s.T);
    const float lift = is_orthographic() ? site.lift : site.lift * depth;
    return vec2(x, (dot(v, site.n) - s.b * x) / site.a - lift);
}

/* O and K of a slice: x along T, y along V. */
struct SliceVectors {
    vec2 open, blocked;
};

/* The blocked share of a slice's measure, and vectors if BENT_NORMAL is 1: the method's
 * own. */
float blocked_share(SliceSite site, Slice s, out SliceVectors vectors);

vec3 in_space(SliceSite site, Slice s, vec2 vector)
{
    return s.weight * (vector.x * s.T + vector.y * site.V);
}

/* A of a pixel: the open share of all slices. */
float accessibility(ivec2 at, float d)
{
    const crv__noise_texel noise = noise_at(at);
    const SliceSite site = slice_site(at, d);
    vec2 sums = sums_before(at); /* blocked, total */
    BentSums bent = bent_sums_before(at);
    for (int k = part_begin(); k < part_end(direction_count()); k++) {
        Slice s;
        if (!slice_at(site, noise, k, s))
            continue;
        SliceVectors vectors;
        sums += s.weight * s.total * vec2(blocked_share(site, s, vectors), 1);
        if (BENT_NORMAL != 0) {
            bent.open += in_space(site, s, vectors.open);
            bent.blocked += in_space(site, s, vectors.blocked);
        }
    }
    keep_bent_sums(at, sums, bent);
    const float a = sums.y > 0 ? 1 - sums.x / sums.y : 1;
    const float h =
        params.weighting == SLICE_WEIGHTING_UNIFORM ? BENT_UNIFORM : BENT_COSINE;
    if (BENT_NORMAL != 0)
        bent_normal = bent_of(bent, site.n, a, h * sums.y);
    return a;
}

#endif

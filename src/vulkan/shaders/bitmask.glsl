/* SPDX-License-Identifier: MIT */
/*
 * Ambient occlusion by a visibility bit mask, with a thickness that grows with what is
 * seen.
 * Olivier Therrien, Yannick Levesque, Guillaume Gilet: Screen Space Indirect Lighting
 * with Visibility Bitmask, The Visual Computer 2023.
 *
 * Every slice through the eye is cut into 32 sectors of equal measure. A sample is the
 * front of a body of some thickness, blocks the sectors from its front to its back, and
 * light passes behind it. src/methods/bitmask.c is the specification.
 */
#ifndef BITMASK_GLSL
#define BITMASK_GLSL

#include "slice.glsl"

/* crv_thickness */
const int THICKNESS_WIDTH = 0, THICKNESS_RUN = 1, THICKNESS_LAYERS = 3;
const float SECTOR_COUNT = 32;
const float GROUP_SECTORS = 4;
const float FALLOFF_END = 0.99999994; /* just below 1 */

/* A slice so far. */
struct Sectors {
    uint mask;
    float occlusion;
    float start;          /* x0 */
    float last_x, last_z; /* of the sample before */
    bool is_new;          /* that one was background */
    vec4 near, far;       /* W_g of groups 0 to 3 and 4 to 7 */
};

/* A surface seen at a texel. */
struct Body {
    float x, z; /* of its front */
    float thickness;
};

/* u at the angle of (x, z); 1 below the tangent. */
float sector_share(SliceSite site, Slice s, float x, float z)
{
    const float inverse = 1 / sqrt(x * x + z * z);
    const float cosine = z * inverse;
    return cosine > s.cos_tangent ? slice_share(site, s, cosine, x * inverse) : 1;
}

/* All sectors from this one on. */
uint sectors_from(float sector)
{
    const float first = max(0.0, ceil(sector));
    return first < SECTOR_COUNT ? 0xffffffffu << uint(first) : 0u;
}

void add_body(inout Sectors to, SliceSite site, Slice s, SliceTexel texel, Body b)
{
    const float R = params.radius;
    const float front_x = b.x * (1 - 0.3 * (1 - texel.near)), back_x = b.x * texel.far;
    const float end = sqrt(max(0.0, R * R - front_x * front_x));
    const float front_z = min(b.z - s.b / site.a * (front_x - b.x), end);
    const float back_z = max(b.z - b.thickness, -end);
    if (!(front_z > back_z))
        return;
    const float front = sector_share(site, s, front_x, front_z);
    const float back = sector_share(site, s, back_x, back_z);
    const uint bits = sectors_from(SECTOR_COUNT * front - s.sector_offset)
                      & ~sectors_from(SECTOR_COUNT * back - s.sector_offset);
    const uint new_bits = bits & ~to.mask;
    if (new_bits == 0u)
        return;
    to.mask |= bits;
    const float new_count = float(bitCount(new_bits));
    const float r = min(sqrt(b.x * b.x + b.z * b.z), R);
    const float middle = r - 0.7 * (r - b.x) * new_count / float(bitCount(bits));
    const float W = falloff_within(min(middle * params.inv_radius, FALLOFF_END));
    to.occlusion += W * new_count / SECTOR_COUNT;
    if (BENT_NORMAL != 0) {
        const uvec4 shift = uvec4(0, 4, 8, 12);
        to.near += W * vec4(bitCount(uvec4(new_bits) >> shift & 0xfu));
        to.far += W * vec4(bitCount(uvec4(new_bits) >> shift + 16 & 0xfu));
    }
}

/* The first surfaces at the samples begin and continue runs. */
void follow_run(inout Sectors to, vec2 point)
{
    if (to.is_new || point.y - to.last_z > 16 * (point.x - to.last_x))
        to.start = point.x;
    to.is_new = false;
    to.last_x = point.x;
    to.last_z = point.y;
}

/* The thickness of the first surface at the texel by what is seen of it, and of sheets
 * behind it. */
vec2 seen_thickness(Sectors so_far, ivec2 texel)
{
    const float least = 0.1 * params.radius, run = so_far.last_x - so_far.start;
    if (params.thickness_rule == THICKNESS_RUN)
        return max(vec2(2, 1) * run, least);
    if (params.thickness_rule == THICKNESS_WIDTH)
        return max(vec2(1, 0.5) * min(2.5 * run, map_at(texel)), least);
    return vec2(params.thickness);
}

/* The thickness of a surface at depth d if the next layer ends it; else `seen`. */
float ended_thickness(ivec2 texel, float d, float next, float seen)
{
    const vec2 ray = unproject(texel, 1).xy;
    const float gap = (next - d) * (is_orthographic() ? 1 : sqrt(dot(ray, ray) + 1));
    if (!is_surface(next) || !is_surface(abs(gap))) /* beyond all numbers */
        return seen;
    const bool is_back = layers_are_solid() || params.thickness_rule == THICKNESS_LAYERS;
    return is_back ? gap : min(seen, gap);
}

/* The first surface at a texel, and those behind it. */
void add_texel(inout Sectors to, SliceSite site, Slice s, SliceTexel t)
{
    vec2 seen = vec2(0);
    float d = slice_depth(0, t);
    if (!is_surface(d))
        to.is_new = true;
    for (int layer = 0; layer < layer_count() && is_surface(d);) {
        const vec2 point = slice_point(site, s, t, d);
        if (layer == 0) {
            follow_run(to, point);
            seen = seen_thickness(to, t.texel);
        }
        Body b = Body(point.x, point.y, layer == 0 ? seen.x : seen.y);
        if (layer + 1 < layer_count())
            b.thickness =
                ended_thickness(t.texel, d, slice_depth(layer + 1, t), b.thickness);
        if (point.x > 0)
            add_body(to, site, s, t, b);
        layer += layers_are_solid() ? 2 : 1;
        d = layer < layer_count() ? slice_depth(layer, t) : INFINITY;
    }
}

/* Sine and cosine of theta_g of four groups; u, v: u_g and v_g. */
void group_angles(Slice s, vec4 u, vec4 v, out vec4 sine, out vec4 cosine)
{
    if (params.weighting == SLICE_WEIGHTING_UNIFORM) {
        cosine = 1 - u * (1 - s.cos_tangent);
        sine = sqrt(max(vec4(0), 1 - cosine * cosine));
        return;
    }
    const float tangent = slice_segment(s.cos_tangent, s.sin_tangent)
                          + s.cos_tangent * s.sin_tangent;
    const float t = 0.63661977 * tangent - 1;
    const vec4 theta =
        0.5 * tangent * (1 + v * (1 - t * (0.13 + 0.1 * t) * (1 - v * v)));
    sine = sin(theta);
    cosine = cos(theta);
}

/* Adds four groups. */
void add_groups(inout SliceVectors sum, Slice s, vec4 blocked, vec4 u, vec4 v)
{
    vec4 sine, cosine;
    group_angles(s, u, v, sine, cosine);
    const vec4 share = s.total / SECTOR_COUNT * blocked,
               rest = s.total / SECTOR_COUNT * GROUP_SECTORS - share;
    sum.open += vec2(dot(rest, sine), dot(rest, cosine));
    sum.blocked += vec2(dot(share, sine), dot(share, cosine));
}

SliceVectors vectors_of(Sectors found, Slice s)
{
    const vec4 u = vec4(0.0625, 0.1875, 0.3125, 0.4375),
               v = vec4(0.69591, 0.43203, 0.2455, 0.08);
    SliceVectors sum = SliceVectors(vec2(0), vec2(0));
    if (BENT_NORMAL != 0) {
        add_groups(sum, s, found.near, u, -v);
        add_groups(sum, s, found.far, u + 0.5, v.wzyx);
    }
    return sum;
}

float blocked_share(SliceSite site, Slice s, out SliceVectors vectors)
{
    Sectors found = Sectors(0u, 0, 0, 0, 0, false, vec4(0), vec4(0));
    for (int i = 0; i < step_count(); i++) {
        SliceTexel texel;
        if (!slice_texel(site, s, i, texel))
            break;
        add_texel(found, site, s, texel);
    }
    vectors = vectors_of(found, s);
    return found.occlusion;
}

#endif

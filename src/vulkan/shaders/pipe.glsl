/* SPDX-License-Identifier: MIT */
/* Pipes: the part of a view ray inside a sphere, and how much of it is open.
 * src/methods/pipe.h */
#ifndef PIPE_GLSL
#define PIPE_GLSL

#include "frame.glsl"

/* A pipe goes along z of clip space (2010): the view ray of a texel's centre, on which
 * the depth buffer is exact. */
struct Pipe {
    ivec2 texel; /* may lie outside the buffers */
    float entry_z,
        exit_z; /* where the ray enters and leaves the sphere: planar depth less P's */
};

/*
 * The pipe through the sphere's centre + radius * the pattern's disk point, turned by the
 * noise, snapped to the nearest texel. The centre is P + `offset`, P the point of pixel
 * `at`; all is computed from P. False if the snapped ray misses the sphere, or the
 * sphere is not all in front of the eye.
 */
bool pipe_through(ivec2 at, vec3 P, vec3 offset, float radius, vec2 point,
                  crv__noise_texel noise, out Pipe pipe)
{
    pipe = Pipe(ivec2(0), 0, 0);
    const vec2 disk = turned(noise, point);
    const float d = -P.z, unit = view_unit(d - offset.z);
    /* Pixels from P's: the centre, and the disk point beside it. */
    precise float inverse = 1 / unit;
    precise vec2 scale = vec2(params.fx, params.fy) * inverse;
    precise float centre_x = params.cx + (P.x + offset.x) * scale.x - float(at.x);
    precise float centre_y = params.cy - (P.y + offset.y) * scale.y - float(at.y);
    precise float right = floor(centre_x + disk.x * radius * scale.x);
    precise float down = floor(centre_y - disk.y * radius * scale.y);
    /* Pixels this far out are background anyway, and no longer fit an integer. */
    if (!(unit > 0 && abs(right) < 1e9 && abs(down) < 1e9))
        return false;
    pipe.texel = at + ivec2(int(right), int(down));
    /* The ray's point at P's depth, from P. */
    precise vec3 aside = vec3(right * params.inv_fx * view_unit(d),
                              -down * params.inv_fy * view_unit(d), 0);
    precise vec3 ray =
        is_orthographic() ? vec3(0, 0, -1) : vec3((P.xy + aside.xy) / d, -1);
    /* |aside + t ray - offset|^2 = radius^2, about the point nearest to the centre. */
    precise vec3 to = offset - aside;
    precise float squared = dot(ray, ray);
    precise float middle = dot(to, ray) / squared;
    precise vec3 miss = to - ray * middle;
    precise float rest = radius * radius - dot(miss, miss);
    if (!(rest > 0))
        return false;
    precise float half_chord = sqrt(rest / squared);
    precise float entry_z = middle - half_chord;
    precise float exit_z = middle + half_chord;
    pipe.entry_z = entry_z;
    pipe.exit_z = exit_z;
    return is_orthographic() || d + entry_z > 0;
}

/* The length between two depths, `from` to `to` behind `origin`, that lies outside the
 * surfaces of the depth buffer at a texel: in front of the first layer, and in between
 * if layers come in pairs. */
float open_length(ivec2 texel, float origin, float from, float to)
{
    if (!in_buffers(texel))
        return to - from;
    float open = 0;
    for (int layer = 0; layer < layer_count() && from < to; layer += 2) {
        const float front = depth_at(texel, layer) - origin;
        if (front > from)
            open += min(front, to) - from;
        if (!layers_are_solid() || layer + 1 >= layer_count() || front >= to)
            return open;
        from = max(from, depth_at(texel, layer + 1) - origin);
    }
    return from < to ? open + (to - from) : open;
}

#endif

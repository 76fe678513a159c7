/* SPDX-License-Identifier: MIT */
/*
 * Horizon-split ambient occlusion.
 * Rouslan Dimitrov, Louis Bavoil, Miguel Sainz: Horizon-Split Ambient Occlusion, 2008.
 *
 * In each of Nd slices around n a ray that starts in the tangent plane is deflected step
 * by step towards the surface points that it runs below of; the height H of its tip is
 * the horizon. Below H all is blocked (H^2, eq. 6), above H Nn rays look for what the
 * horizon cannot know (eq. 7): A = 1 - 1/Nd Sum [H^2 + (1 - H^2)/Nn Sum V].
 * src/methods/hsao.c
 */
#ifndef HSAO_GLSL
#define HSAO_GLSL

#include "march.glsl"

const int ATTENUATION_HORIZON = 1;

/* The horizon of one slice. */
struct Horizon {
    float height;    /* H: cosine between the horizon ray and n */
    float occlusion; /* of all below, falloff applied */
    vec2 below;      /* Z(H): x along t, y along n */
    vec2 blocked;    /* of it, falloff applied */
};

/* Z */
vec2 directions_below(float height)
{
    const float rest = max(0, 1 - height * height);
    return BENT_COSINE * vec2(1 - rest * sqrt(rest), height * height * height);
}

/* Deflects the horizon ray h towards origin + to if that raises the horizon. */
void raise_horizon(inout Horizon horizon, inout float weight, inout vec3 h, vec3 to,
                   vec3 n, vec3 t, float reached)
{
    const float distance = length(to), along_t = dot(to, t);
    if (!(along_t > 0) || (params.growing_sphere != 0 && distance > reached))
        return;
    /* The projection on the plane (n, t), normalised. */
    const float along_n = dot(to, n);
    precise float scale = 1 / sqrt(along_t * along_t + along_n * along_n);
    precise float height = along_n * scale;
    if (height <= horizon.height)
        return; /* hidden below the horizon already */
    weight = falloff(distance * params.inv_radius);
    horizon.occlusion += (height * height - horizon.height * horizon.height) * weight;
    horizon.height = height;
    if (BENT_NORMAL != 0) {
        const vec2 below = directions_below(height);
        horizon.blocked += (below - horizon.below) * weight;
        horizon.below = below;
    }
    precise vec3 direction = height * n + along_t * scale * t;
    h = direction;
}

Horizon traced_horizon(vec3 origin, vec3 n, vec3 t, float beta)
{
    Horizon result = Horizon(0, 0, vec2(0), vec2(0));
    float weight = 0;
    vec3 h = t;
    for (int i = 1; i <= step_count(); i++) {
        vec3 I;
        if (is_blocked(origin, stepped(origin, h, i, beta), I))
            raise_horizon(result, weight, h, I - origin, n, t,
                          float(i) * (params.radius / float(step_count())));
    }
    if (attenuation_kind() == ATTENUATION_HORIZON) {
        result.occlusion = result.height * result.height * weight;
        result.blocked = result.below * weight;
    }
    return result;
}

/* What the rays above the horizon hit: z^2 stratified between H^2 and 1 (eq. 7 to 11). */
float normal_occlusion(vec3 origin, vec3 n, vec3 t, float height, float stratum,
                       float beta, inout BentSums bent)
{
    precise float rest = 1 - height * height;
    float blocked = 0;
    for (int k = 0; k < normal_ray_count(); k++) {
        precise float z2 =
            height * height + rest * (float(k) + stratum) / float(normal_ray_count());
        const vec3 direction = raised(n, t, z2);
        const float hit = marched(origin, direction, beta);
        blocked += hit;
        if (BENT_NORMAL != 0)
            bent_add(bent, direction, rest / float(normal_ray_count()), hit);
    }
    return normal_ray_count() > 0 ? rest * blocked / float(normal_ray_count()) : 0;
}

/* Adds what lies below a slice's horizon and, without rays, above it. */
void add_horizon(inout BentSums bent, vec3 n, vec3 t, Horizon h)
{
    const vec2 end = normal_ray_count() > 0 ? h.below : directions_below(1);
    const vec2 open = end - h.blocked;
    bent.blocked += h.blocked.x * t + h.blocked.y * n;
    bent.open += open.x * t + open.y * n;
}

float accessibility(ivec2 at, float d)
{
    const crv__noise_texel noise = noise_at(at);
    const vec3 n = normal_at(at), origin = lifted(unproject(at, d), n);
    vec3 tangent, bitangent;
    tangents_of(n, tangent, bitangent);
    float occlusion = sums_before(at).x;
    BentSums bent = bent_sums_before(at);
    for (int i = part_begin(); i < part_end(direction_count()); i++) {
        const vec3 t = slice_tangent(noise, i, tangent, bitangent);
        const Horizon h = traced_horizon(origin, n, t, noise.beta);
        occlusion +=
            h.occlusion
            + normal_occlusion(origin, n, t, h.height, stratum_at(noise, i), noise.beta,
                               bent);
        if (BENT_NORMAL != 0)
            add_horizon(bent, n, t, h);
    }
    keep_bent_sums(at, vec2(occlusion, 0), bent);
    const float total = float(direction_count()), a = 1 - occlusion / total;
    if (BENT_NORMAL != 0)
        bent_normal = bent_of(bent, n, a, BENT_COSINE * total);
    return a;
}

#endif

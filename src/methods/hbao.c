/* SPDX-License-Identifier: MIT */
/*
 * Horizon-based ambient occlusion.
 * Louis Bavoil, Miguel Sainz, Rouslan Dimitrov: Image-Space Horizon-Based Ambient
 * Occlusion, SIGGRAPH 2008 talks.
 *
 * The hemisphere over P is cut into slices by directions theta in the image. In each
 * slice a march over the depth buffer keeps the horizon h, the largest elevation so far;
 * everything between the tangent t and h is blocked. With elevations measured from the
 * image plane,
 *
 *     A = 1 - 1/(2 pi) Int (sin h - sin t) W dtheta                            (eq. 3)
 *
 * Samples are snapped to texel centres, because depth belongs to texel centres only; that
 * turns them a little out of their slice. On a tilted surface the tangent changes quickly
 * with the direction, so each sample is measured against the tangent of its own
 * direction: the point of the plane (P, n) that the sample's view ray hits. A plane then
 * never occludes itself.
 */
#include "core/falloff.h"
#include "core/registry.h"

/* The slice so far. */
typedef struct slice {
    float horizon;   /* sin h - sin t, 0 while nothing rises over the tangent */
    float occlusion; /* attenuation slab: sum of (sin h' - sin h) W */
    float weight;    /* attenuation horizon: W at the horizon point */
} slice;

/* A surface point S read at a texel; offset is the step on the image plane from P's view
 * ray to S's, at unit depth (perspective) or in scene units (orthographic). */
static void add_sample(slice *s, const crv__params *p, crv__vec3 P, crv__vec3 n,
                       crv__vec3 ray, crv__vec3 offset, crv__vec3 S)
{
    crv__vec3 v = crv__sub(S, P);
    float r = sqrtf(crv__dot(v, v));
    if (!(r < p->radius) || r == 0)
        return;
    /* T is parallel to the plane and to the plane of both view rays, and points to S's.
     */
    float along = crv__dot(n, offset), facing = -crv__dot(n, ray);
    crv__vec3 T = {facing * offset.x + along * ray.x, facing * offset.y + along * ray.y,
                   along * ray.z};
    float length = sqrtf(crv__dot(T, T));
    if (!(length > 0))
        return;
    float sin_t = T.z / length, cos_t = sqrtf(T.x * T.x + T.y * T.y) / length;
    if (sin_t > 0 && cos_t * p->cos_bias <= sin_t * p->sin_bias)
        return; /* the bias raises the tangent past the zenith */
    float h = v.z / r - (sin_t * p->cos_bias + cos_t * p->sin_bias);
    if (h <= s->horizon)
        return;
    float W = crv__falloff(p, r * p->inv_radius);
    s->occlusion += (h - s->horizon) * W;
    s->horizon = h;
    s->weight = W;
}

static float accessibility(const crv__frame *f, int32_t x, int32_t y)
{
    const crv__params *p = f->params;
    const crv__noise_texel *noise = crv__noise_at(f, x, y);
    const float d = *crv__plane_at(&f->depth[0], x, y);
    const crv__vec3 P = crv__unproject(p, x, y, d), n = crv__normal_at(f, x, y);
    const float unit = p->orthographic ? 1.0f : d; /* of the offsets on the image plane */
    const crv__vec3 ray =
        p->orthographic ? (crv__vec3){0, 0, -1} : (crv__vec3){P.x / d, P.y / d, -1};

    float radius_x = p->radius * p->fx / unit, radius_y = p->radius * p->fy / unit;
    float largest = radius_x > radius_y ? radius_x : radius_y;
    if (largest > p->max_radius_px) {
        radius_x *= p->max_radius_px / largest;
        radius_y *= p->max_radius_px / largest;
    }

    float occlusion = 0;
    for (int32_t k = 0; k < p->directions; k++) {
        const crv__vec2 direction = crv__direction(f, noise, k);
        const float step_x = direction.x * radius_x, step_y = -direction.y * radius_y;
        slice state = {0, 0, 0};
        for (int32_t i = 0; i < p->steps; i++) {
            float t = ((float)i + 0.5f + 0.5f * noise->beta) / (float)p->steps;
            if (p->spacing == CRV_SPACING_QUADRATIC)
                t *= t;
            float sample_x = (float)x + 0.5f + t * step_x,
                  sample_y = (float)y + 0.5f + t * step_y;
            if (!(sample_x >= 0 && sample_x < (float)p->width && sample_y >= 0
                  && sample_y < (float)p->height))
                break; /* background from here on */
            int32_t u = (int32_t)sample_x, v = (int32_t)sample_y;
            if (u == x && v == y)
                continue;
            crv__vec3 offset = {(float)(u - x) * p->inv_fx, -(float)(v - y) * p->inv_fy,
                                0};
            for (int32_t layer = 0; layer < p->layers; layer++) {
                float ds = *crv__plane_at(&f->depth[layer], u, v);
                if (ds < INFINITY)
                    add_sample(&state, p, P, n, ray, offset, crv__unproject(p, u, v, ds));
            }
        }
        occlusion += p->attenuation == CRV_ATTENUATION_SLAB
                         ? state.occlusion
                         : state.horizon * state.weight;
    }
    return 1 - occlusion / (float)p->directions;
}

static const char *const OPTIONS[] = {
    "falloff", "tau",      "u",           "directions",    "steps",
    "spacing", "bias_deg", "attenuation", "max_radius_px", NULL};

const crv__method crv__method_hbao = {
    .info =
        {.name = "hbao",
         .title = "Horizon-based ambient occlusion",
         .paper =
             "Bavoil, Sainz, Dimitrov 2008: Image-Space Horizon-Based Ambient Occlusion",
         .weighting = CRV_WEIGHTING_UNIFORM,
         .options = OPTIONS},
    .accessibility = accessibility,
    .presets = {"directions=4 steps=4", "directions=8 steps=8", "directions=12 steps=12",
                "directions=24 steps=24",
                "directions=8 steps=8 spacing=equal falloff=linear filter=none"}};

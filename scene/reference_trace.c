/* SPDX-License-Identifier: MIT */
/*
 * One point's accessibility. Its rays are split among several independently scrambled
 * copies of a low-discrepancy sequence: each copy has the sequence's fast convergence,
 * and the spread of their means is an honest estimate of the error, which one sequence
 * alone cannot give.
 */
#include "reference_internal.h"
#include "sampling.h"

#define MAX_COPIES 16
/* Fewer rays say too little of their own error to stop there. */
#define FIRST_STOP 64

typedef struct direction_frame {
    vec3 x, y, z;
} direction_frame;

/* Duff and others 2017: stable for every unit vector. */
static direction_frame frame_around(vec3 z)
{
    double sign = copysign(1.0, z.z), a = -1.0 / (sign + z.z), b = z.x * z.y * a;
    return (direction_frame){v3(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x),
                             v3(b, sign + z.y * z.y * a, -z.y), z};
}

/* The elevation's sine for a uniform number, by the density that is wanted. */
static double elevation_sine(const reference_options *o, double u)
{
    if (o->definition == REFERENCE_TANGENT_SPHERE)
        return sqrt(sqrt(u)); /* density c^3, the chord's share of the volume */
    return o->weighting == CRV_WEIGHTING_COSINE ? sqrt(u) : u;
}

/* W for q = r / R in [0, 1]. */
static double falloff_weight(const reference_options *o, crv_falloff falloff, double q)
{
    double u = (double)o->u;
    switch (falloff) {
    case CRV_FALLOFF_NONE:
        return 1.0;
    case CRV_FALLOFF_LINEAR:
        return 1.0 - q;
    case CRV_FALLOFF_SQRT:
        return 1.0 - sqrt(q);
    case CRV_FALLOFF_CUBIC:
        return 1.0 - q * q * q;
    case CRV_FALLOFF_EXPONENTIAL:
        return exp(-(double)o->tau * q);
    case CRV_FALLOFF_ALCHEMY:
        return u * q / (fmax(u, q) * fmax(u, q));
    }
    return 1.0;
}

static struct RTCRay ray_along(vec3 origin, vec3 direction, double length)
{
    struct RTCRay ray = {0};
    ray.org_x = (float)origin.x;
    ray.org_y = (float)origin.y;
    ray.org_z = (float)origin.z;
    ray.dir_x = (float)direction.x;
    ray.dir_y = (float)direction.y;
    ray.dir_z = (float)direction.z;
    ray.tfar = (float)length;
    ray.mask = UINT32_MAX;
    return ray;
}

/* Distance to the nearest hit as a share of `length`; 1 if there is none. */
static double free_share(const reference *r, vec3 origin, vec3 direction, double length)
{
    struct RTCRayHit query = {0};
    query.ray = ray_along(origin, direction, length);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(r->occluders->rtc, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return 1.0;
    return fmin(fmax((double)query.ray.tfar / length, 0.0), 1.0);
}

/* The falloffs that one set of rays is traced for. */
typedef struct falloff_list {
    const crv_falloff *kinds;
    int32_t count;
} falloff_list;

/* One ray of the hemisphere: its direction, and the sine of its elevation. */
typedef struct hemisphere_ray {
    vec3 direction;
    double sine;
} hemisphere_ray;

static hemisphere_ray ray_of_sample(const reference_options *o,
                                    const direction_frame *frame, sample_point sample)
{
    const double sine = elevation_sine(o, sample.u);
    const double cosine = sqrt(fmax(0.0, 1.0 - sine * sine));
    const double angle = 2.0 * SCENE_PI * sample.v;
    vec3 direction = v3_scale(frame->z, sine);
    direction = v3_along(direction, frame->x, cosine * cos(angle));
    direction = v3_along(direction, frame->y, cosine * sin(angle));
    return (hemisphere_ray){direction, sine};
}

/* What one ray says of the accessibility, in [0, 1], under each of the falloffs. */
static void trace_ray(const reference *r, const reference_point *point,
                      const hemisphere_ray *along, falloff_list falloffs, double *out)
{
    const reference_options *o = &r->options;
    const double radius = (double)o->radius;
    const vec3 direction = along->direction;
    double share;
    if (o->definition == REFERENCE_TANGENT_SPHERE) {
        /* Along the chord volume grows with the cube of the distance. */
        share = free_share(r, point->origin, direction, radius * along->sine);
        for (int32_t k = 0; k < falloffs.count; k++)
            out[k] = share * share * share;
        return;
    }
    if (falloffs.count == 1 && falloffs.kinds[0] == CRV_FALLOFF_NONE) {
        struct RTCRay ray = ray_along(point->origin, direction, radius);
        out[0] = embree_occluded(r->occluders->rtc, &ray) ? 0.0 : 1.0;
        return;
    }
    share = free_share(r, point->origin, direction, radius);
    for (int32_t k = 0; k < falloffs.count; k++)
        out[k] = share < 1.0 ? 1.0 - falloff_weight(o, falloffs.kinds[k], share) : 1.0;
}

/* A power of two, so that each copy gets whole blocks of its sequence. */
static int32_t copy_count(int32_t rays)
{
    int32_t most = rays < 4 ? rays : rays < 32 ? 4 : rays / 8, copies = 1;
    while (2 * copies <= most && 2 * copies <= MAX_COPIES)
        copies *= 2;
    return copies;
}

static int32_t rays_of_copy(int32_t rays, int32_t copies, int32_t copy)
{
    return rays / copies + (copy < rays % copies ? 1 : 0);
}

/* n rays that agree do not rule out something that fills less than 1/n: no error below
 * that is claimed. */
static reference_value summary(const double *sum, int32_t copies, int32_t rays)
{
    double mean = 0.0, spread = 0.0;
    for (int32_t c = 0; c < copies; c++)
        mean += sum[c] / (double)rays;
    for (int32_t c = 0; c < copies; c++) {
        double share = (double)rays_of_copy(rays, copies, c) / (double)rays;
        double deviation = sum[c] / (double)rays - share * mean;
        spread += deviation * deviation;
    }
    const double error = copies > 1 ? sqrt(spread * copies / (copies - 1)) : 0.5;
    return (reference_value){.accessibility = (float)fmin(fmax(mean, 0.0), 1.0),
                             .error = (float)fmin(fmax(error, 1.0 / rays), 0.5),
                             .rays = rays};
}

/* Open directions lie about the normal, so that their sum is zero only if there is
 * none. */
static void set_bent_normal(reference_value *out, vec3 sum, vec3 normal)
{
    v3_store(v3_normalise(v3_dot(sum, sum) > 0.0 ? sum : normal), out->bent_normal);
}

/* What was traced so far: of each falloff the openness, by copies, and the sum of
 * openness times direction. */
typedef struct trace_sums {
    double open[REFERENCE_FALLOFFS][MAX_COPIES];
    vec3 bent[REFERENCE_FALLOFFS];
} trace_sums;

/* Summaries of all falloffs; the largest of their errors. */
static float summarise(const trace_sums *sums, const reference_point *point,
                       int32_t count, int32_t copies, int32_t rays, reference_value *out)
{
    float error = 0.0f;
    for (int32_t k = 0; k < count; k++) {
        out[k] = summary(sums->open[k], copies, rays);
        set_bent_normal(&out[k], sums->bent[k], point->normal);
        error = fmaxf(error, out[k].error);
    }
    return error;
}

void reference_trace(const reference *r, const reference_point *point, uint64_t stream,
                     const crv_falloff *falloffs, int32_t count, reference_value *out)
{
    const reference_options *o = &r->options;
    direction_frame frame = frame_around(point->normal);
    int32_t copies = copy_count(o->rays), traced = 0;
    int32_t until = o->max_error > 0.0f && o->rays > FIRST_STOP ? FIRST_STOP : o->rays;
    trace_sums sums = {0};
    double open[REFERENCE_FALLOFFS];
    for (int32_t k = 0; k < count; k++) {
        out[k] = (reference_value){.accessibility = 1.0f};
        set_bent_normal(&out[k], point->normal, point->normal);
    }
    if (!r->occluders)
        return;
    for (;;) {
        for (int32_t c = 0; c < copies; c++) {
            uint64_t seed = sampling_mix(stream + (uint64_t)c);
            int32_t last = rays_of_copy(until, copies, c);
            for (int32_t i = rays_of_copy(traced, copies, c); i < last; i++) {
                const hemisphere_ray ray =
                    ray_of_sample(o, &frame, sampling_owen_sobol((uint32_t)i, seed));
                trace_ray(r, point, &ray, (falloff_list){falloffs, count}, open);
                for (int32_t k = 0; k < count; k++) {
                    sums.open[k][c] += open[k];
                    sums.bent[k] = v3_along(sums.bent[k], ray.direction, open[k]);
                }
            }
        }
        traced = until;
        if (summarise(&sums, point, count, copies, traced, out) <= o->max_error
            || traced >= o->rays)
            return;
        until = traced > o->rays / 2 ? o->rays : 2 * traced;
    }
}

static vec3 add_light(const reference *r, const reference_point *point,
                      const hemisphere_ray *ray, reference_radiance radiance,
                      const void *user, vec3 sum)
{
    const falloff_list falloff = {&r->options.falloff, 1};
    double open = 1.0;
    float direction[3], rgb[3];
    if (r->occluders)
        trace_ray(r, point, ray, falloff, &open);
    if (!(open > 0.0))
        return sum;
    v3_store(ray->direction, direction);
    radiance(user, direction, rgb);
    return v3_along(sum, v3_from(rgb), open);
}

vec3 reference_trace_light(const reference *r, const reference_point *point,
                           uint64_t stream, reference_radiance radiance, const void *user)
{
    const reference_options *o = &r->options;
    const direction_frame frame = frame_around(point->normal);
    const int32_t copies = copy_count(o->rays);
    vec3 sum = v3(0.0, 0.0, 0.0);
    for (int32_t c = 0; c < copies; c++) {
        const uint64_t seed = sampling_mix(stream + (uint64_t)c);
        const int32_t count = rays_of_copy(o->rays, copies, c);
        for (int32_t i = 0; i < count; i++) {
            const hemisphere_ray ray =
                ray_of_sample(o, &frame, sampling_owen_sobol((uint32_t)i, seed));
            sum = add_light(r, point, &ray, radiance, user, sum);
        }
    }
    return v3_scale(sum, SCENE_PI / o->rays);
}

/* SPDX-License-Identifier: MIT */
#include "fixture.h"

#include <math.h>
#include <string.h>

static fixture_hit miss(void)
{
    return (fixture_hit){INFINITY, {0, 0, 0}};
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static fixture_hit hit_plane(const double origin[3], const double direction[3],
                             const double normal[3], double offset)
{
    double along = dot(normal, direction);
    double t = (offset - dot(normal, origin)) / along;
    if (!(t > 0) || along >= 0)
        return miss();
    return (fixture_hit){t, {normal[0], normal[1], normal[2]}};
}

fixture_hit fixture_plane(const double origin[3], const double direction[3],
                          const double *parameters)
{
    double s = sin(parameters[0]);
    double normal[3] = {s * sin(parameters[2]), s * cos(parameters[2]),
                        cos(parameters[0])};
    return hit_plane(origin, direction, normal, -parameters[1] * normal[2]);
}

fixture_hit fixture_groove(const double origin[3], const double direction[3],
                           const double *parameters)
{
    const double h = sqrt(0.5), left[3] = {h, 0, h}, right[3] = {-h, 0, h};
    fixture_hit a = hit_plane(origin, direction, left, -parameters[0] * h);
    fixture_hit b = hit_plane(origin, direction, right, -parameters[0] * h);
    return a.t < b.t ? a : b;
}

static fixture_hit hit_sphere(const double origin[3], const double direction[3],
                              const double centre[3], double radius)
{
    double to[3] = {origin[0] - centre[0], origin[1] - centre[1], origin[2] - centre[2]};
    double a = dot(direction, direction), b = dot(to, direction);
    double root = b * b - a * (dot(to, to) - radius * radius);
    if (root < 0)
        return miss();
    fixture_hit hit = {(-b - sqrt(root)) / a, {0, 0, 0}};
    if (!(hit.t > 0))
        return miss();
    for (int i = 0; i < 3; i++)
        hit.normal[i] = (to[i] + hit.t * direction[i]) / radius;
    return hit;
}

fixture_hit fixture_spheres(const double origin[3], const double direction[3],
                            const double *parameters)
{
    static const double SPHERES[3][4] = {
        {-0.9, -0.3, -5, 0.7}, {0.6, 0, -5.5, 1}, {0.05, -0.7, -4.1, 0.3}};
    static const double UP[3] = {0, 1, 0};
    const double scale = parameters[0];
    fixture_hit nearest = hit_plane(origin, direction, UP, -scale);
    /* The floor ends before the horizon, so that there is background. */
    if (nearest.t * -direction[2] > 12 * scale)
        nearest = miss();
    for (int i = 0; i < 3; i++) {
        const double centre[3] = {SPHERES[i][0] * scale, SPHERES[i][1] * scale,
                                  SPHERES[i][2] * scale};
        fixture_hit hit = hit_sphere(origin, direction, centre, SPHERES[i][3] * scale);
        if (hit.t < nearest.t)
            nearest = hit;
    }
    return nearest;
}

fixture fixture_make(fixture_surface surface, const double *parameters,
                     const crv_camera *camera, int32_t width, int32_t height)
{
    fixture f = {.width = width, .height = height, .camera = *camera};
    size_t count = (size_t)width * (size_t)height;
    f.depth = malloc(count * sizeof(float));
    f.normals = malloc(count * 3 * sizeof(float));
    assert_non_null(f.depth);
    assert_non_null(f.normals);
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++) {
            const double u = (x + 0.5 - (double)camera->cx_px) / (double)camera->fx_px;
            const double v = -(y + 0.5 - (double)camera->cy_px) / (double)camera->fy_px;
            const int flat = camera->projection == CRV_ORTHOGRAPHIC;
            const double origin[3] = {flat ? u : 0, flat ? v : 0, 0};
            const double direction[3] = {flat ? 0 : u, flat ? 0 : v, -1};
            fixture_hit hit = surface(origin, direction, parameters);
            const size_t i = (size_t)y * (size_t)width + (size_t)x;
            f.depth[i] = (float)hit.t; /* direction.z is -1, so t is planar depth */
            for (int k = 0; k < 3; k++)
                f.normals[3 * i + (size_t)k] = (float)hit.normal[k];
        }
    }
    return f;
}

void fixture_free(fixture *f)
{
    free(f->depth);
    free(f->normals);
    *f = (fixture){0};
}

crv_options fixture_options(const char *method)
{
    crv_options options;
    assert_int_equal(crv_options_init(&options, sizeof options, method), CRV_OK);
    return options;
}

static void fail_on_error(void *user, crv_log_level level, const char *line)
{
    (void)user;
    if (level == CRV_LOG_ERROR)
        fail_msg("%s", line);
}

crv_logger fixture_strict_logger(void)
{
    return (crv_logger){fail_on_error, NULL};
}

static void upload(const fixture *f, const fixture_run *run, crv_gbuffer *gbuffer)
{
    crv_const_image depth = crv_const_image_packed(f->depth, f->width, f->height, 1);
    crv_const_image normals = crv_const_image_packed(f->normals, f->width, f->height, 3);
    assert_int_equal(crv_gbuffer_set_camera(gbuffer, &f->camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(gbuffer, 0, &depth, run->format), CRV_OK);
    if (run->second_layer) {
        depth.data = run->second_layer; /* only read */
        assert_int_equal(crv_gbuffer_set_depth(gbuffer, 1, &depth, NULL), CRV_OK);
    }
    if (!run->without_normals)
        assert_int_equal(crv_gbuffer_set_normals(gbuffer, &normals, CRV_NORMAL_VIEW),
                         CRV_OK);
}

static crv_context *vulkan_context; /* of the process: devices take long to make */

static void destroy_vulkan_context(void)
{
    crv_context_destroy(vulkan_context);
}

int fixture_on_vulkan(void)
{
    const char *device = getenv("CREVICE_TEST_DEVICE");
    return device && strcmp(device, "vulkan") == 0;
}

static crv_context *make_context(const fixture_run *run, crv_device device)
{
    crv_context_desc desc;
    crv_context *context = NULL;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = fixture_strict_logger();
    desc.threads = run->threads;
    desc.exact = run->exact;
    desc.parallel = run->parallel;
    desc.device = device;
    assert_int_equal(crv_context_create(&desc, &context), CRV_OK);
    return context;
}

static crv_context *open_context(const fixture_run *run)
{
    if (!fixture_on_vulkan())
        return make_context(run, CRV_DEVICE_CPU);
    if (!vulkan_context) {
        vulkan_context = make_context(run, CRV_DEVICE_VULKAN);
        atexit(destroy_vulkan_context);
    }
    return vulkan_context;
}

crv_context *fixture_context_open(void)
{
    static const fixture_run DEFAULTS;
    return open_context(&DEFAULTS);
}

void fixture_context_close(crv_context *context)
{
    if (context != vulkan_context)
        crv_context_destroy(context);
}

float *fixture_compute(const fixture *f, const crv_options *options,
                       const fixture_run *run)
{
    static const fixture_run DEFAULTS;
    if (!run)
        run = &DEFAULTS;
    crv_gbuffer_desc desc;
    crv_gbuffer_desc_init(&desc, sizeof desc, f->width, f->height);
    desc.layers = run->second_layer ? 2 : 1;
    desc.guard_left = run->guard_left;
    desc.guard_top = run->guard_top;
    desc.guard_right = run->guard_right;
    desc.guard_bottom = run->guard_bottom;
    desc.origin_x = run->origin_x;
    desc.origin_y = run->origin_y;
    const int32_t width = f->width - run->guard_left - run->guard_right;
    const int32_t height = f->height - run->guard_top - run->guard_bottom;
    float *pixels = malloc((size_t)width * (size_t)height * sizeof(float));
    crv_result result;
    assert_int_equal(crv_result_init(&result, sizeof result), CRV_OK);
    result.accessibility = crv_image_packed(pixels, width, height, 1);
    if (run->bent)
        result.bent_normal = crv_image_packed(run->bent, width, height, 3);

    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    crv_context *context = open_context(run);
    assert_int_equal(crv_plan_create(context, options, &desc, &plan), CRV_OK);
    assert_int_equal(crv_gbuffer_create(context, &desc, &gbuffer), CRV_OK);
    upload(f, run, gbuffer);
    assert_int_equal(crv_plan_run_result(plan, gbuffer, &result), CRV_OK);
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    fixture_context_close(context);
    return pixels;
}

/* SPDX-License-Identifier: MIT */
/* Bent normals: closed forms, and what must hold for every method that gives them. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double PI = 3.14159265358979323846, ONE = 1;

static double angle_deg(const double a[3], const float b[3])
{
    double along = 0, across[3];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        along += a[i] * (double)b[i];
        across[i] = a[j] * (double)b[k] - a[k] * (double)b[j];
    }
    const double sine =
        sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2]);
    return atan2(sine, along) * 180 / PI;
}

/* ---- closed forms ---- */

/*
 * A point on the floor at distance c radii from a wall at right angles to it. A direction
 * whose component towards the wall is x meets it at distance c/x, so that the blocked
 * ones are half of a cap around the wall's normal. With rho = sqrt(1 - x^2) and phi the
 * angle around that axis, (along the floor's normal, towards the wall) = (rho cos phi, x)
 * and dw = dx dphi. Integrals over x from c to 1, phi from -pi/2 to pi/2, weighted by
 * W = 1 - c/x and, for cosine weighting, by n.w = rho cos phi.
 */
typedef struct blocked {
    double along_n, to_wall;
} blocked;

static blocked cosine_none(double c)
{
    const double s = sqrt(1 - c * c);
    return (blocked){PI / 2 * (2.0 / 3 - c + c * c * c / 3), 2.0 / 3 * s * s * s};
}

static blocked cosine_linear(double c)
{
    const double s = sqrt(1 - c * c), lost = c * (-log(c) - s * s / 2);
    return (blocked){PI / 2 * (2.0 / 3 - c + c * c * c / 3 - lost),
                     2.0 / 3 * s * s * s - c * (acos(c) - c * s)};
}

static blocked uniform_none(double c)
{
    const double s = sqrt(1 - c * c);
    return (blocked){acos(c) - c * s, PI / 2 * s * s};
}

static blocked uniform_linear(double c)
{
    const double s = sqrt(1 - c * c);
    return (blocked){acos(c) - c * s - 2 * c * (log((1 + s) / c) - s),
                     PI / 2 * (1 - c) * (1 - c)};
}

typedef struct closed_form {
    const char *method;
    crv_weighting weighting;
    crv_falloff falloff;
    blocked (*blocked)(double c);
    double tolerance_deg; /* of the converged estimate */
} closed_form;

/* Steps end up to one late, which turns the sum by half a degree at most; bitmask's
 * groups of sectors span 11 degrees. */
static const closed_form FORMS[] = {
    {"gtao", CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, cosine_none, 1},
    {"gtao", CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR, cosine_linear, 1},
    {"gtao", CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_NONE, uniform_none, 1},
    {"gtao", CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_LINEAR, uniform_linear, 1},
    {"bitmask", CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, cosine_none, 1},
    {"bitmask", CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR, cosine_linear, 1},
    {"bitmask", CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_NONE, uniform_none, 1},
    {"bitmask", CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_LINEAR, uniform_linear, 1},
    {"hsao", CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, cosine_none, 1},
    {"hsao", CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR, cosine_linear, 1},
    {"raymarch", CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, cosine_none, 1},
    {"raymarch", CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR, cosine_linear, 1},
};

enum { FORM_COUNT = sizeof FORMS / sizeof FORMS[0] };

/* The groove of 90 degrees that opens towards the camera, with c for its middle pixel.
 */
typedef struct groove {
    fixture buffers;
    int32_t guard_px; /* on every side of that pixel */
    double c;
} groove;

/* Perspective: from 4 radii above the edge, which makes the walls 1.3 times as large at
 * the end of the radius. */
static groove make_groove(double c, int orthographic)
{
    const double px_per_radius = 120, depth = orthographic ? 10 : 4;
    groove g = {.guard_px = (int32_t)(px_per_radius * (orthographic ? 1 : 1.3)) + 2};
    const int32_t size = 2 * g.guard_px + 1;
    crv_camera camera =
        orthographic
            ? crv_camera_orthographic(size, size, (float)(size / px_per_radius))
            : crv_camera_perspective(
                size, size, (float)(2 * atan(size / 2.0 / (px_per_radius * depth))));
    /* x = c sqrt(1/2), at depth - x in perspective. */
    const double x = c * sqrt(0.5), scale = orthographic ? 1 : depth / (depth - x);
    const double offset_px = round(x * px_per_radius * scale);
    camera.cx_px -= (float)offset_px;
    g.buffers = fixture_make(fixture_groove, &depth, &camera, size, size);
    const double seen = offset_px / px_per_radius;
    g.c = (orthographic ? seen : seen * depth / (depth + seen)) * sqrt(2);
    return g;
}

static double error_in_groove(const groove *g, const closed_form *form)
{
    /* The camera sees the right wall: the floor. The left one is the wall. */
    static const double FLOOR[3] = {-0.70710678, 0, 0.70710678},
                        TO_WALL[3] = {-0.70710678, 0, -0.70710678};
    const double all = form->weighting == CRV_WEIGHTING_COSINE ? 2 * PI / 3 : PI;
    const blocked k = form->blocked(g->c);
    double exact[3];
    for (int i = 0; i < 3; i++)
        exact[i] = (all - k.along_n) * FLOOR[i] - k.to_wall * TO_WALL[i];
    crv_options options = fixture_options(form->method);
    options.falloff = form->falloff;
    options.weighting = form->weighting;
    options.directions = options.steps = 128;
    options.normal_rays = 16;
    options.thickness_rule = CRV_THICKNESS_RUN; /* of one pixel: no map of widths */
    options.thickness = 0;
    options.filter = NULL;
    options.radius = 1;
    options.noise_size = 1;
    options.bent_normal = 1;
    float bent[3];
    const fixture_run run = {.threads = 1,
                             .guard_left = g->guard_px,
                             .guard_top = g->guard_px,
                             .guard_right = g->guard_px,
                             .guard_bottom = g->guard_px,
                             .bent = bent};
    free(fixture_compute(&g->buffers, &options, &run));
    return angle_deg(exact, bent);
}

static void converged_methods_meet_the_groove(void **state)
{
    (void)state;
    static const double C[] = {0.1, 0.25, 0.5, 0.75};
    for (int k = 0; k < 4 * 2; k++) {
        groove g = make_groove(C[k / 2], k % 2);
        for (int i = 0; i < FORM_COUNT; i++) {
            const closed_form *form = &FORMS[i];
            const double error = error_in_groove(&g, form);
            printf("%-9s %s, weighting %d, falloff %d, c %.3f: %.3f degrees off\n",
                   form->method, k % 2 ? "orthographic" : "perspective",
                   (int)form->weighting, (int)form->falloff, g.c, error);
            assert_true(error < form->tolerance_deg);
        }
        fixture_free(&g.buffers);
    }
}

/* The largest angle between bent and surface normals on an open plane. */
static double lean_on_plane(const crv_options *options, double tilt_deg, int orthographic)
{
    enum { WIDTH = 48, HEIGHT = 32 };
    const crv_camera camera = orthographic ? crv_camera_orthographic(WIDTH, HEIGHT, 8)
                                           : crv_camera_perspective(WIDTH, HEIGHT, 0.9f);
    const double parameters[3] = {tilt_deg * PI / 180, orthographic ? 100 : 10, 0.7};
    fixture f = fixture_make(fixture_plane, parameters, &camera, WIDTH, HEIGHT);
    static float bent[3 * WIDTH * HEIGHT];
    free(fixture_compute(&f, options, &(fixture_run){.bent = bent}));
    double largest = 0;
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const float *given = f.normals + 3 * i;
        const double n[3] = {(double)given[0], (double)given[1], (double)given[2]};
        if (f.depth[i] < INFINITY)
            largest = fmax(largest, angle_deg(n, bent + 3 * i));
    }
    fixture_free(&f);
    return largest;
}

static void for_every_method(void (*check)(const crv_options *))
{
    int count = 0;
    for (int32_t m = 0; m < crv_method_count(); m++) {
        crv_options options = fixture_options(crv_method_at(m)->name);
        if (!options.method->bent_normal)
            continue;
        options.radius = 0.7f;
        options.bent_normal = 1;
        check(&options);
        count++;
    }
    assert_true(count >= 4);
}

static void check_plane(const crv_options *given)
{
    static const double TILTS[] = {0, 20, 45, 60, 75, 85};
    crv_options options = *given;
    options.radius = 2;
    for (int k = 0; k < 6 * 2; k++) {
        for (int32_t i = -1; i < crv_filter_count(); i++) {
            options.filter = crv_filter_at(i);
            const double lean = lean_on_plane(&options, TILTS[k / 2], k % 2);
            if (!(lean < 0.1)) /* rounding and, at the end, normals of unit length */
                fail_msg("%s, tilt %g, %s, filter %d: %g degrees", options.method->name,
                         TILTS[k / 2], k % 2 ? "orthographic" : "perspective", (int)i,
                         lean);
        }
    }
}

static void on_an_open_plane_it_is_the_normal(void **state)
{
    (void)state;
    for_every_method(check_plane);
}

/* ---- what always holds ---- */

static fixture spheres(int32_t width, int32_t height)
{
    const crv_camera camera = crv_camera_perspective(width, height, 0.8f);
    return fixture_make(fixture_spheres, &ONE, &camera, width, height);
}

/* Nothing occludes spheres within a radius of less than a pixel: whatever the filter, the
 * bent normal is the normal. That turns by up to 20 degrees from pixel to pixel; means of
 * directions are 7 degrees off. */
static void check_curved(const crv_options *given)
{
    enum { WIDTH = 96, HEIGHT = 64 };
    static float bent[3 * WIDTH * HEIGHT];
    fixture f = spheres(WIDTH, HEIGHT);
    for (int32_t i = -2; i < 2 * crv_filter_count(); i++) {
        crv_options options = *given;
        options.filter = i < 0 ? NULL : crv_filter_at(i / 2);
        options.radius = 1e-4f;
        free(fixture_compute(&f, &options, &(fixture_run){.exact = i & 1, .bent = bent}));
        for (int32_t k = 0; k < WIDTH * HEIGHT; k++) {
            const float *given_normal = f.normals + 3 * k;
            const double n[3] = {(double)given_normal[0], (double)given_normal[1],
                                 (double)given_normal[2]};
            if (f.depth[k] < INFINITY && !(angle_deg(n, bent + 3 * k) < 1.0))
                fail_msg("%s, filter %s, pixel %d: %g degrees", options.method->name,
                         options.filter ? options.filter->name : "-", (int)k,
                         angle_deg(n, bent + 3 * k));
        }
    }
    fixture_free(&f);
}

static void filters_keep_the_detail_of_normals(void **state)
{
    (void)state;
    for_every_method(check_curved);
}

static void assert_well_formed(const fixture *f, const float *bent)
{
    for (int32_t i = 0; i < f->width * f->height; i++) {
        const float *b = bent + 3 * i;
        const double length2 = (double)b[0] * (double)b[0] + (double)b[1] * (double)b[1]
                               + (double)b[2] * (double)b[2];
        if (f->depth[i] > 0 && f->depth[i] < INFINITY)
            assert_true(fabs(length2 - 1) < 1e-5); /* float rounding */
        else
            assert_true(b[0] == 0 && b[1] == 0 && b[2] == 0);
    }
}

/* Exact and deinterleaved, with every filter: unit length, and the same accessibility as
 * without; the same bits for any number of threads. */
static void check_frame(const crv_options *given)
{
    enum { WIDTH = 101, HEIGHT = 53, COUNT = WIDTH * HEIGHT };
    static float bent[3 * COUNT], again[3 * COUNT];
    fixture f = spheres(WIDTH, HEIGHT);
    for (int32_t i = -1; i < 2 * crv_filter_count(); i++) {
        crv_options options = *given;
        options.filter = crv_filter_at(i % crv_filter_count());
        options.falloff = i % 2 ? CRV_FALLOFF_NONE : CRV_FALLOFF_LINEAR;
        const int32_t exact = i >= crv_filter_count();
        fixture_run run = {.exact = exact, .bent = bent};
        float *with = fixture_compute(&f, &options, &run);
        assert_well_formed(&f, bent);
        run = (fixture_run){.exact = exact, .threads = 3, .bent = again};
        free(fixture_compute(&f, &options, &run));
        assert_memory_equal(bent, again, sizeof bent);
        options.bent_normal = 0;
        float *without = fixture_compute(&f, &options, &(fixture_run){.exact = exact});
        assert_memory_equal(with, without, COUNT * sizeof(float));
        free(with);
        free(without);
    }
    fixture_free(&f);
}

static void accessibility_is_the_same_and_lengths_are_one(void **state)
{
    (void)state;
    for_every_method(check_frame);
}

static void check_hostile(const crv_options *given)
{
    static const float ODD[] = {1e-30f, 1e30f, 3e38f, 1e-38f, NAN, 0.5f, 1, 5};
    static const float RADII[] = {1e-9f, 0.5f, 1e9f};
    enum { WIDTH = 64, HEIGHT = 48 };
    static float bent[3 * WIDTH * HEIGHT];
    fixture f = spheres(WIDTH, HEIGHT);
    uint32_t state = 1;
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        state = state * 1664525u + 1013904223u;
        if (state >> 30 == 0)
            f.depth[i] = ODD[state >> 20 & 7];
        if (state >> 28 == 5)
            f.normals[3 * i] = ODD[state >> 10 & 7];
        if (state >> 28 == 6)
            memset(f.normals + 3 * i, 0, 3 * sizeof(float));
    }
    for (int k = 0; k < 3 * 2; k++) {
        crv_options options = *given;
        options.radius = RADII[k % 3];
        free(fixture_compute(&f, &options, &(fixture_run){.exact = k / 3, .bent = bent}));
        for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
            const float *b = bent + 3 * i;
            const double length2 = (double)b[0] * (double)b[0]
                                   + (double)b[1] * (double)b[1]
                                   + (double)b[2] * (double)b[2];
            assert_true(fabs(length2 - 1) < 1e-5 || length2 == 0);
        }
    }
    fixture_free(&f);
}

static void hostile_input_stays_well_formed(void **state)
{
    (void)state;
    for_every_method(check_hostile);
}

/* A piece with a guard band is the piece cut out of the whole. */
static void check_crop(const crv_options *given)
{
    enum { WIDTH = 320, HEIGHT = 200, X = 97, Y = 62, W = 130, H = 75, GUARD = 60 };
    static float all[3 * WIDTH * HEIGHT], part[3 * W * H];
    fixture whole = spheres(WIDTH, HEIGHT);
    const crv_camera camera = crv_camera_crop(&whole.camera, X - GUARD, Y - GUARD);
    fixture piece =
        fixture_make(fixture_spheres, &ONE, &camera, W + 2 * GUARD, H + 2 * GUARD);
    for (int32_t i = -1; i < crv_filter_count(); i++) {
        crv_options options = *given;
        options.filter = crv_filter_at(i);
        options.radius =
            0.4f; /* projects to 50 px: the guard band holds all that is read */
        free(fixture_compute(&whole, &options, &(fixture_run){.bent = all}));
        free(fixture_compute(&piece, &options,
                             &(fixture_run){.guard_left = GUARD,
                                            .guard_top = GUARD,
                                            .guard_right = GUARD,
                                            .guard_bottom = GUARD,
                                            .origin_x = X,
                                            .origin_y = Y,
                                            .bent = part}));
        int32_t beyond = 0;
        for (int32_t k = 0; k < 3 * W * H; k++) {
            const int32_t x = k / 3 % W + X, y = k / 3 / W + Y;
            beyond += !(fabsf(part[k] - all[3 * (y * WIDTH + x) + k % 3]) <= 1e-3f);
        }
        /* Equal but for the rounding of the principal point. */
        assert_true(beyond < 0.002 * 3 * W * H);
    }
    fixture_free(&whole);
    fixture_free(&piece);
}

static void crops_equal_cuts(void **state)
{
    (void)state;
    for_every_method(check_crop);
}

/* ---- what is refused ---- */

typedef struct objects {
    crv_context *context;
    crv_gbuffer *gbuffer;
    crv_gbuffer_desc desc;
    char line[512];
} objects;

static void keep_line(void *user, crv_log_level level, const char *line)
{
    if (level == CRV_LOG_ERROR)
        snprintf(user, 512, "%s", line);
}

enum { SMALL = 16 };

static void open_objects(objects *o)
{
    static float depth[SMALL * SMALL];
    const crv_camera camera = crv_camera_perspective(SMALL, SMALL, 1);
    const crv_const_image image = crv_const_image_packed(depth, SMALL, SMALL, 1);
    crv_context_desc hooks;
    crv_context_desc_init(&hooks, sizeof hooks);
    hooks.logger = (crv_logger){.fn = keep_line, .user = o->line};
    for (int i = 0; i < SMALL * SMALL; i++)
        depth[i] = 3;
    crv_gbuffer_desc_init(&o->desc, sizeof o->desc, SMALL, SMALL);
    assert_int_equal(crv_context_create(&hooks, &o->context), CRV_OK);
    assert_int_equal(crv_gbuffer_create(o->context, &o->desc, &o->gbuffer), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(o->gbuffer, &camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(o->gbuffer, 0, &image, NULL), CRV_OK);
}

static void refuses(objects *o, crv_plan *plan, const crv_result *result,
                    const char *words)
{
    o->line[0] = 0;
    assert_int_equal(crv_plan_run_result(plan, o->gbuffer, result),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(o->line, words));
}

static void what_is_wrong_is_told(void **state)
{
    (void)state;
    objects o = {.line = ""};
    open_objects(&o);
    static float pixels[SMALL * SMALL], bent[3 * SMALL * SMALL];
    crv_result result, newer[2] = {{0}}; /* room for a larger struct */
    assert_int_equal(crv_result_init(&result, sizeof result), CRV_OK);
    assert_int_equal(crv_result_init(newer, sizeof result + 8),
                     CRV_ERROR_INVALID_ARGUMENT);
    crv_options options = fixture_options("gtao");
    crv_plan *plan = NULL;
    assert_int_equal(crv_plan_create(o.context, &options, &o.desc, &plan), CRV_OK);
    refuses(&o, plan, NULL, "crv_result_init()");
    refuses(&o, plan, &result, "result: image or its data is NULL");
    result.bent_normal = crv_image_packed(bent, SMALL, SMALL, 3);
    refuses(&o, plan, &result, "set the option bent_normal to 1");
    options.bent_normal = 1;
    assert_int_equal(crv_plan_set_options(plan, &options), CRV_ERROR_UNSUPPORTED);
    assert_non_null(strstr(o.line, "bent_normal"));
    crv_plan_destroy(plan);

    assert_int_equal(crv_plan_create(o.context, &options, &o.desc, &plan), CRV_OK);
    assert_int_equal(crv_plan_run_result(plan, o.gbuffer, &result), CRV_OK);
    result.bent_normal.channels = 1;
    refuses(&o, plan, &result, "result: bent_normal");
    result.bent_normal = crv_image_packed(bent, SMALL, SMALL, 3);
    result.accessibility = crv_image_packed(pixels, SMALL, SMALL - 1, 1);
    refuses(&o, plan, &result, "result");
    options.bent_normal = 0; /* needs no memory, and is taken */
    assert_int_equal(crv_plan_set_options(plan, &options), CRV_OK);
    result.accessibility.data = NULL;
    refuses(&o, plan, &result, "set the option bent_normal to 1");
    crv_plan_destroy(plan);

    options = fixture_options("hbao");
    options.bent_normal = 1; /* ignored with a warning */
    assert_int_equal(crv_plan_create(o.context, &options, &o.desc, &plan), CRV_OK);
    refuses(&o, plan, &result, "hbao gives no bent normals");
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(o.gbuffer);
    crv_context_destroy(o.context);
}

/* Bent normals alone are those beside accessibility. */
static void each_image_can_be_left_out(void **state)
{
    (void)state;
    objects o = {.line = ""};
    open_objects(&o);
    static float pixels[SMALL * SMALL], both[3 * SMALL * SMALL], alone[3 * SMALL * SMALL];
    crv_options options = fixture_options("bitmask");
    options.bent_normal = 1;
    crv_plan *plan = NULL;
    crv_result result;
    assert_int_equal(crv_plan_create(o.context, &options, &o.desc, &plan), CRV_OK);
    assert_int_equal(crv_result_init(&result, sizeof result), CRV_OK);
    result.bent_normal = crv_image_packed(alone, SMALL, SMALL, 3);
    assert_int_equal(crv_plan_run_result(plan, o.gbuffer, &result), CRV_OK);
    result.bent_normal.data = both;
    result.accessibility = crv_image_packed(pixels, SMALL, SMALL, 1);
    assert_int_equal(crv_plan_run_result(plan, o.gbuffer, &result), CRV_OK);
    assert_memory_equal(both, alone, sizeof both);
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(o.gbuffer);
    crv_context_destroy(o.context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(converged_methods_meet_the_groove),
        cmocka_unit_test(on_an_open_plane_it_is_the_normal),
        cmocka_unit_test(filters_keep_the_detail_of_normals),
        cmocka_unit_test(accessibility_is_the_same_and_lengths_are_one),
        cmocka_unit_test(hostile_input_stays_well_formed),
        cmocka_unit_test(crops_equal_cuts),
        cmocka_unit_test(what_is_wrong_is_told),
        cmocka_unit_test(each_image_can_be_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

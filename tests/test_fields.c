/* SPDX-License-Identifier: MIT */
/* Implicit surfaces and height fields as characteristic functions. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* The methods that take fields. */
static const char *const METHODS[] = {"containment", "vao"};

/* An allocator that counts, and fails at the call that it is told to. */
typedef struct counter {
    int64_t live, calls, fail_at; /* fail_at 0: never */
} counter;

static void *counting_allocate(void *user, size_t size, size_t alignment)
{
    counter *c = user;
    if (++c->calls == c->fail_at)
        return NULL;
    c->live++;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void counting_release(void *user, void *memory, size_t size)
{
    counter *c = user;
    (void)size;
    c->live--;
    free(memory);
}

/* A G-buffer that stays, so that fields can come and go. */
typedef struct scene {
    fixture f;
    crv_context *context;
    crv_gbuffer_desc desc;
    crv_gbuffer *gbuffer;
    counter memory;
} scene;

static void begin_frame(scene *s)
{
    crv_const_image depth =
        crv_const_image_packed(s->f.depth, s->f.width, s->f.height, 1);
    crv_const_image normals =
        crv_const_image_packed(s->f.normals, s->f.width, s->f.height, 3);
    assert_int_equal(crv_gbuffer_set_camera(s->gbuffer, &s->f.camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(s->gbuffer, 0, &depth, NULL), CRV_OK);
    assert_int_equal(crv_gbuffer_set_normals(s->gbuffer, &normals, CRV_NORMAL_VIEW),
                     CRV_OK);
}

/* guard: px on every side. */
static void make(scene *s, fixture f, int32_t guard)
{
    memset(s, 0, sizeof *s);
    s->f = f;
    crv_context_desc hooks;
    crv_context_desc_init(&hooks, sizeof hooks);
    hooks.allocator = (crv_allocator){counting_allocate, counting_release, &s->memory};
    /* Frames with a field are the scalar code's, and are compared with others bit by bit.
     */
    hooks.isa_mask = 1u << CRV_ISA_SCALAR;
    crv_gbuffer_desc_init(&s->desc, sizeof s->desc, f.width, f.height);
    s->desc.guard_left = s->desc.guard_right = guard;
    s->desc.guard_top = s->desc.guard_bottom = guard;
    assert_int_equal(crv_context_create(&hooks, &s->context), CRV_OK);
    assert_int_equal(crv_gbuffer_create(s->context, &s->desc, &s->gbuffer), CRV_OK);
    begin_frame(s);
}

static void destroy(scene *s)
{
    crv_gbuffer_destroy(s->gbuffer);
    crv_context_destroy(s->context);
    assert_int_equal(s->memory.live, 0);
    fixture_free(&s->f);
}

static crv_options plain_options(const char *method, int32_t samples)
{
    crv_options options = fixture_options(method);
    options.filter = NULL;
    options.samples = samples;
    return options;
}

/* Runs a frame; the caller frees the pixels. */
static float *run(scene *s, const crv_options *options)
{
    const int32_t width = s->desc.width - s->desc.guard_left - s->desc.guard_right;
    const int32_t height = s->desc.height - s->desc.guard_top - s->desc.guard_bottom;
    float *pixels = malloc((size_t)width * (size_t)height * sizeof(float));
    crv_image result = crv_image_packed(pixels, width, height, 1);
    crv_plan *plan = NULL;
    assert_int_equal(crv_plan_create(s->context, options, &s->desc, &plan), CRV_OK);
    assert_int_equal(crv_plan_run(plan, s->gbuffer, &result), CRV_OK);
    crv_plan_destroy(plan);
    return pixels;
}

static double first_pixel(scene *s, const crv_options *options)
{
    float *a = run(s, options);
    const double first = (double)a[0];
    free(a);
    return first;
}

/* Implicit surfaces: planes n.p = d, the open side of all of them. */
typedef struct planes {
    float plane[2][4];
    int count;
} planes;

static float outside_of_planes(void *user, const float p[3], float gradient[3])
{
    const planes *s = user;
    float least = INFINITY;
    for (int i = 0; i < s->count; i++) {
        const float *n = s->plane[i];
        const float value = n[0] * p[0] + n[1] * p[1] + n[2] * p[2] - n[3];
        if (value < least) {
            least = value;
            memcpy(gradient, n, 3 * sizeof *n);
        }
    }
    return least;
}

static void an_implicit_plane_is_open(void **state)
{
    (void)state;
    enum { SIZE = 48 };
    for (int tilt = 0; tilt <= 80; tilt += 20) {
        for (int flat = 0; flat < 2; flat++) {
            const double parameters[3] = {tilt * PI / 180, 10, 0.3};
            const double s = sin(parameters[0]);
            planes surface = {.count = 1};
            surface.plane[0][0] = (float)(s * sin(0.3));
            surface.plane[0][1] = (float)(s * cos(0.3));
            surface.plane[0][2] = (float)cos(parameters[0]);
            surface.plane[0][3] = (float)(-10 * cos(parameters[0]));
            const crv_camera camera = flat ? crv_camera_orthographic(SIZE, SIZE, 1)
                                           : crv_camera_perspective(SIZE, SIZE, 0.1f);
            scene sc;
            make(&sc, fixture_make(fixture_plane, parameters, &camera, SIZE, SIZE), 0);
            assert_int_equal(
                crv_gbuffer_set_implicit(sc.gbuffer, outside_of_planes, &surface),
                CRV_OK);
            for (int m = 0; m < 2; m++) {
                crv_options options = plain_options(METHODS[m], 64);
                options.characteristic = CRV_CHARACTERISTIC_FIELD;
                float *a = run(&sc, &options);
                /* vao's sphere touches the plane: what rounding lets it cut is 1e-6 of
                 * the depth on the shorter chords. */
                for (int i = 0; i < SIZE * SIZE; i++)
                    assert_true(a[i] > 0.999f);
                free(a);
            }
            destroy(&sc);
        }
    }
}

/* Occlusion at distance c radii from the wall of a 90-degree groove. */
static double cosine_none(double c)
{
    return (acos(c) - c * sqrt(1 - c * c)) / PI;
}

static double cosine_linear(double c)
{
    const double s = sqrt(1 - c * c);
    return (acos(c) + c * s - 2 * c * log((1 + s) / c)) / PI;
}

/* The share of the tangent sphere, radius 1/2, that the wall cuts off. */
static double tangent_sphere(double c)
{
    const double rho = 0.5, e = fmax(0, rho - c);
    return e * e * (3 * rho - e) / (4 * rho * rho * rho);
}

typedef struct closed_form {
    const char *method;
    crv_falloff falloff;
    double (*occlusion)(double c);
} closed_form;

static const closed_form FORMS[] = {
    {"containment", CRV_FALLOFF_NONE, cosine_none},
    {"containment", CRV_FALLOFF_LINEAR, cosine_linear},
    {"vao", CRV_FALLOFF_LINEAR, tangent_sphere},
};

static const double C[] = {0.1, 0.25, 0.5, 0.75, 1};

static const double PX_PER_RADIUS = 100;

/* The camera over the point x = offset_px to the right of the edge; radius 1, and one
 * radius of guard band around the only pixel. */
static crv_camera camera_over(int32_t offset_px, int32_t *size, int32_t *guard)
{
    *guard = (int32_t)PX_PER_RADIUS + 2;
    *size = 2 * *guard + 1;
    crv_camera camera =
        crv_camera_orthographic(*size, *size, (float)(*size / PX_PER_RADIUS));
    camera.cx_px -= (float)offset_px;
    return camera;
}

/* The error of a form at a point of the scene. */
static double error_of(scene *s, const closed_form *form, double c,
                       crv_characteristic characteristic)
{
    crv_options options = plain_options(form->method, 4096);
    options.radius = 1;
    options.falloff = form->falloff;
    options.characteristic = characteristic;
    options.noise_size = 1;
    return first_pixel(s, &options) - (1 - form->occlusion(c));
}

/* In the symmetric groove a line of sight meets one of the planes only, and it is the one
 * that the function returns: the step to first order is exact for vao too. */
static void an_implicit_groove_meets_the_closed_forms(void **state)
{
    (void)state;
    const float h = sqrtf(0.5f);
    planes walls = {.plane = {{h, 0, h, -10 * h}, {-h, 0, h, -10 * h}}, .count = 2};
    const double depth = 10;
    for (int k = 0; k < 5; k++) {
        const int32_t offset = (int32_t)lround(C[k] * PX_PER_RADIUS * sqrt(0.5));
        const double c = fmin(1, offset / PX_PER_RADIUS * sqrt(2));
        int32_t size, guard;
        const crv_camera camera = camera_over(offset, &size, &guard);
        scene s;
        make(&s, fixture_make(fixture_groove, &depth, &camera, size, size), guard);
        assert_int_equal(crv_gbuffer_set_implicit(s.gbuffer, outside_of_planes, &walls),
                         CRV_OK);
        for (int i = 0; i < 3; i++) {
            const double error = error_of(&s, &FORMS[i], c, CRV_CHARACTERISTIC_FIELD);
            printf("implicit groove, %-11s falloff %d c %.3f: error %+.4f\n",
                   FORMS[i].method, (int)FORMS[i].falloff, c, error);
            assert_true(fabs(error) < 0.01);
        }
        destroy(&s);
    }
}

/* Turned about its edge, the groove's planes have different slopes along the line of
 * sight, and pipes meet both. What the function returns at a pipe's middle is the plane
 * nearer to that point, which need not be the one that the pipe meets: vao's first order
 * is no longer exact. containment asks for the sign alone and does not mind. */
static void a_turned_implicit_groove_is_met_to_first_order(void **state)
{
    (void)state;
    enum { SIZE = 401 };
    const double turn = 20 * PI / 180, quarter = PI / 4;
    const double left = quarter + turn, right = quarter - turn;
    planes walls = {.plane = {{(float)sin(left), 0, (float)cos(left), 0},
                              {-(float)sin(right), 0, (float)cos(right), 0}},
                    .count = 2};
    for (int i = 0; i < 2; i++)
        walls.plane[i][3] = -10 * walls.plane[i][2];
    for (int side = 0; side < 2; side++) {
        for (int k = 0; k < 5; k++) {
            /* The left plane is seen at x < 0: its points lie at -D cos(left) from the
             * edge, at a distance D of the right plane. */
            const double slope = side ? right : left;
            const int32_t offset =
                (int32_t)lround((side ? 1 : -1) * C[k] * PX_PER_RADIUS * cos(slope));
            const double c = fmin(1, fabs(offset / PX_PER_RADIUS / cos(slope)));
            crv_camera camera = crv_camera_orthographic(3, 3, (float)(3 / PX_PER_RADIUS));
            camera.cx_px -= (float)offset;
            fixture f = fixture_make(fixture_groove, &(double){10}, &camera, 3, 3);
            for (int i = 0; i < 9; i++) {
                const double x = (i % 3 + 0.5 - (double)camera.cx_px) / PX_PER_RADIUS;
                f.depth[i] = (float)(10 - fabs(x) * tan(x < 0 ? left : right));
                memcpy(f.normals + 3 * i, walls.plane[x < 0 ? 0 : 1], 3 * sizeof(float));
            }
            scene s;
            make(&s, f, 1);
            assert_int_equal(
                crv_gbuffer_set_implicit(s.gbuffer, outside_of_planes, &walls), CRV_OK);
            for (int i = 0; i < 3; i++) {
                const double error = error_of(&s, &FORMS[i], c, CRV_CHARACTERISTIC_FIELD);
                printf("turned groove, side %d, %-11s falloff %d c %.3f: error %+.4f\n",
                       side, FORMS[i].method, (int)FORMS[i].falloff, c, error);
                assert_true(fabs(error) < (i == 2 ? 0.05 : 0.01));
            }
            destroy(&s);
        }
    }
}

static float sphere(void *user, const float p[3], float gradient[3])
{
    const float *s = user;
    const float to[3] = {p[0] - s[0], p[1] - s[1], p[2] - s[2]};
    const float length = sqrtf(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
    for (int i = 0; i < 3; i++)
        gradient[i] = length > 0 ? to[i] / length : 0;
    return length - s[3];
}

static void a_product_is_darker_than_either(void **state)
{
    (void)state;
    enum { WIDTH = 96, HEIGHT = 64 };
    static const double ONE = 1;
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 0.8f);
    float hidden[4] = {-0.2f, -0.4f, -4.3f, 0.5f}; /* among the spheres, not drawn */
    scene s;
    make(&s, fixture_make(fixture_spheres, &ONE, &camera, WIDTH, HEIGHT), 0);
    assert_int_equal(crv_gbuffer_set_implicit(s.gbuffer, sphere, hidden), CRV_OK);
    for (int m = 0; m < 2; m++) {
        crv_options options = plain_options(METHODS[m], 64);
        float *by[3];
        for (int c = 0; c < 3; c++) {
            options.characteristic = (crv_characteristic)c;
            by[c] = run(&s, &options);
        }
        int32_t darker_than_both = 0;
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const float both = by[CRV_CHARACTERISTIC_PRODUCT][i];
            const float depth = by[CRV_CHARACTERISTIC_DEPTH][i];
            const float field = by[CRV_CHARACTERISTIC_FIELD][i];
            /* The rounding of sums of 64, in another order for vao's pipes. */
            assert_true(both <= fminf(depth, field) + 1e-5f);
            darker_than_both += both < fminf(depth, field) - 0.05f;
        }
        assert_true(darker_than_both > 20);
        for (int c = 0; c < 3; c++)
            free(by[c]);
    }
    destroy(&s);
}

/* Numbers that no surface has must not get out. */
static float nonsense(void *user, const float p[3], float gradient[3])
{
    static const float ODD[] = {NAN, INFINITY, -INFINITY, 0, 1e38f, -1e38f};
    const int k = (int)fabsf(p[0] * 1000 + p[1] * 100);
    (void)user;
    for (int i = 0; i < 3; i++)
        gradient[i] = ODD[(k + i) % 6];
    return ODD[k / 7 % 6];
}

static void hostile_functions_stay_in_range(void **state)
{
    (void)state;
    enum { SIZE = 40 };
    static const double ONE = 1;
    const crv_camera camera = crv_camera_perspective(SIZE, SIZE, 0.8f);
    scene s;
    make(&s, fixture_make(fixture_spheres, &ONE, &camera, SIZE, SIZE), 0);
    assert_int_equal(crv_gbuffer_set_implicit(s.gbuffer, nonsense, NULL), CRV_OK);
    for (int k = 0; k < 6; k++) {
        crv_options options = plain_options(METHODS[k % 2], 24);
        options.characteristic = (crv_characteristic)(k / 2);
        float *a = run(&s, &options);
        for (int i = 0; i < SIZE * SIZE; i++)
            assert_true(a[i] >= 0 && a[i] <= 1);
        free(a);
    }
    destroy(&s);
}

/* A height field over a surface, one frame for every pixel. */
typedef struct relief {
    float *uv, *tangent, *bitangent;
    crv_height_field field;
} relief;

/* Texture coordinates 0 to 1 over [-extent, extent] of the axes x and y (flat = 1) or x
 * and -z (a floor) of view space. */
static relief make_relief(const fixture *f, float extent, int flat, float *map,
                          int32_t map_width, int32_t map_height, float scale)
{
    const size_t count = (size_t)f->width * (size_t)f->height;
    relief r = {malloc(count * 2 * sizeof(float)),
                malloc(count * 3 * sizeof(float)),
                malloc(count * 3 * sizeof(float)),
                {.scale = scale}};
    for (int32_t y = 0; y < f->height; y++) {
        for (int32_t x = 0; x < f->width; x++) {
            const size_t i = (size_t)y * (size_t)f->width + (size_t)x;
            const float d = f->depth[i];
            const float unit = f->camera.projection == CRV_ORTHOGRAPHIC ? 1 : d;
            const float px = ((float)x + 0.5f - f->camera.cx_px) / f->camera.fx_px * unit;
            const float py =
                -((float)y + 0.5f - f->camera.cy_px) / f->camera.fy_px * unit;
            const int is_floor = f->normals[3 * i + 1] > 0.999f;
            const int has = flat || (is_floor && d < INFINITY);
            r.uv[2 * i] = has ? 0.5f + 0.5f * px / extent : NAN;
            r.uv[2 * i + 1] = has ? 0.5f - 0.5f * (flat ? py : d) / extent : NAN;
            const float along[3] = {2 * extent, 0, 0};
            const float across[3] = {0, flat ? -2 * extent : 0, flat ? 0 : 2 * extent};
            memcpy(r.tangent + 3 * i, along, sizeof along);
            memcpy(r.bitangent + 3 * i, across, sizeof across);
        }
    }
    r.field.uv = crv_const_image_packed(r.uv, f->width, f->height, 2);
    r.field.tangent = crv_const_image_packed(r.tangent, f->width, f->height, 3);
    r.field.bitangent = crv_const_image_packed(r.bitangent, f->width, f->height, 3);
    r.field.height = crv_const_image_packed(map, map_width, map_height, 1);
    return r;
}

static void free_relief(relief *r)
{
    free(r->uv);
    free(r->tangent);
    free(r->bitangent);
}

/* Only the floor has texture coordinates; the spheres on it are in the depth buffer. */
static void a_flat_map_changes_nothing(void **state)
{
    (void)state;
    enum { WIDTH = 160, HEIGHT = 100 };
    static const double ONE = 1;
    float map[6] = {0.3f, 0.3f, 0.3f, 0.3f, 0.3f, 0.3f};
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 0.8f);
    for (int m = 0; m < 2; m++) {
        scene s;
        make(&s, fixture_make(fixture_spheres, &ONE, &camera, WIDTH, HEIGHT), 0);
        relief r = make_relief(&s.f, 20, 0, map, 3, 2, 1);
        const crv_options options = plain_options(METHODS[m], 64);
        float *without = run(&s, &options);
        assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, &r.field), CRV_OK);
        float *with = run(&s, &options);
        int32_t beyond = 0;
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            beyond += fabsf(with[i] - without[i]) > 0.02f;
        printf("flat map, %s: %d of %d pixels differ\n", METHODS[m], beyond,
               WIDTH * HEIGHT);
        /* At the contacts the floor is told from the spheres by a pixel's footprint. */
        assert_true(beyond < WIDTH * HEIGHT / 200);
        /* Gone again, it leaves no trace. */
        assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, NULL), CRV_OK);
        float *after = run(&s, &options);
        assert_memory_equal(without, after, WIDTH * HEIGHT * sizeof(float));
        free(without);
        free(with);
        free(after);
        free_relief(&r);
        destroy(&s);
    }
}

/* A V groove of 90 degrees along v in the middle of the map, half as high as wide. */
static float *groove_map(int32_t width, float height)
{
    float *map = malloc((size_t)width * sizeof *map);
    for (int32_t i = 0; i < width; i++)
        map[i] = height * fabsf(2 * ((float)i + 0.5f) / (float)width - 1);
    return map;
}

/*
 * A flat wall whose map has the groove: seen from above its points have the groove's
 * occlusion, although the depth buffer is flat. The map's texels are 1/500 radius; across
 * the one at the edge the height is cut off by half of that, a part of the tolerance.
 */
static void a_groove_in_the_map_meets_the_closed_forms(void **state)
{
    (void)state;
    enum { TEXELS = 4001 };
    const float extent = 4;
    const double flat_wall[3] = {0, 10, 0};
    float *map = groove_map(TEXELS, 0.5f * extent); /* times the scale 2: slope 1 */
    for (int k = 0; k < 5; k++) {
        const int32_t offset = (int32_t)lround(C[k] * PX_PER_RADIUS * sqrt(0.5));
        const double c = fmin(1, offset / PX_PER_RADIUS * sqrt(2));
        int32_t size, guard;
        const crv_camera camera = camera_over(offset, &size, &guard);
        scene s;
        make(&s, fixture_make(fixture_plane, flat_wall, &camera, size, size), guard);
        relief r = make_relief(&s.f, extent, 1, map, TEXELS, 1, 2);
        assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, &r.field), CRV_OK);
        for (int i = 0; i < 3; i++) {
            /* The wall itself, in the depth buffer, must not fill the groove. */
            const double field = error_of(&s, &FORMS[i], c, CRV_CHARACTERISTIC_FIELD);
            const double both = error_of(&s, &FORMS[i], c, CRV_CHARACTERISTIC_PRODUCT);
            printf("groove in the map, %-11s falloff %d c %.3f: error %+.4f, with the "
                   "depth buffer %+.4f\n",
                   FORMS[i].method, (int)FORMS[i].falloff, c, field, both);
            assert_true(fabs(field) < 0.01);
            assert_true(fabs(both) < 0.01);
        }
        free_relief(&r);
        destroy(&s);
    }
    free(map);
}

/* Three periods of a groove's map across a flat wall, repeated or once. */
static void maps_repeat_or_end(void **state)
{
    (void)state;
    enum { WIDTH = 192, PERIOD = 32, HEIGHT = 8, TEXELS = 64 };
    const double flat_wall[3] = {0, 10, 0};
    const crv_camera camera =
        crv_camera_orthographic(WIDTH, HEIGHT, (float)HEIGHT / PERIOD);
    float *map = groove_map(TEXELS, 0.5f);
    for (int m = 0; m < 2; m++) {
        scene s;
        make(&s, fixture_make(fixture_plane, flat_wall, &camera, WIDTH, HEIGHT), 0);
        relief r = make_relief(&s.f, 0.5f, 1, map, TEXELS, 1, 1);
        crv_options options = plain_options(METHODS[m], 64);
        options.radius = 0.5f;
        options.noise_size = 1;
        options.characteristic = CRV_CHARACTERISTIC_FIELD;
        r.field.wrap = CRV_WRAP_REPEAT;
        assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, &r.field), CRV_OK);
        float *repeated = run(&s, &options);
        r.field.wrap = CRV_WRAP_CLAMP;
        assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, &r.field), CRV_OK);
        float *once = run(&s, &options);
        /* The middle period is that of u = 0 to 1: x = 80 to 112. */
        float least = 1;
        for (int x = 0; x + PERIOD < WIDTH; x++) {
            assert_true(fabsf(repeated[x] - repeated[x + PERIOD]) < 0.02f); /* 1 of 64 */
            least = fminf(least, repeated[x]);
        }
        assert_true(least < 0.8f);
        /* In the middle of the groove only the groove counts; away from it clamped edges
         * are flat. */
        assert_true(fabsf(repeated[96] - once[96]) < 0.02f);
        for (int x = 0; x < 80 - PERIOD / 2; x++)
            assert_true(once[x] > 0.999f);
        free(repeated);
        free(once);
        free_relief(&r);
        destroy(&s);
    }
    free(map);
}

static void holes_in_the_map_are_flat(void **state)
{
    (void)state;
    enum { SIZE = 40 };
    static const float HOLES[] = {NAN, INFINITY, -INFINITY};
    const double flat_wall[3] = {0, 10, 0};
    float map[16], filled[16];
    for (int i = 0; i < 16; i++)
        filled[i] = map[i] = i % 5 == 0 ? 0 : 0.1f * (float)(i % 7);
    for (int i = 0; i < 16; i += 5)
        map[i] = HOLES[i / 5 % 3];
    const crv_camera camera = crv_camera_orthographic(SIZE, SIZE, 2);
    scene s;
    make(&s, fixture_make(fixture_plane, flat_wall, &camera, SIZE, SIZE), 0);
    relief r = make_relief(&s.f, 1, 1, map, 4, 4, 1);
    const crv_options options = plain_options("containment", 32);
    assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, &r.field), CRV_OK);
    float *with_holes = run(&s, &options);
    r.field.height = crv_const_image_packed(filled, 4, 4, 1);
    assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, &r.field), CRV_OK);
    float *without = run(&s, &options);
    assert_memory_equal(with_holes, without, SIZE * SIZE * sizeof(float));
    free(with_holes);
    free(without);
    free_relief(&r);
    destroy(&s);
}

/* A pixel whose frame is no frame keeps the depth buffer alone. */
static void pixels_without_a_frame_are_left_out(void **state)
{
    (void)state;
    enum { SIZE = 32 };
    static const double ONE = 1;
    float map[4] = {0, 1, 1, 0};
    const crv_camera camera = crv_camera_perspective(SIZE, SIZE, 0.8f);
    scene s;
    make(&s, fixture_make(fixture_spheres, &ONE, &camera, SIZE, SIZE), 0);
    relief r = make_relief(&s.f, 1, 1, map, 2, 2, 1);
    for (int i = 0; i < SIZE * SIZE; i++) {
        if (i % 4 == 0)
            r.uv[2 * i] = NAN;
        else if (i % 4 == 1)
            r.tangent[3 * i] = INFINITY;
        else if (i % 4 == 2)
            memcpy(r.bitangent + 3 * i, r.tangent + 3 * i, 3 * sizeof(float));
        else
            memset(r.tangent + 3 * i, 0, 3 * sizeof(float));
    }
    for (int m = 0; m < 2; m++) {
        const crv_options options = plain_options(METHODS[m], 32);
        begin_frame(&s); /* forgets the field */
        float *without = run(&s, &options);
        assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, &r.field), CRV_OK);
        float *with = run(&s, &options);
        assert_memory_equal(with, without, SIZE * SIZE * sizeof(float));
        free(with);
        free(without);
    }
    free_relief(&r);
    destroy(&s);
}

/* Each kind takes the place of the other, and a new camera forgets both. */
static void fields_replace_each_other(void **state)
{
    (void)state;
    enum { SIZE = 40 };
    const size_t bytes = SIZE * SIZE * sizeof(float);
    const double flat_wall[3] = {0, 10, 0};
    float ball[4] = {0, 0, -10, 0.5f};
    float map[16];
    for (int i = 0; i < 16; i++)
        map[i] = 0.1f * (float)(i % 7);
    const crv_camera camera = crv_camera_orthographic(SIZE, SIZE, 2);
    scene s;
    make(&s, fixture_make(fixture_plane, flat_wall, &camera, SIZE, SIZE), 0);
    relief r = make_relief(&s.f, 1, 1, map, 4, 4, 1);
    const crv_options options = plain_options("vao", 32);
    float *bare = run(&s, &options);
    assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, &r.field), CRV_OK);
    float *relieved = run(&s, &options);
    assert_int_equal(crv_gbuffer_set_implicit(s.gbuffer, sphere, ball), CRV_OK);
    float *balled = run(&s, &options);
    assert_memory_not_equal(bare, relieved, bytes);
    assert_memory_not_equal(bare, balled, bytes);
    assert_memory_not_equal(relieved, balled, bytes);

    assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, &r.field), CRV_OK);
    float *again = run(&s, &options);
    assert_memory_equal(relieved, again, bytes);
    free(again);
    assert_int_equal(crv_gbuffer_set_implicit(s.gbuffer, NULL, NULL), CRV_OK);
    again = run(&s, &options);
    assert_memory_equal(bare, again, bytes);
    free(again);
    assert_int_equal(crv_gbuffer_set_implicit(s.gbuffer, sphere, ball), CRV_OK);
    begin_frame(&s);
    again = run(&s, &options);
    assert_memory_equal(bare, again, bytes);
    free(again);
    free(bare);
    free(relieved);
    free(balled);
    free_relief(&r);
    destroy(&s);
}

static void bad_arguments_are_refused(void **state)
{
    (void)state;
    enum { SIZE = 8 };
    const crv_status bad = CRV_ERROR_INVALID_ARGUMENT;
    const double flat_wall[3] = {0, 10, 0};
    float map[4] = {0, 1, 2, 3};
    const crv_camera camera = crv_camera_orthographic(SIZE, SIZE, 2);
    scene s;
    make(&s, fixture_make(fixture_plane, flat_wall, &camera, SIZE, SIZE), 0);
    relief r = make_relief(&s.f, 1, 1, map, 2, 2, 1);
    assert_int_equal(crv_gbuffer_set_height_field(NULL, &r.field), bad);
    assert_int_equal(crv_gbuffer_set_implicit(NULL, sphere, NULL), bad);
    for (int k = 0; k < 12; k++) {
        crv_height_field field = r.field;
        switch (k) {
        case 0:
            field.scale = NAN;
            break;
        case 1:
            field.scale = INFINITY;
            break;
        case 2:
            field.wrap = (crv_wrap)2;
            break;
        case 3:
            field.uv.channels = 3;
            break;
        case 4:
            field.uv.width--;
            break;
        case 5:
            field.tangent.data = NULL;
            break;
        case 6:
            field.bitangent.channels = 1;
            break;
        case 7:
            field.bitangent.height++;
            break;
        case 8:
            field.height.data = NULL;
            break;
        case 9:
            field.height.width = 0;
            break;
        case 10:
            field.height.height = CRV_MAX_SIZE + 1;
            break;
        default:
            field.height.channels = 3;
            break;
        }
        assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, &field), bad);
    }
    crv_gbuffer *fresh = NULL;
    assert_int_equal(crv_gbuffer_create(s.context, &s.desc, &fresh), CRV_OK);
    assert_int_equal(crv_gbuffer_set_height_field(fresh, &r.field), CRV_ERROR_NOT_READY);
    assert_int_equal(crv_gbuffer_set_implicit(fresh, sphere, NULL), CRV_ERROR_NOT_READY);
    crv_gbuffer_destroy(fresh);
    free_relief(&r);
    destroy(&s);
}

static void every_failed_allocation_is_survived(void **state)
{
    (void)state;
    enum { SIZE = 16 };
    const double flat_wall[3] = {0, 10, 0};
    float map[9] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    const crv_camera camera = crv_camera_orthographic(SIZE, SIZE, 2);
    scene s;
    make(&s, fixture_make(fixture_plane, flat_wall, &camera, SIZE, SIZE), 0);
    relief r = make_relief(&s.f, 1, 1, map, 3, 3, 0.1f);
    const crv_options options = plain_options("vao", 16);
    float *bare = run(&s, &options);
    int32_t failures = 0;
    for (;; failures++) { /* what was made before stays, so each try gets one farther */
        s.memory.fail_at = s.memory.calls + 1;
        if (failures % 2 == 0)
            s.memory.fail_at++; /* and sometimes two */
        const crv_status status = crv_gbuffer_set_height_field(s.gbuffer, &r.field);
        s.memory.fail_at = 0;
        if (status == CRV_OK)
            break;
        assert_int_equal(status, CRV_ERROR_OUT_OF_MEMORY);
        float *a = run(&s, &options); /* as if there were no field */
        assert_memory_equal(a, bare, SIZE * SIZE * sizeof(float));
        free(a);
    }
    assert_true(failures >= 6);
    /* Another map of the same size takes no memory; of another size, only the map's. */
    int64_t calls = s.memory.calls;
    assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, &r.field), CRV_OK);
    assert_int_equal(s.memory.calls, calls);
    r.field.height = crv_const_image_packed(map, 2, 2, 1);
    calls = s.memory.calls;
    assert_int_equal(crv_gbuffer_set_height_field(s.gbuffer, &r.field), CRV_OK);
    assert_int_equal(s.memory.calls, calls + 1);
    free(bare);
    free_relief(&r);
    destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_implicit_plane_is_open),
        cmocka_unit_test(an_implicit_groove_meets_the_closed_forms),
        cmocka_unit_test(a_turned_implicit_groove_is_met_to_first_order),
        cmocka_unit_test(a_product_is_darker_than_either),
        cmocka_unit_test(hostile_functions_stay_in_range),
        cmocka_unit_test(a_flat_map_changes_nothing),
        cmocka_unit_test(a_groove_in_the_map_meets_the_closed_forms),
        cmocka_unit_test(maps_repeat_or_end),
        cmocka_unit_test(holes_in_the_map_are_flat),
        cmocka_unit_test(pixels_without_a_frame_are_left_out),
        cmocka_unit_test(fields_replace_each_other),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(every_failed_allocation_is_survived),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

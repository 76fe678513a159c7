/* SPDX-License-Identifier: MIT */
/* The library's manners: arguments, memory, threads, order of calls. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 40, HEIGHT = 30 };

/* An allocator that counts, and fails at the call that it is told to. */
typedef struct counter {
    int64_t live, calls, fail_at; /* fail_at 0: never */
    int64_t bytes;
} counter;

static void *counting_allocate(void *user, size_t size, size_t alignment)
{
    counter *c = user;
    c->calls++;
    if (c->calls == c->fail_at)
        return NULL;
    assert_true(alignment >= 64 && (alignment & (alignment - 1)) == 0);
    void *memory =
        aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    assert_non_null(memory);
    c->live++;
    c->bytes += (int64_t)size;
    return memory;
}

static void counting_release(void *user, void *memory, size_t size)
{
    counter *c = user;
    assert_non_null(memory);
    c->live--;
    c->bytes -= (int64_t)size;
    free(memory);
}

typedef struct objects {
    crv_context *context;
    crv_gbuffer *gbuffer;
    crv_plan *plan;
} objects;

/* Makes everything, stopping at the first failure. */
static crv_status make(objects *o, counter *c, const crv_gbuffer_desc *desc)
{
    crv_context_desc context_desc;
    crv_context_desc_init(&context_desc, sizeof context_desc);
    context_desc.allocator = (crv_allocator){counting_allocate, counting_release, c};
    crv_options options = fixture_options(NULL);
    *o = (objects){NULL, NULL, NULL};
    crv_status status = crv_context_create(&context_desc, &o->context);
    if (status == CRV_OK)
        status = crv_gbuffer_create(o->context, desc, &o->gbuffer);
    if (status == CRV_OK)
        status = crv_plan_create(o->context, &options, desc, &o->plan);
    return status;
}

static void destroy(objects *o)
{
    crv_plan_destroy(o->plan);
    crv_gbuffer_destroy(o->gbuffer);
    crv_context_destroy(o->context);
}

static crv_gbuffer_desc small_desc(void)
{
    crv_gbuffer_desc desc;
    crv_gbuffer_desc_init(&desc, sizeof desc, WIDTH, HEIGHT);
    return desc;
}

static void every_failed_allocation_is_survived(void **state)
{
    (void)state;
    const crv_gbuffer_desc desc = small_desc();
    counter c = {0};
    objects o;
    assert_int_equal(make(&o, &c, &desc), CRV_OK);
    destroy(&o);
    assert_int_equal(c.live, 0);
    assert_int_equal(c.bytes, 0);
    const int64_t calls = c.calls;
    assert_true(calls >= 8);
    for (int64_t i = 1; i <= calls; i++) {
        c = (counter){.fail_at = i};
        assert_int_equal(make(&o, &c, &desc), CRV_ERROR_OUT_OF_MEMORY);
        destroy(&o);
        assert_int_equal(c.live, 0);
        assert_int_equal(c.bytes, 0);
    }
}

static void a_run_allocates_nothing(void **state)
{
    (void)state;
    crv_gbuffer_desc desc = small_desc();
    static float depth[WIDTH * HEIGHT], out[WIDTH * HEIGHT];
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        depth[i] = 5 + 0.01f * (float)(i % 7);
    counter c = {0};
    objects o;
    assert_int_equal(make(&o, &c, &desc), CRV_OK);
    const int64_t calls = c.calls;
    crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 1);
    crv_image image = crv_image_packed(depth, WIDTH, HEIGHT, 1);
    crv_image result = crv_image_packed(out, WIDTH, HEIGHT, 1);
    for (int frame = 0; frame < 3; frame++) {
        assert_int_equal(crv_gbuffer_set_camera(o.gbuffer, &camera), CRV_OK);
        assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 0, &image, NULL), CRV_OK);
        assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &result), CRV_OK);
        assert_int_equal(crv_plan_filter(o.plan, o.gbuffer, &result, &result), CRV_OK);
    }
    assert_int_equal(c.calls, calls);
    destroy(&o);
}

static void memory_stays_within_the_promise(void **state)
{
    (void)state;
    crv_gbuffer_desc desc;
    crv_gbuffer_desc_init(&desc, sizeof desc, 640, 400);
    counter c = {0};
    objects o;
    assert_int_equal(make(&o, &c, &desc), CRV_OK);
    /* depth 4, normals 12, estimate 4, filter 4 bytes a pixel; in the fast structure
     * depth once more, and tables */
    assert_true(c.bytes < 640 * 400 * 48);
    destroy(&o);
}

static void calls_out_of_order_are_told(void **state)
{
    (void)state;
    crv_gbuffer_desc desc = small_desc();
    desc.layers = 2;
    static float pixels[WIDTH * HEIGHT], normals[WIDTH * HEIGHT * 3];
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        pixels[i] = 1;
    crv_image image = crv_image_packed(pixels, WIDTH, HEIGHT, 1);
    crv_image vectors = crv_image_packed(normals, WIDTH, HEIGHT, 3);
    crv_camera camera = crv_camera_orthographic(WIDTH, HEIGHT, 1);
    counter c = {0};
    objects o;
    assert_int_equal(make(&o, &c, &desc), CRV_OK);
    assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &image), CRV_ERROR_NOT_READY);
    assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 0, &image, NULL),
                     CRV_ERROR_NOT_READY);
    assert_int_equal(crv_gbuffer_set_normals(o.gbuffer, &vectors, CRV_NORMAL_VIEW),
                     CRV_ERROR_NOT_READY);
    assert_int_equal(crv_gbuffer_set_camera(o.gbuffer, &camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 0, &image, NULL), CRV_OK);
    assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &image), CRV_ERROR_NOT_READY);
    assert_int_equal(crv_gbuffer_get_depth(o.gbuffer, 1, &image), CRV_ERROR_NOT_READY);
    assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 1, &image, NULL), CRV_OK);
    assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &image), CRV_OK);
    /* A new camera begins a new frame. */
    assert_int_equal(crv_gbuffer_set_camera(o.gbuffer, &camera), CRV_OK);
    assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &image), CRV_ERROR_NOT_READY);
    destroy(&o);
}

static void bad_sizes_are_refused(void **state)
{
    (void)state;
    static const struct {
        int32_t width, height, layers, left, right, top, bottom;
    } BAD[] = {
        {0, 5, 1, 0, 0, 0, 0},  {5, -1, 1, 0, 0, 0, 0}, {100000, 5, 1, 0, 0, 0, 0},
        {5, 5, 0, 0, 0, 0, 0},  {5, 5, 5, 0, 0, 0, 0},  {5, 5, 1, -1, 0, 0, 0},
        {5, 5, 1, 2, 3, 0, 0},  {5, 5, 1, 0, 0, 5, 0},  {5, 5, 1, 0, 2147483647, 0, 0},
        {5, 5, 1, 0, 0, 0, 99},
    };
    crv_context *context = NULL;
    assert_int_equal(crv_context_create(NULL, &context), CRV_OK);
    for (size_t i = 0; i < sizeof BAD / sizeof BAD[0]; i++) {
        crv_gbuffer_desc desc;
        crv_gbuffer_desc_init(&desc, sizeof desc, BAD[i].width, BAD[i].height);
        desc.layers = BAD[i].layers;
        desc.guard_left = BAD[i].left;
        desc.guard_right = BAD[i].right;
        desc.guard_top = BAD[i].top;
        desc.guard_bottom = BAD[i].bottom;
        crv_gbuffer *gbuffer = NULL;
        crv_plan *plan = NULL;
        crv_options options = fixture_options(NULL);
        assert_int_equal(crv_gbuffer_create(context, &desc, &gbuffer),
                         CRV_ERROR_INVALID_ARGUMENT);
        assert_int_equal(crv_plan_create(context, &options, &desc, &plan),
                         CRV_ERROR_INVALID_ARGUMENT);
        assert_null(gbuffer);
        assert_null(plan);
    }
    crv_context_destroy(context);
}

static void bad_images_are_refused(void **state)
{
    (void)state;
    static float pixels[WIDTH * HEIGHT * 3];
    const crv_image good = crv_image_packed(pixels, WIDTH, HEIGHT, 1);
    crv_image bad[7];
    for (int i = 0; i < 7; i++)
        bad[i] = good;
    bad[0].data = NULL;
    bad[1].width--;
    bad[2].height++;
    bad[3].channels = 3;
    bad[4].row_stride += 2;
    bad[5].pixel_stride = PTRDIFF_MAX / 4 * 4;
    bad[6].data = (float *)(void *)((char *)pixels + 1);
    crv_gbuffer_desc desc = small_desc();
    counter c = {0};
    objects o;
    assert_int_equal(make(&o, &c, &desc), CRV_OK);
    crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 1);
    assert_int_equal(crv_gbuffer_set_camera(o.gbuffer, &camera), CRV_OK);
    for (int i = 0; i < 7; i++)
        assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 0, &bad[i], NULL),
                         CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 0, &good, NULL), CRV_OK);
    for (int i = 0; i < 7; i++)
        assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &bad[i]),
                         CRV_ERROR_INVALID_ARGUMENT);
    /* An input may repeat a row or a pixel; an output may not. */
    crv_image repeated = good;
    repeated.row_stride = 0;
    assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 0, &repeated, NULL), CRV_OK);
    assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &repeated),
                     CRV_ERROR_INVALID_ARGUMENT);
    repeated.row_stride = (WIDTH - 1) * (ptrdiff_t)sizeof(float);
    assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &repeated),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_set_normals(o.gbuffer, &good, CRV_NORMAL_VIEW),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 1, &good, NULL),
                     CRV_ERROR_INVALID_ARGUMENT);
    destroy(&o);
}

static void bad_formats_and_cameras_are_refused(void **state)
{
    (void)state;
    static const crv_depth_format FORMATS[] = {
        {(crv_depth_encoding)9, 1, 2, 1},      {CRV_DEPTH_PLANAR, 0, 0, 0},
        {CRV_DEPTH_RADIAL, 0, 0, NAN},         {CRV_DEPTH_HARDWARE, 0, 10, 0},
        {CRV_DEPTH_HARDWARE, 1, 1, 0},         {CRV_DEPTH_REVERSED, NAN, 10, 0},
        {CRV_DEPTH_REVERSED, 1, -INFINITY, 0},
    };
    static float pixels[WIDTH * HEIGHT];
    crv_image image = crv_image_packed(pixels, WIDTH, HEIGHT, 1);
    crv_gbuffer_desc desc = small_desc();
    counter c = {0};
    objects o;
    assert_int_equal(make(&o, &c, &desc), CRV_OK);
    crv_camera good = crv_camera_perspective(WIDTH, HEIGHT, 1);
    assert_int_equal(crv_gbuffer_set_camera(o.gbuffer, &good), CRV_OK);
    for (size_t i = 0; i < sizeof FORMATS / sizeof FORMATS[0]; i++)
        assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 0, &image, &FORMATS[i]),
                         CRV_ERROR_INVALID_ARGUMENT);
    crv_camera bad[6];
    for (int i = 0; i < 6; i++)
        bad[i] = good;
    bad[0].fx_px = 0;
    bad[1].fy_px = INFINITY;
    bad[2].cx_px = NAN;
    bad[3].world_to_view[4] = 2;
    bad[4].world_to_view[0] = -1; /* a reflection */
    bad[5].projection = (crv_projection)2;
    for (int i = 0; i < 6; i++)
        assert_int_equal(crv_gbuffer_set_camera(o.gbuffer, &bad[i]),
                         CRV_ERROR_INVALID_ARGUMENT);
    destroy(&o);
}

static void nulls_are_refused(void **state)
{
    (void)state;
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    crv_gbuffer_desc desc = small_desc();
    crv_options options = fixture_options(NULL);
    assert_int_equal(crv_context_create(NULL, NULL), CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_context_create(&(crv_context_desc){0}, &context),
                     CRV_ERROR_INVALID_ARGUMENT);
    crv_context_desc half;
    crv_context_desc_init(&half, sizeof half);
    half.allocator.allocate = counting_allocate;
    assert_int_equal(crv_context_create(&half, &context), CRV_ERROR_INVALID_ARGUMENT);
    crv_context_desc_init(&half, sizeof half);
    half.threads = -1;
    assert_int_equal(crv_context_create(&half, &context), CRV_ERROR_INVALID_ARGUMENT);
    crv_context_desc_init(&half, sizeof half);
    half.half_filters = 2;
    assert_int_equal(crv_context_create(&half, &context), CRV_ERROR_INVALID_ARGUMENT);
    half.half_filters = 1;
    half.depth_layout = (crv_depth_layout)3;
    assert_int_equal(crv_context_create(&half, &context), CRV_ERROR_INVALID_ARGUMENT);
    assert_null(context);
    assert_int_equal(crv_context_create(NULL, &context), CRV_OK);
    assert_int_equal(crv_gbuffer_create(NULL, &desc, &gbuffer),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_create(context, NULL, &gbuffer),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_create(context, &desc, NULL),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_plan_create(NULL, &options, &desc, &plan),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_plan_create(context, NULL, &desc, &plan),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_plan_create(context, &options, NULL, &plan),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_plan_create(context, &options, &desc, NULL),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_plan_run(NULL, NULL, NULL), CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_plan_filter(NULL, NULL, NULL, NULL), CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_set_camera(NULL, NULL), CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_set_depth(NULL, 0, NULL, NULL),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_set_normals(NULL, NULL, CRV_NORMAL_VIEW),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_get_depth(NULL, 0, NULL), CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_get_normals(NULL, NULL), CRV_ERROR_INVALID_ARGUMENT);
    crv_plan_destroy(NULL);
    crv_gbuffer_destroy(NULL);
    crv_context_destroy(NULL);
    crv_context_destroy(context);
    assert_string_equal(crv_status_string(CRV_ERROR_OUT_OF_MEMORY), "out of memory");
    assert_non_null(crv_status_string((crv_status)-7));
    char version[32];
    snprintf(version, sizeof version, "%d.%d.%d", CRV_VERSION_MAJOR, CRV_VERSION_MINOR,
             CRV_VERSION_PATCH);
    assert_string_equal(crv_version(), version);
}

static void mismatched_objects_are_refused(void **state)
{
    (void)state;
    static float pixels[WIDTH * HEIGHT];
    crv_image image = crv_image_packed(pixels, WIDTH, HEIGHT, 1);
    crv_gbuffer_desc desc = small_desc(), shifted = small_desc();
    shifted.origin_x = 1;
    counter c = {0};
    objects a, b;
    assert_int_equal(make(&a, &c, &desc), CRV_OK);
    assert_int_equal(make(&b, &c, &shifted), CRV_OK);
    assert_int_equal(crv_plan_run(a.plan, b.gbuffer, &image), CRV_ERROR_INVALID_ARGUMENT);
    destroy(&a);
    destroy(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_failed_allocation_is_survived),
        cmocka_unit_test(a_run_allocates_nothing),
        cmocka_unit_test(memory_stays_within_the_promise),
        cmocka_unit_test(calls_out_of_order_are_told),
        cmocka_unit_test(bad_sizes_are_refused),
        cmocka_unit_test(bad_images_are_refused),
        cmocka_unit_test(bad_formats_and_cameras_are_refused),
        cmocka_unit_test(nulls_are_refused),
        cmocka_unit_test(mismatched_objects_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

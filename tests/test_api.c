/* SPDX-License-Identifier: MIT */
/* The library's manners: arguments, memory, threads, order of calls. */
#include "aligned.h"
#include "fixture.h"

#include <math.h>
#include <stdbool.h>
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
    void *memory = take_aligned(alignment, size);
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
    give_aligned(memory);
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
    crv_const_image image = crv_const_image_packed(depth, WIDTH, HEIGHT, 1);
    crv_image result = crv_image_packed(out, WIDTH, HEIGHT, 1);
    const crv_const_image estimate = crv_image_const(result);
    for (int frame = 0; frame < 3; frame++) {
        assert_int_equal(crv_gbuffer_set_camera(o.gbuffer, &camera), CRV_OK);
        assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 0, &image, NULL), CRV_OK);
        assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &result), CRV_OK);
        assert_int_equal(crv_plan_filter(o.plan, o.gbuffer, &estimate, &result), CRV_OK);
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
    const crv_const_image depth = crv_image_const(image);
    const crv_const_image vectors = crv_const_image_packed(normals, WIDTH, HEIGHT, 3);
    crv_camera camera = crv_camera_orthographic(WIDTH, HEIGHT, 1);
    counter c = {0};
    objects o;
    assert_int_equal(make(&o, &c, &desc), CRV_OK);
    assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &image), CRV_ERROR_NOT_READY);
    assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 0, &depth, NULL),
                     CRV_ERROR_NOT_READY);
    assert_int_equal(crv_gbuffer_set_normals(o.gbuffer, &vectors, CRV_NORMAL_VIEW),
                     CRV_ERROR_NOT_READY);
    assert_int_equal(crv_gbuffer_set_camera(o.gbuffer, &camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 0, &depth, NULL), CRV_OK);
    assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &image), CRV_ERROR_NOT_READY);
    assert_int_equal(crv_gbuffer_get_depth(o.gbuffer, 1, &image), CRV_ERROR_NOT_READY);
    assert_int_equal(crv_gbuffer_set_depth(o.gbuffer, 1, &depth, NULL), CRV_OK);
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

static void keep_line(void *user, crv_log_level level, const char *line)
{
    (void)level;
    snprintf(user, 256, "%s", line);
}

/* Room for a struct of the headers, and more than it. */
typedef union room {
    unsigned char bytes[512];
    size_t struct_size;
    crv_context_desc context;
    crv_gbuffer_desc gbuffer;
    crv_options options;
} room;

static crv_status init_context(room *r, size_t size)
{
    return crv_context_desc_init(&r->context, size);
}

static crv_status init_gbuffer(room *r, size_t size)
{
    return crv_gbuffer_desc_init(&r->gbuffer, size, WIDTH, HEIGHT);
}

static crv_status init_options(room *r, size_t size)
{
    return crv_options_init(&r->options, size, "vao");
}

static crv_status use_context(crv_context *context, const room *r)
{
    (void)context;
    crv_context *made = NULL;
    const crv_status status = crv_context_create(&r->context, &made);
    crv_context_destroy(made);
    return status;
}

static crv_status use_gbuffer(crv_context *context, const room *r)
{
    crv_gbuffer *made = NULL;
    const crv_status status = crv_gbuffer_create(context, &r->gbuffer, &made);
    crv_gbuffer_destroy(made);
    return status;
}

static crv_status use_options(crv_context *context, const room *r)
{
    crv_gbuffer_desc desc = small_desc();
    crv_plan *made = NULL;
    const crv_status status = crv_plan_create(context, &r->options, &desc, &made);
    crv_plan_destroy(made);
    return status;
}

/* base.h: every earlier size is taken and nothing is written beyond it; a larger one, and
 * what was never initialised, is refused with a line. Structs end at multiples of their
 * alignment. */
static void structs_of_every_earlier_size_are_taken(void **state)
{
    (void)state;
    static const struct {
        size_t first, size;
        crv_status (*init)(room *r, size_t size);
        crv_status (*use)(crv_context *context, const room *r);
    } CASES[] = {
        {offsetof(crv_context_desc, allocator), sizeof(crv_context_desc), init_context,
         use_context},
        {offsetof(crv_gbuffer_desc, guard_left), sizeof(crv_gbuffer_desc), init_gbuffer,
         use_gbuffer},
        {offsetof(crv_options, tau), sizeof(crv_options), init_options, use_options},
    };
    char line[256] = "";
    crv_context_desc hooks;
    crv_context *context = NULL;
    assert_int_equal(crv_context_desc_init(&hooks, sizeof hooks), CRV_OK);
    hooks.logger = (crv_logger){.fn = keep_line, .user = line};
    assert_int_equal(crv_context_create(&hooks, &context), CRV_OK);
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        for (size_t size = CASES[i].first; size <= CASES[i].size; size += 8) {
            room r;
            memset(&r, 0xa5, sizeof r);
            assert_int_equal(CASES[i].init(&r, size), CRV_OK);
            assert_int_equal(r.struct_size, size);
            for (size_t k = size; k < sizeof r; k++)
                assert_int_equal(r.bytes[k], 0xa5);
            assert_int_equal(CASES[i].use(context, &r), CRV_OK);
        }
        const size_t bad[] = {CASES[i].first - 8, CASES[i].size + 8};
        for (int k = 0; k < 2; k++) {
            room r;
            memset(&r, 0xa5, sizeof r);
            assert_int_equal(CASES[i].init(&r, bad[k]), CRV_ERROR_INVALID_ARGUMENT);
            for (size_t at = sizeof r.struct_size; at < bad[k]; at++)
                assert_int_equal(r.bytes[at], 0);
            line[0] = 0;
            assert_int_equal(CASES[i].use(context, &r), CRV_ERROR_INVALID_ARGUMENT);
            if (CASES[i].use != use_context) /* its logger is in the struct itself */
                assert_non_null(
                    strstr(line, k ? "as new as the headers" : "not initialised"));
        }
    }
    crv_context_destroy(context);
}

/* Options that the program does not know have their defaults, and cannot be set. */
static void missing_members_take_their_defaults(void **state)
{
    (void)state;
    crv_options full, early;
    assert_int_equal(crv_options_init(&full, sizeof full, "hbao"), CRV_OK);
    memset(&early, 0x7f, sizeof early);
    const size_t size = offsetof(crv_options, intensity) / 8 * 8;
    assert_int_equal(crv_options_init(&early, size, "hbao"), CRV_OK);
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        assert_true(crv_options_get(&early, option) == crv_options_get(&full, option));
    }
    assert_int_equal(crv_options_set(&early, "steps", "5", NULL), CRV_OK);
    assert_int_equal(crv_options_set(&early, "contrast", "2", NULL),
                     CRV_ERROR_UNSUPPORTED);
    assert_int_equal(crv_options_preset(&early, CRV_PRESET_ULTRA), CRV_OK);
    assert_int_equal(crv_options_check(&early, NULL), CRV_OK);
}

static crv_status set_depth(const objects *o, int32_t layer, crv_image image)
{
    const crv_const_image depth = crv_image_const(image);
    return crv_gbuffer_set_depth(o->gbuffer, layer, &depth, NULL);
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
        assert_int_equal(set_depth(&o, 0, bad[i]), CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(set_depth(&o, 0, good), CRV_OK);
    for (int i = 0; i < 7; i++)
        assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &bad[i]),
                         CRV_ERROR_INVALID_ARGUMENT);
    /* An input may repeat a row or a pixel; an output may not. */
    crv_image repeated = good;
    repeated.row_stride = 0;
    assert_int_equal(set_depth(&o, 0, repeated), CRV_OK);
    assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &repeated),
                     CRV_ERROR_INVALID_ARGUMENT);
    repeated.row_stride = (WIDTH - 1) * (ptrdiff_t)sizeof(float);
    assert_int_equal(crv_plan_run(o.plan, o.gbuffer, &repeated),
                     CRV_ERROR_INVALID_ARGUMENT);
    const crv_const_image one_channel = crv_image_const(good);
    assert_int_equal(crv_gbuffer_set_normals(o.gbuffer, &one_channel, CRV_NORMAL_VIEW),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(set_depth(&o, 1, good), CRV_ERROR_INVALID_ARGUMENT);
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
    const crv_const_image image = crv_const_image_packed(pixels, WIDTH, HEIGHT, 1);
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
    bad[4].world_to_view[1] = 0.5f; /* sheared */
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

static void what_was_built_in_is_told(void **state)
{
    (void)state;
    const uint32_t known = CRV_FEATURE_VULKAN | CRV_FEATURE_OPENMP;
    assert_int_equal(crv_features() & ~known, 0);
    crv_device_info info;
    const bool vulkan = crv_features() & CRV_FEATURE_VULKAN;
    const crv_status status = crv_vulkan_device_info(0, &info, NULL);
    assert_true(vulkan || status == CRV_ERROR_UNSUPPORTED);
    assert_int_equal(vulkan, CRV_HAS_VULKAN);
    assert_int_equal(crv_struct_size(CRV_STRUCT_OPTIONS), sizeof(crv_options));
    assert_int_equal(crv_struct_size(CRV_STRUCT_RESULT), sizeof(crv_result));
    assert_int_equal(crv_struct_size(CRV_STRUCT_GBUFFER_DESC), sizeof(crv_gbuffer_desc));
    assert_int_equal(crv_struct_size((crv_struct)99), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_failed_allocation_is_survived),
        cmocka_unit_test(a_run_allocates_nothing),
        cmocka_unit_test(memory_stays_within_the_promise),
        cmocka_unit_test(calls_out_of_order_are_told),
        cmocka_unit_test(bad_sizes_are_refused),
        cmocka_unit_test(what_was_built_in_is_told),
        cmocka_unit_test(bad_images_are_refused),
        cmocka_unit_test(structs_of_every_earlier_size_are_taken),
        cmocka_unit_test(missing_members_take_their_defaults),
        cmocka_unit_test(bad_formats_and_cameras_are_refused),
        cmocka_unit_test(nulls_are_refused),
        cmocka_unit_test(mismatched_objects_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

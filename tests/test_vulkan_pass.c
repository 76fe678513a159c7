/* SPDX-License-Identifier: MIT */
/* The engine's side of the Vulkan backend: images and a command buffer of the host's,
 * under the validation layer, against the scalar code. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "vulkan_stage.h"

#define DEPTHS(format, kind) VK_FORMAT_##format, CRV_DEPTH_##kind
#define NORMALS(format, kind, space)                                                     \
    VK_FORMAT_##format, CRV_VULKAN_NORMALS_##kind, CRV_NORMAL_##space

static const scene_encoding ENCODINGS[] = {
    {"D32 reversed", DEPTHS(D32_SFLOAT, REVERSED),
     NORMALS(R32G32B32A32_SFLOAT, XYZ, VIEW), VK_FORMAT_R32_SFLOAT, "hbao",
     "bilateral13"},
    {"D32 hardware", DEPTHS(D32_SFLOAT, HARDWARE),
     NORMALS(R32G32B32A32_SFLOAT, XYZ, WORLD), VK_FORMAT_R32_SFLOAT, "hbao", NULL},
    {"D16 hardware", DEPTHS(D16_UNORM, HARDWARE), NORMALS(R8G8B8A8_SNORM, XYZ, WORLD),
     VK_FORMAT_R16_SFLOAT, "alchemy", "gauss5"},
    {"D24 reversed", DEPTHS(X8_D24_UNORM_PACK32, REVERSED),
     NORMALS(R8G8B8A8_UNORM, XYZ_HALVED, VIEW), VK_FORMAT_R16_SFLOAT, "vo", NULL},
    {"D24S8 hardware", DEPTHS(D24_UNORM_S8_UINT, HARDWARE),
     NORMALS(A2B10G10R10_UNORM_PACK32, XYZ_HALVED, WORLD), VK_FORMAT_R8_UNORM, "vao",
     "box4"},
    {"R32F planar", DEPTHS(R32_SFLOAT, PLANAR), NORMALS(R16G16_SNORM, OCT, WORLD),
     VK_FORMAT_R8_UNORM, "hsao", "bilateral13"},
    {"R32F disparity", DEPTHS(R32_SFLOAT, DISPARITY),
     NORMALS(R8G8_UNORM, OCT_HALVED, VIEW), VK_FORMAT_R32_SFLOAT, "raymarch", NULL},
    {"D32, float octahedron", DEPTHS(D32_SFLOAT, REVERSED),
     NORMALS(R32G32_SFLOAT, OCT, VIEW), VK_FORMAT_R8_UNORM, "containment", NULL},
    {"gtao", DEPTHS(D32_SFLOAT, HARDWARE), NORMALS(R16G16_SFLOAT, OCT, VIEW),
     VK_FORMAT_R16_SFLOAT, "gtao", "box4"},
    {"bitmask", DEPTHS(D32_SFLOAT, REVERSED), NORMALS(R16G16_SFLOAT, OCT, WORLD),
     VK_FORMAT_R32_SFLOAT, "bitmask", NULL},
    {"no normals", DEPTHS(D32_SFLOAT, REVERSED), NORMALS(UNDEFINED, NONE, VIEW),
     VK_FORMAT_R32_SFLOAT, "hbao", "box4"},
    {"ssao", DEPTHS(D32_SFLOAT, REVERSED), NORMALS(UNDEFINED, NONE, VIEW),
     VK_FORMAT_R16_SFLOAT, "ssao", "gauss5"},
};

static void images_of_every_encoding_give_the_picture_of_the_cpu(void **state)
{
    engine *g = *state;
    scene_lines log = {0};
    crv_context *context = scene_context(g, &log);
    scene *s = malloc(sizeof *s);
    int tried = 0;
    assert_non_null(s);
    for (size_t i = 0; i < sizeof ENCODINGS / sizeof *ENCODINGS; i++) {
        const scene_encoding *e = &ENCODINGS[i];
        const crv_options options = scene_options(e);
        const crv_vulkan_pass_desc desc = scene_pass_desc(e);
        crv_vulkan_pass *pass = NULL;
        scene_make(s, e, 1);
        const crv_status status =
            crv_vulkan_pass_create(context, &options, &s->desc, &desc, &pass);
        if (!scene_has_format(g, e->depth_format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)
            || !scene_has_format(g, e->result_format,
                                 VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) {
            assert_int_equal(status, CRV_ERROR_UNSUPPORTED);
            continue;
        }
        assert_int_equal(status, CRV_OK);
        scene_images in = scene_upload(g, s, e);
        const crv_vulkan_frame frame = scene_frame(s, e, &in);
        assert_int_equal(crv_vulkan_pass_record(pass, engine_begin(g, 0), &frame),
                         CRV_OK);
        engine_submit(g, 0);
        engine_wait(g);
        float *got = scene_download(g, s, e, &in), *wanted = scene_scalar(s, e);
        scene_assert_agrees(s, e, got, wanted);
        free(got);
        free(wanted);
        scene_free(g, &in);
        crv_vulkan_pass_destroy(pass);
        tried++;
    }
    assert_true(tried >= 6); /* D24 is not everywhere; R8 and R16F storage neither */
    free(s);
    crv_context_destroy(context);
}

static void frames_in_flight_do_not_mix(void **state)
{
    engine *g = *state;
    scene_lines log = {0};
    const scene_encoding *e = &ENCODINGS[0];
    crv_context *context = scene_context(g, &log);
    const crv_options options = scene_options(e);
    const crv_vulkan_pass_desc desc = scene_pass_desc(e);
    crv_vulkan_pass *pass = NULL;
    scene *scenes[2];
    scene_images in[2];
    for (int i = 0; i < 2; i++) {
        scenes[i] = malloc(sizeof *scenes[i]);
        assert_non_null(scenes[i]);
        scene_make(scenes[i], e, i ? 1.2 : 1);
        in[i] = scene_upload(g, scenes[i], e);
    }
    scenes[1]->camera.cx_px += 5; /* of what was drawn otherwise: wrong, but another */
    assert_int_equal(
        crv_vulkan_pass_create(context, &options, &scenes[0]->desc, &desc, &pass),
        CRV_OK);
    for (int i = 0; i < 2; i++) {
        crv_vulkan_frame frame = scene_frame(scenes[i], e, &in[i]);
        frame.index = i;
        assert_int_equal(crv_vulkan_pass_record(pass, engine_begin(g, i), &frame),
                         CRV_OK);
    }
    engine_submit(g, 0);
    engine_submit(g, 1);
    engine_wait(g);
    for (int i = 0; i < 2; i++) {
        float *got = scene_download(g, scenes[i], e, &in[i]),
              *wanted = scene_scalar(scenes[i], e);
        scene_assert_agrees(scenes[i], e, got, wanted);
        free(got);
        free(wanted);
        scene_free(g, &in[i]);
        free(scenes[i]);
    }
    crv_vulkan_pass_destroy(pass);
    crv_context_destroy(context);
}

static void plans_run_on_the_queue_of_the_host(void **state)
{
    stage *t = stage_open_guarded(*state, &ENCODINGS[0]);
    float *got = scene_planned(t->context, t->s, &t->e),
          *wanted = scene_scalar(t->s, &t->e);
    scene_assert_agrees(t->s, &t->e, got, wanted);
    free(got);
    free(wanted);
    stage_close(t);
}

static void times_are_of_every_pass(void **state)
{
    stage *t = stage_open_guarded(*state, &ENCODINGS[0]);
    const crv_options options = scene_options(&t->e);
    crv_vulkan_pass_desc desc = scene_pass_desc(&t->e);
    crv_device_time times[CRV_MAX_DEVICE_TIMES];
    crv_vulkan_pass *pass = NULL, *plain = stage_usual_pass(t);
    int32_t count = -1;
    const crv_vulkan_frame frame = scene_frame(t->s, &t->e, &t->in);
    assert_int_equal(crv_vulkan_pass_times(plain, 0, times, &count),
                     CRV_ERROR_UNSUPPORTED);
    desc.timestamps = VK_TRUE;
    assert_int_equal(
        crv_vulkan_pass_create(t->context, &options, &t->s->desc, &desc, &pass), CRV_OK);
    t->log.errors = 0;
    assert_int_equal(crv_vulkan_pass_times(pass, 0, times, &count), CRV_ERROR_NOT_READY);
    assert_int_equal(t->log.errors, 1);
    assert_int_equal(crv_vulkan_pass_times(pass, 2, times, &count),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_vulkan_pass_times(pass, 0, NULL, &count),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_vulkan_pass_record(pass, engine_begin(t->g, 0), &frame), CRV_OK);
    engine_submit(t->g, 0);
    t->log.errors = 0;
    crv_status status;
    while ((status = crv_vulkan_pass_times(pass, 0, times, &count))
           == CRV_ERROR_NOT_READY)
        continue; /* nothing is wrong, and nothing is logged */
    assert_int_equal(t->log.errors, 0);
    engine_wait(t->g);
    assert_int_equal(status, CRV_OK);
    assert_int_equal(count, 4); /* depth and normals, hbao, two passes of the filter */
    assert_string_equal(times[0].name, "depth and normals");
    assert_string_equal(times[1].name, "hbao");
    double sum = 0;
    for (int32_t i = 0; i < count; i++) {
        assert_true(times[i].time_ms >= 0);
        sum += times[i].time_ms;
    }
    assert_true(sum > 0 && sum < 60000);
    crv_vulkan_pass_destroy(pass);
    crv_vulkan_pass_destroy(plain);
    stage_close(t);
}

static void a_plan_has_no_times_before_its_first_run(void **state)
{
    engine *g = *state;
    scene_lines log = {0};
    const scene_encoding *e = &ENCODINGS[0];
    crv_context *context = scene_context(g, &log);
    const crv_options options = scene_options(e);
    crv_device_time times[CRV_MAX_DEVICE_TIMES];
    crv_gbuffer_desc size;
    crv_plan *plan = NULL;
    int32_t count = -1;
    crv_gbuffer_desc_init(&size, sizeof size, SCENE_WIDTH, SCENE_HEIGHT);
    assert_int_equal(crv_plan_create(context, &options, &size, &plan), CRV_OK);
    assert_int_equal(crv_plan_device_times(plan, times, &count), CRV_ERROR_NOT_READY);
    assert_int_equal(log.errors, 1);
    assert_non_null(strstr(log.last, "crv_plan_run()"));
    crv_plan_destroy(plan);
    crv_context_destroy(context);
}

/* ---- structs of other versions ---- */

/* Room for a struct of the headers, and more than it. */
typedef union room {
    unsigned char bytes[1024];
    size_t struct_size;
    crv_vulkan_host host;
    crv_vulkan_pass_desc desc;
    crv_vulkan_frame frame;
} room;

/* What a struct is for: a pass of the usual size, or a frame of it. */
typedef struct user {
    engine *g;
    crv_context_desc context_desc;
    crv_context *context;
    crv_vulkan_pass *pass; /* with today's defaults */
    scene_images in;
} user;

static crv_status init_host(room *r, size_t size)
{
    return crv_vulkan_host_init(&r->host, size);
}

static crv_status use_host(const user *u, room *r)
{
    crv_context *context = NULL;
    const crv_vulkan_host full = engine_host(u->g);
    const size_t size = r->struct_size;
    if (size == sizeof full)
        r->host = full;
    const crv_status status =
        crv_vulkan_context_create(&u->context_desc, &r->host, &context);
    crv_context_destroy(context);
    return status;
}

static crv_status init_desc(room *r, size_t size)
{
    return crv_vulkan_pass_desc_init(&r->desc, size);
}

static crv_status use_desc(const user *u, room *r)
{
    const crv_options options = scene_options(&ENCODINGS[0]);
    crv_gbuffer_desc size;
    crv_vulkan_pass *pass = NULL;
    crv_gbuffer_desc_init(&size, sizeof size, SCENE_WIDTH, SCENE_HEIGHT);
    const crv_status status =
        crv_vulkan_pass_create(u->context, &options, &size, &r->desc, &pass);
    if (status == CRV_OK)
        assert_int_equal(crv_vulkan_pass_bytes(pass), crv_vulkan_pass_bytes(u->pass));
    crv_vulkan_pass_destroy(pass);
    return status;
}

static crv_status init_frame(room *r, size_t size)
{
    return crv_vulkan_frame_init(&r->frame, size);
}

static crv_status use_frame(const user *u, room *r)
{
    if (r->struct_size >= offsetof(crv_vulkan_frame, bent_normal)) {
        r->frame.camera = crv_camera_perspective(SCENE_WIDTH, SCENE_HEIGHT, 1);
        r->frame.depth[0].view = u->in.depth.view;
        r->frame.result = u->in.result.image;
        r->frame.result_view = u->in.result.view;
    }
    const VkCommandBuffer commands = engine_begin(u->g, 0);
    const crv_status status = crv_vulkan_pass_record(u->pass, commands, &r->frame);
    engine_submit(u->g, 0);
    engine_wait(u->g);
    return status;
}

/* Every size since the first version is taken, nothing is read or written beyond it, and
 * missing members have their defaults; other sizes are refused with a line. */
static void structs_of_every_earlier_size_are_taken(void **state)
{
    static const struct {
        size_t first, size;
        crv_status (*init)(room *r, size_t size);
        crv_status (*use)(const user *u, room *r);
    } CASES[] = {
        {sizeof(crv_vulkan_host), sizeof(crv_vulkan_host), init_host, use_host},
        {offsetof(crv_vulkan_pass_desc, normals), sizeof(crv_vulkan_pass_desc), init_desc,
         use_desc},
        {offsetof(crv_vulkan_frame, bent_normal), sizeof(crv_vulkan_frame), init_frame,
         use_frame},
    };
    scene_lines log = {0};
    scene_encoding e = ENCODINGS[0]; /* what the defaults of a pass are for */
    e.normals = CRV_VULKAN_NORMALS_NONE;
    e.result_format = VK_FORMAT_R8_UNORM;
    const crv_options options = scene_options(&e);
    crv_vulkan_pass_desc desc;
    scene *s = malloc(sizeof *s);
    assert_non_null(s);
    scene_make_sized(s, &e, 1, SCENE_WIDTH, SCENE_HEIGHT);
    user u = {.g = *state};
    crv_context_desc_init(&u.context_desc, sizeof u.context_desc);
    u.context_desc.logger = (crv_logger){.fn = scene_keep_line, .user = &log};
    u.context = scene_context(u.g, &log);
    u.in = scene_upload(u.g, s, &e);
    crv_vulkan_pass_desc_init(&desc, sizeof desc);
    assert_int_equal(
        crv_vulkan_pass_create(u.context, &options, &s->desc, &desc, &u.pass), CRV_OK);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        for (size_t size = CASES[i].first - 8; size <= CASES[i].size + 8; size += 8) {
            const int fits = size >= CASES[i].first && size <= CASES[i].size;
            const crv_status wanted = fits ? CRV_OK : CRV_ERROR_INVALID_ARGUMENT;
            room r;
            memset(&r, 0xa5, sizeof r);
            log = (scene_lines){0};
            assert_int_equal(CASES[i].init(&r, size), wanted);
            assert_int_equal(r.struct_size, size);
            for (size_t k = size; k < sizeof r; k++)
                assert_int_equal(r.bytes[k], 0xa5);
            assert_int_equal(CASES[i].use(&u, &r), wanted);
            assert_int_equal(log.errors, !fits);
            if (!fits)
                assert_non_null(strstr(log.last, size < CASES[i].first
                                                     ? "not initialised"
                                                     : "as new as the headers"));
        }
    }
    crv_vulkan_pass_destroy(u.pass);
    scene_free(u.g, &u.in);
    crv_context_destroy(u.context);
    free(s);
}

/* ---- what is refused ---- */

static void assert_refused(scene_lines *log, crv_status status, crv_status wanted)
{
    assert_int_equal(status, wanted);
    assert_int_equal(log->errors, 1);
    assert_true(strlen(log->last) > 10);
    log->errors = 0;
}

static void bad_passes_are_refused_with_one_line(void **state)
{
    engine *g = *state;
    scene_lines log = {0};
    crv_context *context = scene_context(g, &log), *cpu = NULL;
    const scene_encoding *e = &ENCODINGS[0];
    const crv_options options = scene_options(e);
    crv_gbuffer_desc size;
    crv_gbuffer_desc_init(&size, sizeof size, SCENE_WIDTH, SCENE_HEIGHT);
    crv_vulkan_pass *pass = NULL;
    crv_vulkan_pass_desc d = scene_pass_desc(e);
#define REFUSED(status, change)                                                          \
    do {                                                                                 \
        d = scene_pass_desc(e);                                                          \
        change;                                                                          \
        assert_refused(&log,                                                             \
                       crv_vulkan_pass_create(context, &options, &size, &d, &pass),      \
                       CRV_ERROR_##status);                                              \
        assert_null(pass);                                                               \
    } while (0)
    REFUSED(INVALID_ARGUMENT, d.struct_size = 0);
    REFUSED(INVALID_ARGUMENT, d.frames = 0);
    REFUSED(INVALID_ARGUMENT, d.frames = CRV_VULKAN_MAX_FRAMES + 1);
    REFUSED(INVALID_ARGUMENT, d.normals = (crv_vulkan_normals)5);
    REFUSED(INVALID_ARGUMENT, d.normal_space = (crv_normal_space)2);
    REFUSED(UNSUPPORTED, d.depth_format = VK_FORMAT_UNDEFINED);
    REFUSED(UNSUPPORTED, d.depth_format = VK_FORMAT_R64_SFLOAT);
    REFUSED(UNSUPPORTED, d.normal_format = VK_FORMAT_R64G64_SFLOAT);
    REFUSED(UNSUPPORTED, d.result_format = VK_FORMAT_D32_SFLOAT);
    REFUSED(INVALID_ARGUMENT, d.half_filters = (crv_vulkan_half)3);
    REFUSED(INVALID_ARGUMENT, d.depth_layout = (crv_vulkan_depth_layout)3);
    REFUSED(INVALID_ARGUMENT, d.level_px = 0);
#undef REFUSED
    d = scene_pass_desc(e);
    assert_refused(&log, crv_vulkan_pass_create(context, &options, &size, NULL, &pass),
                   CRV_ERROR_INVALID_ARGUMENT);
    assert_refused(&log, crv_vulkan_pass_create(context, &options, NULL, &d, &pass),
                   CRV_ERROR_INVALID_ARGUMENT);
    assert_refused(&log, crv_vulkan_pass_create(context, NULL, &size, &d, &pass),
                   CRV_ERROR_INVALID_ARGUMENT);
    assert_refused(&log, crv_vulkan_pass_create(context, &options, &size, &d, NULL),
                   CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_vulkan_pass_create(NULL, &options, &size, &d, &pass),
                     CRV_ERROR_INVALID_ARGUMENT);
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = (crv_logger){.fn = scene_keep_line, .user = &log};
    assert_int_equal(crv_context_create(&desc, &cpu), CRV_OK);
    assert_refused(&log, crv_vulkan_pass_create(cpu, &options, &size, &d, &pass),
                   CRV_ERROR_UNSUPPORTED);
    crv_context_destroy(cpu);
    crv_context_destroy(context);
    crv_vulkan_pass_destroy(NULL);
    assert_int_equal(crv_vulkan_pass_bytes(NULL), 0);
}

static void bad_settings_of_plans_are_refused_with_one_line(void **state)
{
    scene_lines log = {0};
    crv_context *context = scene_context(*state, &log), *cpu = NULL;
    const crv_vulkan_depth_layout linear = CRV_VULKAN_DEPTH_LINEAR;
    const crv_vulkan_half off = CRV_VULKAN_HALF_OFF;
    assert_refused(&log,
                   crv_vulkan_context_set_plans(context, (crv_vulkan_depth_layout)3, off),
                   CRV_ERROR_INVALID_ARGUMENT);
    assert_refused(&log,
                   crv_vulkan_context_set_plans(context, linear, (crv_vulkan_half)3),
                   CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_vulkan_context_set_plans(NULL, linear, off),
                     CRV_ERROR_INVALID_ARGUMENT);
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = (crv_logger){.fn = scene_keep_line, .user = &log};
    assert_int_equal(crv_context_create(&desc, &cpu), CRV_OK);
    assert_refused(&log, crv_vulkan_context_set_plans(cpu, linear, off),
                   CRV_ERROR_UNSUPPORTED);
    crv_context_destroy(cpu);
    crv_context_destroy(context);
}

/* It stays with a line, and so does what was made with it. */
static void a_context_is_not_destroyed_before_its_passes(void **state)
{
    stage *t = stage_open_guarded(*state, &ENCODINGS[0]);
    crv_vulkan_pass *pass = stage_usual_pass(t);
    crv_context_destroy(t->context);
    assert_int_equal(t->log.errors, 1);
    assert_non_null(strstr(t->log.last, "destroy them first"));
    const crv_vulkan_frame frame = scene_frame(t->s, &t->e, &t->in);
    stage_draw(t, pass, &frame);
    crv_vulkan_pass_destroy(pass);
    assert_int_equal(t->log.errors, 1);
    stage_close(t); /* or the layer misses the context when the device goes */
}

static void what_lavapipe_would_break_off_is_refused_there(void **state)
{
    engine *g = *state;
    scene_lines log = {0};
    crv_context *context = scene_context(g, &log);
    const crv_vulkan_pass_desc desc = scene_pass_desc(&ENCODINGS[0]);
    crv_options options = fixture_options("raymarch");
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    vkGetPhysicalDeviceProperties2(g->h.physical, &properties);
    crv_gbuffer_desc size;
    crv_vulkan_pass *pass = NULL;
    crv_gbuffer_desc_init(&size, sizeof size, 8, 8);
    size.layers = CRV_MAX_LAYERS;
    options.steps = 256;
    options.normal_rays = 64; /* 83000 rounds for one direction */
    const crv_status status =
        crv_vulkan_pass_create(context, &options, &size, &desc, &pass);
    if (driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE) {
        assert_refused(&log, status, CRV_ERROR_UNSUPPORTED);
        assert_non_null(strstr(log.last, "lavapipe"));
    } else {
        assert_int_equal(status, CRV_OK);
    }
    crv_vulkan_pass_destroy(pass);
    crv_context_destroy(context);
}

static void bad_frames_are_refused_with_one_line(void **state)
{
    stage *t = stage_open_guarded(*state, &ENCODINGS[0]);
    crv_vulkan_pass *pass = stage_usual_pass(t);
    const VkCommandBuffer commands = engine_begin(t->g, 0);
    crv_vulkan_frame f;
#define REFUSED(change)                                                                  \
    do {                                                                                 \
        f = scene_frame(t->s, &t->e, &t->in);                                            \
        change;                                                                          \
        assert_refused(&t->log, crv_vulkan_pass_record(pass, commands, &f),              \
                       CRV_ERROR_INVALID_ARGUMENT);                                      \
    } while (0)
    REFUSED(f.struct_size = 0);
    REFUSED(f.index = -1);
    REFUSED(f.index = scene_pass_desc(&t->e).frames);
    REFUSED(f.depth[0].view = VK_NULL_HANDLE);
    REFUSED(f.depth[0].layout = VK_IMAGE_LAYOUT_UNDEFINED);
    REFUSED(f.depth[0].layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    REFUSED(f.normals.view = VK_NULL_HANDLE);
    REFUSED(f.normals.layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    REFUSED(f.result = VK_NULL_HANDLE);
    REFUSED(f.result_view = VK_NULL_HANDLE);
    REFUSED(f.result_layout = VK_IMAGE_LAYOUT_UNDEFINED);
    REFUSED(f.camera.fx_px = NAN);
    REFUSED(f.depth_encoding.z_near = 0);
#undef REFUSED
    f = scene_frame(t->s, &t->e, &t->in);
    assert_refused(&t->log, crv_vulkan_pass_record(pass, NULL, &f),
                   CRV_ERROR_INVALID_ARGUMENT);
    assert_refused(&t->log, crv_vulkan_pass_record(pass, commands, NULL),
                   CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_vulkan_pass_record(NULL, commands, &f),
                     CRV_ERROR_INVALID_ARGUMENT);
    engine_submit(t->g, 0); /* nothing was recorded: valid, and empty */
    engine_wait(t->g);
    crv_vulkan_pass_destroy(pass);
    stage_close(t);
}

static void bad_hosts_are_refused_with_one_line(void **state)
{
    engine *g = *state;
    scene_lines log = {0};
    crv_context_desc desc;
    crv_context *context = NULL;
    crv_vulkan_host h;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = (crv_logger){.fn = scene_keep_line, .user = &log};
#define REFUSED(status, change)                                                          \
    do {                                                                                 \
        h = engine_host(g);                                                              \
        change;                                                                          \
        assert_refused(&log, crv_vulkan_context_create(&desc, &h, &context),             \
                       CRV_ERROR_##status);                                              \
        assert_null(context);                                                            \
    } while (0)
    REFUSED(INVALID_ARGUMENT, h.struct_size = 0);
    REFUSED(INVALID_ARGUMENT, h.instance = VK_NULL_HANDLE);
    REFUSED(INVALID_ARGUMENT, h.physical_device = VK_NULL_HANDLE);
    REFUSED(INVALID_ARGUMENT, h.device = VK_NULL_HANDLE);
    REFUSED(INVALID_ARGUMENT, h.queue_family = 99);
    REFUSED(UNSUPPORTED, h.has_synchronization2 = VK_FALSE);
    REFUSED(UNSUPPORTED, h.has_storage_image_write_without_format = VK_FALSE);
    REFUSED(INVALID_ARGUMENT,
            h.memory.release = (void (*)(void *, const crv_vulkan_block *))abort);
#undef REFUSED
    assert_refused(&log, crv_vulkan_context_create(&desc, NULL, &context),
                   CRV_ERROR_INVALID_ARGUMENT);
    /* Without a queue there are passes, but no plans. */
    h = engine_host(g);
    h.queue = VK_NULL_HANDLE;
    assert_int_equal(crv_vulkan_context_create(&desc, &h, &context), CRV_OK);
    const crv_options options = fixture_options("hbao");
    crv_gbuffer_desc size;
    crv_gbuffer_desc_init(&size, sizeof size, SCENE_WIDTH, SCENE_HEIGHT);
    crv_plan *plan = NULL;
    assert_refused(&log, crv_plan_create(context, &options, &size, &plan),
                   CRV_ERROR_INVALID_ARGUMENT);
    crv_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_of_every_encoding_give_the_picture_of_the_cpu),
        cmocka_unit_test(frames_in_flight_do_not_mix),
        cmocka_unit_test(plans_run_on_the_queue_of_the_host),
        cmocka_unit_test(times_are_of_every_pass),
        cmocka_unit_test(a_plan_has_no_times_before_its_first_run),
        cmocka_unit_test(structs_of_every_earlier_size_are_taken),
        cmocka_unit_test(bad_passes_are_refused_with_one_line),
        cmocka_unit_test(bad_settings_of_plans_are_refused_with_one_line),
        cmocka_unit_test(a_context_is_not_destroyed_before_its_passes),
        cmocka_unit_test(what_lavapipe_would_break_off_is_refused_there),
        cmocka_unit_test(bad_frames_are_refused_with_one_line),
        cmocka_unit_test(bad_hosts_are_refused_with_one_line),
        cmocka_unit_test(the_validation_layer_is_silent),
    };
    const int refused = engine_tests_begin();
    if (refused)
        return refused;
    return engine_tests_end(cmocka_run_group_tests(tests, engine_tests_setup, NULL));
}

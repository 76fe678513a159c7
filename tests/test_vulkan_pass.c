/* SPDX-License-Identifier: MIT */
/* The engine's side of the Vulkan backend: images and a command buffer of the host's,
 * under the validation layer, against the scalar code. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "vulkan_engine.h"

/* Of such a size that one texel, taken for its neighbour at a silhouette and spread by a
 * filter over a dozen pixels, is no large share. */
enum { WIDTH = 240, HEIGHT = 180, PIXELS = WIDTH * HEIGHT };

/* A rotation about y by 0.5 rad and then about x by 0.3. */
static const float TO_VIEW[9] = {0.87758256f,  0,           0.47942554f,
                                 0.14167993f,  0.95533649f, -0.25934338f,
                                 -0.45801266f, 0.29552021f, 0.83838664f};

/* ---- lines of the log ---- */

typedef struct lines {
    int errors;
    char last[512];
} lines;

static void keep_line(void *user, crv_log_level level, const char *line)
{
    lines *l = user;
    if (level != CRV_LOG_ERROR)
        return;
    l->errors++;
    snprintf(l->last, sizeof l->last, "%s", line);
}

static crv_context *open_context(engine *e, lines *log)
{
    const crv_vulkan_host device = engine_host(e);
    crv_context *context = NULL;
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = (crv_logger){.fn = keep_line, .user = log};
    assert_int_equal(crv_vulkan_context_create(&desc, &device, &context), CRV_OK);
    return context;
}

/* ---- formats: what the host stores, and what that means ---- */

typedef struct encoding {
    const char *name;
    VkFormat depth_format;
    crv_depth_encoding depth;
    VkFormat normal_format;
    crv_vulkan_normals normals;
    crv_normal_space space;
    VkFormat result_format;
    const char *method, *filter;
} encoding;

static const float Z_NEAR = 1, Z_FAR = 40;

/* Depth as the host's renderer writes it. */
static double stored_depth(crv_depth_encoding kind, double d)
{
    const double n = (double)Z_NEAR, f = (double)Z_FAR;
    if (kind == CRV_DEPTH_HARDWARE)
        return isfinite(d) ? (f / (f - n)) * (1 - n / d) : 1;
    if (kind == CRV_DEPTH_REVERSED)
        return isfinite(d) ? n / d : 0; /* infinite far plane */
    if (kind == CRV_DEPTH_DISPARITY)
        return isfinite(d) ? 1 / d : 0;
    return d;
}

static size_t texel_size(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R8G8_UNORM:
        return 2;
    case VK_FORMAT_R8_UNORM:
        return 1;
    case VK_FORMAT_R32G32_SFLOAT:
        return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        return 16;
    default:
        return 4;
    }
}

/* Writes a depth texel; what it then holds. */
static float put_depth(VkFormat format, double value, void *texel)
{
    if (format == VK_FORMAT_D16_UNORM) {
        const uint16_t bits = (uint16_t)lrint(value * 65535);
        memcpy(texel, &bits, sizeof bits);
        return (float)(bits / 65535.0);
    }
    if (format == VK_FORMAT_X8_D24_UNORM_PACK32
        || format == VK_FORMAT_D24_UNORM_S8_UINT) {
        const uint32_t bits = (uint32_t)lrint(value * 16777215);
        memcpy(texel, &bits, sizeof bits);
        return (float)(bits / 16777215.0);
    }
    const float number = (float)value;
    memcpy(texel, &number, sizeof number);
    return number;
}

/* Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit
 * Vectors". */
static void octahedral(const double n[3], double e[2])
{
    const double sum = fabs(n[0]) + fabs(n[1]) + fabs(n[2]);
    const double x = sum > 0 ? n[0] / sum : 0, y = sum > 0 ? n[1] / sum : 0;
    e[0] = n[2] >= 0 ? x : copysign(1 - fabs(y), x);
    e[1] = n[2] >= 0 ? y : copysign(1 - fabs(x), y);
}

static void unfold(const double e[2], double n[3])
{
    n[2] = 1 - fabs(e[0]) - fabs(e[1]);
    n[0] = n[2] >= 0 ? e[0] : copysign(1 - fabs(e[1]), e[0]);
    n[1] = n[2] >= 0 ? e[1] : copysign(1 - fabs(e[0]), e[1]);
}

static double put_unsigned(double value, int bits, uint32_t *out)
{
    const double most = (1u << bits) - 1;
    *out = (uint32_t)lrint((value * 0.5 + 0.5) * most);
    return *out / most * 2 - 1;
}

static double put_signed(double value, int bits, uint32_t *out)
{
    const double most = (1u << (bits - 1)) - 1;
    const int32_t whole = (int32_t)lrint(value * most);
    *out = (uint32_t)whole & ((1u << bits) - 1);
    return whole / most;
}

/* Writes a normal's texel; n becomes what it then holds, of any length. */
static void put_normal(VkFormat format, crv_vulkan_normals kind, double n[3], void *texel)
{
    double stored[3] = {n[0], n[1], n[2]};
    uint32_t bits[3] = {0}, word;
    float numbers[4] = {0};
    const int flat =
        kind == CRV_VULKAN_NORMALS_OCT || kind == CRV_VULKAN_NORMALS_OCT_HALVED;
    if (flat)
        octahedral(n, stored);
    for (int k = 0; k < (flat ? 2 : 3); k++) {
        numbers[k] = (float)stored[k];
        if (format == VK_FORMAT_R16G16_SNORM)
            stored[k] = put_signed(stored[k], 16, &bits[k]);
        else if (format == VK_FORMAT_R8G8B8A8_SNORM)
            stored[k] = put_signed(stored[k], 8, &bits[k]);
        else if (format == VK_FORMAT_A2B10G10R10_UNORM_PACK32)
            stored[k] = put_unsigned(stored[k], 10, &bits[k]);
        else if (format == VK_FORMAT_R8G8_UNORM || format == VK_FORMAT_R8G8B8A8_UNORM)
            stored[k] = put_unsigned(stored[k], 8, &bits[k]);
    }
    if (format == VK_FORMAT_R32G32B32A32_SFLOAT || format == VK_FORMAT_R32G32_SFLOAT) {
        memcpy(texel, numbers, texel_size(format));
    } else {
        const int shift = format == VK_FORMAT_A2B10G10R10_UNORM_PACK32 ? 10
                          : format == VK_FORMAT_R16G16_SNORM           ? 16
                                                                       : 8;
        word = bits[0] | bits[1] << shift | (flat ? 0 : bits[2] << (2 * shift));
        memcpy(texel, &word, texel_size(format));
    }
    if (flat)
        unfold(stored, n);
    else
        memcpy(n, stored, sizeof stored);
}

/* ---- a frame, on both ---- */

typedef struct scene {
    crv_camera camera;
    crv_gbuffer_desc desc;
    float depth[PIXELS], normals[3 * PIXELS]; /* as stored, decoded */
    unsigned char depth_bytes[4 * PIXELS], normal_bytes[16 * PIXELS];
} scene;

static void make_scene(scene *s, const encoding *e, double scale)
{
    s->camera = crv_camera_perspective(WIDTH, HEIGHT, 1);
    memcpy(s->camera.world_to_view, TO_VIEW, sizeof TO_VIEW);
    crv_gbuffer_desc_init(&s->desc, sizeof s->desc, WIDTH, HEIGHT);
    s->desc.guard_left = 9;
    s->desc.guard_top = 3;
    s->desc.guard_right = 1;
    s->desc.origin_x = 9;
    fixture f = fixture_make(fixture_spheres, &scale, &s->camera, WIDTH, HEIGHT);
    for (size_t i = 0; i < PIXELS; i++) {
        double n[3], world[3];
        s->depth[i] =
            put_depth(e->depth_format, stored_depth(e->depth, (double)f.depth[i]),
                      s->depth_bytes + i * texel_size(e->depth_format));
        for (size_t k = 0; k < 3; k++)
            n[k] = (double)f.normals[3 * i + k];
        for (int k = 0; k < 3 && e->space == CRV_NORMAL_WORLD; k++)
            world[k] = (double)TO_VIEW[k] * n[0] + (double)TO_VIEW[3 + k] * n[1]
                       + (double)TO_VIEW[6 + k] * n[2];
        if (e->space == CRV_NORMAL_WORLD)
            memcpy(n, world, sizeof n);
        if (e->normals)
            put_normal(e->normal_format, e->normals, n,
                       s->normal_bytes + i * texel_size(e->normal_format));
        for (size_t k = 0; k < 3; k++)
            s->normals[3 * i + k] = (float)n[k];
    }
    fixture_free(&f);
}

static crv_options options_of(const encoding *e)
{
    crv_options options = fixture_options(e->method);
    options.radius = 0.8f;
    assert_int_equal(
        crv_options_set(&options, "filter", e->filter ? e->filter : "none", NULL),
        CRV_OK);
    return options;
}

static crv_depth_format format_of(const encoding *e)
{
    crv_depth_format format = crv_depth_format_planar();
    format.encoding = e->depth;
    if (e->depth == CRV_DEPTH_HARDWARE || e->depth == CRV_DEPTH_REVERSED)
        format.z_near = Z_NEAR;
    if (e->depth == CRV_DEPTH_HARDWARE)
        format.z_far = Z_FAR;
    if (e->depth == CRV_DEPTH_REVERSED)
        format.z_far = INFINITY;
    return format;
}

static int result_width(const scene *s)
{
    return s->desc.width - s->desc.guard_left - s->desc.guard_right;
}

static int result_height(const scene *s)
{
    return s->desc.height - s->desc.guard_top - s->desc.guard_bottom;
}

/* The scene on a context, through the ordinary interface. */
static float *planned(crv_context *context, const scene *s, const encoding *e)
{
    const crv_options options = options_of(e);
    const crv_depth_format format = format_of(e);
    const crv_image depth = crv_image_packed((float *)s->depth, WIDTH, HEIGHT, 1);
    const crv_image normals = crv_image_packed((float *)s->normals, WIDTH, HEIGHT, 3);
    float *pixels = malloc(PIXELS * sizeof *pixels);
    const crv_image result =
        crv_image_packed(pixels, result_width(s), result_height(s), 1);
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    assert_non_null(pixels);
    assert_int_equal(crv_gbuffer_create(context, &s->desc, &gbuffer), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(gbuffer, &s->camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(gbuffer, 0, &depth, &format), CRV_OK);
    if (e->normals)
        assert_int_equal(crv_gbuffer_set_normals(gbuffer, &normals, e->space), CRV_OK);
    assert_int_equal(crv_plan_create(context, &options, &s->desc, &plan), CRV_OK);
    assert_int_equal(crv_plan_run(plan, gbuffer, &result), CRV_OK);
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    return pixels;
}

static float *scalar(const scene *s, const encoding *e)
{
    crv_context *context = NULL;
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.isa_mask = 1u << CRV_ISA_SCALAR;
    desc.exact = 1;
    assert_int_equal(crv_context_create(&desc, &context), CRV_OK);
    float *pixels = planned(context, s, e);
    crv_context_destroy(context);
    return pixels;
}

static crv_vulkan_pass_desc pass_desc(const encoding *e)
{
    crv_vulkan_pass_desc desc;
    crv_vulkan_pass_desc_init(&desc, sizeof desc);
    desc.depth_format = e->depth_format;
    desc.normals = e->normals;
    desc.normal_space = e->space;
    desc.normal_format = e->normal_format;
    desc.result_format = e->result_format;
    desc.half_filters = CRV_VULKAN_HALF_ON; /* also on lavapipe */
    return desc;
}

typedef struct images {
    host_image depth, normals, result;
} images;

static images upload(engine *g, const scene *s, const encoding *e)
{
    images i = {0};
    i.depth = engine_upload(g, e->depth_format, WIDTH, HEIGHT, s->depth_bytes,
                            PIXELS * texel_size(e->depth_format));
    if (e->normals)
        i.normals = engine_upload(g, e->normal_format, WIDTH, HEIGHT, s->normal_bytes,
                                  PIXELS * texel_size(e->normal_format));
    i.result = engine_result(g, e->result_format, result_width(s), result_height(s));
    return i;
}

static void free_images(engine *g, images *i)
{
    host_image_free(&g->h, &i->depth);
    if (i->normals.image)
        host_image_free(&g->h, &i->normals);
    host_image_free(&g->h, &i->result);
}

static crv_vulkan_frame frame_of(const scene *s, const encoding *e, const images *i)
{
    crv_vulkan_frame frame;
    crv_vulkan_frame_init(&frame, sizeof frame);
    frame.camera = s->camera;
    frame.depth_encoding = format_of(e);
    frame.depth[0].view = i->depth.view;
    frame.normals.view = i->normals.view;
    frame.result = i->result.image;
    frame.result_view = i->result.view;
    frame.result_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    frame.result_stages = VK_PIPELINE_STAGE_2_COPY_BIT;
    frame.result_access = VK_ACCESS_2_TRANSFER_READ_BIT;
    return frame;
}

static float half(uint16_t bits)
{
    const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
    return exponent ? ldexpf((float)(mantissa | 1024), exponent - 25)
                    : ldexpf((float)mantissa, -24);
}

static float *download(engine *g, const scene *s, const encoding *e, const images *i)
{
    const size_t count = (size_t)result_width(s) * (size_t)result_height(s);
    float *pixels = malloc(count * sizeof *pixels);
    unsigned char *bytes =
        engine_download(g, &i->result, result_width(s), result_height(s),
                        count * texel_size(e->result_format));
    assert_non_null(pixels);
    assert_non_null(bytes);
    for (size_t k = 0; k < count; k++) {
        uint16_t bits;
        if (e->result_format == VK_FORMAT_R8_UNORM) {
            pixels[k] = (float)bytes[k] / 255.0f;
        } else if (e->result_format == VK_FORMAT_R16_SFLOAT) {
            memcpy(&bits, bytes + 2 * k, sizeof bits);
            pixels[k] = half(bits);
        } else {
            memcpy(&pixels[k], bytes + 4 * k, sizeof *pixels);
        }
    }
    free(bytes);
    return pixels;
}

/*
 * 2e-3 but for a pixel in a thousand, which is what the backend promises: a device may
 * round a division otherwise and then takes the neighbouring texel. A step of 8 bits is
 * 1/255, of which half is lost.
 */
static void assert_agrees(const scene *s, const encoding *e, const float *got,
                          const float *wanted)
{
    const double tolerance =
        2e-3 + (e->result_format == VK_FORMAT_R8_UNORM ? 0.5 / 255 : 0);
    const int count = result_width(s) * result_height(s);
    int beyond = 0;
    for (int i = 0; i < count; i++)
        beyond += !(fabs((double)got[i] - (double)wanted[i]) <= tolerance);
    if (beyond > count / 1000)
        fail_msg("%s: %d of %d pixels differ", e->name, beyond, count);
}

#define DEPTHS(format, kind) VK_FORMAT_##format, CRV_DEPTH_##kind
#define NORMALS(format, kind, space)                                                     \
    VK_FORMAT_##format, CRV_VULKAN_NORMALS_##kind, CRV_NORMAL_##space

static const encoding ENCODINGS[] = {
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
    {"no normals", DEPTHS(D32_SFLOAT, REVERSED), NORMALS(UNDEFINED, NONE, VIEW),
     VK_FORMAT_R32_SFLOAT, "hbao", "box4"},
    {"ssao", DEPTHS(D32_SFLOAT, REVERSED), NORMALS(UNDEFINED, NONE, VIEW),
     VK_FORMAT_R16_SFLOAT, "ssao", "gauss5"},
};

static int has_format(const engine *g, VkFormat format, VkFormatFeatureFlags feature)
{
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(g->h.physical, format, &properties);
    return (properties.optimalTilingFeatures & feature) != 0;
}

static void images_of_every_encoding_give_the_picture_of_the_cpu(void **state)
{
    engine *g = *state;
    lines log = {0};
    crv_context *context = open_context(g, &log);
    scene *s = malloc(sizeof *s);
    int tried = 0;
    assert_non_null(s);
    for (size_t i = 0; i < sizeof ENCODINGS / sizeof *ENCODINGS; i++) {
        const encoding *e = &ENCODINGS[i];
        const crv_options options = options_of(e);
        const crv_vulkan_pass_desc desc = pass_desc(e);
        crv_vulkan_pass *pass = NULL;
        make_scene(s, e, 1);
        const crv_status status =
            crv_vulkan_pass_create(context, &options, &s->desc, &desc, &pass);
        if (!has_format(g, e->depth_format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)
            || !has_format(g, e->result_format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) {
            assert_int_equal(status, CRV_ERROR_UNSUPPORTED);
            continue;
        }
        assert_int_equal(status, CRV_OK);
        images in = upload(g, s, e);
        const crv_vulkan_frame frame = frame_of(s, e, &in);
        assert_int_equal(crv_vulkan_pass_record(pass, engine_begin(g, 0), &frame),
                         CRV_OK);
        engine_submit(g, 0);
        engine_wait(g);
        float *got = download(g, s, e, &in), *wanted = scalar(s, e);
        assert_agrees(s, e, got, wanted);
        free(got);
        free(wanted);
        free_images(g, &in);
        crv_vulkan_pass_destroy(pass);
        tried++;
    }
    assert_true(tried >= 6); /* D24 is not everywhere; R8 and R16F storage neither */
    free(s);
    crv_context_destroy(context);
}

static void frames_in_flight_keep_apart(void **state)
{
    engine *g = *state;
    lines log = {0};
    const encoding *e = &ENCODINGS[0];
    crv_context *context = open_context(g, &log);
    const crv_options options = options_of(e);
    const crv_vulkan_pass_desc desc = pass_desc(e);
    crv_vulkan_pass *pass = NULL;
    scene *scenes[2];
    images in[2];
    for (int i = 0; i < 2; i++) {
        scenes[i] = malloc(sizeof *scenes[i]);
        assert_non_null(scenes[i]);
        make_scene(scenes[i], e, i ? 1.2 : 1);
        in[i] = upload(g, scenes[i], e);
    }
    scenes[1]->camera.cx_px += 5; /* of what was drawn otherwise: wrong, but another */
    assert_int_equal(
        crv_vulkan_pass_create(context, &options, &scenes[0]->desc, &desc, &pass),
        CRV_OK);
    for (int i = 0; i < 2; i++) {
        crv_vulkan_frame frame = frame_of(scenes[i], e, &in[i]);
        frame.index = i;
        assert_int_equal(crv_vulkan_pass_record(pass, engine_begin(g, i), &frame),
                         CRV_OK);
    }
    engine_submit(g, 0);
    engine_submit(g, 1);
    engine_wait(g);
    for (int i = 0; i < 2; i++) {
        float *got = download(g, scenes[i], e, &in[i]), *wanted = scalar(scenes[i], e);
        assert_agrees(scenes[i], e, got, wanted);
        free(got);
        free(wanted);
        free_images(g, &in[i]);
        free(scenes[i]);
    }
    crv_vulkan_pass_destroy(pass);
    crv_context_destroy(context);
}

static void plans_run_on_the_queue_of_the_host(void **state)
{
    engine *g = *state;
    lines log = {0};
    const encoding *e = &ENCODINGS[0];
    crv_context *context = open_context(g, &log);
    scene *s = malloc(sizeof *s);
    assert_non_null(s);
    make_scene(s, e, 1);
    float *got = planned(context, s, e), *wanted = scalar(s, e);
    assert_agrees(s, e, got, wanted);
    free(got);
    free(wanted);
    free(s);
    crv_context_destroy(context);
}

static void times_are_of_every_pass(void **state)
{
    engine *g = *state;
    lines log = {0};
    const encoding *e = &ENCODINGS[0];
    crv_context *context = open_context(g, &log);
    const crv_options options = options_of(e);
    crv_vulkan_pass_desc desc = pass_desc(e);
    crv_vulkan_time times[CRV_VULKAN_MAX_TIMES];
    crv_vulkan_pass *pass = NULL, *plain = NULL;
    int32_t count = -1;
    scene *s = malloc(sizeof *s);
    assert_non_null(s);
    make_scene(s, e, 1);
    images in = upload(g, s, e);
    const crv_vulkan_frame frame = frame_of(s, e, &in);
    assert_int_equal(crv_vulkan_pass_create(context, &options, &s->desc, &desc, &plain),
                     CRV_OK);
    assert_int_equal(crv_vulkan_pass_times(plain, 0, times, &count),
                     CRV_ERROR_UNSUPPORTED);
    desc.timestamps = VK_TRUE;
    assert_int_equal(crv_vulkan_pass_create(context, &options, &s->desc, &desc, &pass),
                     CRV_OK);
    assert_int_equal(crv_vulkan_pass_times(pass, 0, times, &count), CRV_ERROR_NOT_READY);
    assert_int_equal(crv_vulkan_pass_times(pass, 2, times, &count),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_vulkan_pass_times(pass, 0, NULL, &count),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_vulkan_pass_record(pass, engine_begin(g, 0), &frame), CRV_OK);
    engine_submit(g, 0);
    engine_wait(g);
    assert_int_equal(crv_vulkan_pass_times(pass, 0, times, &count), CRV_OK);
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
    free_images(g, &in);
    free(s);
    crv_context_destroy(context);
}

/* ---- what is refused ---- */

static void assert_refused(lines *log, crv_status status, crv_status wanted)
{
    assert_int_equal(status, wanted);
    assert_int_equal(log->errors, 1);
    assert_true(strlen(log->last) > 10);
    log->errors = 0;
}

static void bad_passes_are_refused_with_one_line(void **state)
{
    engine *g = *state;
    lines log = {0};
    crv_context *context = open_context(g, &log), *cpu = NULL;
    const encoding *e = &ENCODINGS[0];
    const crv_options options = options_of(e);
    crv_gbuffer_desc size;
    crv_gbuffer_desc_init(&size, sizeof size, WIDTH, HEIGHT);
    crv_vulkan_pass *pass = NULL;
    crv_vulkan_pass_desc d = pass_desc(e);
#define REFUSED(status, change)                                                          \
    do {                                                                                 \
        d = pass_desc(e);                                                                \
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
#undef REFUSED
    d = pass_desc(e);
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
    desc.logger = (crv_logger){.fn = keep_line, .user = &log};
    assert_int_equal(crv_context_create(&desc, &cpu), CRV_OK);
    assert_refused(&log, crv_vulkan_pass_create(cpu, &options, &size, &d, &pass),
                   CRV_ERROR_UNSUPPORTED);
    crv_context_destroy(cpu);
    crv_context_destroy(context);
    crv_vulkan_pass_destroy(NULL);
    assert_int_equal(crv_vulkan_pass_bytes(NULL), 0);
}

static void bad_frames_are_refused_with_one_line(void **state)
{
    engine *g = *state;
    lines log = {0};
    crv_context *context = open_context(g, &log);
    const encoding *e = &ENCODINGS[0];
    const crv_options options = options_of(e);
    const crv_vulkan_pass_desc desc = pass_desc(e);
    crv_vulkan_pass *pass = NULL;
    scene *s = malloc(sizeof *s);
    assert_non_null(s);
    make_scene(s, e, 1);
    images in = upload(g, s, e);
    assert_int_equal(crv_vulkan_pass_create(context, &options, &s->desc, &desc, &pass),
                     CRV_OK);
    const VkCommandBuffer commands = engine_begin(g, 0);
    crv_vulkan_frame f;
#define REFUSED(change)                                                                  \
    do {                                                                                 \
        f = frame_of(s, e, &in);                                                         \
        change;                                                                          \
        assert_refused(&log, crv_vulkan_pass_record(pass, commands, &f),                 \
                       CRV_ERROR_INVALID_ARGUMENT);                                      \
    } while (0)
    REFUSED(f.struct_size = 0);
    REFUSED(f.index = -1);
    REFUSED(f.index = desc.frames);
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
    f = frame_of(s, e, &in);
    assert_refused(&log, crv_vulkan_pass_record(pass, NULL, &f),
                   CRV_ERROR_INVALID_ARGUMENT);
    assert_refused(&log, crv_vulkan_pass_record(pass, commands, NULL),
                   CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_vulkan_pass_record(NULL, commands, &f),
                     CRV_ERROR_INVALID_ARGUMENT);
    engine_submit(g, 0); /* nothing was recorded: valid, and empty */
    engine_wait(g);
    crv_vulkan_pass_destroy(pass);
    free_images(g, &in);
    free(s);
    crv_context_destroy(context);
}

static void bad_hosts_are_refused_with_one_line(void **state)
{
    engine *g = *state;
    lines log = {0};
    crv_context_desc desc;
    crv_context *context = NULL;
    crv_vulkan_host h;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = (crv_logger){.fn = keep_line, .user = &log};
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
    crv_gbuffer_desc_init(&size, sizeof size, WIDTH, HEIGHT);
    crv_plan *plan = NULL;
    assert_refused(&log, crv_plan_create(context, &options, &size, &plan),
                   CRV_ERROR_INVALID_ARGUMENT);
    crv_context_destroy(context);
}

static void the_validation_layer_is_silent(void **state)
{
    engine *g = *state;
    assert_int_equal(g->h.complaints, 0);
}

static engine the_engine;

static int open_all(void **state)
{
    *state = &the_engine;
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_of_every_encoding_give_the_picture_of_the_cpu),
        cmocka_unit_test(frames_in_flight_keep_apart),
        cmocka_unit_test(plans_run_on_the_queue_of_the_host),
        cmocka_unit_test(times_are_of_every_pass),
        cmocka_unit_test(bad_passes_are_refused_with_one_line),
        cmocka_unit_test(bad_frames_are_refused_with_one_line),
        cmocka_unit_test(bad_hosts_are_refused_with_one_line),
        cmocka_unit_test(the_validation_layer_is_silent),
    };
    if (engine_open(&the_engine, 1) != 0) {
        printf("SKIPPED: no Vulkan 1.3 device, or no validation layer\n");
        return getenv("CI") ? 1 : 77;
    }
    const int failed = cmocka_run_group_tests(tests, open_all, NULL);
    engine_close(&the_engine);
    return failed || the_engine.h.complaints;
}

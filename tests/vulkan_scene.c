/* SPDX-License-Identifier: MIT */
#include "vulkan_scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fixture.h"

/* A rotation about y by 0.5 rad and then about x by 0.3. */
static const float TO_VIEW[9] = {0.87758256f,  0,           0.47942554f,
                                 0.14167993f,  0.95533649f, -0.25934338f,
                                 -0.45801266f, 0.29552021f, 0.83838664f};

/* ---- lines of the log ---- */

void scene_keep_line(void *user, crv_log_level level, const char *line)
{
    scene_lines *l = user;
    if (level != CRV_LOG_ERROR)
        return;
    l->errors++;
    snprintf(l->last, sizeof l->last, "%s", line);
}

crv_context *scene_context(const engine *e, scene_lines *log)
{
    const crv_vulkan_host device = engine_host(e);
    crv_context *context = NULL;
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = (crv_logger){.fn = scene_keep_line, .user = log};
    assert_int_equal(crv_vulkan_context_create(&desc, &device, &context), CRV_OK);
    return context;
}

/* ---- texels ---- */

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
    if (kind == CRV_DEPTH_NORMALISED)
        return isfinite(d) ? (d - n) / (f - n) : 1;
    if (kind == CRV_DEPTH_NORMALISED_REVERSED)
        return isfinite(d) ? (f - d) / (f - n) : 0;
    if (kind == CRV_DEPTH_GL)
        return isfinite(d) ? 2 * (f / (f - n)) * (1 - n / d) - 1 : 1;
    if (kind == CRV_DEPTH_LOGARITHMIC)
        return isfinite(d) ? log2(1 + d) / log2(1 + f) : 1;
    return d;
}

static size_t texel_bytes(VkFormat format)
{
    return texel_layout_of(format)->size;
}

/* Writes a depth texel; what it then holds. */
static float put_depth(VkFormat format, double value, void *texel)
{
    return (float)texel_put(texel_layout_of(format), 0, value, texel);
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

void scene_unfold(const double e[2], double n[3])
{
    n[2] = 1 - fabs(e[0]) - fabs(e[1]);
    n[0] = n[2] >= 0 ? e[0] : copysign(1 - fabs(e[1]), e[0]);
    n[1] = n[2] >= 0 ? e[1] : copysign(1 - fabs(e[0]), e[1]);
}

/* Writes a normal's texel; n becomes what it then holds, of any length. */
static void put_normal(VkFormat format, crv_vulkan_normals kind, double n[3], void *texel)
{
    const texel_layout *t = texel_layout_of(format);
    const int flat =
        kind == CRV_VULKAN_NORMALS_OCT || kind == CRV_VULKAN_NORMALS_OCT_HALVED;
    const int halved =
        kind == CRV_VULKAN_NORMALS_XYZ_HALVED || kind == CRV_VULKAN_NORMALS_OCT_HALVED;
    double stored[3] = {n[0], n[1], n[2]};
    if (flat)
        octahedral(n, stored);
    for (int k = 0; k < (flat ? 2 : 3); k++) {
        const double value = halved ? stored[k] * 0.5 + 0.5 : stored[k];
        const double held = texel_put(t, k, value, texel);
        stored[k] = halved ? held * 2 - 1 : held;
    }
    if (flat)
        scene_unfold(stored, n);
    else
        memcpy(n, stored, sizeof stored);
}

/* ---- a frame, on both ---- */

void scene_make(scene *s, const scene_encoding *e, double scale)
{
    scene_make_sized(s, e, scale, SCENE_WIDTH, SCENE_HEIGHT);
    s->desc.guard_left = 9;
    s->desc.guard_top = 3;
    s->desc.guard_right = 1;
    s->desc.origin_x = 9;
}

void scene_make_sized(scene *s, const scene_encoding *e, double scale, int width,
                      int height)
{
    assert_true(width <= SCENE_WIDTH && height <= SCENE_HEIGHT);
    const size_t count = (size_t)width * (size_t)height;
    s->camera = crv_camera_perspective(width, height, 1);
    memcpy(s->camera.world_to_view, TO_VIEW, sizeof TO_VIEW);
    crv_gbuffer_desc_init(&s->desc, sizeof s->desc, width, height);
    memset(s->depth_bytes, 0, sizeof s->depth_bytes);
    memset(s->normal_bytes, 0, sizeof s->normal_bytes);
    fixture f = fixture_make(fixture_spheres, &scale, &s->camera, width, height);
    for (size_t i = 0; i < count; i++) {
        double n[3], world[3];
        s->depth[i] =
            put_depth(e->depth_format, stored_depth(e->depth, (double)f.depth[i]),
                      s->depth_bytes + i * texel_bytes(e->depth_format));
        for (size_t k = 0; k < 3; k++)
            n[k] = (double)f.normals[3 * i + k];
        for (int k = 0; k < 3 && e->space == CRV_NORMAL_WORLD; k++)
            world[k] = (double)TO_VIEW[k] * n[0] + (double)TO_VIEW[3 + k] * n[1]
                       + (double)TO_VIEW[6 + k] * n[2];
        if (e->space == CRV_NORMAL_WORLD)
            memcpy(n, world, sizeof n);
        if (e->normals)
            put_normal(e->normal_format, e->normals, n,
                       s->normal_bytes + i * texel_bytes(e->normal_format));
        for (size_t k = 0; k < 3; k++)
            s->normals[3 * i + k] = (float)n[k];
    }
    fixture_free(&f);
}

crv_options scene_options(const scene_encoding *e)
{
    crv_options options = fixture_options(e->method);
    options.radius = 0.8f;
    assert_int_equal(
        crv_options_set(&options, "filter", e->filter ? e->filter : "none", NULL),
        CRV_OK);
    return options;
}

static crv_depth_format scene_depth_format(const scene_encoding *e)
{
    crv_depth_format format = crv_depth_format_planar();
    format.encoding = e->depth;
    if (e->depth == CRV_DEPTH_HARDWARE || e->depth >= CRV_DEPTH_NORMALISED) {
        format.z_near = Z_NEAR;
        format.z_far = Z_FAR;
    }
    if (e->depth == CRV_DEPTH_REVERSED) {
        format.z_near = Z_NEAR;
        format.z_far = INFINITY;
    }
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

/* The scene on a context, through the ordinary interface. bent NULL: not wanted. */
static float *planned(crv_context *context, const scene *s, const scene_encoding *e,
                      crv_options options, float *bent)
{
    options.bent_normal = bent ? 1 : 0;
    const crv_depth_format format = scene_depth_format(e);
    const crv_const_image depth =
        crv_const_image_packed(s->depth, s->desc.width, s->desc.height, 1);
    const crv_const_image normals =
        crv_const_image_packed(s->normals, s->desc.width, s->desc.height, 3);
    float *pixels = malloc(SCENE_PIXELS * sizeof *pixels);
    crv_result result;
    crv_result_init(&result, sizeof result);
    result.accessibility = crv_image_packed(pixels, result_width(s), result_height(s), 1);
    if (bent)
        result.bent_normal = crv_image_packed(bent, result_width(s), result_height(s), 3);
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    assert_non_null(pixels);
    assert_int_equal(crv_gbuffer_create(context, &s->desc, &gbuffer), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(gbuffer, &s->camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(gbuffer, 0, &depth, &format), CRV_OK);
    if (e->normals)
        assert_int_equal(crv_gbuffer_set_normals(gbuffer, &normals, e->space), CRV_OK);
    assert_int_equal(crv_plan_create(context, &options, &s->desc, &plan), CRV_OK);
    assert_int_equal(crv_plan_run_result(plan, gbuffer, &result), CRV_OK);
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    return pixels;
}

float *scene_planned(crv_context *context, const scene *s, const scene_encoding *e)
{
    return planned(context, s, e, scene_options(e), NULL);
}

float *scene_scalar(const scene *s, const scene_encoding *e)
{
    return scene_scalar_bent(s, e, scene_options(e), NULL);
}

float *scene_scalar_bent(const scene *s, const scene_encoding *e, crv_options options,
                         float *bent)
{
    crv_context *context = NULL;
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.isa_mask = 1u << CRV_ISA_SCALAR;
    desc.exact = 1;
    assert_int_equal(crv_context_create(&desc, &context), CRV_OK);
    float *pixels = planned(context, s, e, options, bent);
    crv_context_destroy(context);
    return pixels;
}

crv_vulkan_pass_desc scene_pass_desc(const scene_encoding *e)
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

scene_images scene_upload(engine *g, const scene *s, const scene_encoding *e)
{
    scene_images i = {0};
    const int width = s->desc.width, height = s->desc.height;
    const size_t count = (size_t)width * (size_t)height;
    i.depth = engine_upload(g, e->depth_format, width, height, s->depth_bytes,
                            count * texel_bytes(e->depth_format));
    if (e->normals)
        i.normals = engine_upload(g, e->normal_format, width, height, s->normal_bytes,
                                  count * texel_bytes(e->normal_format));
    i.result = engine_result(g, e->result_format, result_width(s), result_height(s));
    return i;
}

void scene_free(engine *g, scene_images *i)
{
    host_image_free(&g->h, &i->depth);
    if (i->normals.image)
        host_image_free(&g->h, &i->normals);
    host_image_free(&g->h, &i->result);
}

crv_vulkan_frame scene_frame(const scene *s, const scene_encoding *e,
                             const scene_images *i)
{
    crv_vulkan_frame frame;
    crv_vulkan_frame_init(&frame, sizeof frame);
    frame.camera = s->camera;
    frame.depth_encoding = scene_depth_format(e);
    frame.depth[0].view = i->depth.view;
    frame.normals.view = i->normals.view;
    frame.result = i->result.image;
    frame.result_view = i->result.view;
    frame.result_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    frame.result_stages = VK_PIPELINE_STAGE_2_COPY_BIT;
    frame.result_access = VK_ACCESS_2_TRANSFER_READ_BIT;
    return frame;
}

float *scene_download(engine *g, const scene *s, const scene_encoding *e,
                      const scene_images *i)
{
    const texel_layout *t = texel_layout_of(e->result_format);
    const size_t count = (size_t)result_width(s) * (size_t)result_height(s);
    float *pixels = malloc(count * sizeof *pixels);
    unsigned char *bytes = engine_download(g, &i->result, result_width(s),
                                           result_height(s), count * t->size);
    assert_non_null(pixels);
    assert_non_null(bytes);
    for (size_t k = 0; k < count; k++)
        pixels[k] = (float)texel_get(t, 0, bytes + k * t->size);
    free(bytes);
    return pixels;
}

/*
 * 2e-3 but for a pixel in a thousand, which is what the backend promises: a device may
 * round a division otherwise and then takes the neighbouring texel. On top
 * comes what storing the result changes.
 */
void scene_assert_agrees(const scene *s, const scene_encoding *e, const float *got,
                         const float *wanted)
{
    const double tolerance = 2e-3 + texel_rounding(texel_layout_of(e->result_format));
    const int count = result_width(s) * result_height(s);
    int beyond = 0;
    for (int i = 0; i < count; i++)
        beyond += !(fabs((double)got[i] - (double)wanted[i]) <= tolerance);
    if (beyond > count / 1000)
        fail_msg("%s: %d of %d pixels differ", e->name, beyond, count);
}

int scene_has_format(const engine *g, VkFormat format, VkFormatFeatureFlags feature)
{
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(g->h.physical, format, &properties);
    return (properties.optimalTilingFeatures & feature) != 0;
}

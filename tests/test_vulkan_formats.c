/* SPDX-License-Identifier: MIT */
/* Every format, encoding and layout that crevice/vulkan.h lists gives the picture of the
 * scalar code, and every other is refused with one line. Under the validation layer. */
#include "fixture.h"

#include <stdio.h>
#include <string.h>

#include "vulkan_scene.h"

#define COUNT_OF(array) ((int)(sizeof(array) / sizeof *(array)))

/* ---- the lists of crevice/vulkan.h ---- */

#define F(format) VK_FORMAT_##format
static const VkFormat UNSIGNED_DEPTHS[] = {F(D24_UNORM_S8_UINT), F(X8_D24_UNORM_PACK32),
                                           F(D16_UNORM), F(D16_UNORM_S8_UINT),
                                           F(R16_UNORM)};
static const VkFormat FLOAT_DEPTHS[] = {
    F(D32_SFLOAT), F(D32_SFLOAT_S8_UINT), F(R32_SFLOAT),          F(R32G32_SFLOAT),
    F(R16_SFLOAT), F(R16G16_SFLOAT),      F(R16G16B16A16_SFLOAT), F(R32G32B32A32_SFLOAT)};
static const VkFormat XYZ[] = {F(R16G16B16A16_SFLOAT),      F(R32G32B32A32_SFLOAT),
                               F(R8G8B8A8_SNORM),           F(A8B8G8R8_SNORM_PACK32),
                               F(A2B10G10R10_SNORM_PACK32), F(R16G16B16A16_SNORM)};
static const VkFormat XYZ_HALVED[] = {
    F(R8G8B8A8_UNORM),           F(B8G8R8A8_UNORM),           F(A8B8G8R8_UNORM_PACK32),
    F(A2R10G10B10_UNORM_PACK32), F(A2B10G10R10_UNORM_PACK32), F(R16G16B16A16_UNORM),
    F(B10G11R11_UFLOAT_PACK32),  F(R16G16B16A16_SFLOAT),      F(R32G32B32A32_SFLOAT)};
static const VkFormat OCT[] = {F(R16G16_SFLOAT), F(R32G32_SFLOAT), F(R8G8_SNORM),
                               F(R16G16_SNORM)}; /* beside those of XYZ */
static const VkFormat OCT_HALVED[] = {F(R8G8_UNORM), F(R16G16_UNORM), F(R16G16_SFLOAT),
                                      F(R32G32_SFLOAT)}; /* beside those of XYZ_HALVED */
static const VkFormat RESULTS[] = {F(R8_UNORM),
                                   F(R16_UNORM),
                                   F(R16_SFLOAT),
                                   F(R32_SFLOAT),
                                   F(R8G8_UNORM),
                                   F(R16G16_UNORM),
                                   F(R16G16_SFLOAT),
                                   F(R32G32_SFLOAT),
                                   F(R8G8B8A8_UNORM),
                                   F(B8G8R8A8_UNORM),
                                   F(A8B8G8R8_UNORM_PACK32),
                                   F(A2R10G10B10_UNORM_PACK32),
                                   F(A2B10G10R10_UNORM_PACK32),
                                   F(B10G11R11_UFLOAT_PACK32),
                                   F(R16G16B16A16_UNORM),
                                   F(R16G16B16A16_SFLOAT),
                                   F(R32G32B32A32_SFLOAT)};
#undef F

enum { LAST_FORMAT = VK_FORMAT_ASTC_12x12_SRGB_BLOCK }; /* of Vulkan 1.0, from 0 on */

static int is_in(VkFormat format, const VkFormat *list, int count)
{
    for (int i = 0; i < count; i++) {
        if (list[i] == format)
            return 1;
    }
    return 0;
}
#define IS_IN(format, list) is_in(format, list, COUNT_OF(list))

static int is_depth(VkFormat format)
{
    return IS_IN(format, UNSIGNED_DEPTHS) || IS_IN(format, FLOAT_DEPTHS);
}

static int holds(VkFormat format, crv_vulkan_normals kind)
{
    switch (kind) {
    case CRV_VULKAN_NORMALS_XYZ:
        return IS_IN(format, XYZ);
    case CRV_VULKAN_NORMALS_XYZ_HALVED:
        return IS_IN(format, XYZ_HALVED);
    case CRV_VULKAN_NORMALS_OCT:
        return IS_IN(format, XYZ) || IS_IN(format, OCT);
    default:
        return IS_IN(format, XYZ_HALVED) || IS_IN(format, OCT_HALVED);
    }
}

static int is_normal(VkFormat format)
{
    return holds(format, CRV_VULKAN_NORMALS_OCT)
           || holds(format, CRV_VULKAN_NORMALS_OCT_HALVED);
}

/* ---- what is listed ---- */

static const scene_encoding USUAL = {
    "usual",
    VK_FORMAT_D32_SFLOAT,
    CRV_DEPTH_REVERSED,
    VK_FORMAT_R32G32B32A32_SFLOAT,
    CRV_VULKAN_NORMALS_XYZ,
    CRV_NORMAL_VIEW,
    VK_FORMAT_R32_SFLOAT,
    "alchemy", /* it reads depth and normals, and is quick */
    NULL,
};

typedef struct bench {
    engine *g;
    crv_context *context;
    scene_lines log;
    scene *s;
    int tried;
} bench;

static bench *open_bench(engine *g)
{
    bench *b = calloc(1, sizeof *b);
    assert_non_null(b);
    b->g = g;
    b->s = malloc(sizeof *b->s);
    assert_non_null(b->s);
    b->context = scene_context(g, &b->log);
    return b;
}

static void close_bench(bench *b)
{
    crv_context_destroy(b->context);
    free(b->s);
    free(b);
}

static int device_has(const engine *g, const scene_encoding *e)
{
    return scene_has_format(g, e->depth_format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)
           && scene_has_format(g, e->normal_format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)
           && scene_has_format(g, e->result_format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
}

/* The picture of the scalar code, or UNSUPPORTED if the device lacks a format. */
static void agrees(bench *b, scene_encoding e)
{
    char name[160];
    snprintf(name, sizeof name, "depth %s as %d, normals %s as %d, result %s",
             texel_layout_of(e.depth_format)->name, (int)e.depth,
             texel_layout_of(e.normal_format)->name, (int)e.normals,
             texel_layout_of(e.result_format)->name);
    e.name = name;
    const crv_options options = scene_options(&e);
    const crv_vulkan_pass_desc desc = scene_pass_desc(&e);
    crv_vulkan_pass *pass = NULL;
    scene_make(b->s, &e, 1);
    const crv_status status =
        crv_vulkan_pass_create(b->context, &options, &b->s->desc, &desc, &pass);
    if (!device_has(b->g, &e)) {
        assert_int_equal(status, CRV_ERROR_UNSUPPORTED);
        assert_int_equal(b->log.errors, 1);
        b->log.errors = 0;
        print_message("%s: the device lacks it\n", name);
        return;
    }
    if (status)
        fail_msg("%s: %s", name, b->log.last);
    scene_images in = scene_upload(b->g, b->s, &e);
    const crv_vulkan_frame frame = scene_frame(b->s, &e, &in);
    assert_int_equal(crv_vulkan_pass_record(pass, engine_begin(b->g, 0), &frame), CRV_OK);
    engine_submit(b->g, 0);
    engine_wait(b->g);
    float *got = scene_download(b->g, b->s, &e, &in), *wanted = scene_scalar(b->s, &e);
    scene_assert_agrees(b->s, &e, got, wanted);
    free(got);
    free(wanted);
    scene_free(b->g, &in);
    crv_vulkan_pass_destroy(pass);
    b->tried++;
}

static void depth_in_every_listed_format(void **state)
{
    bench *b = open_bench(*state);
    static const crv_depth_encoding KINDS[] = {CRV_DEPTH_REVERSED, CRV_DEPTH_HARDWARE,
                                               CRV_DEPTH_PLANAR, CRV_DEPTH_DISPARITY};
    scene_encoding e = USUAL;
    for (int k = 0; k < 4; k++) {
        e.depth = KINDS[k];
        for (int i = 0; k < 2 && i < COUNT_OF(UNSIGNED_DEPTHS); i++) {
            e.depth_format = UNSIGNED_DEPTHS[i]; /* they hold 0 to 1 */
            agrees(b, e);
        }
        for (int i = 0; i < COUNT_OF(FLOAT_DEPTHS); i++) {
            e.depth_format = FLOAT_DEPTHS[i];
            agrees(b, e);
        }
    }
    e.depth_format = VK_FORMAT_R32_SFLOAT;
    for (int kind = CRV_DEPTH_NORMALISED; kind <= CRV_DEPTH_LOGARITHMIC; kind++) {
        e.depth = (crv_depth_encoding)kind;
        agrees(b, e);
    }
    /* Vulkan promises D16, one of D24 and D32, and sampling of the floats. */
    assert_true(b->tried >= 2 * 2 + 4 * 6 + 4);
    close_bench(b);
}

static void normals_in_every_listed_format(void **state)
{
    bench *b = open_bench(*state);
    scene_encoding e = USUAL;
    for (int kind = CRV_VULKAN_NORMALS_XYZ; kind <= CRV_VULKAN_NORMALS_OCT_HALVED;
         kind++) {
        e.normals = (crv_vulkan_normals)kind;
        for (int f = 0; f <= LAST_FORMAT; f++) {
            e.normal_format = (VkFormat)f;
            if (holds(e.normal_format, e.normals))
                agrees(b, e);
        }
    }
    assert_true(b->tried >= 20); /* Vulkan promises sampling of all but a few */
    close_bench(b);
}

static void results_in_every_listed_format(void **state)
{
    bench *b = open_bench(*state);
    scene_encoding e = USUAL;
    for (int i = 0; i < COUNT_OF(RESULTS); i++) {
        e.result_format = RESULTS[i];
        agrees(b, e);
    }
    assert_true(b->tried >= 5); /* Vulkan promises no more as storage images */
    close_bench(b);
}

/* ---- what is not ---- */

static void assert_line(bench *b, crv_status status, crv_status wanted, const char *part)
{
    assert_int_equal(status, wanted);
    assert_int_equal(b->log.errors, 1);
    if (!strstr(b->log.last, part))
        fail_msg("\"%s\" has no \"%s\"", b->log.last, part);
    b->log.errors = 0;
}

static void expect(bench *b, const crv_vulkan_pass_desc *desc, crv_status wanted,
                   const char *part)
{
    const crv_options options = scene_options(&USUAL);
    crv_gbuffer_desc size;
    crv_vulkan_pass *pass = NULL;
    crv_gbuffer_desc_init(&size, sizeof size, 8, 8);
    assert_line(b, crv_vulkan_pass_create(b->context, &options, &size, desc, &pass),
                wanted, part);
    assert_null(pass);
}

static void other_formats_are_refused_with_one_line(void **state)
{
    bench *b = open_bench(*state);
    for (int f = 0; f <= LAST_FORMAT; f++) {
        const VkFormat format = (VkFormat)f;
        crv_vulkan_pass_desc desc = scene_pass_desc(&USUAL);
        desc.depth_format = format;
        if (!is_depth(format))
            expect(b, &desc, CRV_ERROR_UNSUPPORTED, "depth_format");
        desc = scene_pass_desc(&USUAL);
        desc.normal_format = format;
        if (!is_normal(format))
            expect(b, &desc, CRV_ERROR_UNSUPPORTED, "normal_format");
        desc = scene_pass_desc(&USUAL);
        desc.result_format = format;
        if (!IS_IN(format, RESULTS))
            expect(b, &desc, CRV_ERROR_UNSUPPORTED, "result_format");
    }
    close_bench(b);
}

static void normals_that_a_format_cannot_hold_are_refused_with_the_cure(void **state)
{
    bench *b = open_bench(*state);
    for (int kind = CRV_VULKAN_NORMALS_XYZ; kind <= CRV_VULKAN_NORMALS_OCT_HALVED;
         kind++) {
        for (int f = 0; f <= LAST_FORMAT; f++) {
            crv_vulkan_pass_desc desc = scene_pass_desc(&USUAL);
            desc.normals = (crv_vulkan_normals)kind;
            desc.normal_format = (VkFormat)f;
            if (is_normal(desc.normal_format) && !holds(desc.normal_format, desc.normals)
                && scene_has_format(b->g, desc.normal_format,
                                    VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
                expect(b, &desc, CRV_ERROR_INVALID_ARGUMENT, "CRV_VULKAN_NORMALS_");
        }
    }
    crv_vulkan_pass_desc desc = scene_pass_desc(&USUAL);
    desc.normal_format = VK_FORMAT_R8G8B8A8_UNORM;
    expect(b, &desc, CRV_ERROR_INVALID_ARGUMENT, "XYZ_HALVED");
    desc.normal_format = VK_FORMAT_R16G16_SNORM;
    expect(b, &desc, CRV_ERROR_INVALID_ARGUMENT, "NORMALS_OCT,");
    desc.normals = CRV_VULKAN_NORMALS_OCT_HALVED;
    expect(b, &desc, CRV_ERROR_INVALID_ARGUMENT, "NORMALS_OCT,");
    close_bench(b);
}

/* ---- layouts ---- */

typedef struct layout {
    VkImageLayout layout;
    const char *name;
    int depth, colour, result; /* 0 or 1: whether such an image may be in it */
} layout;

#define L(name, depth, colour, result)                                                   \
    {VK_IMAGE_LAYOUT_##name, #name, depth, colour, result},
static const layout LAYOUTS[] = {
    /* clang-format off */
    L(UNDEFINED, 0, 0, 0)
    L(GENERAL, 1, 1, 1)
    L(COLOR_ATTACHMENT_OPTIMAL, 0, 0, 1)
    L(DEPTH_STENCIL_ATTACHMENT_OPTIMAL, 0, 0, 0)
    L(DEPTH_STENCIL_READ_ONLY_OPTIMAL, 1, 0, 0)
    L(SHADER_READ_ONLY_OPTIMAL, 1, 1, 1)
    L(TRANSFER_SRC_OPTIMAL, 0, 0, 1)
    L(TRANSFER_DST_OPTIMAL, 0, 0, 1)
    L(PREINITIALIZED, 0, 0, 0)
    L(DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL, 1, 0, 0)
    L(DEPTH_ATTACHMENT_STENCIL_READ_ONLY_OPTIMAL, 0, 0, 0)
    L(DEPTH_ATTACHMENT_OPTIMAL, 0, 0, 0)
    L(DEPTH_READ_ONLY_OPTIMAL, 1, 0, 0)
    L(STENCIL_ATTACHMENT_OPTIMAL, 0, 0, 0)
    L(STENCIL_READ_ONLY_OPTIMAL, 0, 0, 0)
    L(READ_ONLY_OPTIMAL, 1, 1, 1)
    L(ATTACHMENT_OPTIMAL, 0, 0, 1)
    L(PRESENT_SRC_KHR, 0, 0, 1)
    /* clang-format on */
};
#undef L

/* Takes an image to a layout in which shaders sample it. */
static void take(VkCommandBuffer commands, const host_image *i, VkImageAspectFlags aspect,
                 VkImageLayout from, VkImageLayout to)
{
    const VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const VkAccessFlags2 read = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
    host_barrier(commands, i->image, aspect, (host_use){stage, read, from},
                 (host_use){stage, read, to});
}

/* A recording with the inputs in these layouts, which they are in, and the result left in
 * a third. */
static void record_in(bench *b, crv_vulkan_pass *pass, const scene_images *in,
                      VkImageLayout depth, VkImageLayout normals, VkImageLayout result)
{
    const VkImageLayout usual = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    crv_vulkan_frame f = scene_frame(b->s, &USUAL, in);
    f.depth[0].layout = depth;
    f.normals.layout = normals;
    f.result_layout = result;
    const VkCommandBuffer commands = engine_begin(b->g, 0);
    take(commands, &in->depth, VK_IMAGE_ASPECT_DEPTH_BIT, usual, depth);
    take(commands, &in->normals, VK_IMAGE_ASPECT_COLOR_BIT, usual, normals);
    if (crv_vulkan_pass_record(pass, commands, &f))
        fail_msg("%s", b->log.last);
    take(commands, &in->depth, VK_IMAGE_ASPECT_DEPTH_BIT, depth, usual);
    take(commands, &in->normals, VK_IMAGE_ASPECT_COLOR_BIT, normals, usual);
    engine_submit(b->g, 0);
    engine_wait(b->g);
}

/* Each of the three images in turn, the others in the usual layout. */
static void check_layout(bench *b, crv_vulkan_pass *pass, const scene_images *in,
                         const layout *l)
{
    const VkImageLayout usual = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const int allowed[3] = {l->depth, l->colour, l->result};
    static const char *const WHAT[3] = {"depth layer 0", "normals", "the result"};
    for (int image = 0; image < 3; image++) {
        crv_vulkan_frame f = scene_frame(b->s, &USUAL, in);
        VkImageLayout layouts[3] = {usual, usual, VK_IMAGE_LAYOUT_GENERAL};
        layouts[image] = l->layout;
        f.depth[0].layout = layouts[0];
        f.normals.layout = layouts[1];
        f.result_layout = layouts[2];
        if (!allowed[image]) {
            const crv_status status =
                crv_vulkan_pass_record(pass, engine_begin(b->g, 0), &f);
            engine_submit(b->g, 0);
            engine_wait(b->g);
            assert_non_null(strstr(b->log.last, WHAT[image]));
            assert_line(b, status, CRV_ERROR_INVALID_ARGUMENT, l->name);
        } else if (l->layout != VK_IMAGE_LAYOUT_PRESENT_SRC_KHR) { /* of swapchains */
            record_in(b, pass, in, layouts[0], layouts[1], layouts[2]);
        }
    }
}

static void layouts_are_taken_or_refused_by_name(void **state)
{
    bench *b = open_bench(*state);
    const crv_options options = scene_options(&USUAL);
    const crv_vulkan_pass_desc desc = scene_pass_desc(&USUAL);
    crv_vulkan_pass *pass = NULL;
    scene_make(b->s, &USUAL, 1);
    scene_images in = scene_upload(b->g, b->s, &USUAL);
    assert_int_equal(
        crv_vulkan_pass_create(b->context, &options, &b->s->desc, &desc, &pass), CRV_OK);
    for (int i = 0; i < COUNT_OF(LAYOUTS); i++)
        check_layout(b, pass, &in, &LAYOUTS[i]);
    /* One that nobody has heard of cannot be read from. */
    crv_vulkan_frame f = scene_frame(b->s, &USUAL, &in);
    f.normals.layout = (VkImageLayout)123456;
    assert_line(b, crv_vulkan_pass_record(pass, engine_begin(b->g, 0), &f),
                CRV_ERROR_INVALID_ARGUMENT, "123456");
    engine_submit(b->g, 0);
    engine_wait(b->g);
    crv_vulkan_pass_destroy(pass);
    scene_free(b->g, &in);
    close_bench(b);
}

/* test_vulkan_formats --usual: one recording, for the layer that instruments shaders. */
static void the_usual_formats(void **state)
{
    bench *b = open_bench(*state);
    agrees(b, USUAL);
    assert_int_equal(b->tried, 1);
    close_bench(b);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest usual[] = {
        cmocka_unit_test(the_usual_formats),
        cmocka_unit_test(the_validation_layer_is_silent),
    };
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depth_in_every_listed_format),
        cmocka_unit_test(normals_in_every_listed_format),
        cmocka_unit_test(results_in_every_listed_format),
        cmocka_unit_test(other_formats_are_refused_with_one_line),
        cmocka_unit_test(normals_that_a_format_cannot_hold_are_refused_with_the_cure),
        cmocka_unit_test(layouts_are_taken_or_refused_by_name),
        cmocka_unit_test(the_validation_layer_is_silent),
    };
    const int refused = engine_tests_begin();
    if (refused)
        return refused;
    const int failed = argc > 1 && strcmp(argv[1], "--usual") == 0
                           ? cmocka_run_group_tests(usual, engine_tests_setup, NULL)
                           : cmocka_run_group_tests(tests, engine_tests_setup, NULL);
    return engine_tests_end(failed);
}

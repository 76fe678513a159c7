/* SPDX-License-Identifier: MIT */
/* Bent normals in images of the host's, under the validation layer, against the scalar
 * code. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "vulkan_stage.h"

/* Where the pass puts what it computes: not at the corner of the images. */
enum { AT_X = 5, AT_Y = 3 };

typedef struct bent_case {
    VkFormat format;
    const char *method, *filter; /* filter NULL: none */
    void (*adjust)(crv_options *options);
    int width, height;
} bent_case;

static void weigh_uniformly(crv_options *options)
{
    options->weighting = CRV_WEIGHTING_UNIFORM;
}

/* So many samples that several dispatches hand on their sums. */
static void take_many(crv_options *options)
{
    options->directions = 96;
    options->steps = 128;
}

static const bent_case CASES[] = {
    {VK_FORMAT_R16G16_SFLOAT, "gtao", "edges15", NULL, SCENE_WIDTH, SCENE_HEIGHT},
    {VK_FORMAT_R16G16_SNORM, "bitmask", "bilateral13", NULL, SCENE_WIDTH, SCENE_HEIGHT},
    {VK_FORMAT_R16G16B16A16_SFLOAT, "hsao", "box4", NULL, SCENE_WIDTH, SCENE_HEIGHT},
    {VK_FORMAT_R32G32B32A32_SFLOAT, "raymarch", NULL, NULL, SCENE_WIDTH, SCENE_HEIGHT},
    {VK_FORMAT_R16G16_SFLOAT, "bitmask", NULL, weigh_uniformly, SCENE_WIDTH,
     SCENE_HEIGHT},
    {VK_FORMAT_R32G32B32A32_SFLOAT, "gtao", "gauss5", take_many, 40, 30},
};

static int is_octahedral(VkFormat format)
{
    return format == VK_FORMAT_R16G16_SFLOAT || format == VK_FORMAT_R16G16_SNORM;
}

/* The vector of a texel, of any length. */
static void vector_of(const texel_layout *t, const void *texel, double n[3])
{
    double e[3] = {0, 0, 0};
    for (int k = 0; k < (is_octahedral(t->format) ? 2 : 3); k++)
        e[k] = texel_get(t, k, texel);
    if (is_octahedral(t->format))
        scene_unfold(e, n);
    else
        memcpy(n, e, sizeof e);
}

/* Radians; 0 if both are zero. */
static double angle_between(const double a[3], const float b[3])
{
    double ab = 0, aa = 0, bb = 0;
    for (int k = 0; k < 3; k++) {
        ab += a[k] * (double)b[k];
        aa += a[k] * a[k];
        bb += (double)b[k] * (double)b[k];
    }
    if (aa == 0 || bb == 0)
        return aa > 0 || bb > 0 ? 10 : 0;
    return acos(fmin(1, ab / sqrt(aa * bb)));
}

/*
 * What differs by 2e-3 in accessibility differs by as much in the sum of open vectors,
 * whose length is two thirds of A at least: 3e-3/A radians. To that comes what storing
 * changes: 2^-11 of a component, once between the steps and once at the end, less than
 * 1e-3. As of accessibility a pixel in a thousand may take a neighbouring texel.
 */
static void assert_agrees(const scene *s, const bent_case *c, const unsigned char *bytes,
                          const float *bent, const float *A)
{
    const texel_layout *t = texel_layout_of(c->format);
    const int width = s->desc.width, height = s->desc.height;
    int beyond = 0;
    double largest = 0;
    for (int i = 0; i < width * height; i++) {
        double n[3];
        const int x = i % width + AT_X, y = i / width + AT_Y;
        vector_of(t, bytes + (size_t)(y * (width + AT_X) + x) * t->size, n);
        if (isinf(s->depth[i]) || s->depth[i] <= 0) { /* reversed: background is 0 */
            for (int k = 0; k < 3 && !is_octahedral(c->format); k++)
                assert_true(fabs(n[k]) <= 0);
            continue;
        }
        const double angle = angle_between(n, bent + 3 * (size_t)i);
        const double allowed = 1e-3 + 3e-3 / fmax((double)A[i], 1e-2);
        beyond += !(angle <= allowed);
        largest = fmax(largest, angle);
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (!is_octahedral(c->format))
            assert_true(fabs(length - 1) < 2e-3); /* stored as halves */
    }
    print_message("%s, %s: largest angle %.3f degrees, %d beyond\n", c->method, t->name,
                  largest * 180 / 3.14159265358979, beyond);
    if (beyond > width * height / 1000)
        fail_msg("%s: %d of %d pixels differ", c->method, beyond, width * height);
}

static void try_case(engine *g, const bent_case *c)
{
    scene_encoding e = STAGE_USUAL;
    e.method = c->method;
    e.filter = c->filter;
    stage *t = stage_open(g, &e, c->width, c->height);
    crv_options options = scene_options(&e);
    crv_vulkan_pass_desc desc = scene_pass_desc(&e);
    crv_vulkan_pass *pass = NULL;
    if (c->adjust)
        c->adjust(&options);
    desc.bent_normal_format = c->format;
    assert_int_equal(
        crv_vulkan_pass_create(t->context, &options, &t->s->desc, &desc, &pass), CRV_OK);
    const int width = c->width + AT_X, height = c->height + AT_Y;
    host_image_free(&g->h, &t->in.result);
    t->in.result = engine_result(g, e.result_format, width, height);
    host_image bent = engine_result(g, c->format, width, height);
    crv_vulkan_frame frame = scene_frame(t->s, &e, &t->in);
    frame.result_x = AT_X;
    frame.result_y = AT_Y;
    frame.bent_normal = bent.image;
    frame.bent_normal_view = bent.view;
    stage_draw(t, pass, &frame);
    const size_t texel = texel_layout_of(c->format)->size;
    unsigned char *bytes =
        engine_download(g, &bent, width, height, (size_t)(width * height) * texel);
    float *expected = malloc(3 * stage_pixels(t) * sizeof *expected);
    assert_non_null(bytes);
    assert_non_null(expected);
    float *A = scene_scalar_bent(t->s, &e, options, expected);
    assert_agrees(t->s, c, bytes, expected, A);
    free(A);
    free(expected);
    free(bytes);
    host_image_free(&g->h, &bent);
    crv_vulkan_pass_destroy(pass);
    stage_close(t);
}

static void images_hold_the_bent_normals_of_the_cpu(void **state)
{
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++)
        try_case(*state, &CASES[i]);
}

static void what_cannot_be_is_refused_with_one_line(void **state)
{
    scene_encoding e = STAGE_USUAL;
    e.method = "gtao";
    stage *t = stage_open(*state, &e, 32, 24);
    crv_options options = scene_options(&e);
    crv_vulkan_pass_desc desc = scene_pass_desc(&e);
    crv_vulkan_pass *pass = NULL;
    desc.bent_normal_format = VK_FORMAT_R8_UNORM;
    stage_assert_refused(
        t, crv_vulkan_pass_create(t->context, &options, &t->s->desc, &desc, &pass),
        CRV_ERROR_UNSUPPORTED, "bent_normal_format is VkFormat 9");
    desc.bent_normal_format = VK_FORMAT_R16G16B16A16_SFLOAT;
    const crv_options hbao = fixture_options("hbao");
    stage_assert_refused(
        t, crv_vulkan_pass_create(t->context, &hbao, &t->s->desc, &desc, &pass),
        CRV_ERROR_INVALID_ARGUMENT, "hbao gives no bent normals");
    assert_null(pass);
    assert_int_equal(
        crv_vulkan_pass_create(t->context, &options, &t->s->desc, &desc, &pass), CRV_OK);
    const crv_vulkan_frame frame = scene_frame(t->s, &e, &t->in);
    stage_assert_refused(t, crv_vulkan_pass_record(pass, engine_begin(t->g, 0), &frame),
                         CRV_ERROR_INVALID_ARGUMENT, "set bent_normal");
    engine_submit(t->g, 0);
    engine_wait(t->g);
    options.bent_normal = 1; /* the pass's format decides */
    assert_int_equal(crv_vulkan_pass_set_options(pass, &options), CRV_OK);
    crv_vulkan_pass_destroy(pass);
    stage_close(t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_hold_the_bent_normals_of_the_cpu),
        cmocka_unit_test(what_cannot_be_is_refused_with_one_line),
        cmocka_unit_test(the_validation_layer_is_silent),
    };
    const int refused = engine_tests_begin();
    if (refused)
        return refused;
    return engine_tests_end(cmocka_run_group_tests(tests, engine_tests_setup, NULL));
}

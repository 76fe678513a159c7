/* SPDX-License-Identifier: MIT */
/* Several views and frames at once: rectangles and layers of larger images, command
 * buffers with more than one recording, many of them in flight. Under the validation
 * layer. */
#include "fixture.h"

#include <stdio.h>
#include <string.h>

#include "vulkan_stage.h"

/* ---- parts of larger images ---- */

enum { VIEWS = 2, VIEW_WIDTH = 100, VIEW_HEIGHT = 60, ATLAS_WIDTH = 230 };
enum { ATLAS_HEIGHT = 90, ATLAS_PIXELS = ATLAS_WIDTH * ATLAS_HEIGHT };

static const int VIEW_X[VIEWS] = {3, 120}, VIEW_Y[VIEWS] = {11, 20};
static const float UNTOUCHED = 7; /* in results: no accessibility */

/* Split screen: two views side by side in the host's images. */
typedef struct split {
    stage t; /* without a scene of its own */
    scene *s[VIEWS];
    host_image depth;
} split;

static split *split_open(engine *g, const char *method)
{
    split *p = calloc(1, sizeof *p);
    float *depth = malloc(ATLAS_PIXELS * sizeof *depth);
    assert_non_null(p);
    assert_non_null(depth);
    p->t.g = g;
    p->t.e = STAGE_USUAL;
    p->t.e.method = method;
    p->t.e.normals = CRV_VULKAN_NORMALS_NONE;
    p->t.e.depth_format = VK_FORMAT_R32_SFLOAT;
    p->t.e.depth = CRV_DEPTH_PLANAR;
    p->t.context = scene_context(g, &p->t.log);
    for (int i = 0; i < ATLAS_PIXELS; i++)
        depth[i] = 0.01f; /* an occluder, were it read */
    for (int v = 0; v < VIEWS; v++) {
        p->s[v] = malloc(sizeof *p->s[v]);
        assert_non_null(p->s[v]);
        scene_make_sized(p->s[v], &p->t.e, v ? 1.2 : 1, VIEW_WIDTH, VIEW_HEIGHT);
        for (int i = 0; i < VIEW_WIDTH * VIEW_HEIGHT; i++)
            depth[(VIEW_Y[v] + i / VIEW_WIDTH) * ATLAS_WIDTH + VIEW_X[v]
                  + i % VIEW_WIDTH] = p->s[v]->depth[i];
    }
    p->depth = engine_upload(g, p->t.e.depth_format, ATLAS_WIDTH, ATLAS_HEIGHT, depth,
                             ATLAS_PIXELS * sizeof *depth);
    free(depth);
    return p;
}

static void split_close(split *p)
{
    for (int v = 0; v < VIEWS; v++)
        free(p->s[v]);
    host_image_free(&p->t.g->h, &p->depth);
    crv_context_destroy(p->t.context);
    free(p);
}

static host_image split_result(const split *p)
{
    return engine_filled(p->t.g, VK_FORMAT_R32_SFLOAT, ATLAS_WIDTH, ATLAS_HEIGHT,
                         UNTOUCHED);
}

/* A view from and to its place; what else the result holds is kept. */
static crv_vulkan_frame split_frame(const split *p, int view, host_image result)
{
    const scene_images in = {.depth = p->depth, .result = result};
    crv_vulkan_frame f = scene_frame(p->s[view], &p->t.e, &in);
    f.input_x = f.result_x = VIEW_X[view];
    f.input_y = f.result_y = VIEW_Y[view];
    f.result_layout_before = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    f.result_stages_before = VK_PIPELINE_STAGE_2_COPY_BIT;
    f.result_access_before = VK_ACCESS_2_TRANSFER_READ_BIT;
    return f;
}

/* A result, which the caller frees. */
static float *split_download(const split *p, const host_image *result)
{
    return engine_download(p->t.g, result, ATLAS_WIDTH, ATLAS_HEIGHT,
                           ATLAS_PIXELS * sizeof(float));
}

static int count_touched(const float *atlas)
{
    int touched = 0;
    for (int i = 0; i < ATLAS_PIXELS; i++)
        touched += atlas[i] < UNTOUCHED;
    return touched;
}

static void views_share_images_and_a_command_buffer(void **state)
{
    split *p = split_open(*state, "hbao");
    const crv_options options = scene_options(&p->t.e);
    crv_vulkan_pass *pass = stage_pass(&p->t, &options, VIEWS, VIEW_WIDTH, VIEW_HEIGHT);
    host_image result = split_result(p);
    const VkCommandBuffer commands = engine_begin(p->t.g, 0);
    for (int v = 0; v < VIEWS; v++) {
        crv_vulkan_frame f = split_frame(p, v, result);
        f.index = v;
        assert_int_equal(crv_vulkan_pass_record(pass, commands, &f), CRV_OK);
    }
    engine_submit(p->t.g, 0);
    engine_wait(p->t.g);
    float *got = split_download(p, &result);
    assert_int_equal(count_touched(got), VIEWS * VIEW_WIDTH * VIEW_HEIGHT);
    for (int v = 0; v < VIEWS; v++) {
        float view[VIEW_WIDTH * VIEW_HEIGHT];
        float *wanted = scene_scalar(p->s[v], &p->t.e);
        for (int i = 0; i < VIEW_WIDTH * VIEW_HEIGHT; i++)
            view[i] = got[(VIEW_Y[v] + i / VIEW_WIDTH) * ATLAS_WIDTH + VIEW_X[v]
                          + i % VIEW_WIDTH];
        scene_assert_agrees(p->s[v], &p->t.e, view, wanted);
        free(wanted);
    }
    free(got);
    host_image_free(&p->t.g->h, &result);
    crv_vulkan_pass_destroy(pass);
    split_close(p);
}

/* Multiview: each view has a layer of the result; the other one keeps what it held. */
static void results_are_layers_of_an_array(void **state)
{
    stage *t = stage_open(*state, &STAGE_USUAL, 150, 97);
    const crv_options options = scene_options(&t->e);
    crv_vulkan_pass *pass = stage_pass(t, &options, 2, 150, 97);
    crv_vulkan_frame frame = scene_frame(t->s, &t->e, &t->in);
    float *wanted = stage_drawn(t, pass, &frame), *got[2];
    engine_array array = engine_array_make(t->g, t->e.result_format, 150, 97);
    const VkCommandBuffer commands = engine_begin(t->g, 0);
    for (int v = 0; v < 2; v++) {
        frame.index = v;
        frame.result = array.image.image;
        frame.result_layer = (uint32_t)v;
        frame.result_view = array.layer[v];
        assert_int_equal(crv_vulkan_pass_record(pass, commands, &frame), CRV_OK);
    }
    engine_submit(t->g, 0);
    engine_wait(t->g);
    for (int v = 0; v < 2; v++) {
        got[v] = engine_download_layer(t->g, &array.image, v, 150, 97,
                                       stage_pixels(t) * sizeof *got[v]);
        assert_memory_equal(got[v], wanted, stage_pixels(t) * sizeof *wanted);
        free(got[v]);
    }
    free(wanted);
    engine_array_free(t->g, &array);
    crv_vulkan_pass_destroy(pass);
    stage_close(t);
}

/* Tiles of a larger picture: one pass for all, which have noise by where they lie. */
static void origins_of_frames_add_to_those_of_a_pass(void **state)
{
    static const struct {
        int32_t pass, frame;
    } ORIGINS[] = {{6, 0}, {1, 5}, {0, 6}, {0, 0}};
    scene_encoding e = STAGE_USUAL;
    e.filter = NULL; /* it would hide the noise */
    stage *t = stage_open(*state, &e, 150, 97);
    const crv_options options = scene_options(&e);
    crv_vulkan_frame frame = scene_frame(t->s, &e, &t->in);
    float *got[4];
    for (int i = 0; i < 4; i++) {
        crv_gbuffer_desc size = t->s->desc;
        const crv_vulkan_pass_desc desc = scene_pass_desc(&e);
        crv_vulkan_pass *pass = NULL;
        size.origin_x = size.origin_y = ORIGINS[i].pass;
        frame.origin_x = frame.origin_y = ORIGINS[i].frame;
        assert_int_equal(
            crv_vulkan_pass_create(t->context, &options, &size, &desc, &pass), CRV_OK);
        got[i] = stage_drawn(t, pass, &frame);
        crv_vulkan_pass_destroy(pass);
    }
    const size_t bytes = stage_pixels(t) * sizeof(float);
    assert_memory_equal(got[0], got[1], bytes);
    assert_memory_equal(got[0], got[2], bytes);
    assert_true(memcmp(got[0], got[3], bytes) != 0);
    for (int i = 0; i < 4; i++)
        free(got[i]);
    stage_close(t);
}

/* ---- frames in flight ---- */

enum { FLIGHT = 8 };
_Static_assert((int)FLIGHT <= ENGINE_COMMANDS, "a command buffer for each frame");

/* Records both views of frame i: of a size, with options and noise of their own. Returns
 * how many pixels they have. */
static int record_changed(const split *p, crv_vulkan_pass *pass, VkCommandBuffer commands,
                          int i, host_image result)
{
    int pixels = 0;
    for (int v = 0; v < VIEWS; v++) {
        crv_options options = scene_options(&p->t.e);
        options.radius = 0.4f + 0.1f * (float)(i + v);
        options.contrast = 1 + 0.1f * (float)i;
        options.filter_depth = 0.05f * (float)(1 + i);
        options.noise_index = v;
        crv_vulkan_frame f = split_frame(p, v, result);
        f.index = VIEWS * i + v;
        f.width = VIEW_WIDTH - 15 + 3 * i;
        f.height = VIEW_HEIGHT - 3 * v + i / 2;
        f.camera = crv_camera_perspective(f.width, f.height, 1);
        f.noise_index = (uint32_t)i;
        assert_int_equal(crv_vulkan_pass_set_options(pass, &options), CRV_OK);
        assert_int_equal(crv_vulkan_pass_record(pass, commands, &f), CRV_OK);
        pixels += f.width * f.height;
    }
    return pixels;
}

/* The window grows on the way: then there is another pass, while recordings of the one
 * before are pending. Each frame alone gives the same picture. */
static void eight_frames_of_two_views_are_in_flight(void **state)
{
    static const char *const METHODS[] = {"hbao", "bitmask"};
    engine *g = *state;
    for (int m = 0; m < 2; m++) {
        split *p = split_open(g, METHODS[m]);
        const crv_options options = scene_options(&p->t.e);
        crv_vulkan_pass *small = stage_pass(&p->t, &options, VIEWS * FLIGHT, VIEW_WIDTH,
                                            VIEW_HEIGHT + 3),
                        *large = NULL;
        host_image results[FLIGHT], alone = split_result(p);
        int pixels[FLIGHT];
        for (int i = 0; i < FLIGHT; i++)
            results[i] = split_result(p);
        for (int i = 0; i < FLIGHT; i++) {
            if (i == FLIGHT / 2)
                large = stage_pass(&p->t, &options, VIEWS * FLIGHT, VIEW_WIDTH + 10,
                                   VIEW_HEIGHT + 5);
            pixels[i] = record_changed(p, large ? large : small, engine_begin(g, i), i,
                                       results[i]);
            engine_submit(g, i);
        }
        engine_wait(g);
        for (int i = 0; i < FLIGHT; i++) {
            host_image_free(&g->h, &alone);
            alone = split_result(p);
            record_changed(p, large, engine_begin(g, 0), i, alone);
            engine_submit(g, 0);
            engine_wait(g);
            float *got = split_download(p, &results[i]),
                  *wanted = split_download(p, &alone);
            assert_int_equal(count_touched(got), pixels[i]);
            assert_memory_equal(got, wanted, ATLAS_PIXELS * sizeof *got);
            free(got);
            free(wanted);
            host_image_free(&g->h, &results[i]);
        }
        host_image_free(&g->h, &alone);
        crv_vulkan_pass_destroy(small);
        crv_vulkan_pass_destroy(large);
        split_close(p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_share_images_and_a_command_buffer),
        cmocka_unit_test(results_are_layers_of_an_array),
        cmocka_unit_test(origins_of_frames_add_to_those_of_a_pass),
        cmocka_unit_test(eight_frames_of_two_views_are_in_flight),
        cmocka_unit_test(the_validation_layer_is_silent),
    };
    const int refused = engine_tests_begin();
    if (refused)
        return refused;
    return engine_tests_end(cmocka_run_group_tests(tests, engine_tests_setup, NULL));
}

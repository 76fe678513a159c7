/* SPDX-License-Identifier: MIT */
/* What renderers change from frame to frame: sizes, options, noise. Under the validation
 * layer. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "vulkan_stage.h"

static void assert_same(const float *a, const float *b, size_t count)
{
    assert_memory_equal(a, b, count * sizeof *a);
}

static double rmse(const float *a, const float *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
    return sqrt(sum / (double)count);
}

/* ---- sizes ---- */

/* In the middle column of an odd width view rays have x = 0: the floor's tangents lie in
 * the viewing plane there. Filters spread a sample that falls on another texel. */
static void odd_sizes_agree_with_the_cpu(void **state)
{
    static const char *const METHODS[] = {"hbao", "vao"};
    static const char *const FILTERS[] = {"bilateral13", "box4", "edges15", "gauss5"};
    for (int i = 0; i < 8; i++) {
        char name[64];
        scene_encoding e = STAGE_USUAL;
        e.method = METHODS[i / 4];
        e.filter = FILTERS[i % 4];
        snprintf(name, sizeof name, "161x91, %s, %s", e.method, e.filter);
        e.name = name;
        stage *t = stage_open(*state, &e, 161, 91);
        crv_options options = scene_options(&e);
        crv_vulkan_pass *pass = stage_pass(t, &options, 1, 161, 91);
        const crv_vulkan_frame frame = scene_frame(t->s, &e, &t->in);
        float *got = stage_drawn(t, pass, &frame), *wanted = scene_scalar(t->s, &e);
        scene_assert_agrees(t->s, &e, got, wanted);
        free(got);
        free(wanted);
        crv_vulkan_pass_destroy(pass);
        stage_close(t);
    }
}

/* Dynamic resolution: the pass is for the largest size, with each layout of depth, and
 * with a map that lies as depth does. */
static void smaller_frames_are_those_of_a_smaller_pass(void **state)
{
    static const char *const METHODS[] = {"hbao", "bitmask"};
    stage *t = stage_open(*state, &STAGE_USUAL, 150, 97);
    crv_vulkan_frame frame = scene_frame(t->s, &t->e, &t->in);
    for (int i = 0; i < 5; i++) {
        float *got[2];
        t->e.method = METHODS[i / 3];
        const crv_options options = scene_options(&t->e);
        for (int large = 0; large < 2; large++) {
            crv_vulkan_pass_desc desc = scene_pass_desc(&t->e);
            crv_gbuffer_desc size;
            crv_vulkan_pass *pass = NULL;
            desc.depth_layout = (crv_vulkan_depth_layout)(i % 3);
            crv_gbuffer_desc_init(&size, sizeof size, large ? 200 : 150,
                                  large ? 131 : 97);
            frame.width = large ? 150 : 0;
            frame.height = large ? 97 : 0;
            assert_int_equal(
                crv_vulkan_pass_create(t->context, &options, &size, &desc, &pass),
                CRV_OK);
            got[large] = stage_drawn(t, pass, &frame);
            crv_vulkan_pass_destroy(pass);
        }
        assert_same(got[0], got[1], stage_pixels(t));
        free(got[0]);
        free(got[1]);
    }
    stage_close(t);
}

static void sizes_that_do_not_fit_are_refused(void **state)
{
    stage *t = stage_open(*state, &STAGE_USUAL, 150, 97);
    const crv_options options = scene_options(&t->e);
    crv_vulkan_pass *pass = stage_pass(t, &options, 1, 150, 97);
    const VkCommandBuffer commands = engine_begin(t->g, 0);
    crv_vulkan_frame f;
#define REFUSED(change, part)                                                            \
    do {                                                                                 \
        f = scene_frame(t->s, &t->e, &t->in);                                            \
        change;                                                                          \
        stage_assert_refused(t, crv_vulkan_pass_record(pass, commands, &f),              \
                             CRV_ERROR_INVALID_ARGUMENT, part);                          \
    } while (0)
    REFUSED(f.width = 151, "150 x 97");
    REFUSED(f.height = -1, "150 x 97");
    REFUSED(f.input_x = -1, "input_x");
    REFUSED(f.result_y = -1, "result_y");
#undef REFUSED
    engine_submit(t->g, 0);
    engine_wait(t->g);
    crv_vulkan_pass_destroy(pass);
    stage_close(t);
}

/* ---- options and noise ---- */

/* A pass with new options draws what a pass made with them draws, and back again. */
static void assert_options_change(const stage *t, const crv_options *second)
{
    const crv_options first = scene_options(&t->e);
    const crv_vulkan_frame frame = scene_frame(t->s, &t->e, &t->in);
    crv_vulkan_pass *pass = stage_pass(t, &first, 2, 150, 97),
                    *other = stage_pass(t, second, 1, 150, 97);
    float *a = stage_drawn(t, pass, &frame), *b = stage_drawn(t, other, &frame);
    assert_int_equal(crv_vulkan_pass_set_options(pass, second), CRV_OK);
    float *c = stage_drawn(t, pass, &frame);
    assert_same(b, c, stage_pixels(t));
    assert_true(rmse(a, b, stage_pixels(t)) > 0.001); /* noise, filtered, is the least */
    assert_int_equal(crv_vulkan_pass_set_options(pass, &first), CRV_OK);
    float *d = stage_drawn(t, pass, &frame);
    assert_same(a, d, stage_pixels(t));
    free(a);
    free(b);
    free(c);
    free(d);
    crv_vulkan_pass_destroy(other);
    crv_vulkan_pass_destroy(pass);
}

static void options_change_without_another_pass(void **state)
{
    stage *t = stage_open(*state, &STAGE_USUAL, 150, 97);
    crv_options numbers = scene_options(&t->e), seed = numbers, noise = numbers;
    numbers.radius = 1.7f;
    numbers.intensity = 1.5f;
    numbers.contrast = 2;
    numbers.max_radius_px = 30;
    numbers.filter_depth = 0.2f;
    numbers.filter_normal = 40;
    seed.seed = 5;
    noise.noise_index = 3;
    assert_options_change(t, &numbers);
    assert_options_change(t, &seed);
    assert_options_change(t, &noise);
    stage_close(t);
}

/* bitmask's map is a step and an image, which other rules do without. */
static void widths_are_made_only_if_asked_for(void **state)
{
    scene_encoding e = STAGE_USUAL;
    e.method = "bitmask";
    e.filter = NULL;
    stage *t = stage_open(*state, &e, 150, 97);
    crv_options options[2] = {scene_options(&e), scene_options(&e)};
    options[1].thickness_rule = CRV_THICKNESS_RUN;
    crv_vulkan_pass *pass[2];
    float *got[4];
    crv_device_time times[CRV_MAX_DEVICE_TIMES];
    int32_t count = 0;
    const crv_vulkan_frame frame = scene_frame(t->s, &e, &t->in);
    for (int i = 0; i < 2; i++) {
        crv_vulkan_pass_desc desc = scene_pass_desc(&e);
        desc.timestamps = VK_TRUE;
        assert_int_equal(
            crv_vulkan_pass_create(t->context, &options[i], &t->s->desc, &desc, &pass[i]),
            CRV_OK);
        got[i] = stage_drawn(t, pass[i], &frame);
        assert_int_equal(crv_vulkan_pass_times(pass[i], 0, times, &count), CRV_OK);
        assert_int_equal(count, i ? 2 : 3); /* depth and normals, width, bitmask */
        assert_string_equal(times[1].name, i ? "bitmask" : "width");
    }
    assert_true(crv_vulkan_pass_bytes(pass[0]) - crv_vulkan_pass_bytes(pass[1])
                >= stage_pixels(t) * sizeof(float));
    for (int i = 0; i < 2; i++) {
        assert_int_equal(crv_vulkan_pass_set_options(pass[0], &options[1 - i]), CRV_OK);
        got[2 + i] = stage_drawn(t, pass[0], &frame);
    }
    assert_same(got[1], got[2], stage_pixels(t));
    assert_same(got[0], got[3], stage_pixels(t));
    assert_true(rmse(got[0], got[1], stage_pixels(t)) > 0.001);
    stage_assert_refused(t, crv_vulkan_pass_set_options(pass[1], &options[0]),
                         CRV_ERROR_UNSUPPORTED, "thickness_rule is fixed");
    for (int i = 0; i < 4; i++)
        free(got[i]);
    crv_vulkan_pass_destroy(pass[0]);
    crv_vulkan_pass_destroy(pass[1]);
    stage_close(t);
}

/* A plan is a pass on its own images. */
static void plans_take_new_options_as_passes_do(void **state)
{
    stage *t = stage_open(*state, &STAGE_USUAL, 150, 97);
    const crv_options first = scene_options(&t->e);
    crv_options second = first;
    second.radius = 1.7f;
    second.contrast = 2;
    second.seed = 5;
    const crv_const_image depth = crv_const_image_packed(t->s->depth, 150, 97, 1);
    float *pixels[2] = {malloc(stage_pixels(t) * sizeof(float)),
                        malloc(stage_pixels(t) * sizeof(float))};
    const crv_depth_format format = scene_frame(t->s, &t->e, &t->in).depth_encoding;
    crv_gbuffer *gbuffer = NULL;
    assert_int_equal(crv_gbuffer_create(t->context, &t->s->desc, &gbuffer), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(gbuffer, &t->s->camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(gbuffer, 0, &depth, &format), CRV_OK);
    for (int i = 0; i < 2; i++) {
        const crv_image result = crv_image_packed(pixels[i], 150, 97, 1);
        crv_plan *plan = NULL;
        assert_int_equal(
            crv_plan_create(t->context, i ? &second : &first, &t->s->desc, &plan),
            CRV_OK);
        assert_int_equal(crv_plan_run(plan, gbuffer, &result), CRV_OK);
        if (i == 0) {
            assert_int_equal(crv_plan_set_options(plan, &second), CRV_OK);
            assert_int_equal(crv_plan_run(plan, gbuffer, &result), CRV_OK);
            second.falloff = CRV_FALLOFF_NONE; /* a specialisation constant */
            stage_assert_refused(t, crv_plan_set_options(plan, &second),
                                 CRV_ERROR_UNSUPPORTED, "fixed on vulkan");
            second.falloff = first.falloff;
        }
        crv_plan_destroy(plan);
    }
    assert_same(pixels[0], pixels[1], stage_pixels(t));
    free(pixels[0]);
    free(pixels[1]);
    crv_gbuffer_destroy(gbuffer);
    stage_close(t);
}

static void what_is_fixed_is_refused_by_name(void **state)
{
    stage *t = stage_open(*state, &STAGE_USUAL, 150, 97);
    const crv_options first = scene_options(&t->e);
    const crv_vulkan_frame frame = scene_frame(t->s, &t->e, &t->in);
    crv_vulkan_pass *pass = stage_pass(t, &first, 1, 150, 97);
    float *before = stage_drawn(t, pass, &frame);
    crv_options o;
#define REFUSED(key, change)                                                             \
    do {                                                                                 \
        o = first;                                                                       \
        change;                                                                          \
        stage_assert_refused(t, crv_vulkan_pass_set_options(pass, &o),                   \
                             CRV_ERROR_UNSUPPORTED, key " is fixed");                    \
    } while (0)
    REFUSED("method", o.method = crv_method_find("vao"));
    REFUSED("filter", o.filter = crv_filter_find("box4"));
    REFUSED("directions", o.directions = 5);
    REFUSED("steps", o.steps = 3);
    REFUSED("falloff", o.falloff = CRV_FALLOFF_NONE);
    REFUSED("noise_size", o.noise_size = 3);
    REFUSED("bias_deg", o.bias_deg = 10);
    REFUSED("filter_normal", o.filter_normal = 5);
#undef REFUSED
    o = first;
    o.radius = -1;
    stage_assert_refused(t, crv_vulkan_pass_set_options(pass, &o),
                         CRV_ERROR_INVALID_ARGUMENT, "radius");
    assert_int_equal(crv_vulkan_pass_set_options(NULL, &first),
                     CRV_ERROR_INVALID_ARGUMENT);
    float *after = stage_drawn(t, pass, &frame);
    assert_same(before, after, stage_pixels(t));
    free(before);
    free(after);
    crv_vulkan_pass_destroy(pass);
    stage_close(t);
}

/* Adds a picture to a mean of `count`. */
static void add(float *mean, float *picture, size_t pixels, int count)
{
    for (size_t k = 0; k < pixels; k++)
        mean[k] += picture[k] / (float)count;
    free(picture);
}

/* The converged estimate is the mean of seeds, which are independent draws: what a frame
 * with more samples gives is another one, whose steps miss less. Independent frames would
 * leave a quarter of a frame's error; what is left of the truth's own is an eighth. */
static void noise_of_its_own_makes_frames_converge(void **state)
{
    enum { FRAMES = 16, SEEDS = 64 };
    static const char *const METHODS[] = {"hbao", "alchemy"};
    for (int m = 0; m < 2; m++) {
        scene_encoding e = STAGE_USUAL;
        e.method = METHODS[m];
        e.filter = NULL;
        stage *t = stage_open(*state, &e, 150, 97);
        crv_options options = scene_options(&e);
        crv_vulkan_pass *pass = stage_pass(t, &options, 2, 150, 97);
        crv_vulkan_frame frame = scene_frame(t->s, &e, &t->in);
        const size_t count = stage_pixels(t);
        float *converged = calloc(count, sizeof *converged),
              *mean = calloc(count, sizeof *mean);
        assert_non_null(converged);
        assert_non_null(mean);
        float *first = stage_drawn(t, pass, &frame);
        for (int i = 0; i < FRAMES; i++) {
            frame.index = i % 2;
            frame.noise_index = (uint32_t)i;
            float *one = stage_drawn(t, pass, &frame);
            if (i == 0)
                assert_same(one, first, count); /* that of plans */
            add(mean, one, count, FRAMES);
        }
        frame.noise_index = 0;
        for (int i = 0; i < SEEDS; i++) {
            options.seed = 1 + i;
            assert_int_equal(crv_vulkan_pass_set_options(pass, &options), CRV_OK);
            add(converged, stage_drawn(t, pass, &frame), count, SEEDS);
        }
        const double alone = rmse(first, converged, count),
                     together = rmse(mean, converged, count);
        print_message("%s: error of one frame %.4f, of the mean of %d %.4f\n", e.method,
                      alone, FRAMES, together);
        assert_true(together < alone / 3);
        free(first);
        free(mean);
        free(converged);
        crv_vulkan_pass_destroy(pass);
        stage_close(t);
    }
}

/* ---- memory, cache, names ---- */

static void recordings_share_their_images(void **state)
{
    stage *t = stage_open(*state, &STAGE_USUAL, 150, 97);
    const crv_options options = scene_options(&t->e);
    crv_vulkan_pass *one = stage_pass(t, &options, 1, 200, 131),
                    *eight = stage_pass(t, &options, 8, 200, 131);
    const uint64_t image = 200 * 131 * sizeof(float);
    assert_true(crv_vulkan_pass_bytes(one) > image);
    /* Parameters and tables: less than an image for all seven. */
    assert_true(crv_vulkan_pass_bytes(eight) - crv_vulkan_pass_bytes(one) < image);
    crv_vulkan_pass_destroy(one);
    crv_vulkan_pass_destroy(eight);
    stage_close(t);
}

/* What the backend calls, seen on its way to the driver. */
static struct {
    VkPipelineCache cache;
    int pipelines, names, labels, open_labels;
} seen;

static VKAPI_ATTR VkResult VKAPI_CALL
create_pipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                 const VkComputePipelineCreateInfo *infos,
                 const VkAllocationCallbacks *callbacks, VkPipeline *out)
{
    seen.cache = cache;
    seen.pipelines++;
    return vkCreateComputePipelines(device, cache, count, infos, callbacks, out);
}

static VKAPI_ATTR VkResult VKAPI_CALL set_name(VkDevice device,
                                               const VkDebugUtilsObjectNameInfoEXT *info)
{
    const PFN_vkSetDebugUtilsObjectNameEXT real =
        (PFN_vkSetDebugUtilsObjectNameEXT)vkGetInstanceProcAddr(
            the_engine.h.instance, "vkSetDebugUtilsObjectNameEXT");
    assert_int_equal(strncmp(info->pObjectName, "crevice ", 8), 0);
    seen.names++;
    return real(device, info);
}

static VKAPI_ATTR void VKAPI_CALL begin_label(VkCommandBuffer commands,
                                              const VkDebugUtilsLabelEXT *label)
{
    const PFN_vkCmdBeginDebugUtilsLabelEXT real =
        (PFN_vkCmdBeginDebugUtilsLabelEXT)vkGetInstanceProcAddr(
            the_engine.h.instance, "vkCmdBeginDebugUtilsLabelEXT");
    seen.labels++;
    seen.open_labels++;
    real(commands, label);
}

static VKAPI_ATTR void VKAPI_CALL end_label(VkCommandBuffer commands)
{
    const PFN_vkCmdEndDebugUtilsLabelEXT real =
        (PFN_vkCmdEndDebugUtilsLabelEXT)vkGetInstanceProcAddr(
            the_engine.h.instance, "vkCmdEndDebugUtilsLabelEXT");
    seen.open_labels--;
    real(commands);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device,
                                                                    const char *name)
{
    if (strcmp(name, "vkCreateComputePipelines") == 0)
        return (PFN_vkVoidFunction)create_pipelines;
    return vkGetDeviceProcAddr(device, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_function(VkInstance instance,
                                                             const char *name)
{
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } OWN[] = {
        {"vkGetDeviceProcAddr", (PFN_vkVoidFunction)get_device_function},
        {"vkSetDebugUtilsObjectNameEXT", (PFN_vkVoidFunction)set_name},
        {"vkCmdBeginDebugUtilsLabelEXT", (PFN_vkVoidFunction)begin_label},
        {"vkCmdEndDebugUtilsLabelEXT", (PFN_vkVoidFunction)end_label},
    };
    for (size_t i = 0; i < sizeof OWN / sizeof *OWN; i++) {
        if (strcmp(name, OWN[i].name) == 0)
            return OWN[i].function;
    }
    return vkGetInstanceProcAddr(instance, name);
}

static void the_host_gives_a_cache_and_gets_names(void **state)
{
    engine *g = *state;
    const VkPipelineCacheCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    crv_vulkan_host device = engine_host(g);
    stage *t = stage_open(*state, &STAGE_USUAL, 150, 97);
    crv_context *own = t->context;
    host_check(vkCreatePipelineCache(g->h.device, &info, NULL, &device.pipeline_cache),
               "cache");
    device.get_instance_proc_addr = get_function;
    device.has_debug_utils = VK_TRUE;
    assert_int_equal(crv_vulkan_context_create(NULL, &device, &t->context), CRV_OK);
    const crv_options options = scene_options(&STAGE_USUAL);
    crv_vulkan_pass *pass = stage_pass(t, &options, 1, 150, 97);
    assert_int_equal(seen.pipelines, 4); /* conversion, estimate, two of the filter */
    assert_ptr_equal(seen.cache, device.pipeline_cache);
    /* Those, four images with their views, and a buffer, at least. */
    assert_true(seen.names >= 4 + 4 * 2 + 1);
    const crv_vulkan_frame frame = scene_frame(t->s, &t->e, &t->in);
    stage_draw(t, pass, &frame);
    assert_int_equal(seen.labels, 1 + 4); /* all of it, and each step */
    assert_int_equal(seen.open_labels, 0);
    crv_vulkan_pass_destroy(pass);
    crv_context_destroy(t->context);
    t->context = own;
    stage_close(t);
    vkDestroyPipelineCache(g->h.device, device.pipeline_cache, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(odd_sizes_agree_with_the_cpu),
        cmocka_unit_test(smaller_frames_are_those_of_a_smaller_pass),
        cmocka_unit_test(sizes_that_do_not_fit_are_refused),
        cmocka_unit_test(options_change_without_another_pass),
        cmocka_unit_test(widths_are_made_only_if_asked_for),
        cmocka_unit_test(plans_take_new_options_as_passes_do),
        cmocka_unit_test(what_is_fixed_is_refused_by_name),
        cmocka_unit_test(noise_of_its_own_makes_frames_converge),
        cmocka_unit_test(recordings_share_their_images),
        cmocka_unit_test(the_host_gives_a_cache_and_gets_names),
        cmocka_unit_test(the_validation_layer_is_silent),
    };
    const int refused = engine_tests_begin();
    if (refused)
        return refused;
    return engine_tests_end(cmocka_run_group_tests(tests, engine_tests_setup, NULL));
}

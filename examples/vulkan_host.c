/* SPDX-License-Identifier: MIT */
/*
 * Crevice inside a Vulkan renderer: a scene is drawn into depth and octahedral normals,
 * crv_vulkan_pass_record() adds ambient occlusion in the same command buffer, a last draw
 * lights the picture with it. Two frames are in flight; the last of a few becomes a file.
 * vulkan_host_setup.c has what every Vulkan program begins with, and nothing of Crevice.
 *
 *   vulkan_host [--validate] [OUT.ppm]
 *
 * Exit code 77 if there is no Vulkan 1.3 device (with --validate: no validation layer).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "crevice/vulkan.h"
#include "vulkan_host_setup.h"

#include "vulkan_host_shaders.h"

/* The scene is drawn GUARD pixels beyond the picture on each side, so that what lies
 * there occludes as well. */
enum { WIDTH = 960, HEIGHT = 540, GUARD = 48 };
enum { BUFFER_WIDTH = WIDTH + 2 * GUARD, BUFFER_HEIGHT = HEIGHT + 2 * GUARD };
enum { FRAMES_IN_FLIGHT = 2, FRAMES = 5 };

static const VkFormat DEPTH = VK_FORMAT_D32_SFLOAT, NORMALS = VK_FORMAT_R16G16_SFLOAT,
                      OCCLUSION = VK_FORMAT_R8_UNORM, COLOUR = VK_FORMAT_R8G8B8A8_SRGB;
static const float NEAR_PLANE = 0.1f;

typedef struct renderer {
    host h;
    host_image depth, normals, occlusion, colour;
    host_buffer readback;
    host_layout layout;
    VkPipeline prepass, light;
    host_frame frames[FRAMES_IN_FLIGHT];
    crv_context *crevice;
    crv_vulkan_pass *pass;
} renderer;

/* As in the shaders. */
typedef struct push_constants {
    float view[3][4], scale[2], shift[2], z_near;
    int32_t guard_px;
} push_constants;

/* ---- once ---- */

static void print_line(void *user, crv_log_level level, const char *line)
{
    (void)user;
    fprintf(stderr, "%s%s\n", level == CRV_LOG_ERROR ? "error: " : "", line);
}

/* A context on the renderer's device, made once; a pass of one method and filter, for
 * frames up to this size. */
static crv_status make_crevice(renderer *r)
{
    crv_context_desc context_desc;
    crv_context_desc_init(&context_desc, sizeof context_desc);
    context_desc.logger.fn = print_line;
    crv_vulkan_host device;
    crv_vulkan_host_init(&device, sizeof device);
    device.get_instance_proc_addr = vkGetInstanceProcAddr;
    device.instance = r->h.instance;
    device.physical_device = r->h.physical;
    device.device = r->h.device;
    device.queue_family = r->h.family;
    device.has_synchronization2 = VK_TRUE;
    device.has_storage_image_write_without_format = VK_TRUE;
    device.has_shader_float16 = r->h.has_float16;
    const crv_status status =
        crv_vulkan_context_create(&context_desc, &device, &r->crevice);
    if (status)
        return status;

    crv_options options;
    crv_options_init(&options, sizeof options, "hbao");
    crv_options_set(&options, "filter", "bilateral13", NULL);
    options.radius = 0.8f;
    crv_gbuffer_desc gbuffer;
    crv_gbuffer_desc_init(&gbuffer, sizeof gbuffer, BUFFER_WIDTH, BUFFER_HEIGHT);
    gbuffer.guard_left = gbuffer.guard_right = GUARD;
    gbuffer.guard_top = gbuffer.guard_bottom = GUARD;
    crv_vulkan_pass_desc desc;
    crv_vulkan_pass_desc_init(&desc, sizeof desc);
    desc.frames = FRAMES_IN_FLIGHT;
    desc.depth_format = DEPTH;
    desc.normals = CRV_VULKAN_NORMALS_OCT;
    desc.normal_space = CRV_NORMAL_WORLD;
    desc.normal_format = NORMALS;
    desc.result_format = OCCLUSION;
    desc.timestamps = VK_TRUE;
    return crv_vulkan_pass_create(r->crevice, &options, &gbuffer, &desc, &r->pass);
}

static void make_images(renderer *r)
{
    const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT,
                            drawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    r->depth = host_image_make(&r->h, DEPTH, BUFFER_WIDTH, BUFFER_HEIGHT,
                               sampled | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    r->normals =
        host_image_make(&r->h, NORMALS, BUFFER_WIDTH, BUFFER_HEIGHT, sampled | drawn);
    r->occlusion = host_image_make(&r->h, OCCLUSION, WIDTH, HEIGHT,
                                   sampled | VK_IMAGE_USAGE_STORAGE_BIT);
    r->colour = host_image_make(&r->h, COLOUR, WIDTH, HEIGHT,
                                drawn | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    r->readback = host_buffer_make(&r->h, (size_t)WIDTH * HEIGHT * 4,
                                   VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

#define SHADER(words) ((host_shader){words, sizeof words})

static void make_pipelines(renderer *r)
{
    const VkImageView views[] = {r->depth.view, r->normals.view, r->occlusion.view};
    r->layout = host_layout_make(&r->h, views, 3, sizeof(push_constants));
    r->prepass =
        host_pipeline_make(&r->h, r->layout.pipelines, SHADER(vulkan_host_prepass_vert),
                           SHADER(vulkan_host_prepass_frag), NORMALS, DEPTH);
    r->light =
        host_pipeline_make(&r->h, r->layout.pipelines, SHADER(vulkan_host_light_vert),
                           SHADER(vulkan_host_light_frag), COLOUR, VK_FORMAT_UNDEFINED);
    for (int i = 0; i < FRAMES_IN_FLIGHT; i++)
        r->frames[i] = host_frame_make(&r->h);
}

/* Crevice first: it uses the device. */
static void free_all(renderer *r)
{
    crv_vulkan_pass_destroy(r->pass);
    crv_context_destroy(r->crevice);
    for (int i = 0; i < FRAMES_IN_FLIGHT; i++)
        host_frame_free(&r->h, &r->frames[i]);
    vkDestroyPipeline(r->h.device, r->prepass, NULL);
    vkDestroyPipeline(r->h.device, r->light, NULL);
    host_layout_free(&r->h, &r->layout);
    host_buffer_free(&r->h, &r->readback);
    host_image_free(&r->h, &r->colour);
    host_image_free(&r->h, &r->occlusion);
    host_image_free(&r->h, &r->normals);
    host_image_free(&r->h, &r->depth);
}

/* ---- a frame ---- */

/* The camera of the buffers, guard band included, and what draws with it: depth reversed,
 * infinitely far. */
static crv_camera look(int number, push_constants *push)
{
    const float angle = 0.35f + 0.04f * (float)number;
    const float eye[3] = {5.2f * sinf(angle), 2.6f, 5.2f * cosf(angle)};
    const float target[3] = {0.1f, 0.6f, -0.4f}, up[3] = {0, 1, 0};
    crv_camera whole = crv_camera_perspective(WIDTH, HEIGHT, 0.75f);
    crv_camera_look_at(&whole, eye, target, up);
    const crv_camera camera = crv_camera_crop(&whole, -GUARD, -GUARD);
    *push = (push_constants){
        .scale = {2 * camera.fx_px / BUFFER_WIDTH, -2 * camera.fy_px / BUFFER_HEIGHT},
        .shift = {1 - 2 * camera.cx_px / BUFFER_WIDTH,
                  1 - 2 * camera.cy_px / BUFFER_HEIGHT},
        .z_near = NEAR_PLANE,
        .guard_px = GUARD};
    for (int row = 0; row < 3; row++) {
        const float *v = camera.world_to_view + 3 * row;
        memcpy(push->view[row], v, 3 * sizeof *v);
        push->view[row][3] = -(v[0] * eye[0] + v[1] * eye[1] + v[2] * eye[2]);
    }
    return camera;
}

static const host_use
    /* Whatever the frame before did with it: its contents are not needed. */
    USED = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED},
    DRAWN = {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
             VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
             VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
    DRAWN_DEPTH = {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT
                       | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                   VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT
                       | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                   VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL},
    /* By Crevice, in compute shaders, and by the light. */
    SAMPLED = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT
                   | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
               VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
    COPIED = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
              VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};

static void record_prepass(const renderer *r, VkCommandBuffer commands)
{
    const VkImage depth = r->depth.image, normals = r->normals.image;
    host_barrier(commands, normals, VK_IMAGE_ASPECT_COLOR_BIT, USED, DRAWN);
    host_barrier(commands, depth, VK_IMAGE_ASPECT_DEPTH_BIT, USED, DRAWN_DEPTH);
    host_rendering_begin(commands, r->normals.view, r->depth.view, BUFFER_WIDTH,
                         BUFFER_HEIGHT);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, r->prepass);
    vkCmdDraw(commands, 36, 14, 0, 0);          /* boxes */
    vkCmdDraw(commands, 24 * 48 * 6, 4, 0, 14); /* balls */
    vkCmdEndRendering(commands);
    host_barrier(commands, normals, VK_IMAGE_ASPECT_COLOR_BIT, DRAWN, SAMPLED);
    host_barrier(commands, depth, VK_IMAGE_ASPECT_DEPTH_BIT, DRAWN_DEPTH, SAMPLED);
}

/* The result needs no barriers, neither before nor after: Crevice leaves it in
 * SHADER_READ_ONLY_OPTIMAL, visible to fragment shaders. */
static crv_status record_occlusion(const renderer *r, VkCommandBuffer commands, int index,
                                   const crv_camera *camera)
{
    crv_vulkan_frame f;
    crv_vulkan_frame_init(&f, sizeof f);
    f.index = index;
    f.camera = *camera;
    f.depth_encoding.encoding = CRV_DEPTH_REVERSED;
    f.depth_encoding.z_near = NEAR_PLANE;
    f.depth_encoding.z_far = INFINITY;
    f.depth[0].view = r->depth.view;
    f.normals.view = r->normals.view;
    f.result = r->occlusion.image;
    f.result_view = r->occlusion.view;
    return crv_vulkan_pass_record(r->pass, commands, &f);
}

static void record_light(const renderer *r, VkCommandBuffer commands)
{
    const VkImage colour = r->colour.image;
    host_barrier(commands, colour, VK_IMAGE_ASPECT_COLOR_BIT, USED, DRAWN);
    host_rendering_begin(commands, r->colour.view, VK_NULL_HANDLE, WIDTH, HEIGHT);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, r->light);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                            r->layout.pipelines, 0, 1, &r->layout.set, 0, NULL);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRendering(commands);
    host_barrier(commands, colour, VK_IMAGE_ASPECT_COLOR_BIT, DRAWN, COPIED);
}

/* Waits only for the frame that had this index before, so that two are in flight. */
static crv_status draw_frame(renderer *r, int number)
{
    const int index = number % FRAMES_IN_FLIGHT;
    host_frame *f = &r->frames[index];
    push_constants push;
    const crv_camera camera = look(number, &push);
    host_check(vkWaitForFences(r->h.device, 1, &f->done, VK_TRUE, UINT64_MAX), "wait");
    host_frame_begin(&r->h, f);
    vkCmdPushConstants(f->commands, r->layout.pipelines, HOST_PUSH_STAGES, 0, sizeof push,
                       &push);
    record_prepass(r, f->commands);
    const crv_status status = record_occlusion(r, f->commands, index, &camera);
    if (status)
        return status;
    record_light(r, f->commands);
    if (number == FRAMES - 1)
        host_readback(f->commands, r->colour.image, 0, WIDTH, HEIGHT, &r->readback);
    host_frame_submit(&r->h, f);
    return CRV_OK;
}

static void print_times(const renderer *r)
{
    crv_device_time times[CRV_MAX_DEVICE_TIMES];
    int32_t count = 0;
    if (crv_vulkan_pass_times(r->pass, (FRAMES - 1) % FRAMES_IN_FLIGHT, times, &count))
        return;
    printf("on %s\n", r->h.properties.deviceName);
    for (int32_t i = 0; i < count; i++)
        printf("%-20s %8.3f ms\n", times[i].name, times[i].time_ms);
}

int main(int argc, char **argv)
{
    const int validate = argc > 1 && strcmp(argv[1], "--validate") == 0;
    const char *path = argc > 1 + validate ? argv[1 + validate] : "vulkan_host.ppm";
    static renderer r;
    if (host_open(&r.h, validate) != 0) {
        fprintf(stderr, "no Vulkan 1.3 device%s\n", validate ? " with validation" : "");
        return 77;
    }
    make_images(&r);
    make_pipelines(&r);
    crv_status status = make_crevice(&r);
    for (int i = 0; status == CRV_OK && i < FRAMES; i++)
        status = draw_frame(&r, i);
    host_check(vkDeviceWaitIdle(r.h.device), "wait");
    if (status == CRV_OK)
        print_times(&r);
    const int failed =
        status != CRV_OK || host_write_ppm(path, &r.readback, WIDTH, HEIGHT);
    free_all(&r);
    host_close(&r.h);
    return failed || r.h.complaints ? EXIT_FAILURE : EXIT_SUCCESS;
}

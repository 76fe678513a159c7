/* SPDX-License-Identifier: MIT */
/*
 * Crevice inside a Vulkan renderer: a mesh is drawn into depth and octahedral normals,
 * crv_vulkan_pass_record() adds ambient occlusion in the same command buffer, a last draw
 * lights the picture with it. Two frames are in flight; the last of a few becomes a file.
 *
 *   vulkan_host [--validate] [OUT.ppm]
 *
 * Exit code 77 if there is no Vulkan 1.3 device (with --validate: no validation
 * layer).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "crevice/vulkan.h"
#include "vulkan_host_setup.h"

#include "vulkan_host_shaders.h"

/* The geometry is drawn GUARD pixels beyond the picture on each side, so that what lies
 * there occludes as well. */
enum { WIDTH = 960, HEIGHT = 540, GUARD = 48 };
enum { BUFFER_WIDTH = WIDTH + 2 * GUARD, BUFFER_HEIGHT = HEIGHT + 2 * GUARD };
enum { FRAMES_IN_FLIGHT = 2, FRAMES = 5 };

static const VkFormat DEPTH = VK_FORMAT_D32_SFLOAT, NORMALS = VK_FORMAT_R16G16_SFLOAT,
                      OCCLUSION = VK_FORMAT_R8_UNORM, COLOUR = VK_FORMAT_R8G8B8A8_SRGB;
static const float NEAR_PLANE = 0.1f;

/* ---- the mesh: boxes and balls on a floor ---- */

typedef struct mesh {
    float *at; /* position, normal, position, ... */
    uint32_t count;
} mesh;

enum { MOST_VERTICES = 60000 };

static void add_vertex(mesh *m, const float position[3], const float normal[3])
{
    if (m->count == MOST_VERTICES)
        return;
    memcpy(m->at + (size_t)m->count * 6, position, 3 * sizeof(float));
    memcpy(m->at + (size_t)m->count * 6 + 3, normal, 3 * sizeof(float));
    m->count++;
}

static void add_box(mesh *m, float x, float y, float z, float w, float h, float d)
{
    static const int CORNERS[6][2] = {{-1, -1}, {1, -1}, {1, 1},
                                      {-1, -1}, {1, 1},  {-1, 1}};
    const float centre[3] = {x, y + h / 2, z}, half[3] = {w / 2, h / 2, d / 2};
    for (int face = 0; face < 6; face++) {
        const int axis = face / 2, sign = face % 2 ? 1 : -1;
        for (int corner = 0; corner < 6; corner++) {
            float normal[3] = {0}, position[3];
            int side[3];
            normal[axis] = (float)sign;
            side[axis] = sign;
            side[(axis + 1) % 3] = CORNERS[corner][0];
            side[(axis + 2) % 3] = CORNERS[corner][1];
            for (int i = 0; i < 3; i++)
                position[i] = centre[i] + half[i] * (float)side[i];
            add_vertex(m, position, normal);
        }
    }
}

static void add_ball(mesh *m, float x, float y, float z, float radius)
{
    enum { RINGS = 24, SECTORS = 48 };
    const float centre[3] = {x, y, z}, turn = 6.2831853f;
    static const int QUAD[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i < RINGS * SECTORS * 6; i++) {
        const int ring = i / 6 / SECTORS + QUAD[i % 6][0];
        const int sector = i / 6 % SECTORS + QUAD[i % 6][1];
        const float theta = turn / 2 * (float)ring / RINGS;
        const float phi = turn * (float)sector / SECTORS;
        const float normal[3] = {sinf(theta) * cosf(phi), cosf(theta),
                                 sinf(theta) * sinf(phi)};
        float position[3];
        for (int k = 0; k < 3; k++)
            position[k] = centre[k] + radius * normal[k];
        add_vertex(m, position, normal);
    }
}

static void build_mesh(mesh *m)
{
    add_box(m, 0, -0.2f, 0, 14, 0.2f, 14);
    for (int i = 0; i < 5; i++)
        add_box(m, -2.6f, 0, -2 + 0.5f * (float)i, 1.6f, 1.5f - 0.3f * (float)i, 0.5f);
    for (int i = 0; i < 6; i++)
        add_box(m, -1 + 0.6f * (float)i, 0, -2.2f, 0.25f, 1.8f, 0.25f);
    add_box(m, 0.5f, 1.8f, -2.2f, 3.8f, 0.3f, 0.6f);
    add_box(m, 2.5f, 0, 0.4f, 1, 0.6f, 1);
    add_ball(m, 2.5f, 1.1f, 0.4f, 0.5f);
    add_ball(m, -0.4f, 0.6f, 0, 0.6f);
    add_ball(m, 0.7f, 0.35f, 0.7f, 0.35f);
    add_ball(m, 0.9f, 0.2f, -0.3f, 0.2f);
}

/* ---- the renderer ---- */

typedef struct frame {
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence done;
} frame;

typedef struct renderer {
    host h;
    host_image depth, normals, occlusion, colour;
    host_buffer vertices, readback;
    uint32_t vertex_count;
    VkSampler sampler;
    VkDescriptorSetLayout set_layout;
    VkDescriptorPool descriptors;
    VkDescriptorSet set;
    VkPipelineLayout layout;
    VkPipeline prepass, light;
    frame frames[FRAMES_IN_FLIGHT];
    crv_context *crevice;
    crv_vulkan_pass *pass;
} renderer;

typedef struct push_constants {
    float view_projection[16]; /* column-major */
    int32_t guard_px;
} push_constants;

static void print_line(void *user, crv_log_level level, const char *line)
{
    (void)user;
    fprintf(stderr, "%s%s\n", level == CRV_LOG_ERROR ? "error: " : "", line);
}

/* Crevice on this device; made once, and the pass anew when the size changes. */
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
    crv_status status = crv_vulkan_context_create(&context_desc, &device, &r->crevice);
    if (status)
        return status;

    crv_options options;
    crv_options_init(&options, sizeof options, "hbao");
    crv_options_set(&options, "filter", "bilateral13", &context_desc.logger);
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
    const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT;
    const VkImageUsageFlags colour = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    r->depth = host_image_make(&r->h, DEPTH, BUFFER_WIDTH, BUFFER_HEIGHT,
                               sampled | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    r->normals =
        host_image_make(&r->h, NORMALS, BUFFER_WIDTH, BUFFER_HEIGHT, sampled | colour);
    r->occlusion = host_image_make(&r->h, OCCLUSION, WIDTH, HEIGHT,
                                   sampled | VK_IMAGE_USAGE_STORAGE_BIT);
    r->colour = host_image_make(&r->h, COLOUR, WIDTH, HEIGHT,
                                colour | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    r->readback = host_buffer_make(&r->h, (size_t)WIDTH * HEIGHT * 4,
                                   VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

static void make_vertices(renderer *r)
{
    mesh m = {malloc(sizeof(float) * 6 * MOST_VERTICES), 0};
    if (!m.at)
        host_check(VK_ERROR_OUT_OF_HOST_MEMORY, "mesh");
    build_mesh(&m);
    const size_t size = (size_t)m.count * 6 * sizeof(float);
    r->vertices = host_buffer_make(&r->h, size, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    memcpy(r->vertices.bytes, m.at, size);
    r->vertex_count = m.count;
    free(m.at);
}

/* What the light reads: depth, normals, accessibility. */
static void make_descriptors(renderer *r)
{
    const VkDevice device = r->h.device;
    const VkSamplerCreateInfo sampler = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    host_check(vkCreateSampler(device, &sampler, NULL, &r->sampler), "sampler");
    VkDescriptorSetLayoutBinding bindings[3];
    for (uint32_t i = 0; i < 3; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                           1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL};
    const VkDescriptorSetLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 3,
        .pBindings = bindings};
    host_check(vkCreateDescriptorSetLayout(device, &layout, NULL, &r->set_layout),
               "set layout");
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 3};
    const VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = 1,
        .poolSizeCount = 1,
        .pPoolSizes = &size};
    host_check(vkCreateDescriptorPool(device, &pool, NULL, &r->descriptors), "pool");
    const VkDescriptorSetAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = r->descriptors,
        .descriptorSetCount = 1,
        .pSetLayouts = &r->set_layout};
    host_check(vkAllocateDescriptorSets(device, &info, &r->set), "set");
    const VkDescriptorImageInfo images[3] = {
        {r->sampler, r->depth.view, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
        {r->sampler, r->normals.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
        {r->sampler, r->occlusion.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}};
    VkWriteDescriptorSet writes[3];
    for (uint32_t i = 0; i < 3; i++)
        writes[i] = (VkWriteDescriptorSet){
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = r->set,
            .dstBinding = i,
            .descriptorCount = 1,
            .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            .pImageInfo = &images[i]};
    vkUpdateDescriptorSets(device, 3, writes, 0, NULL);
}

#define SHADER(words) ((host_shader){words, sizeof words})

static void make_pipelines(renderer *r)
{
    const VkPushConstantRange range = {VK_SHADER_STAGE_VERTEX_BIT
                                           | VK_SHADER_STAGE_FRAGMENT_BIT,
                                       0, sizeof(push_constants)};
    const VkPipelineLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &r->set_layout,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &range};
    host_check(vkCreatePipelineLayout(r->h.device, &layout, NULL, &r->layout), "layout");
    r->prepass = host_pipeline_make(&r->h, r->layout, SHADER(vulkan_host_prepass_vert),
                                    SHADER(vulkan_host_prepass_frag), 6 * sizeof(float),
                                    NORMALS, DEPTH);
    r->light = host_pipeline_make(&r->h, r->layout, SHADER(vulkan_host_light_vert),
                                  SHADER(vulkan_host_light_frag), 0, COLOUR,
                                  VK_FORMAT_UNDEFINED);
}

static void make_frames(renderer *r)
{
    for (int i = 0; i < FRAMES_IN_FLIGHT; i++) {
        frame *f = &r->frames[i];
        const VkCommandPoolCreateInfo pool = {
            .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
            .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
            .queueFamilyIndex = r->h.family};
        host_check(vkCreateCommandPool(r->h.device, &pool, NULL, &f->pool), "pool");
        const VkCommandBufferAllocateInfo buffer = {
            .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
            .commandPool = f->pool,
            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
            .commandBufferCount = 1};
        host_check(vkAllocateCommandBuffers(r->h.device, &buffer, &f->commands),
                   "command buffer");
        const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                         .flags = VK_FENCE_CREATE_SIGNALED_BIT};
        host_check(vkCreateFence(r->h.device, &fence, NULL, &f->done), "fence");
    }
}

static void renderer_free(renderer *r)
{
    vkDeviceWaitIdle(r->h.device);
    crv_vulkan_pass_destroy(r->pass);
    crv_context_destroy(r->crevice);
    for (int i = 0; i < FRAMES_IN_FLIGHT; i++) {
        vkDestroyFence(r->h.device, r->frames[i].done, NULL);
        vkDestroyCommandPool(r->h.device, r->frames[i].pool, NULL);
    }
    vkDestroyPipeline(r->h.device, r->prepass, NULL);
    vkDestroyPipeline(r->h.device, r->light, NULL);
    vkDestroyPipelineLayout(r->h.device, r->layout, NULL);
    vkDestroyDescriptorPool(r->h.device, r->descriptors, NULL);
    vkDestroyDescriptorSetLayout(r->h.device, r->set_layout, NULL);
    vkDestroySampler(r->h.device, r->sampler, NULL);
    host_buffer_free(&r->h, &r->vertices);
    host_buffer_free(&r->h, &r->readback);
    host_image_free(&r->h, &r->colour);
    host_image_free(&r->h, &r->occlusion);
    host_image_free(&r->h, &r->normals);
    host_image_free(&r->h, &r->depth);
}

/* ---- a frame ---- */

/* The camera of the buffers, guard band included, and the matrix that draws with it:
 * depth reversed, infinitely far. */
static crv_camera look(int number, push_constants *push)
{
    const float angle = 0.35f + 0.04f * (float)number;
    const float eye[3] = {5.2f * sinf(angle), 2.6f, 5.2f * cosf(angle)};
    const float target[3] = {0.1f, 0.6f, -0.4f}, up[3] = {0, 1, 0};
    crv_camera whole = crv_camera_perspective(WIDTH, HEIGHT, 0.75f);
    crv_camera_look_at(&whole, eye, target, up);
    const crv_camera camera = crv_camera_crop(&whole, -GUARD, -GUARD);
    const float *view = camera.world_to_view;
    float *m = push->view_projection;
    for (int column = 0; column < 4; column++) {
        float v[3];
        for (int row = 0; row < 3; row++)
            v[row] = column < 3 ? view[row * 3 + column]
                                : -(view[row * 3] * eye[0] + view[row * 3 + 1] * eye[1]
                                    + view[row * 3 + 2] * eye[2]);
        m[column * 4] = 2 * camera.fx_px / BUFFER_WIDTH * v[0]
                        + (1 - 2 * camera.cx_px / BUFFER_WIDTH) * v[2];
        m[column * 4 + 1] = -2 * camera.fy_px / BUFFER_HEIGHT * v[1]
                            + (1 - 2 * camera.cy_px / BUFFER_HEIGHT) * v[2];
        m[column * 4 + 2] = column < 3 ? 0 : NEAR_PLANE;
        m[column * 4 + 3] = -v[2];
    }
    push->guard_px = GUARD;
    return camera;
}

static void begin_rendering(VkCommandBuffer commands, VkImageView colour,
                            VkImageView depth, int width, int height)
{
    const VkRenderingAttachmentInfo colours = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
        .imageView = colour,
        .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRenderingAttachmentInfo depths = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
        .imageView = depth,
        .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR, /* to 0: infinitely far */
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRect2D area = {{0, 0}, {(uint32_t)width, (uint32_t)height}};
    const VkViewport viewport = {0, 0, (float)width, (float)height, 0, 1};
    const VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = area,
                                  .layerCount = 1,
                                  .colorAttachmentCount = 1,
                                  .pColorAttachments = &colours,
                                  .pDepthAttachment = depth ? &depths : NULL};
    vkCmdBeginRendering(commands, &info);
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &area);
}

static const VkPipelineStageFlags2 READERS =
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
static const VkPipelineStageFlags2 DEPTH_TESTS =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT
    | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;

static void record_prepass(renderer *r, VkCommandBuffer commands,
                           const push_constants *push)
{
    const VkDeviceSize none = 0;
    const host_use read = {READERS, 0, VK_IMAGE_LAYOUT_UNDEFINED};
    const host_use draw_normals = {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                   VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const host_use draw_depth = {DEPTH_TESTS,
                                 VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT
                                     | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                                 VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
    host_barrier(commands, r->normals.image, VK_IMAGE_ASPECT_COLOR_BIT, read,
                 draw_normals);
    host_barrier(commands, r->depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, read, draw_depth);
    begin_rendering(commands, r->normals.view, r->depth.view, BUFFER_WIDTH,
                    BUFFER_HEIGHT);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, r->prepass);
    vkCmdPushConstants(commands, r->layout,
                       VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       sizeof *push, push);
    vkCmdBindVertexBuffers(commands, 0, 1, &r->vertices.buffer, &none);
    vkCmdDraw(commands, r->vertex_count, 1, 0, 0);
    vkCmdEndRendering(commands);
    /* Now Crevice and the light sample both. */
    host_barrier(commands, r->normals.image, VK_IMAGE_ASPECT_COLOR_BIT, draw_normals,
                 (host_use){READERS, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    host_barrier(commands, r->depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, draw_depth,
                 (host_use){READERS, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                            VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL});
}

static crv_status record_occlusion(renderer *r, VkCommandBuffer commands, int slot,
                                   const crv_camera *camera)
{
    crv_vulkan_frame f;
    crv_vulkan_frame_init(&f, sizeof f);
    f.index = slot;
    f.camera = *camera;
    f.depth_encoding.encoding = CRV_DEPTH_REVERSED;
    f.depth_encoding.z_near = NEAR_PLANE;
    f.depth_encoding.z_far = INFINITY;
    f.depth[0].view = r->depth.view;
    f.depth[0].layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
    f.normals.view = r->normals.view;
    f.result = r->occlusion.image;
    f.result_view = r->occlusion.view;
    return crv_vulkan_pass_record(r->pass, commands, &f);
}

static void record_light(renderer *r, VkCommandBuffer commands,
                         const push_constants *push)
{
    const host_use draw = {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                           VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                           VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const host_use copied = {VK_PIPELINE_STAGE_2_COPY_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED};
    const host_use copy = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const VkImage colour = r->colour.image;
    host_barrier(commands, colour, VK_IMAGE_ASPECT_COLOR_BIT, copied, draw);
    begin_rendering(commands, r->colour.view, VK_NULL_HANDLE, WIDTH, HEIGHT);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, r->light);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, r->layout, 0, 1,
                            &r->set, 0, NULL);
    vkCmdPushConstants(commands, r->layout,
                       VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       sizeof *push, push);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRendering(commands);
    host_barrier(commands, colour, VK_IMAGE_ASPECT_COLOR_BIT, draw, copy);
}

static void record_copy(renderer *r, VkCommandBuffer commands)
{
    const VkBufferImageCopy copy = {
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .imageExtent = {WIDTH, HEIGHT, 1}};
    const VkMemoryBarrier2 barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                      .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                      .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                      .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                      .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                   .memoryBarrierCount = 1,
                                   .pMemoryBarriers = &barrier};
    vkCmdCopyImageToBuffer(commands, r->colour.image,
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, r->readback.buffer, 1,
                           &copy);
    vkCmdPipelineBarrier2(commands, &info);
}

/* Waits only for the frame that had this slot before, so that two are in flight. */
static crv_status draw_frame(renderer *r, int number)
{
    frame *f = &r->frames[number % FRAMES_IN_FLIGHT];
    push_constants push;
    const crv_camera camera = look(number, &push);
    const VkDevice device = r->h.device;
    host_check(vkWaitForFences(device, 1, &f->done, VK_TRUE, UINT64_MAX), "wait");
    host_check(vkResetFences(device, 1, &f->done), "fence");
    host_check(vkResetCommandPool(device, f->pool, 0), "pool");
    const VkCommandBufferBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    host_check(vkBeginCommandBuffer(f->commands, &begin), "begin");
    record_prepass(r, f->commands, &push);
    const crv_status status =
        record_occlusion(r, f->commands, number % FRAMES_IN_FLIGHT, &camera);
    if (status)
        return status;
    record_light(r, f->commands, &push);
    if (number == FRAMES - 1)
        record_copy(r, f->commands);
    host_check(vkEndCommandBuffer(f->commands), "end");
    const VkCommandBufferSubmitInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
        .commandBuffer = f->commands};
    const VkSubmitInfo2 submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                                  .commandBufferInfoCount = 1,
                                  .pCommandBufferInfos = &commands};
    host_check(vkQueueSubmit2(r->h.queue, 1, &submit, f->done), "submit");
    return CRV_OK;
}

/* ---- the whole ---- */

static void print_times(renderer *r)
{
    crv_device_time times[CRV_MAX_DEVICE_TIMES];
    int32_t count = 0;
    if (crv_vulkan_pass_times(r->pass, (FRAMES - 1) % FRAMES_IN_FLIGHT, times, &count))
        return;
    for (int32_t i = 0; i < count; i++)
        printf("%-20s %8.3f ms\n", times[i].name, times[i].time_ms);
}

static int write_ppm(const char *path, const unsigned char *rgba)
{
    FILE *file = fopen(path, "wb");
    if (!file) {
        perror(path);
        return -1;
    }
    fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        fwrite(rgba + 4 * i, 1, 3, file);
    const int failed = ferror(file);
    if (fclose(file) != 0 || failed) {
        perror(path);
        return -1;
    }
    return 0;
}

static crv_status draw_all(renderer *r)
{
    make_images(r);
    make_vertices(r);
    make_descriptors(r);
    make_pipelines(r);
    make_frames(r);
    crv_status status = make_crevice(r);
    for (int i = 0; status == CRV_OK && i < FRAMES; i++)
        status = draw_frame(r, i);
    host_check(vkDeviceWaitIdle(r->h.device), "wait");
    return status;
}

int main(int argc, char **argv)
{
    const int validate = argc > 1 && strcmp(argv[1], "--validate") == 0;
    const char *path = argc > 1 + validate ? argv[1 + validate] : "vulkan_host.ppm";
    static renderer r;
    if (host_open(&r.h, validate) != 0) {
        fprintf(stderr, "no device with Vulkan 1.3%s\n",
                validate ? ", or no validation layer" : "");
        return 77;
    }
    const crv_status status = draw_all(&r);
    int failed = status != CRV_OK;
    if (failed) {
        fprintf(stderr, "%s\n", crv_status_string(status));
    } else {
        printf("on %s\n", r.h.properties.deviceName);
        print_times(&r);
        failed = write_ppm(path, r.readback.bytes) != 0;
    }
    renderer_free(&r);
    host_close(&r.h);
    return failed || r.h.complaints ? EXIT_FAILURE : EXIT_SUCCESS;
}

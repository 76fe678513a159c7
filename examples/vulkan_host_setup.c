/* SPDX-License-Identifier: MIT */
#include "vulkan_host_setup.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 32 };

void host_check(VkResult result, const char *what)
{
    if (result >= 0)
        return;
    fprintf(stderr, "%s: VkResult %d\n", what, (int)result);
    exit(EXIT_FAILURE);
}

/* ---- instance and device ---- */

static VKAPI_ATTR VkBool32 VKAPI_CALL
print_complaint(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                VkDebugUtilsMessageTypeFlagsEXT types,
                const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    host *h = user;
    (void)severity;
    (void)types;
    fprintf(stderr, "validation: %s\n", data->pMessage);
    h->complaints++;
    return VK_FALSE;
}

static int has_validation(void)
{
    VkLayerProperties layers[MOST];
    uint32_t count = MOST;
    vkEnumerateInstanceLayerProperties(&count, layers);
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(layers[i].layerName, "VK_LAYER_KHRONOS_validation") == 0)
            return 1;
    }
    return 0;
}

static int open_instance(host *h, int validate)
{
    static const char *const LAYER[] = {"VK_LAYER_KHRONOS_validation"};
    static const char *const EXTENSION[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    static const VkValidationFeatureEnableEXT CHECKS[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT
                           | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = print_complaint,
        .pUserData = h};
    const VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messenger, /* while the instance itself is made and destroyed */
        .enabledValidationFeatureCount = sizeof CHECKS / sizeof *CHECKS,
        .pEnabledValidationFeatures = CHECKS};
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .pApplicationName = "crevice host",
                                           .apiVersion = VK_API_VERSION_1_3};
    const uint32_t one = validate ? 1 : 0;
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                       .pNext = validate ? &features : NULL,
                                       .pApplicationInfo = &application,
                                       .enabledLayerCount = one,
                                       .ppEnabledLayerNames = LAYER,
                                       .enabledExtensionCount = one,
                                       .ppEnabledExtensionNames = EXTENSION};
    if (vkCreateInstance(&info, NULL, &h->instance) != VK_SUCCESS)
        return -1;
    if (!validate)
        return 0;
    const PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
            h->instance, "vkCreateDebugUtilsMessengerEXT");
    host_check(create(h->instance, &messenger, NULL, &h->messenger), "messenger");
    return 0;
}

/* A family with graphics and compute, of a device with Vulkan 1.3; 0 where there is one.
 */
static int choose_family(host *h, VkPhysicalDevice device)
{
    VkQueueFamilyProperties families[MOST];
    uint32_t count = MOST;
    const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    vkGetPhysicalDeviceProperties(device, &h->properties);
    if (h->properties.apiVersion < VK_API_VERSION_1_3)
        return -1;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families);
    for (h->family = 0; h->family < count; h->family++) {
        if ((families[h->family].queueFlags & both) == both)
            return 0;
    }
    return -1;
}

static int open_device(host *h)
{
    VkPhysicalDevice devices[MOST];
    uint32_t count = MOST, chosen = 0;
    if (vkEnumeratePhysicalDevices(h->instance, &count, devices) < 0)
        return -1;
    while (chosen < count && choose_family(h, devices[chosen]) != 0)
        chosen++;
    if (chosen == count)
        return -1;
    h->physical = devices[chosen];
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {.sType =
                                               VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = h->family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    /* Crevice needs synchronization2 and shaderStorageImageWriteWithoutFormat, and makes
     * use of shaderFloat16. */
    VkPhysicalDeviceVulkan12Features v12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 there = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &v12};
    vkGetPhysicalDeviceFeatures2(h->physical, &there);
    h->has_float16 = v12.shaderFloat16;
    v12 = (VkPhysicalDeviceVulkan12Features){.sType = v12.sType,
                                             .shaderFloat16 = h->has_float16};
    VkPhysicalDeviceVulkan13Features v13 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
        .pNext = &v12,
        .synchronization2 = VK_TRUE,
        .dynamicRendering = VK_TRUE};
    const VkPhysicalDeviceFeatures2 features = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
        .pNext = &v13,
        .features = {.shaderStorageImageWriteWithoutFormat = VK_TRUE}};
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &features,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue};
    host_check(vkCreateDevice(h->physical, &info, NULL, &h->device), "device");
    vkGetDeviceQueue(h->device, h->family, 0, &h->queue);
    return 0;
}

int host_open(host *h, int validate)
{
    *h = (host){0};
    if ((validate && !has_validation()) || open_instance(h, validate) != 0)
        return -1;
    if (open_device(h) == 0)
        return 0;
    host_close(h);
    return -1;
}

void host_close(host *h)
{
    vkDestroyDevice(h->device, NULL);
    if (h->messenger) {
        const PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                h->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(h->instance, h->messenger, NULL);
    }
    vkDestroyInstance(h->instance, NULL);
}

/* ---- memory ---- */

static VkDeviceMemory memory_make(const host *h, VkMemoryRequirements needs,
                                  VkMemoryPropertyFlags flags)
{
    VkPhysicalDeviceMemoryProperties heaps;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    vkGetPhysicalDeviceMemoryProperties(h->physical, &heaps);
    uint32_t type = 0;
    while (type < heaps.memoryTypeCount
           && (!(needs.memoryTypeBits >> type & 1)
               || (heaps.memoryTypes[type].propertyFlags & flags) != flags))
        type++;
    const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                       .allocationSize = needs.size,
                                       .memoryTypeIndex = type};
    host_check(vkAllocateMemory(h->device, &info, NULL, &memory), "memory");
    return memory;
}

static int is_depth(VkFormat format)
{
    return format >= VK_FORMAT_D16_UNORM && format <= VK_FORMAT_D32_SFLOAT_S8_UINT;
}

host_image host_image_make(const host *h, VkFormat format, int width, int height,
                           VkImageUsageFlags usage)
{
    return host_image_make_layers(h, format, width, height, 1, usage);
}

host_image host_image_make_layers(const host *h, VkFormat format, int width, int height,
                                  int layers, VkImageUsageFlags usage)
{
    host_image i = {0};
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = format,
                                    .extent = {(uint32_t)width, (uint32_t)height, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = (uint32_t)layers,
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .usage = usage};
    host_check(vkCreateImage(h->device, &info, NULL, &i.image), "image");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(h->device, i.image, &needs);
    i.memory = memory_make(h, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    host_check(vkBindImageMemory(h->device, i.image, i.memory, 0), "memory of an image");
    const VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = i.image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = format,
        .subresourceRange = {is_depth(format) ? VK_IMAGE_ASPECT_DEPTH_BIT
                                              : VK_IMAGE_ASPECT_COLOR_BIT,
                             0, 1, 0, 1}};
    host_check(vkCreateImageView(h->device, &view, NULL, &i.view), "view");
    return i;
}

void host_image_free(const host *h, host_image *i)
{
    vkDestroyImageView(h->device, i->view, NULL);
    vkDestroyImage(h->device, i->image, NULL);
    vkFreeMemory(h->device, i->memory, NULL);
    *i = (host_image){0};
}

host_buffer host_buffer_make(const host *h, size_t size, VkBufferUsageFlags usage)
{
    host_buffer b = {0};
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
    host_check(vkCreateBuffer(h->device, &info, NULL, &b.buffer), "buffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(h->device, b.buffer, &needs);
    b.memory = memory_make(h, needs,
                           VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT
                               | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    host_check(vkBindBufferMemory(h->device, b.buffer, b.memory, 0),
               "memory of a buffer");
    host_check(vkMapMemory(h->device, b.memory, 0, VK_WHOLE_SIZE, 0, &b.bytes), "map");
    return b;
}

void host_buffer_free(const host *h, host_buffer *b)
{
    vkDestroyBuffer(h->device, b->buffer, NULL);
    vkFreeMemory(h->device, b->memory, NULL);
    *b = (host_buffer){0};
}

/* ---- frames in flight ---- */

host_frame host_frame_make(const host *h)
{
    host_frame f = {0};
    const VkCommandPoolCreateInfo pool = {.sType =
                                              VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                          .queueFamilyIndex = h->family};
    host_check(vkCreateCommandPool(h->device, &pool, NULL, &f.pool), "pool");
    const VkCommandBufferAllocateInfo buffer = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = f.pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1};
    host_check(vkAllocateCommandBuffers(h->device, &buffer, &f.commands), "commands");
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                     .flags = VK_FENCE_CREATE_SIGNALED_BIT};
    host_check(vkCreateFence(h->device, &fence, NULL, &f.done), "fence");
    return f;
}

void host_frame_begin(const host *h, host_frame *f)
{
    const VkCommandBufferBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    host_check(vkResetFences(h->device, 1, &f->done), "fence");
    host_check(vkResetCommandPool(h->device, f->pool, 0), "pool");
    host_check(vkBeginCommandBuffer(f->commands, &begin), "begin");
}

void host_frame_submit(const host *h, host_frame *f)
{
    const VkCommandBufferSubmitInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
        .commandBuffer = f->commands};
    const VkSubmitInfo2 submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                                  .commandBufferInfoCount = 1,
                                  .pCommandBufferInfos = &commands};
    host_check(vkEndCommandBuffer(f->commands), "end");
    host_check(vkQueueSubmit2(h->queue, 1, &submit, f->done), "submit");
}

void host_frame_free(const host *h, host_frame *f)
{
    vkDestroyFence(h->device, f->done, NULL);
    vkDestroyCommandPool(h->device, f->pool, NULL);
    *f = (host_frame){0};
}

/* ---- drawing ---- */

static void make_layouts(const host *h, host_layout *l, uint32_t count,
                         uint32_t push_bytes)
{
    VkDescriptorSetLayoutBinding bindings[HOST_MOST_IMAGES];
    for (uint32_t i = 0; i < count; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT};
    const VkDescriptorSetLayoutCreateInfo sets = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = count,
        .pBindings = bindings};
    host_check(vkCreateDescriptorSetLayout(h->device, &sets, NULL, &l->sets), "layout");
    const VkPushConstantRange range = {.stageFlags = HOST_PUSH_STAGES,
                                       .size = push_bytes};
    const VkPipelineLayoutCreateInfo pipelines = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &l->sets,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &range};
    host_check(vkCreatePipelineLayout(h->device, &pipelines, NULL, &l->pipelines),
               "layout");
}

host_layout host_layout_make(const host *h, const VkImageView *views, uint32_t count,
                             uint32_t push_bytes)
{
    host_layout l = {0};
    const VkSamplerCreateInfo sampler = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count};
    const VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = 1,
        .poolSizeCount = 1,
        .pPoolSizes = &size};
    make_layouts(h, &l, count, push_bytes);
    host_check(vkCreateSampler(h->device, &sampler, NULL, &l.sampler), "sampler");
    host_check(vkCreateDescriptorPool(h->device, &pool, NULL, &l.pool), "pool");
    const VkDescriptorSetAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = l.pool,
        .descriptorSetCount = 1,
        .pSetLayouts = &l.sets};
    host_check(vkAllocateDescriptorSets(h->device, &info, &l.set), "set");
    for (uint32_t i = 0; i < count; i++) {
        const VkDescriptorImageInfo image = {l.sampler, views[i],
                                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        const VkWriteDescriptorSet write = {
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = l.set,
            .dstBinding = i,
            .descriptorCount = 1,
            .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            .pImageInfo = &image};
        vkUpdateDescriptorSets(h->device, 1, &write, 0, NULL);
    }
    return l;
}

void host_layout_free(const host *h, host_layout *l)
{
    vkDestroyDescriptorPool(h->device, l->pool, NULL);
    vkDestroySampler(h->device, l->sampler, NULL);
    vkDestroyPipelineLayout(h->device, l->pipelines, NULL);
    vkDestroyDescriptorSetLayout(h->device, l->sets, NULL);
    *l = (host_layout){0};
}

static VkPipelineShaderStageCreateInfo stage(const host *h, host_shader shader,
                                             VkShaderStageFlagBits which)
{
    VkPipelineShaderStageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = which,
        .pName = "main"};
    const VkShaderModuleCreateInfo module = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = shader.size_bytes,
        .pCode = shader.words};
    host_check(vkCreateShaderModule(h->device, &module, NULL, &info.module), "shader");
    return info;
}

VkPipeline host_pipeline_make(const host *h, VkPipelineLayout layout, host_shader vertex,
                              host_shader fragment, VkFormat colour_format,
                              VkFormat depth_format)
{
    const VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1};
    const VkPipelineRasterizationStateCreateInfo rasterisation = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .lineWidth = 1};
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = depth_format != VK_FORMAT_UNDEFINED,
        .depthWriteEnable = depth_format != VK_FORMAT_UNDEFINED,
        .depthCompareOp = VK_COMPARE_OP_GREATER};
    const VkPipelineColorBlendAttachmentState attachment = {.colorWriteMask = 0xf};
    const VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &attachment};
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = 2,
        .pDynamicStates = states};
    const VkPipelineRenderingCreateInfo rendering = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .colorAttachmentCount = 1,
        .pColorAttachmentFormats = &colour_format,
        .depthAttachmentFormat = depth_format};
    const VkPipelineShaderStageCreateInfo stages[] = {
        stage(h, vertex, VK_SHADER_STAGE_VERTEX_BIT),
        stage(h, fragment, VK_SHADER_STAGE_FRAGMENT_BIT)};
    const VkGraphicsPipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .pNext = &rendering,
        .stageCount = 2,
        .pStages = stages,
        .pVertexInputState = &input,
        .pInputAssemblyState = &assembly,
        .pViewportState = &viewport,
        .pRasterizationState = &rasterisation,
        .pMultisampleState = &samples,
        .pDepthStencilState = &depth,
        .pColorBlendState = &blend,
        .pDynamicState = &dynamic,
        .layout = layout};
    VkPipeline pipeline = VK_NULL_HANDLE;
    host_check(
        vkCreateGraphicsPipelines(h->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline),
        "pipeline");
    vkDestroyShaderModule(h->device, stages[0].module, NULL);
    vkDestroyShaderModule(h->device, stages[1].module, NULL);
    return pipeline;
}

void host_rendering_begin(VkCommandBuffer commands, VkImageView colour, VkImageView depth,
                          int width, int height)
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
        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRect2D area = {{0, 0}, {(uint32_t)width, (uint32_t)height}};
    const VkViewport viewport = {
        .width = (float)width, .height = (float)height, .maxDepth = 1};
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

void host_barrier(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                  host_use before, host_use after)
{
    const VkImageMemoryBarrier2 barrier = {.sType =
                                               VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                           .srcStageMask = before.stages,
                                           .srcAccessMask = before.access,
                                           .dstStageMask = after.stages,
                                           .dstAccessMask = after.access,
                                           .oldLayout = before.layout,
                                           .newLayout = after.layout,
                                           .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                           .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                           .image = image,
                                           .subresourceRange = {aspect, 0, 1, 0, 1}};
    const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                   .imageMemoryBarrierCount = 1,
                                   .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands, &info);
}

void host_readback(VkCommandBuffer commands, VkImage image, int layer, int width,
                   int height, const host_buffer *to)
{
    const VkBufferImageCopy copy = {
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, (uint32_t)layer, 1},
        .imageExtent = {(uint32_t)width, (uint32_t)height, 1}};
    const VkMemoryBarrier2 barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                      .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                      .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                      .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                      .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                   .memoryBarrierCount = 1,
                                   .pMemoryBarriers = &barrier};
    vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           to->buffer, 1, &copy);
    vkCmdPipelineBarrier2(commands, &info);
}

int host_write_ppm(const char *path, const host_buffer *rgba, int width, int height)
{
    const unsigned char *bytes = rgba->bytes;
    FILE *file = fopen(path, "wb");
    int failed = !file;
    if (file) {
        fprintf(file, "P6\n%d %d\n255\n", width, height);
        for (int i = 0; i < width * height; i++)
            fwrite(bytes + 4 * i, 1, 3, file);
        failed = ferror(file);
        failed |= fclose(file) != 0;
    }
    if (failed)
        perror(path);
    return failed;
}

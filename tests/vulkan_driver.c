/* SPDX-License-Identifier: MIT */
#include "vulkan_driver.h"

#include <string.h>

vulkan_driver driver;

/* Whether the call that begins fails. */
static int is_due(void)
{
    driver.calls++;
    return driver.calls == driver.due;
}

static VkResult done(VkResult result)
{
    driver.call = NULL;
    return result;
}

/* What the real driver makes of a call. */
#define REAL(name, arguments) (driver.call = #name, done(name arguments))

#define CREATES(F)                                                                       \
    F(CreateBuffer, VkBufferCreateInfo, VkBuffer)                                        \
    F(CreateImage, VkImageCreateInfo, VkImage)                                           \
    F(CreateImageView, VkImageViewCreateInfo, VkImageView)                               \
    F(CreateSampler, VkSamplerCreateInfo, VkSampler)                                     \
    F(CreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout) \
    F(CreateDescriptorPool, VkDescriptorPoolCreateInfo, VkDescriptorPool)                \
    F(CreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)                \
    F(CreateShaderModule, VkShaderModuleCreateInfo, VkShaderModule)                      \
    F(CreateCommandPool, VkCommandPoolCreateInfo, VkCommandPool)                         \
    F(CreateFence, VkFenceCreateInfo, VkFence)                                           \
    F(CreateQueryPool, VkQueryPoolCreateInfo, VkQueryPool)                               \
    F(AllocateMemory, VkMemoryAllocateInfo, VkDeviceMemory)

#define DEFINE(name, info_type, handle_type)                                             \
    static VKAPI_ATTR VkResult VKAPI_CALL fail_##name(                                   \
        VkDevice device, const info_type *info, const VkAllocationCallbacks *callbacks,  \
        handle_type *out)                                                                \
    {                                                                                    \
        const VkResult result =                                                          \
            is_due() ? driver.result : REAL(vk##name, (device, info, callbacks, out));   \
        driver.objects += result == VK_SUCCESS;                                          \
        return result;                                                                   \
    }
CREATES(DEFINE)
#undef DEFINE

#define DESTROYS(F)                                                                      \
    F(DestroyBuffer, VkBuffer)                                                           \
    F(DestroyImage, VkImage)                                                             \
    F(DestroyImageView, VkImageView)                                                     \
    F(DestroySampler, VkSampler)                                                         \
    F(DestroyDescriptorSetLayout, VkDescriptorSetLayout)                                 \
    F(DestroyDescriptorPool, VkDescriptorPool)                                           \
    F(DestroyPipelineLayout, VkPipelineLayout)                                           \
    F(DestroyShaderModule, VkShaderModule)                                               \
    F(DestroyCommandPool, VkCommandPool)                                                 \
    F(DestroyFence, VkFence)                                                             \
    F(DestroyQueryPool, VkQueryPool)                                                     \
    F(DestroyPipeline, VkPipeline)                                                       \
    F(FreeMemory, VkDeviceMemory)

#define DEFINE(name, handle_type)                                                        \
    static VKAPI_ATTR void VKAPI_CALL count_##name(                                      \
        VkDevice device, handle_type handle, const VkAllocationCallbacks *callbacks)     \
    {                                                                                    \
        driver.objects -= handle != VK_NULL_HANDLE;                                      \
        vk##name(device, handle, callbacks);                                             \
    }
DESTROYS(DEFINE)
#undef DEFINE

/* The others: parameters, and the same as arguments. */
#define OTHERS(F)                                                                        \
    F(AllocateDescriptorSets,                                                            \
      (VkDevice d, const VkDescriptorSetAllocateInfo *i, VkDescriptorSet *out),          \
      (d, i, out))                                                                       \
    F(AllocateCommandBuffers,                                                            \
      (VkDevice d, const VkCommandBufferAllocateInfo *i, VkCommandBuffer *out),          \
      (d, i, out))                                                                       \
    F(BindBufferMemory, (VkDevice d, VkBuffer b, VkDeviceMemory m, VkDeviceSize o),      \
      (d, b, m, o))                                                                      \
    F(BindImageMemory, (VkDevice d, VkImage b, VkDeviceMemory m, VkDeviceSize o),        \
      (d, b, m, o))                                                                      \
    F(MapMemory,                                                                         \
      (VkDevice d, VkDeviceMemory m, VkDeviceSize o, VkDeviceSize s, VkMemoryMapFlags f, \
       void **out),                                                                      \
      (d, m, o, s, f, out))                                                              \
    F(ResetCommandPool, (VkDevice d, VkCommandPool p, VkCommandPoolResetFlags f),        \
      (d, p, f))                                                                         \
    F(BeginCommandBuffer, (VkCommandBuffer c, const VkCommandBufferBeginInfo *i),        \
      (c, i))                                                                            \
    F(QueueSubmit2, (VkQueue q, uint32_t n, const VkSubmitInfo2 *s, VkFence f),          \
      (q, n, s, f))

#define DEFINE(name, parameters, arguments)                                              \
    static VKAPI_ATTR VkResult VKAPI_CALL fail_##name parameters                         \
    {                                                                                    \
        return is_due() ? driver.result : REAL(vk##name, arguments);                     \
    }
OTHERS(DEFINE)
#undef DEFINE

/* These do their work and then say that it failed: commands that are half recorded and
 * fences that are not waited for would be the test's own fault. */
#define AFTERWARDS(F)                                                                    \
    F(EndCommandBuffer, (VkCommandBuffer c), (c))                                        \
    F(WaitForFences, (VkDevice d, uint32_t n, const VkFence *f, VkBool32 a, uint64_t t), \
      (d, n, f, a, t))                                                                   \
    F(ResetFences, (VkDevice d, uint32_t n, const VkFence *f), (d, n, f))                \
    F(GetQueryPoolResults,                                                               \
      (VkDevice d, VkQueryPool p, uint32_t first, uint32_t n, size_t size, void *out,    \
       VkDeviceSize stride, VkQueryResultFlags f),                                       \
      (d, p, first, n, size, out, stride, f))

#define DEFINE(name, parameters, arguments)                                              \
    static VKAPI_ATTR VkResult VKAPI_CALL fail_##name parameters                         \
    {                                                                                    \
        const VkResult result = REAL(vk##name, arguments);                               \
        return is_due() ? driver.result : result;                                        \
    }
AFTERWARDS(DEFINE)
#undef DEFINE

/* With several pipelines, those that were made are to be given back. */
static VKAPI_ATTR VkResult VKAPI_CALL
fail_CreateComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                            const VkComputePipelineCreateInfo *infos,
                            const VkAllocationCallbacks *callbacks, VkPipeline *out)
{
    if (is_due()) {
        memset(out, 0, count * sizeof *out);
        return driver.result;
    }
    const VkResult result =
        REAL(vkCreateComputePipelines, (device, cache, count, infos, callbacks, out));
    for (uint32_t i = 0; i < count; i++)
        driver.objects += out[i] != VK_NULL_HANDLE;
    return result;
}

/* These have no result; the real one may need memory for them all the same. */
#define COMMANDS(F)                                                                      \
    F(CmdResetQueryPool, (VkCommandBuffer c, VkQueryPool p, uint32_t first, uint32_t n), \
      (c, p, first, n))                                                                  \
    F(CmdWriteTimestamp2,                                                                \
      (VkCommandBuffer c, VkPipelineStageFlags2 s, VkQueryPool p, uint32_t n),           \
      (c, s, p, n))                                                                      \
    F(CmdPipelineBarrier2, (VkCommandBuffer c, const VkDependencyInfo *i), (c, i))       \
    F(CmdBindPipeline, (VkCommandBuffer c, VkPipelineBindPoint b, VkPipeline p),         \
      (c, b, p))                                                                         \
    F(CmdBindDescriptorSets,                                                             \
      (VkCommandBuffer c, VkPipelineBindPoint b, VkPipelineLayout l, uint32_t first,     \
       uint32_t n, const VkDescriptorSet *s, uint32_t m, const uint32_t *o),             \
      (c, b, l, first, n, s, m, o))                                                      \
    F(CmdPushConstants,                                                                  \
      (VkCommandBuffer c, VkPipelineLayout l, VkShaderStageFlags f, uint32_t o,          \
       uint32_t n, const void *v),                                                       \
      (c, l, f, o, n, v))                                                                \
    F(CmdDispatch, (VkCommandBuffer c, uint32_t x, uint32_t y, uint32_t z),              \
      (c, x, y, z))                                                                      \
    F(CmdCopyBufferToImage,                                                              \
      (VkCommandBuffer c, VkBuffer b, VkImage i, VkImageLayout l, uint32_t n,            \
       const VkBufferImageCopy *r),                                                      \
      (c, b, i, l, n, r))                                                                \
    F(CmdCopyImageToBuffer,                                                              \
      (VkCommandBuffer c, VkImage i, VkImageLayout l, VkBuffer b, uint32_t n,            \
       const VkBufferImageCopy *r),                                                      \
      (c, i, l, b, n, r))

#define DEFINE(name, parameters, arguments)                                              \
    static VKAPI_ATTR void VKAPI_CALL tell_##name parameters                             \
    {                                                                                    \
        driver.call = "vk" #name;                                                        \
        vk##name arguments;                                                              \
        driver.call = NULL;                                                              \
    }
COMMANDS(DEFINE)
#undef DEFINE

/* One texel instead of 64 MiB: how fast memory is does not matter here, and would take
 * most of the time. */
static VKAPI_ATTR void VKAPI_CALL tell_CmdCopyImage(
    VkCommandBuffer commands, VkImage from, VkImageLayout from_layout, VkImage to,
    VkImageLayout to_layout, uint32_t count, const VkImageCopy *regions)
{
    VkImageCopy region = regions[0];
    region.extent = (VkExtent3D){1, 1, 1};
    (void)count;
    driver.call = "vkCmdCopyImage";
    vkCmdCopyImage(commands, from, from_layout, to, to_layout, 1, &region);
    driver.call = NULL;
}

typedef struct named {
    const char *name;
    PFN_vkVoidFunction function;
} named;

#define ROW(name, ...) {"vk" #name, (PFN_vkVoidFunction)fail_##name},
static const named FAILING[] = {CREATES(ROW) OTHERS(ROW) AFTERWARDS(ROW){
    "vkCreateComputePipelines", (PFN_vkVoidFunction)fail_CreateComputePipelines}};
#undef ROW

#define ROW(name, handle_type) {"vk" #name, (PFN_vkVoidFunction)count_##name},
#define TELL(name, ...)        {"vk" #name, (PFN_vkVoidFunction)tell_##name},
static const named OTHERWISE[] = {DESTROYS(ROW) COMMANDS(TELL) TELL(CmdCopyImage)};
#undef TELL
#undef ROW

enum { FAILING_FUNCTIONS = sizeof FAILING / sizeof *FAILING };

static PFN_vkVoidFunction find(const named *list, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++) {
        if (strcmp(list[i].name, name) == 0)
            return list[i].function;
    }
    return NULL;
}

static PFN_vkVoidFunction own(const char *name)
{
    const PFN_vkVoidFunction f = find(FAILING, FAILING_FUNCTIONS, name);
    return f ? f : find(OTHERWISE, sizeof OTHERWISE / sizeof *OTHERWISE, name);
}

int vulkan_driver_functions(void)
{
    return FAILING_FUNCTIONS;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device,
                                                                const char *name)
{
    const PFN_vkVoidFunction f = own(name);
    return f ? f : vkGetDeviceProcAddr(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vulkan_driver_get(VkInstance instance,
                                                           const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0)
        return (PFN_vkVoidFunction)device_function;
    const PFN_vkVoidFunction f = own(name);
    return f ? f : vkGetInstanceProcAddr(instance, name);
}

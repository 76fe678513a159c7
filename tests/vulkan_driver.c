/* SPDX-License-Identifier: MIT */
#include "vulkan_driver.h"

#include <string.h>

vulkan_driver driver;

static int is_due(void)
{
    driver.calls++;
    return driver.calls == driver.due;
}

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
            is_due() ? driver.result : vk##name(device, info, callbacks, out);           \
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
        return is_due() ? driver.result : vk##name arguments;                            \
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
        const VkResult result = vk##name arguments;                                      \
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
        vkCreateComputePipelines(device, cache, count, infos, callbacks, out);
    for (uint32_t i = 0; i < count; i++)
        driver.objects += out[i] != VK_NULL_HANDLE;
    return result;
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
static const named COUNTING[] = {DESTROYS(ROW)};
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
    return f ? f : find(COUNTING, sizeof COUNTING / sizeof *COUNTING, name);
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

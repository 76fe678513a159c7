/* SPDX-License-Identifier: MIT */
/* The Vulkan functions that Crevice calls, looked up for each context: nothing is linked
 * and nothing is global. */
#ifndef CRV_VULKAN_LOADER_H
#define CRV_VULKAN_LOADER_H

#include "base/log.h"

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan.h>

#define CRV__INSTANCE_FUNCTIONS(F)                                                       \
    F(DestroyInstance)                                                                   \
    F(EnumeratePhysicalDevices)                                                          \
    F(EnumerateDeviceExtensionProperties)                                                \
    F(GetPhysicalDeviceProperties)                                                       \
    F(GetPhysicalDeviceProperties2)                                                      \
    F(GetPhysicalDeviceFeatures2)                                                        \
    F(GetPhysicalDeviceMemoryProperties)                                                 \
    F(GetPhysicalDeviceQueueFamilyProperties)                                            \
    F(GetPhysicalDeviceFormatProperties)                                                 \
    F(CreateDevice)                                                                      \
    F(GetDeviceProcAddr)

#define CRV__DEVICE_FUNCTIONS(F)                                                         \
    F(DestroyDevice)                                                                     \
    F(GetDeviceQueue)                                                                    \
    F(QueueSubmit2)                                                                      \
    F(AllocateMemory)                                                                    \
    F(FreeMemory)                                                                        \
    F(MapMemory)                                                                         \
    F(CreateBuffer)                                                                      \
    F(DestroyBuffer)                                                                     \
    F(GetBufferMemoryRequirements)                                                       \
    F(BindBufferMemory)                                                                  \
    F(CreateImage)                                                                       \
    F(DestroyImage)                                                                      \
    F(GetImageMemoryRequirements)                                                        \
    F(BindImageMemory)                                                                   \
    F(CreateImageView)                                                                   \
    F(DestroyImageView)                                                                  \
    F(CreateSampler)                                                                     \
    F(DestroySampler)                                                                    \
    F(CreateDescriptorSetLayout)                                                         \
    F(DestroyDescriptorSetLayout)                                                        \
    F(CreateDescriptorPool)                                                              \
    F(DestroyDescriptorPool)                                                             \
    F(AllocateDescriptorSets)                                                            \
    F(UpdateDescriptorSets)                                                              \
    F(CreatePipelineLayout)                                                              \
    F(DestroyPipelineLayout)                                                             \
    F(CreateShaderModule)                                                                \
    F(DestroyShaderModule)                                                               \
    F(CreateComputePipelines)                                                            \
    F(DestroyPipeline)                                                                   \
    F(CreateCommandPool)                                                                 \
    F(DestroyCommandPool)                                                                \
    F(ResetCommandPool)                                                                  \
    F(AllocateCommandBuffers)                                                            \
    F(BeginCommandBuffer)                                                                \
    F(EndCommandBuffer)                                                                  \
    F(CreateFence)                                                                       \
    F(DestroyFence)                                                                      \
    F(ResetFences)                                                                       \
    F(WaitForFences)                                                                     \
    F(CreateQueryPool)                                                                   \
    F(DestroyQueryPool)                                                                  \
    F(GetQueryPoolResults)                                                               \
    F(CmdResetQueryPool)                                                                 \
    F(CmdWriteTimestamp2)                                                                \
    F(CmdPipelineBarrier2)                                                               \
    F(CmdBindPipeline)                                                                   \
    F(CmdBindDescriptorSets)                                                             \
    F(CmdPushConstants)                                                                  \
    F(CmdDispatch)                                                                       \
    F(CmdCopyBufferToImage)                                                              \
    F(CmdCopyImageToBuffer)

typedef struct crv__vk_table {
    PFN_vkGetInstanceProcAddr GetInstanceProcAddr;
    PFN_vkCreateInstance CreateInstance;
    PFN_vkEnumerateInstanceVersion EnumerateInstanceVersion;
    PFN_vkEnumerateInstanceExtensionProperties EnumerateInstanceExtensionProperties;
#define CRV__MEMBER(name) PFN_vk##name name;
    CRV__INSTANCE_FUNCTIONS(CRV__MEMBER)
    CRV__DEVICE_FUNCTIONS(CRV__MEMBER)
#undef CRV__MEMBER
} crv__vk_table;

/* Of VK_EXT_debug_utils; NULL unless the host has it. */
typedef struct crv__debug_table {
    PFN_vkSetDebugUtilsObjectNameEXT set_name;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label;
} crv__debug_table;

crv__debug_table crv__debug_load(const crv__vk_table *t, VkInstance instance);

/* The loader installed on this machine, for contexts that make their own device.
 * NULL: there is none. */
void *crv__loader_open(PFN_vkGetInstanceProcAddr *function);
void crv__loader_close(void *loader);

/* Each fails with UNSUPPORTED and a line that names the function that is missing. */
crv_status crv__table_load_global(crv__vk_table *t, PFN_vkGetInstanceProcAddr function,
                                  const crv_logger *logger);
crv_status crv__table_load_instance(crv__vk_table *t, VkInstance instance,
                                    const crv_logger *logger);
crv_status crv__table_load_device(crv__vk_table *t, VkDevice device,
                                  const crv_logger *logger);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * A Vulkan loader in front of the real one, whose devices are the least that there may
 * be: they are listed only to those who ask for portability, want that to be named, have
 * no feature but the two that Crevice needs, no timestamps, and no larger limits than
 * Vulkan 1.3 demands. What a device under VK_KHR_portability_subset need not do is
 * refused with a line. CREVICE_TEST_LACKS: they lack one of the two features as well.
 */
#include <dlfcn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan.h>

static const char ENUMERATION[] = "VK_KHR_portability_enumeration",
                  SUBSET[] = "VK_KHR_portability_subset";
enum { ENUMERATE_PORTABILITY = 1 }; /* the flag of the instance */
enum { MOST_IMAGES = 256 };

static PFN_vkGetInstanceProcAddr real_get;
static PFN_vkGetDeviceProcAddr real_get_device;
static VkInstance the_instance;
static VkDevice the_device;
static bool asked_for_portability;
static struct {
    VkImage image;
    VkFormat format;
} images[MOST_IMAGES];
static int image_count;

#define REAL(name)   ((PFN_##name)real_get(the_instance, #name))
#define DEVICE(name) ((PFN_##name)real_get_device(the_device, #name))

static VkResult refuse(VkResult result, const char *what)
{
    fprintf(stderr, "portable: %s\n", what);
    return result;
}

/* ---- extensions ---- */

static VkResult list_one(const char *name, uint32_t *count, VkExtensionProperties *out)
{
    const uint32_t room = out ? *count : 1;
    *count = room > 0 ? 1 : 0;
    if (out && room > 0) {
        *out = (VkExtensionProperties){.specVersion = 1};
        memcpy(out->extensionName, name, strlen(name) + 1);
    }
    return room > 0 ? VK_SUCCESS : VK_INCOMPLETE;
}

static VKAPI_ATTR VkResult VKAPI_CALL EnumerateInstanceExtensionProperties(
    const char *layer, uint32_t *count, VkExtensionProperties *out)
{
    (void)layer;
    return list_one(ENUMERATION, count, out);
}

static VKAPI_ATTR VkResult VKAPI_CALL
EnumerateDeviceExtensionProperties(VkPhysicalDevice device, const char *layer,
                                   uint32_t *count, VkExtensionProperties *out)
{
    (void)device;
    (void)layer;
    return list_one(SUBSET, count, out);
}

static bool is_only(const char *name, uint32_t count, const char *const *names)
{
    return count == 1 && strcmp(names[0], name) == 0;
}

/* ---- instances ---- */

static VKAPI_ATTR VkResult VKAPI_CALL
CreateInstance(const VkInstanceCreateInfo *info, const VkAllocationCallbacks *callbacks,
               VkInstance *out)
{
    VkInstanceCreateInfo plain = *info;
    asked_for_portability =
        is_only(ENUMERATION, info->enabledExtensionCount, info->ppEnabledExtensionNames)
        && info->flags == ENUMERATE_PORTABILITY;
    plain.flags = 0;
    plain.enabledExtensionCount = 0;
    const PFN_vkCreateInstance create =
        (PFN_vkCreateInstance)real_get(NULL, "vkCreateInstance");
    const VkResult result = create(&plain, callbacks, out);
    the_instance = result == VK_SUCCESS ? *out : NULL;
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL EnumeratePhysicalDevices(VkInstance instance,
                                                               uint32_t *count,
                                                               VkPhysicalDevice *out)
{
    if (asked_for_portability)
        return REAL(vkEnumeratePhysicalDevices)(instance, count, out);
    *count = 0;
    return refuse(VK_SUCCESS, "nobody has asked for such devices");
}

/* ---- what the devices have ---- */

static void bound(uint32_t *limit, uint32_t least)
{
    *limit = *limit < least ? *limit : least;
}

static void bound_limits(VkPhysicalDeviceLimits *l)
{
    static const uint32_t SIZE[3] = {128, 128, 64};
    bound(&l->maxImageDimension2D, 4096);
    bound(&l->maxImageArrayLayers, 256);
    bound(&l->maxUniformBufferRange, 16384);
    bound(&l->maxPushConstantsSize, 128);
    bound(&l->maxPerStageDescriptorSamplers, 16);
    bound(&l->maxPerStageDescriptorUniformBuffers, 12);
    bound(&l->maxPerStageDescriptorStorageBuffers, 4);
    bound(&l->maxPerStageDescriptorSampledImages, 16);
    bound(&l->maxPerStageDescriptorStorageImages, 4);
    bound(&l->maxComputeSharedMemorySize, 16384);
    bound(&l->maxComputeWorkGroupInvocations, 128);
    for (int i = 0; i < 3; i++) {
        bound(&l->maxComputeWorkGroupCount[i], 65535);
        bound(&l->maxComputeWorkGroupSize[i], SIZE[i]);
    }
}

static VKAPI_ATTR void VKAPI_CALL
GetPhysicalDeviceProperties(VkPhysicalDevice device, VkPhysicalDeviceProperties *out)
{
    REAL(vkGetPhysicalDeviceProperties)(device, out);
    bound_limits(&out->limits);
}

static VKAPI_ATTR void VKAPI_CALL
GetPhysicalDeviceProperties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2 *out)
{
    REAL(vkGetPhysicalDeviceProperties2)(device, out);
    bound_limits(&out->properties.limits);
}

static VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceQueueFamilyProperties(
    VkPhysicalDevice device, uint32_t *count, VkQueueFamilyProperties *out)
{
    REAL(vkGetPhysicalDeviceQueueFamilyProperties)(device, count, out);
    for (uint32_t i = 0; out && i < *count; i++)
        out[i].timestampValidBits = 0;
}

/* Takes all features out of a struct but one; `of`: where features begin in it. */
static void keep_only(void *features, size_t size, size_t of, VkBool32 *kept)
{
    const VkBool32 had = *kept;
    memset((char *)features + of, 0, size - of);
    *kept = had;
}

/* Takes all features out of the chain but those that Crevice needs. */
static void bound_features(VkPhysicalDeviceFeatures2 *f)
{
    VkPhysicalDeviceFeatures *core = &f->features;
    keep_only(core, sizeof *core, 0, &core->shaderStorageImageWriteWithoutFormat);
    if (getenv("CREVICE_TEST_LACKS"))
        core->shaderStorageImageWriteWithoutFormat = VK_FALSE;
    for (VkBaseOutStructure *s = f->pNext; s; s = s->pNext) {
        if (s->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES) {
            VkPhysicalDeviceVulkan12Features *v = (void *)s;
            memset(&v->samplerMirrorClampToEdge, 0,
                   sizeof *v
                       - offsetof(VkPhysicalDeviceVulkan12Features,
                                  samplerMirrorClampToEdge));
        } else if (s->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES) {
            VkPhysicalDeviceVulkan13Features *v = (void *)s;
            keep_only(v, sizeof *v,
                      offsetof(VkPhysicalDeviceVulkan13Features, robustImageAccess),
                      &v->synchronization2);
        }
    }
}

static VKAPI_ATTR void VKAPI_CALL
GetPhysicalDeviceFeatures2(VkPhysicalDevice device, VkPhysicalDeviceFeatures2 *out)
{
    REAL(vkGetPhysicalDeviceFeatures2)(device, out);
    bound_features(out);
}

/* ---- what may be made ---- */

/* Whether the chain enables nothing that the devices lack. Each struct has features from
 * `of` on; one of them may be there. */
static bool enables_only(const void *features, size_t size, size_t of, size_t allowed)
{
    for (size_t at = of; at < size; at += sizeof(VkBool32)) {
        VkBool32 enabled;
        memcpy(&enabled, (const char *)features + at, sizeof enabled);
        if (enabled && at != allowed)
            return false;
    }
    return true;
}

static bool enables_what_is_there(const VkDeviceCreateInfo *info)
{
    bool good = !info->pEnabledFeatures;
    for (const VkBaseInStructure *s = info->pNext; s; s = s->pNext) {
        if (s->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2)
            good = good
                   && enables_only(&((const VkPhysicalDeviceFeatures2 *)s)->features,
                                   sizeof(VkPhysicalDeviceFeatures), 0,
                                   offsetof(VkPhysicalDeviceFeatures,
                                            shaderStorageImageWriteWithoutFormat));
        else if (s->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES)
            good = good
                   && enables_only(s, sizeof(VkPhysicalDeviceVulkan12Features),
                                   offsetof(VkPhysicalDeviceVulkan12Features,
                                            samplerMirrorClampToEdge),
                                   0);
        else if (s->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES)
            good = good
                   && enables_only(
                       s, sizeof(VkPhysicalDeviceVulkan13Features),
                       offsetof(VkPhysicalDeviceVulkan13Features, robustImageAccess),
                       offsetof(VkPhysicalDeviceVulkan13Features, synchronization2));
        else
            good = false;
    }
    return good;
}

static VKAPI_ATTR VkResult VKAPI_CALL CreateDevice(VkPhysicalDevice physical,
                                                   const VkDeviceCreateInfo *info,
                                                   const VkAllocationCallbacks *callbacks,
                                                   VkDevice *out)
{
    if (!is_only(SUBSET, info->enabledExtensionCount, info->ppEnabledExtensionNames))
        return refuse(
            VK_ERROR_EXTENSION_NOT_PRESENT,
            "a device wants VK_KHR_portability_subset to be named, and no more");
    if (!enables_what_is_there(info))
        return refuse(VK_ERROR_FEATURE_NOT_PRESENT, "the device lacks a feature");
    VkDeviceCreateInfo plain = *info;
    plain.enabledExtensionCount = 0;
    const VkResult result = REAL(vkCreateDevice)(physical, &plain, callbacks, out);
    the_device = result == VK_SUCCESS ? *out : NULL;
    image_count = 0;
    fprintf(stderr, "portable: a device is made\n");
    return result;
}

/* multisampleArrayImage, imageViewFormatReinterpretation (no mutable formats). */
static VKAPI_ATTR VkResult VKAPI_CALL CreateImage(VkDevice device,
                                                  const VkImageCreateInfo *info,
                                                  const VkAllocationCallbacks *callbacks,
                                                  VkImage *out)
{
    if (info->samples != VK_SAMPLE_COUNT_1_BIT || info->flags
        || info->imageType != VK_IMAGE_TYPE_2D || info->extent.width > 4096
        || info->extent.height > 4096 || info->arrayLayers > 256)
        return refuse(VK_ERROR_FEATURE_NOT_PRESENT, "no such images");
    const VkResult result = DEVICE(vkCreateImage)(device, info, callbacks, out);
    if (result == VK_SUCCESS && image_count < MOST_IMAGES) {
        images[image_count].image = *out;
        images[image_count++].format = info->format;
    }
    return result;
}

static VkFormat format_of(VkImage image)
{
    for (int i = image_count - 1; i >= 0; i--) /* handles come again */
        if (images[i].image == image)
            return images[i].format;
    return VK_FORMAT_UNDEFINED;
}

/* imageViewFormatSwizzle, imageViewFormatReinterpretation, imageView2DOn3DImage. */
static VKAPI_ATTR VkResult VKAPI_CALL
CreateImageView(VkDevice device, const VkImageViewCreateInfo *info,
                const VkAllocationCallbacks *callbacks, VkImageView *out)
{
    const VkComponentMapping *c = &info->components;
    const bool plain = (!c->r || c->r == VK_COMPONENT_SWIZZLE_R)
                       && (!c->g || c->g == VK_COMPONENT_SWIZZLE_G)
                       && (!c->b || c->b == VK_COMPONENT_SWIZZLE_B)
                       && (!c->a || c->a == VK_COMPONENT_SWIZZLE_A);
    if (!plain || info->format != format_of(info->image))
        return refuse(VK_ERROR_FEATURE_NOT_PRESENT,
                      "views have the image's format and order");
    return DEVICE(vkCreateImageView)(device, info, callbacks, out);
}

/* samplerMipLodBias, mutableComparisonSamplers. */
static VKAPI_ATTR VkResult VKAPI_CALL
CreateSampler(VkDevice device, const VkSamplerCreateInfo *info,
              const VkAllocationCallbacks *callbacks, VkSampler *out)
{
    if (info->mipLodBias < 0 || info->mipLodBias > 0 || info->compareEnable
        || info->anisotropyEnable)
        return refuse(VK_ERROR_FEATURE_NOT_PRESENT, "no such samplers");
    return DEVICE(vkCreateSampler)(device, info, callbacks, out);
}

static VKAPI_ATTR VkResult VKAPI_CALL CreateDescriptorSetLayout(
    VkDevice device, const VkDescriptorSetLayoutCreateInfo *info,
    const VkAllocationCallbacks *callbacks, VkDescriptorSetLayout *out)
{
    uint32_t buffers = 0, stored = 0, sampled = 0;
    for (uint32_t i = 0; i < info->bindingCount; i++) {
        const VkDescriptorSetLayoutBinding *b = &info->pBindings[i];
        buffers += b->descriptorType == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        stored += b->descriptorType == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        sampled += b->descriptorType == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    }
    if (buffers > 4 || stored > 4 || sampled > 16)
        return refuse(VK_ERROR_TOO_MANY_OBJECTS, "too many descriptors of a kind");
    return DEVICE(vkCreateDescriptorSetLayout)(device, info, callbacks, out);
}

static VKAPI_ATTR VkResult VKAPI_CALL
CreatePipelineLayout(VkDevice device, const VkPipelineLayoutCreateInfo *info,
                     const VkAllocationCallbacks *callbacks, VkPipelineLayout *out)
{
    for (uint32_t i = 0; i < info->pushConstantRangeCount; i++)
        if (info->pPushConstantRanges[i].offset + info->pPushConstantRanges[i].size > 128)
            return refuse(VK_ERROR_TOO_MANY_OBJECTS, "too many push constants");
    return DEVICE(vkCreatePipelineLayout)(device, info, callbacks, out);
}

/* Invocations of a workgroup: constants 0 and 1 are its edges (pipelines.h). */
static int64_t invocations(const VkSpecializationInfo *info)
{
    int64_t product = 1;
    for (uint32_t i = 0; i < info->mapEntryCount; i++) {
        int32_t value;
        memcpy(&value, (const char *)info->pData + info->pMapEntries[i].offset,
               sizeof value);
        if (info->pMapEntries[i].constantID <= 1)
            product *= value;
    }
    return product;
}

static VKAPI_ATTR VkResult VKAPI_CALL
CreateComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                       const VkComputePipelineCreateInfo *infos,
                       const VkAllocationCallbacks *callbacks, VkPipeline *out)
{
    for (uint32_t i = 0; i < count; i++)
        if (invocations(infos[i].stage.pSpecializationInfo) > 128)
            return refuse(VK_ERROR_INITIALIZATION_FAILED, "a workgroup is too large");
    return DEVICE(vkCreateComputePipelines)(device, cache, count, infos, callbacks, out);
}

/* ---- the table ---- */

static PFN_vkVoidFunction own(const char *name)
{
#define ROW(name)                                                                        \
    {                                                                                    \
        "vk" #name, (PFN_vkVoidFunction)(name)                                           \
    }
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } FUNCTIONS[] = {
        ROW(EnumerateInstanceExtensionProperties),
        ROW(EnumerateDeviceExtensionProperties),
        ROW(CreateInstance),
        ROW(EnumeratePhysicalDevices),
        ROW(GetPhysicalDeviceProperties),
        ROW(GetPhysicalDeviceProperties2),
        ROW(GetPhysicalDeviceQueueFamilyProperties),
        ROW(GetPhysicalDeviceFeatures2),
        ROW(CreateDevice),
        ROW(CreateImage),
        ROW(CreateImageView),
        ROW(CreateSampler),
        ROW(CreateDescriptorSetLayout),
        ROW(CreatePipelineLayout),
        ROW(CreateComputePipelines),
    };
#undef ROW
    for (size_t i = 0; i < sizeof FUNCTIONS / sizeof *FUNCTIONS; i++)
        if (strcmp(FUNCTIONS[i].name, name) == 0)
            return FUNCTIONS[i].function;
    return NULL;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device(VkDevice device,
                                                           const char *name)
{
    const PFN_vkVoidFunction f = own(name);
    return f ? f : real_get_device(device, name);
}

/* All that this library exports. */
__attribute__((visibility("default"))) VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL
vkGetInstanceProcAddr(VkInstance instance, const char *name);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance,
                                                               const char *name)
{
    if (!real_get) {
        void *loader = dlopen(REAL_LOADER, RTLD_NOW | RTLD_LOCAL);
        void *symbol = loader ? dlsym(loader, "vkGetInstanceProcAddr") : NULL;
        memcpy(&real_get, &symbol, sizeof symbol);
        if (!real_get)
            return NULL;
    }
    if (strcmp(name, "vkGetDeviceProcAddr") == 0) {
        real_get_device =
            (PFN_vkGetDeviceProcAddr)real_get(instance, "vkGetDeviceProcAddr");
        return (PFN_vkVoidFunction)get_device;
    }
    const PFN_vkVoidFunction f = own(name);
    return f ? f : real_get(instance, name);
}

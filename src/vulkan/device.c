/* SPDX-License-Identifier: MIT */
#include "vulkan/pipelines.h"

#include "base/structs.h"

#include <stdio.h>
#include <string.h>

enum { MOST_DEVICES = 16, MOST_FAMILIES = 32, NO_FAMILY = -1 };

crv__device *crv__device_of(const crv_context *context)
{
    return context->device;
}

static const char *result_name(VkResult result)
{
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_OUT_OF_POOL_MEMORY:
        return "out of pool memory";
    case VK_ERROR_DEVICE_LOST:
        return "the device was lost; make a new context";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialisation failed";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "no driver; install one";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "a feature is not present";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "too many objects";
    case VK_TIMEOUT:
        return "it took too long";
    default:
        return "an error";
    }
}

crv_status crv__device_fail(const crv__device *d, VkResult result, const char *what)
{
    crv_status status = CRV_ERROR_DEVICE;
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY
        || result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_TOO_MANY_OBJECTS)
        status = CRV_ERROR_OUT_OF_MEMORY;
    return crv__fail(&d->logger, status, "vulkan: %s: %s (VkResult %d)", what,
                     result_name(result), (int)result);
}

void crv__device_name(const crv__device *d, VkObjectType type, uint64_t handle,
                      const char *name)
{
    char text[64];
    snprintf(text, sizeof text, "crevice %s", name);
    const VkDebugUtilsObjectNameInfoEXT info = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
        .objectType = type,
        .objectHandle = handle,
        .pObjectName = text};
    if (d->debug.set_name)
        d->debug.set_name(d->device, &info); /* a failure costs the name only */
}

/* ---- what a device must have ---- */

static int compute_family(const crv__device *d, VkPhysicalDevice physical)
{
    VkQueueFamilyProperties families[MOST_FAMILIES];
    uint32_t count = MOST_FAMILIES;
    d->vk.GetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    for (uint32_t i = 0; i < count; i++) {
        if (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT)
            return (int)i;
    }
    return NO_FAMILY;
}

/* Why the physical device cannot be used; "": it can. */
static const char *lacking(const crv__device *d, VkPhysicalDevice physical)
{
    VkPhysicalDeviceProperties properties;
    d->vk.GetPhysicalDeviceProperties(physical, &properties);
    if (properties.apiVersion < VK_API_VERSION_1_3)
        return "it has no Vulkan 1.3";
    VkPhysicalDeviceVulkan13Features v13 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceFeatures2 features = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &v13};
    d->vk.GetPhysicalDeviceFeatures2(physical, &features);
    if (!features.features.shaderStorageImageWriteWithoutFormat)
        return "it has no shaderStorageImageWriteWithoutFormat";
    if (!v13.synchronization2)
        return "it has no synchronization2";
    return compute_family(d, physical) == NO_FAMILY ? "it has no queue for compute" : "";
}

static bool can_half(const crv__device *d)
{
    VkPhysicalDeviceVulkan12Features v12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &v12};
    d->vk.GetPhysicalDeviceFeatures2(d->physical, &features);
    return v12.shaderFloat16 != VK_FALSE;
}

static void look_up_properties(crv__device *d)
{
    VkQueueFamilyProperties families[MOST_FAMILIES];
    uint32_t count = MOST_FAMILIES;
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    d->vk.GetPhysicalDeviceProperties2(d->physical, &properties);
    d->properties = properties.properties;
    d->is_lavapipe = driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE;
    d->vk.GetPhysicalDeviceMemoryProperties(d->physical, &d->heaps);
    d->vk.GetPhysicalDeviceQueueFamilyProperties(d->physical, &count, families);
    if (d->family < count)
        d->timestamp_bits = families[d->family].timestampValidBits;
}

/* ---- a device of one's own ---- */

/* Drivers that translate to other interfaces, as macOS has, are listed only to those who
 * ask for them by one extension, and want another to be named when a device is made. */
static const char *const ENUMERATION = "VK_KHR_portability_enumeration",
                         *const SUBSET = "VK_KHR_portability_subset";

/* VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR, which the first 1.3 headers lack. */
enum { ENUMERATE_PORTABILITY = 1 };

/* Whether the instance (physical: NULL) or the device has an extension. A failure costs
 * the extension only. */
static bool has_extension(const crv__device *d, VkPhysicalDevice physical,
                          const char *name)
{
    const crv__vk_table *vk = &d->vk;
    uint32_t count = 0;
    if (physical)
        vk->EnumerateDeviceExtensionProperties(physical, NULL, &count, NULL);
    else
        vk->EnumerateInstanceExtensionProperties(NULL, &count, NULL);
    const uint32_t room = count;
    VkExtensionProperties *all = crv__allocate(&d->allocator, room, sizeof *all);
    if (!all)
        return false;
    if (physical)
        vk->EnumerateDeviceExtensionProperties(physical, NULL, &count, all);
    else
        vk->EnumerateInstanceExtensionProperties(NULL, &count, all);
    bool found = false;
    for (uint32_t i = 0; i < count && i < room; i++)
        found = found || strcmp(all[i].extensionName, name) == 0;
    crv__release(&d->allocator, all, room, sizeof *all);
    return found;
}

static crv_status open_instance(crv__device *d)
{
    PFN_vkGetInstanceProcAddr function = NULL;
    d->loader = crv__loader_open(&function);
    if (!d->loader)
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "vulkan: there is no Vulkan loader on this machine; install it "
                         "(libvulkan1) and a driver, or use the CPU");
    crv_status status = crv__table_load_global(&d->vk, function, &d->logger);
    if (status)
        return status;
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .pApplicationName = "crevice",
                                           .apiVersion = VK_API_VERSION_1_3};
    const bool portable = has_extension(d, NULL, ENUMERATION);
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                       .flags = portable ? ENUMERATE_PORTABILITY : 0,
                                       .pApplicationInfo = &application,
                                       .enabledExtensionCount = portable ? 1 : 0,
                                       .ppEnabledExtensionNames = &ENUMERATION};
    const VkResult result = d->vk.CreateInstance(&info, d->callbacks, &d->instance);
    if (result)
        return crv__device_fail(d, result, "instance");
    d->owned = true;
    return crv__table_load_instance(&d->vk, d->instance, &d->logger);
}

/* INVALID_ARGUMENT, not logged, if there are fewer. */
static crv_status choose_physical(crv__device *d, int32_t index, uint32_t *count)
{
    VkPhysicalDevice devices[MOST_DEVICES];
    *count = MOST_DEVICES;
    const VkResult result = d->vk.EnumeratePhysicalDevices(d->instance, count, devices);
    if (result < 0)
        return crv__device_fail(d, result, "devices");
    if (index < 0 || (uint32_t)index >= *count)
        return CRV_ERROR_INVALID_ARGUMENT;
    d->physical = devices[index];
    return CRV_OK;
}

static crv_status open_device(crv__device *d)
{
    const float priority = 1;
    d->family = (uint32_t)compute_family(d, d->physical);
    const VkDeviceQueueCreateInfo queue = {.sType =
                                               VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = d->family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    d->has_half = can_half(d);
    VkPhysicalDeviceVulkan12Features v12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
        .shaderFloat16 = d->has_half ? VK_TRUE : VK_FALSE};
    VkPhysicalDeviceVulkan13Features v13 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
        .pNext = &v12,
        .synchronization2 = VK_TRUE};
    const VkPhysicalDeviceFeatures2 features = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
        .pNext = &v13,
        .features = {.shaderStorageImageWriteWithoutFormat = VK_TRUE}};
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &features,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue,
                                     .enabledExtensionCount =
                                         has_extension(d, d->physical, SUBSET) ? 1 : 0,
                                     .ppEnabledExtensionNames = &SUBSET};
    const VkResult result =
        d->vk.CreateDevice(d->physical, &info, d->callbacks, &d->device);
    if (result)
        return crv__device_fail(d, result, "device");
    const crv_status status = crv__table_load_device(&d->vk, d->device, &d->logger);
    if (status == CRV_OK)
        d->vk.GetDeviceQueue(d->device, d->family, 0, &d->queue);
    return status;
}

static crv_status open_own(crv__device *d, int32_t index)
{
    uint32_t count = 0;
    crv_status status = open_instance(d);
    if (status)
        return status;
    status = choose_physical(d, index, &count);
    if (status == CRV_ERROR_INVALID_ARGUMENT)
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "vulkan: no device %d; there are %u, counted from 0", index,
                         count);
    if (status)
        return status;
    const char *why = lacking(d, d->physical);
    if (why[0]) {
        VkPhysicalDeviceProperties properties;
        d->vk.GetPhysicalDeviceProperties(d->physical, &properties);
        return crv__fail(
            &d->logger, CRV_ERROR_UNSUPPORTED,
            "vulkan: %s cannot be used: %s; choose another device or the CPU",
            properties.deviceName, why);
    }
    status = open_device(d);
    if (status == CRV_OK)
        look_up_properties(d);
    return status;
}

/* ---- the host's device ---- */

static const crv__struct HOST = {.name = "vulkan host",
                                 .init = "crv_vulkan_host_init()",
                                 .first = CRV__SIZE_TO(crv_vulkan_host, memory),
                                 .size = sizeof(crv_vulkan_host)};

static crv_status check_host(const crv_logger *logger, const crv_vulkan_host *host)
{
    if (!host->instance || !host->physical_device || !host->device)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "vulkan: instance, physical_device and device must be set");
    if (!host->memory.allocate != !host->memory.release)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "vulkan: memory needs both functions or neither");
    if (!host->has_synchronization2 || !host->has_storage_image_write_without_format)
        return crv__fail(logger, CRV_ERROR_UNSUPPORTED,
                         "vulkan: make the device with the features synchronization2 and "
                         "shaderStorageImageWriteWithoutFormat, and say so in host");
    return CRV_OK;
}

static crv_status open_host(crv__device *d, const crv_vulkan_host *host)
{
    PFN_vkGetInstanceProcAddr function = host->get_instance_proc_addr;
    d->callbacks = host->callbacks;
    d->memory = host->memory;
    d->instance = host->instance;
    d->physical = host->physical_device;
    d->device = host->device;
    d->queue = host->queue;
    d->family = host->queue_family;
    d->cache = host->pipeline_cache;
    if (!function)
        d->loader = crv__loader_open(&function);
    if (!function)
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "vulkan: there is no Vulkan loader on this machine; set "
                         "host.get_instance_proc_addr");
    d->vk.GetInstanceProcAddr = function;
    crv_status status = crv__table_load_instance(&d->vk, d->instance, &d->logger);
    if (host->has_debug_utils)
        d->debug = crv__debug_load(&d->vk, d->instance);
    if (status == CRV_OK)
        status = crv__table_load_device(&d->vk, d->device, &d->logger);
    if (status)
        return status;
    const char *why = lacking(d, d->physical);
    look_up_properties(d);
    d->has_half = host->has_shader_float16 && can_half(d);
    if (why[0])
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "vulkan: %s cannot be used: %s", d->properties.deviceName, why);
    VkQueueFamilyProperties families[MOST_FAMILIES];
    uint32_t count = MOST_FAMILIES;
    d->vk.GetPhysicalDeviceQueueFamilyProperties(d->physical, &count, families);
    if (d->family >= count || !(families[d->family].queueFlags & VK_QUEUE_COMPUTE_BIT))
        return crv__fail(&d->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "vulkan: queue family %u has no compute; give one that has",
                         d->family);
    return CRV_OK;
}

/* ---- contexts ---- */

double crv__device_seconds(const crv__device *d, uint64_t from, uint64_t to)
{
    const uint64_t mask =
        d->timestamp_bits < 64 ? ((uint64_t)1 << d->timestamp_bits) - 1 : UINT64_MAX;
    return (double)((to - from) & mask) * (double)d->properties.limits.timestampPeriod
           * 1e-9;
}

void crv__device_destroy(crv__device *d)
{
    if (!d)
        return;
    crv__pipelines_close(d);
    if (d->owned && d->device)
        d->vk.DestroyDevice(d->device, d->callbacks);
    if (d->owned && d->vk.DestroyInstance)
        d->vk.DestroyInstance(d->instance, d->callbacks);
    crv__loader_close(d->loader);
    const crv_allocator allocator = d->allocator;
    crv__release(&allocator, d, 1, sizeof *d);
}

static crv__device *device_make(const crv_logger *logger, const crv_allocator *allocator)
{
    crv__device *d = crv__allocate(allocator, 1, sizeof *d);
    if (d) {
        d->logger = *logger;
        d->allocator = *allocator;
        d->plan_half = CRV_VULKAN_HALF_OFF;
    } else {
        crv__fail(logger, CRV_ERROR_OUT_OF_MEMORY, "vulkan: out of memory");
    }
    return d;
}

static crv_status adopt(crv_context *context, crv__device *d, crv_status status)
{
    if (status == CRV_OK)
        status = crv__pipelines_open(d);
    if (status) {
        crv__device_destroy(d);
        return status;
    }
    context->device = d;
    context->backend = &crv__vulkan_backend;
    crv__log(&context->logger, CRV_LOG_INFO, "vulkan: on %s", d->properties.deviceName);
    return CRV_OK;
}

crv_status crv__vulkan_open(crv_context *context, int32_t index)
{
    crv__device *d = device_make(&context->logger, &context->allocator);
    return d ? adopt(context, d, open_own(d, index)) : CRV_ERROR_OUT_OF_MEMORY;
}

crv_status crv_vulkan_host_init(crv_vulkan_host *host, size_t struct_size)
{
    const crv_vulkan_host defaults = {.struct_size = 0};
    return crv__struct_init(&HOST, host, struct_size, &defaults);
}

crv_status crv_vulkan_context_create(const crv_context_desc *desc,
                                     const crv_vulkan_host *host, crv_context **out)
{
    crv_context *context = NULL;
    crv_status status = crv__context_create_bare(desc, out ? &context : NULL);
    if (status)
        return status;
    crv_vulkan_host full = {.struct_size = 0};
    status = crv__struct_take(&HOST, &context->logger, host, &full);
    host = &full;
    if (status == CRV_OK)
        status = check_host(&context->logger, host);
    if (status == CRV_OK) {
        crv__device *d = device_make(&context->logger, &context->allocator);
        status = d ? adopt(context, d, open_host(d, host)) : CRV_ERROR_OUT_OF_MEMORY;
    }
    if (status)
        crv_context_destroy(context);
    else
        *out = context;
    return status;
}

crv_status crv_vulkan_context_set_plans(crv_context *context,
                                        crv_vulkan_depth_layout depth_layout,
                                        crv_vulkan_half half_filters)
{
    if (!context)
        return CRV_ERROR_INVALID_ARGUMENT;
    crv__device *d = crv__device_of(context);
    if (!d)
        return crv__fail(&context->logger, CRV_ERROR_UNSUPPORTED,
                         "vulkan: the context has no Vulkan device; make it with one");
    if (depth_layout < CRV_VULKAN_DEPTH_LINEAR || depth_layout > CRV_VULKAN_DEPTH_LEVELS
        || half_filters < CRV_VULKAN_HALF_AUTO || half_filters > CRV_VULKAN_HALF_ON)
        return crv__fail(&d->logger, CRV_ERROR_INVALID_ARGUMENT,
                         "vulkan: depth layout %d or half filters %d does not exist; use "
                         "crv_vulkan_depth_layout and crv_vulkan_half",
                         (int)depth_layout, (int)half_filters);
    d->plan_layout = depth_layout;
    d->plan_half = half_filters;
    return CRV_OK;
}

static void describe(const crv__device *d, crv_device_info *info)
{
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    d->vk.GetPhysicalDeviceProperties2(d->physical, &properties);
    const VkPhysicalDeviceProperties *p = &properties.properties;
    const uint32_t api = p->apiVersion;
    *info = (crv_device_info){.software = p->deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU};
    if (!driver.driverName[0]) /* before Vulkan 1.2 there is only a number */
        snprintf(driver.driverName, sizeof driver.driverName, "driver 0x%x",
                 p->driverVersion);
    snprintf(info->name, sizeof info->name, "%s", p->deviceName);
    snprintf(info->driver, sizeof info->driver, "%.100s%s%.100s, Vulkan %u.%u.%u",
             driver.driverName, driver.driverInfo[0] ? " " : "", driver.driverInfo,
             VK_API_VERSION_MAJOR(api), VK_API_VERSION_MINOR(api),
             VK_API_VERSION_PATCH(api));
}

crv_status crv_vulkan_device_info(int32_t index, crv_device_info *info,
                                  const crv_logger *logger)
{
    static const crv_logger SILENT;
    if (!info)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv_allocator allocator = crv__default_allocator();
    crv__device *d = device_make(logger ? logger : &SILENT, &allocator);
    if (!d)
        return CRV_ERROR_OUT_OF_MEMORY;
    uint32_t count = 0;
    crv_status status = open_instance(d);
    if (status == CRV_OK)
        status = choose_physical(d, index, &count);
    if (status == CRV_OK) {
        describe(d, info);
        snprintf(info->missing, sizeof info->missing, "%s", lacking(d, d->physical));
    }
    crv__device_destroy(d);
    return status;
}

/* SPDX-License-Identifier: MIT */
#include "vulkan/loader.h"

#include <string.h>
#if defined(_WIN32)
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#if defined(_WIN32)
void *crv__loader_open(PFN_vkGetInstanceProcAddr *function)
{
    const HMODULE module = LoadLibraryA("vulkan-1.dll");
    if (module)
        *function =
            (PFN_vkGetInstanceProcAddr)GetProcAddress(module, "vkGetInstanceProcAddr");
    return module;
}

void crv__loader_close(void *loader)
{
    if (loader)
        FreeLibrary(loader);
}
#else
void *crv__loader_open(PFN_vkGetInstanceProcAddr *function)
{
    static const char *const NAMES[] = {
#if defined(__APPLE__)
        "libvulkan.1.dylib", /* on the loader's own path, then where Homebrew puts it */
        "/opt/homebrew/lib/libvulkan.1.dylib",
        "/usr/local/lib/libvulkan.1.dylib",
        "libMoltenVK.dylib",
        "/opt/homebrew/lib/libMoltenVK.dylib",
        "/usr/local/lib/libMoltenVK.dylib"
#else
        "libvulkan.so.1",
        "libvulkan.so"
#endif
    };
    for (size_t i = 0; i < sizeof NAMES / sizeof NAMES[0]; i++) {
        void *loader = dlopen(NAMES[i], RTLD_NOW | RTLD_LOCAL);
        void *symbol = loader ? dlsym(loader, "vkGetInstanceProcAddr") : NULL;
        if (symbol) {
            memcpy(function, &symbol, sizeof symbol); /* POSIX: they have one size */
            return loader;
        }
        if (loader)
            dlclose(loader);
    }
    return NULL;
}

void crv__loader_close(void *loader)
{
    if (loader)
        dlclose(loader);
}
#endif

static crv_status missing(const crv_logger *logger, const char *name)
{
    return crv__fail(logger, CRV_ERROR_UNSUPPORTED,
                     "vulkan: there is no vk%s; Crevice needs Vulkan 1.3, update the "
                     "driver and the loader",
                     name);
}

crv_status crv__table_load_global(crv__vk_table *t, PFN_vkGetInstanceProcAddr function,
                                  const crv_logger *logger)
{
    t->GetInstanceProcAddr = function;
    t->CreateInstance = (PFN_vkCreateInstance)function(NULL, "vkCreateInstance");
    t->EnumerateInstanceVersion =
        (PFN_vkEnumerateInstanceVersion)function(NULL, "vkEnumerateInstanceVersion");
    t->EnumerateInstanceExtensionProperties =
        (PFN_vkEnumerateInstanceExtensionProperties)function(
            NULL, "vkEnumerateInstanceExtensionProperties");
    if (!t->CreateInstance)
        return missing(logger, "CreateInstance");
    if (!t->EnumerateInstanceExtensionProperties)
        return missing(logger, "EnumerateInstanceExtensionProperties");
    return t->EnumerateInstanceVersion ? CRV_OK
                                       : missing(logger, "EnumerateInstanceVersion");
}

crv_status crv__table_load_instance(crv__vk_table *t, VkInstance instance,
                                    const crv_logger *logger)
{
#define LOAD(name)                                                                       \
    t->name = (PFN_vk##name)t->GetInstanceProcAddr(instance, "vk" #name);                \
    if (!t->name)                                                                        \
        return missing(logger, #name);
    CRV__INSTANCE_FUNCTIONS(LOAD)
#undef LOAD
    return CRV_OK;
}

crv_status crv__table_load_device(crv__vk_table *t, VkDevice device,
                                  const crv_logger *logger)
{
#define LOAD(name)                                                                       \
    t->name = (PFN_vk##name)t->GetDeviceProcAddr(device, "vk" #name);                    \
    if (!t->name)                                                                        \
        return missing(logger, #name);
    CRV__DEVICE_FUNCTIONS(LOAD)
#undef LOAD
    return CRV_OK;
}

crv__debug_table crv__debug_load(const crv__vk_table *t, VkInstance instance)
{
    return (crv__debug_table){
        .set_name = (PFN_vkSetDebugUtilsObjectNameEXT)t->GetInstanceProcAddr(
            instance, "vkSetDebugUtilsObjectNameEXT"),
        .begin_label = (PFN_vkCmdBeginDebugUtilsLabelEXT)t->GetInstanceProcAddr(
            instance, "vkCmdBeginDebugUtilsLabelEXT"),
        .end_label = (PFN_vkCmdEndDebugUtilsLabelEXT)t->GetInstanceProcAddr(
            instance, "vkCmdEndDebugUtilsLabelEXT")};
}

/* SPDX-License-Identifier: MIT */
/* vulkan_driver.h: a driver that fails when it is told to. It stands between Crevice and
 * the real one, as functions that a host gives instead of the loader's. */
#ifndef TESTS_VULKAN_DRIVER_H
#define TESTS_VULKAN_DRIVER_H

#include <vulkan/vulkan.h>

typedef struct vulkan_driver {
    int calls; /* that may fail, so far */
    int due;   /* the call that fails, from 1; 0: none */
    VkResult result;
    int objects;      /* that were made and not destroyed */
    const char *call; /* that the real driver is at; NULL: none that takes memory */
} vulkan_driver;

/* Of the process: functions of Vulkan know of no user pointer. */
extern vulkan_driver driver;

/* How many functions may fail. */
int vulkan_driver_functions(void);

/* crv_vulkan_host.get_instance_proc_addr. */
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vulkan_driver_get(VkInstance instance,
                                                           const char *name);

#endif

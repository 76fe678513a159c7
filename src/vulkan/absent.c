/* SPDX-License-Identifier: MIT */
/* What stands in for the Vulkan backend if the library is built without it. */
#include "core/backend.h"

static crv_status absent(const crv_logger *logger)
{
    return crv__fail(
        logger, CRV_ERROR_UNSUPPORTED,
        "vulkan: this library was built without it; build with "
        "CREVICE_VULKAN=ON (needs Vulkan's headers and glslangValidator), or "
        "use the CPU");
}

static crv_status open_nothing(crv_context *context, int32_t index)
{
    (void)index;
    return absent(&context->logger);
}

extern const crv__backend crv__vulkan_backend;
const crv__backend crv__vulkan_backend = {
    .name = "vulkan", .device = CRV_DEVICE_VULKAN, .open = open_nothing};

crv_status crv_vulkan_device_info(int32_t index, crv_device_info *info,
                                  const crv_logger *logger)
{
    (void)index;
    return info ? absent(logger) : CRV_ERROR_INVALID_ARGUMENT;
}

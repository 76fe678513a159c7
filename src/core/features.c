/* SPDX-License-Identifier: MIT */
#include "core/backend.h"

#include "base/parallel.h"

uint32_t crv_features(void)
{
    uint32_t features = crv__parallel_is_openmp() ? CRV_FEATURE_OPENMP : 0;
    for (const crv__backend *const *b = crv__backends; *b; b++)
        features |= (*b)->device == CRV_DEVICE_VULKAN && (*b)->run
                        ? (uint32_t)CRV_FEATURE_VULKAN
                        : 0;
    return features;
}

size_t crv_struct_size(crv_struct which)
{
    switch (which) {
    case CRV_STRUCT_CAMERA:
        return sizeof(crv_camera);
    case CRV_STRUCT_CONST_IMAGE:
        return sizeof(crv_const_image);
    case CRV_STRUCT_CONTEXT_DESC:
        return sizeof(crv_context_desc);
    case CRV_STRUCT_DEPTH_FORMAT:
        return sizeof(crv_depth_format);
    case CRV_STRUCT_GBUFFER_DESC:
        return sizeof(crv_gbuffer_desc);
    case CRV_STRUCT_IMAGE:
        return sizeof(crv_image);
    case CRV_STRUCT_OPTIONS:
        return sizeof(crv_options);
    case CRV_STRUCT_RESULT:
        return sizeof(crv_result);
    }
    return 0;
}

/* SPDX-License-Identifier: MIT */
/* The host's images that a pass takes: formats, encodings and layouts (vulkan.h lists
 * them). */
#ifndef CRV_VULKAN_FORMATS_H
#define CRV_VULKAN_FORMATS_H

#include "vulkan/device.h"

/* Whether optimal images of the format have all of these features. */
bool crv__format_has(const crv__device *d, VkFormat format,
                     VkFormatFeatureFlags features);

/* Whether bent normals are two octahedral numbers in such an image, not x, y, z. */
bool crv__format_is_octahedral(VkFormat format);

/* INVALID_ARGUMENT if normals are not stored like that in such a format, UNSUPPORTED if a
 * format is not listed or the device lacks it. Each logs its line. */
crv_status crv__formats_check(const crv__device *d, const crv_vulkan_pass_desc *desc);

/* INVALID_ARGUMENT with a line if a view is missing, or a layout can never be right.
 */
crv_status crv__layouts_check(const crv_logger *logger, const crv_vulkan_pass_desc *desc,
                              int32_t layers, const crv_vulkan_frame *frame);

#endif

/* SPDX-License-Identifier: MIT */
#include "vulkan/formats.h"

#include <stdio.h>

/* ---- formats ---- */

typedef enum format_kind {
    KIND_DEPTH,
    KIND_FLOAT,
    KIND_SIGNED,
    KIND_UNSIGNED
} format_kind;

enum { FOR_DEPTH = 1, FOR_NORMALS = 2, FOR_RESULTS = 4, FOR_BENT = 8, FOR_ALL = 15 };

typedef struct format_row {
    VkFormat format;
    const char *name;
    format_kind kind;
    int components, uses;
} format_row;

/* All that vulkan.h lists. */
#define ROW(format, kind, components, uses)                                              \
    {VK_FORMAT_##format, #format, kind, components, uses},
static const format_row FORMATS[] = {
    /* clang-format off */
    ROW(D16_UNORM, KIND_DEPTH, 1, FOR_DEPTH)
    ROW(X8_D24_UNORM_PACK32, KIND_DEPTH, 1, FOR_DEPTH)
    ROW(D32_SFLOAT, KIND_DEPTH, 1, FOR_DEPTH)
    ROW(D16_UNORM_S8_UINT, KIND_DEPTH, 1, FOR_DEPTH)
    ROW(D24_UNORM_S8_UINT, KIND_DEPTH, 1, FOR_DEPTH)
    ROW(D32_SFLOAT_S8_UINT, KIND_DEPTH, 1, FOR_DEPTH)
    ROW(R16_UNORM, KIND_UNSIGNED, 1, FOR_DEPTH | FOR_RESULTS)
    ROW(R16_SFLOAT, KIND_FLOAT, 1, FOR_DEPTH | FOR_RESULTS)
    ROW(R32_SFLOAT, KIND_FLOAT, 1, FOR_DEPTH | FOR_RESULTS)
    ROW(R16G16_SFLOAT, KIND_FLOAT, 2, FOR_ALL)
    ROW(R32G32_SFLOAT, KIND_FLOAT, 2, FOR_DEPTH | FOR_NORMALS | FOR_RESULTS)
    ROW(R16G16B16A16_SFLOAT, KIND_FLOAT, 4, FOR_ALL)
    ROW(R32G32B32A32_SFLOAT, KIND_FLOAT, 4, FOR_ALL)
    ROW(R8G8_SNORM, KIND_SIGNED, 2, FOR_NORMALS)
    ROW(R16G16_SNORM, KIND_SIGNED, 2, FOR_NORMALS | FOR_BENT)
    ROW(R8G8B8A8_SNORM, KIND_SIGNED, 4, FOR_NORMALS)
    ROW(A8B8G8R8_SNORM_PACK32, KIND_SIGNED, 4, FOR_NORMALS)
    ROW(A2B10G10R10_SNORM_PACK32, KIND_SIGNED, 4, FOR_NORMALS)
    ROW(R16G16B16A16_SNORM, KIND_SIGNED, 4, FOR_NORMALS)
    ROW(R8_UNORM, KIND_UNSIGNED, 1, FOR_RESULTS)
    ROW(R8G8_UNORM, KIND_UNSIGNED, 2, FOR_NORMALS | FOR_RESULTS)
    ROW(R16G16_UNORM, KIND_UNSIGNED, 2, FOR_NORMALS | FOR_RESULTS)
    ROW(R8G8B8A8_UNORM, KIND_UNSIGNED, 4, FOR_NORMALS | FOR_RESULTS)
    ROW(B8G8R8A8_UNORM, KIND_UNSIGNED, 4, FOR_NORMALS | FOR_RESULTS)
    ROW(A8B8G8R8_UNORM_PACK32, KIND_UNSIGNED, 4, FOR_NORMALS | FOR_RESULTS)
    ROW(A2R10G10B10_UNORM_PACK32, KIND_UNSIGNED, 4, FOR_NORMALS | FOR_RESULTS)
    ROW(A2B10G10R10_UNORM_PACK32, KIND_UNSIGNED, 4, FOR_NORMALS | FOR_RESULTS)
    ROW(B10G11R11_UFLOAT_PACK32, KIND_UNSIGNED, 3, FOR_NORMALS | FOR_RESULTS)
    ROW(R16G16B16A16_UNORM, KIND_UNSIGNED, 4, FOR_NORMALS | FOR_RESULTS)
    /* clang-format on */
};
#undef ROW

static const format_row *row_of(VkFormat format)
{
    for (size_t i = 0; i < sizeof FORMATS / sizeof *FORMATS; i++) {
        if (FORMATS[i].format == format)
            return &FORMATS[i];
    }
    return NULL;
}

bool crv__format_has(const crv__device *d, VkFormat format, VkFormatFeatureFlags features)
{
    VkFormatProperties properties;
    d->vk.GetPhysicalDeviceFormatProperties(d->physical, format, &properties);
    return (properties.optimalTilingFeatures & features) == features;
}

/* Whether a format is listed for a use and the device has what it takes. `instead` is
 * what every device has. */
static crv_status check_format(const crv__device *d, VkFormat format, int use,
                               const char *what, const char *instead)
{
    const bool stored = use == FOR_RESULTS || use == FOR_BENT;
    const format_row *row = row_of(format);
    if (!row || !(row->uses & use))
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "pass: %s_format is VkFormat %d, which is none of those that "
                         "crevice/vulkan.h lists for it; give %s",
                         what, (int)format, instead);
    if (!crv__format_has(d, format,
                         stored ? VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT
                                : VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "pass: %s %s %s, the %s_format; give %s, as every device does",
                         d->properties.deviceName,
                         stored ? "has no storage images of" : "does not sample",
                         row->name, what, instead);
    return CRV_OK;
}

static crv_status check_normals(const crv_logger *logger,
                                const crv_vulkan_pass_desc *desc)
{
    const format_row *row = row_of(desc->normal_format);
    const bool flat = desc->normals == CRV_VULKAN_NORMALS_OCT
                      || desc->normals == CRV_VULKAN_NORMALS_OCT_HALVED;
    const bool halved = desc->normals == CRV_VULKAN_NORMALS_XYZ_HALVED
                        || desc->normals == CRV_VULKAN_NORMALS_OCT_HALVED;
    if (!flat && row->components < 3)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: normal_format %s has no z; set normals to "
                         "CRV_VULKAN_NORMALS_OCT%s, or give three components",
                         row->name, halved ? "_HALVED" : "");
    if (!halved && row->kind == KIND_UNSIGNED)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: normal_format %s cannot hold what is negative; set "
                         "normals to CRV_VULKAN_NORMALS_%s_HALVED if it holds n * 0.5 + "
                         "0.5",
                         row->name, flat ? "OCT" : "XYZ");
    if (halved && row->kind == KIND_SIGNED)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: normal_format %s has a sign of its own; set normals to "
                         "CRV_VULKAN_NORMALS_%s, and store them as they are",
                         row->name, flat ? "OCT" : "XYZ");
    return CRV_OK;
}

crv_status crv__formats_check(const crv__device *d, const crv_vulkan_pass_desc *desc)
{
    crv_status status =
        check_format(d, desc->depth_format, FOR_DEPTH, "depth", "R32_SFLOAT");
    if (status == CRV_OK && desc->normals)
        status = check_format(d, desc->normal_format, FOR_NORMALS, "normal",
                              "R16G16B16A16_SFLOAT");
    if (status == CRV_OK && desc->normals)
        status = check_normals(&d->logger, desc);
    if (status == CRV_OK)
        status =
            check_format(d, desc->result_format, FOR_RESULTS, "result", "R32_SFLOAT");
    if (status == CRV_OK && desc->bent_normal_format)
        status = check_format(d, desc->bent_normal_format, FOR_BENT, "bent_normal",
                              "R16G16B16A16_SFLOAT");
    return status;
}

/* ---- layouts ---- */

/* Which images shaders sample in a layout. */
enum { OF_NOTHING, OF_COLOUR_AND_DEPTH, OF_DEPTH };

typedef struct layout_row {
    VkImageLayout layout;
    const char *name;
    int sampled; /* one of the above */
    bool colour; /* an image of colours can be left in it */
} layout_row;

/* Of Vulkan 1.3; of extensions those that hosts confuse with them. */
#define ROW(layout, sampled, colour) {VK_IMAGE_LAYOUT_##layout, #layout, sampled, colour},
static const layout_row LAYOUTS[] = {
    /* clang-format off */
    ROW(UNDEFINED, OF_NOTHING, 0)
    ROW(GENERAL, OF_COLOUR_AND_DEPTH, 1)
    ROW(COLOR_ATTACHMENT_OPTIMAL, OF_NOTHING, 1)
    ROW(DEPTH_STENCIL_ATTACHMENT_OPTIMAL, OF_NOTHING, 0)
    ROW(DEPTH_STENCIL_READ_ONLY_OPTIMAL, OF_DEPTH, 0)
    ROW(SHADER_READ_ONLY_OPTIMAL, OF_COLOUR_AND_DEPTH, 1)
    ROW(TRANSFER_SRC_OPTIMAL, OF_NOTHING, 1)
    ROW(TRANSFER_DST_OPTIMAL, OF_NOTHING, 1)
    ROW(PREINITIALIZED, OF_NOTHING, 0)
    ROW(DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL, OF_DEPTH, 0)
    ROW(DEPTH_ATTACHMENT_STENCIL_READ_ONLY_OPTIMAL, OF_NOTHING, 0)
    ROW(DEPTH_ATTACHMENT_OPTIMAL, OF_NOTHING, 0)
    ROW(DEPTH_READ_ONLY_OPTIMAL, OF_DEPTH, 0)
    ROW(STENCIL_ATTACHMENT_OPTIMAL, OF_NOTHING, 0)
    ROW(STENCIL_READ_ONLY_OPTIMAL, OF_NOTHING, 0)
    ROW(READ_ONLY_OPTIMAL, OF_COLOUR_AND_DEPTH, 1)
    ROW(ATTACHMENT_OPTIMAL, OF_NOTHING, 1)
    ROW(PRESENT_SRC_KHR, OF_NOTHING, 1)
    ROW(SHARED_PRESENT_KHR, OF_NOTHING, 1)
    /* clang-format on */
};
#undef ROW

static const layout_row *layout_of(VkImageLayout layout)
{
    for (size_t i = 0; i < sizeof LAYOUTS / sizeof *LAYOUTS; i++) {
        if (LAYOUTS[i].layout == layout)
            return &LAYOUTS[i];
    }
    return NULL;
}

/* The layout's name, or its number in `number`. */
static const char *layout_name(VkImageLayout layout, char number[32])
{
    const layout_row *row = layout_of(layout);
    snprintf(number, 32, "%d", (int)layout);
    return row ? row->name : number;
}

static crv_status check_input(const crv_logger *logger, const crv_vulkan_input *input,
                              const char *what, VkFormat format)
{
    char number[32];
    const layout_row *row = layout_of(input->layout);
    const bool is_depth = row_of(format)->kind == KIND_DEPTH;
    if (!input->view)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: %s: there is no view; give one", what);
    if (!row || row->sampled == OF_NOTHING)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: %s: shaders cannot read from the layout %s; take the "
                         "image to SHADER_READ_ONLY_OPTIMAL and say so",
                         what, layout_name(input->layout, number));
    if (row->sampled == OF_DEPTH && !is_depth)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: %s: the layout %s is for depth formats, not for %s; use "
                         "SHADER_READ_ONLY_OPTIMAL",
                         what, row->name, row_of(format)->name);
    return CRV_OK;
}

crv_status crv__layouts_check(const crv_logger *logger, const crv_vulkan_pass_desc *desc,
                              int32_t layers, const crv_vulkan_frame *frame)
{
    char what[32];
    crv_status status = CRV_OK;
    for (int32_t i = 0; status == CRV_OK && i < layers; i++) {
        snprintf(what, sizeof what, "depth layer %d", i);
        status = check_input(logger, &frame->depth[i], what, desc->depth_format);
    }
    if (status == CRV_OK && desc->normals)
        status = check_input(logger, &frame->normals, "normals", desc->normal_format);
    if (status)
        return status;
    const layout_row *row = layout_of(frame->result_layout);
    if (row && !row->colour)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "pass: the result cannot be left in the layout %s; give the one "
                         "that it is read in, such as SHADER_READ_ONLY_OPTIMAL",
                         row->name);
    return CRV_OK;
}

bool crv__format_is_octahedral(VkFormat format)
{
    return row_of(format) && row_of(format)->components == 2;
}

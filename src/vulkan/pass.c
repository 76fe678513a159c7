/* SPDX-License-Identifier: MIT */
#include "vulkan/pass.h"

#include "vulkan/formats.h"

/* The smallest format that keeps the error far below what can be seen, if the device has
 * it; every device has the other. */
static VkFormat preferred(const crv__device *d, VkFormat small, VkFormat sure)
{
    const VkFormatFeatureFlags both =
        VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
    return crv__format_has(d, small, both) ? small : sure;
}

static bool wants_half(const crv__device *d, crv_vulkan_half half)
{
    return half == CRV_VULKAN_HALF_ON
           || (half == CRV_VULKAN_HALF_AUTO
               && d->properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU);
}

static crv_status create_parts(crv__pass *p, const crv__setup *setup,
                               const crv__pass_desc *desc)
{
    const crv__device *d = p->device;
    const crv_vulkan_depth_layout layout = desc->depth_layout;
    const VkFormat sure = VK_FORMAT_R32_SFLOAT; /* every device stores and samples it */
    const crv__program_desc program = {
        .converts = desc->converts,
        .octahedral = !desc->single,
        .edge = layout == CRV_VULKAN_DEPTH_DEINTERLEAVED
                    ? crv__deinterleave_edge(d, setup)
                    : 1,
        .half = wants_half(d, desc->half_filters),
        .level_px = layout == CRV_VULKAN_DEPTH_LEVELS ? desc->level_px : 0,
        .bent = desc->bent,
        .bent_form = desc->bent_form};
    const crv__scratch_desc scratch = {
        .normal_format =
            desc->single ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R32G32_SFLOAT,
        .accessibility_format =
            desc->single ? sure : preferred(d, VK_FORMAT_R16_SFLOAT, sure),
        .bent_format =
            desc->single ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT};
    const bool timestamps = desc->timestamps && d->timestamp_bits > 0;
    crv_status status = crv__program_create(&p->program, d, setup, &program);
    if (status == CRV_OK)
        status = crv__scratch_create(&p->scratch, &p->program, setup, &scratch);
    for (int32_t i = 0; status == CRV_OK && i < p->slot_count; i++)
        status =
            crv__slot_create(&p->slots[i], &p->program, &p->scratch, setup, timestamps);
    return status;
}

crv_status crv__pass_create(crv__pass *p, const crv__device *d, const crv__setup *setup,
                            const crv__pass_desc *desc)
{
    const size_t count = (size_t)desc->slots;
    *p = (crv__pass){.device = d, .options = setup->options};
    p->slots = crv__allocate(&d->allocator, count, sizeof *p->slots);
    if (!p->slots)
        return crv__fail(&d->logger, CRV_ERROR_OUT_OF_MEMORY, "vulkan: out of memory");
    p->slot_count = desc->slots;
    return create_parts(p, setup, desc);
}

void crv__pass_destroy(crv__pass *p, const crv_allocator *allocator)
{
    for (int32_t i = 0; i < p->slot_count; i++)
        crv__slot_destroy(&p->slots[i]);
    crv__scratch_destroy(&p->scratch);
    crv__program_destroy(&p->program);
    crv__release(allocator, p->slots, (size_t)p->slot_count, sizeof *p->slots);
}

uint64_t crv__pass_bytes(const crv__pass *p)
{
    uint64_t bytes = crv__scratch_bytes(&p->scratch);
    for (int32_t i = 0; i < p->slot_count; i++)
        bytes += crv__slot_bytes(&p->slots[i]);
    return bytes;
}

const char *crv__pass_fixes(const crv__pass *p, const crv_options *options)
{
    const crv_options *own = &p->options;
    /* Specialisation constants, and what buffers are as large as. */
    static const char *const KEYS[] = {
        "falloff", "directions",  "steps",      "spacing",      "normal_rays",
        "samples", "attenuation", "noise_size", "filter_slope", "bent_normal"};
    if (own->method != options->method)
        return "method";
    if (own->filter != options->filter)
        return "filter";
    for (size_t i = 0; i < sizeof KEYS / sizeof *KEYS; i++) {
        const crv_option *option = crv_option_find(KEYS[i]);
        const double is = crv_options_get(own, option),
                     wanted = crv_options_get(options, option);
        if (is < wanted || is > wanted)
            return KEYS[i];
    }
    if ((own->bias_deg > 0) != (options->bias_deg > 0))
        return "bias_deg";
    if (own->filter
        && crv__program_uses_half(&p->program, own)
               != crv__program_uses_half(&p->program, options))
        return "filter_normal";
    return NULL;
}

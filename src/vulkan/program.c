/* SPDX-License-Identifier: MIT */
#include "vulkan/program.h"

#include "crevice_shaders.h"

#include <stdio.h>
#include <string.h>

/* Offsets of storage buffers: every device takes a multiple of this. */
enum { OFFSET_ALIGNMENT = 256 };

/* Specialisation constants, by id (shaders/common.glsl). */
enum {
    SPEC_SIZE_X,
    SPEC_SIZE_Y,
    SPEC_FALLOFF,
    SPEC_DIRECTIONS,
    SPEC_STEPS,
    SPEC_NORMAL_RAYS,
    SPEC_SAMPLES,
    SPEC_ATTENUATION,
    SPEC_LAYERS,
    SPEC_ORTHOGRAPHIC,
    SPEC_NOISE_SIZE,
    SPEC_FILTER_SLOPE,
    SPEC_LAYERS_SOLID,
    SPEC_INTERLEAVE,
    SPEC_SPACING,
    SPEC_NORMALS_OCTAHEDRAL,
    SPEC_DEPTH_EDGE,
    SPEC_BIASED,
    SPEC_FILTER_PASS,
    SPEC_LOD_PX,
    SPECS
};

static void fill_specs(const crv__setup *setup, int32_t group, int32_t pass,
                       int32_t specs[SPECS])
{
    const crv_options *o = &setup->options;
    specs[SPEC_SIZE_X] = specs[SPEC_SIZE_Y] = group;
    specs[SPEC_FALLOFF] = (int32_t)o->falloff;
    specs[SPEC_DIRECTIONS] = o->directions;
    specs[SPEC_STEPS] = o->steps;
    specs[SPEC_NORMAL_RAYS] = o->normal_rays;
    specs[SPEC_SAMPLES] = o->samples;
    specs[SPEC_ATTENUATION] = (int32_t)o->attenuation;
    specs[SPEC_LAYERS] = setup->desc.layers;
    specs[SPEC_ORTHOGRAPHIC] = -1; /* the camera comes with the frame */
    specs[SPEC_NOISE_SIZE] = o->noise_size;
    specs[SPEC_FILTER_SLOPE] = o->filter_slope;
    specs[SPEC_LAYERS_SOLID] = setup->desc.layer_kind == CRV_LAYERS_SOLID;
    specs[SPEC_INTERLEAVE] = 1;
    specs[SPEC_SPACING] = (int32_t)o->spacing;
    specs[SPEC_NORMALS_OCTAHEDRAL] = 0;
    specs[SPEC_DEPTH_EDGE] = 1;
    specs[SPEC_BIASED] = o->bias_deg > 0;
    specs[SPEC_FILTER_PASS] = pass;
    specs[SPEC_LOD_PX] = 0;
}

static const crv__shader *shader_find(const char *name)
{
    for (int i = 0; i < CRV__SHADER_COUNT; i++) {
        if (strcmp(crv__shaders[i].name, name) == 0)
            return &crv__shaders[i];
    }
    return NULL;
}

static crv_status create_pipeline(crv__program *p, const crv__setup *setup,
                                  const char *name, int32_t group, int32_t pass,
                                  crv__pipeline *out)
{
    const crv__device *d = p->device;
    const crv__shader *shader = shader_find(name);
    if (!shader)
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "vulkan: there is no shader %s; use the CPU", name);
    int32_t specs[SPECS];
    VkSpecializationMapEntry entries[SPECS];
    fill_specs(setup, group, pass, specs);
    for (uint32_t i = 0; i < SPECS; i++)
        entries[i] =
            (VkSpecializationMapEntry){i, i * (uint32_t)sizeof *specs, sizeof *specs};
    const VkSpecializationInfo specialization = {SPECS, entries, sizeof specs, specs};
    const VkShaderModuleCreateInfo module = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = shader->size_bytes,
        .pCode = shader->words};
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .pName = "main",
                  .pSpecializationInfo = &specialization},
        .layout = p->layout};
    VkResult result =
        d->vk.CreateShaderModule(d->device, &module, d->callbacks, &info.stage.module);
    if (result == VK_SUCCESS) {
        result = d->vk.CreateComputePipelines(d->device, VK_NULL_HANDLE, 1, &info,
                                              d->callbacks, &out->pipeline);
        d->vk.DestroyShaderModule(d->device, info.stage.module, d->callbacks);
    }
    out->group = group;
    return result ? crv__device_fail(d, result, name) : CRV_OK;
}

/* Filters share texels in a workgroup: the larger, the fewer are fetched twice. */
static int32_t filter_group(const crv__device *d)
{
    return d->properties.limits.maxComputeWorkGroupInvocations >= 256 ? 16 : 8;
}

static crv_status create_pipelines(crv__program *p, const crv__setup *setup, int converts)
{
    enum { GROUP = 8 };
    crv_status status =
        create_pipeline(p, setup, setup->method->info.name, GROUP, 0, &p->estimate);
    for (int32_t i = 0; status == CRV_OK && i < p->passes; i++)
        status = create_pipeline(p, setup, setup->filter->info.name,
                                 filter_group(p->device), i, &p->filter[i]);
    if (status == CRV_OK && converts)
        status = create_pipeline(p, setup, "depth_convert", GROUP, 0, &p->depth);
    if (status == CRV_OK && converts)
        status = create_pipeline(p, setup, "normals_convert", GROUP, 0, &p->normals);
    return status;
}

static VkResult create_layouts(crv__program *p)
{
    const crv__device *d = p->device;
    VkDescriptorSetLayoutBinding bindings[CRV__BINDINGS];
    for (uint32_t i = 0; i < CRV__BINDINGS; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = i == CRV__BIND_PARAMS ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                              : i < CRV__BIND_DEPTH ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                              : i == CRV__BIND_OUTPUT
                                  ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                  : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    const VkDescriptorSetLayoutCreateInfo sets = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = CRV__BINDINGS,
        .pBindings = bindings};
    VkResult result =
        d->vk.CreateDescriptorSetLayout(d->device, &sets, d->callbacks, &p->set_layout);
    if (result)
        return result;
    const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(crv__push)};
    const VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &p->set_layout,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &push};
    result = d->vk.CreatePipelineLayout(d->device, &info, d->callbacks, &p->layout);
    if (result)
        return result;
    const VkSamplerCreateInfo sampler = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    return d->vk.CreateSampler(d->device, &sampler, d->callbacks, &p->sampler);
}

static VkDeviceSize aligned(VkDeviceSize size)
{
    return (size + OFFSET_ALIGNMENT - 1) / OFFSET_ALIGNMENT * OFFSET_ALIGNMENT;
}

static crv_status create_constants(crv__program *p, const crv__setup *setup)
{
    const size_t noise = (size_t)setup->options.noise_size
                         * (size_t)setup->options.noise_size * sizeof *setup->noise;
    const size_t directions = (size_t)setup->options.directions * 2 * sizeof(float);
    /* Methods without points still have the binding. */
    const size_t pattern =
        setup->pattern ? (size_t)setup->options.samples * 4 * sizeof(float) : 0;
    const VkDeviceSize second = aligned(noise), third = second + aligned(directions);
    const crv_status status =
        crv__buffer_create(&p->constants, p->device, third + aligned(pattern + 16),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    if (status)
        return status;
    char *bytes = p->constants.block.mapped;
    memcpy(bytes, setup->noise, noise);
    memcpy(bytes + second, setup->directions, directions);
    if (setup->pattern)
        memcpy(bytes + third, setup->pattern, pattern);
    const VkBuffer buffer = p->constants.buffer;
    p->table[CRV__BIND_NOISE] = (VkDescriptorBufferInfo){buffer, 0, noise};
    p->table[CRV__BIND_DIRECTIONS] = (VkDescriptorBufferInfo){buffer, second, directions};
    p->table[CRV__BIND_PATTERN] =
        (VkDescriptorBufferInfo){buffer, third, pattern ? pattern : 16};
    return CRV_OK;
}

crv_status crv__program_create(crv__program *p, const crv__device *device,
                               const crv__setup *setup, int converts)
{
    *p = (crv__program){.device = device,
                        .passes = setup->filter ? setup->filter->passes : 0};
    const VkResult result = create_layouts(p);
    if (result)
        return crv__device_fail(device, result, "layouts");
    const crv_status status = create_constants(p, setup);
    return status ? status : create_pipelines(p, setup, converts);
}

void crv__program_destroy(crv__program *p)
{
    const crv__device *d = p->device;
    if (!d)
        return;
    const VkPipeline pipelines[] = {p->depth.pipeline,     p->normals.pipeline,
                                    p->estimate.pipeline,  p->filter[0].pipeline,
                                    p->filter[1].pipeline, p->resolve.pipeline};
    for (size_t i = 0; i < sizeof pipelines / sizeof pipelines[0]; i++)
        d->vk.DestroyPipeline(d->device, pipelines[i], d->callbacks);
    crv__buffer_destroy(&p->constants, d);
    d->vk.DestroySampler(d->device, p->sampler, d->callbacks);
    d->vk.DestroyPipelineLayout(d->device, p->layout, d->callbacks);
    d->vk.DestroyDescriptorSetLayout(d->device, p->set_layout, d->callbacks);
    *p = (crv__program){0};
}

/* SPDX-License-Identifier: MIT */
#include "vulkan/pipelines.h"

#include "shared/push.h"

#include "crevice_shaders.h"

#include <string.h>

VkDescriptorType crv__binding_type(uint32_t binding)
{
    if (binding == CRV__BIND_PARAMS)
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    if (binding < CRV__BIND_DEPTH)
        return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    return binding == CRV__BIND_OUTPUT || binding == CRV__BIND_VECTORS_OUTPUT
               ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
               : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

void crv__specs_clear(int32_t specs[CRV__SPECS], int32_t group)
{
    for (int i = 0; i < CRV__SPECS; i++)
        specs[i] = -1;
    specs[CRV__SPEC_SIZE_X] = specs[CRV__SPEC_SIZE_Y] = group;
    specs[CRV__SPEC_PIXEL_STRIDE] = specs[CRV__SPEC_DEPTH_EDGE] = 1;
    specs[CRV__SPEC_NORMALS_OCTAHEDRAL] = specs[CRV__SPEC_LOD_PX] = 0;
    specs[CRV__SPEC_IN_PARTS] = 0;
    specs[CRV__SPEC_BENT_NORMAL] = specs[CRV__SPEC_BENT_FORM] = 0;
}

static VkResult create_layouts(const crv__device *d, crv__pipelines *p)
{
    VkDescriptorSetLayoutBinding bindings[CRV__BINDINGS];
    for (uint32_t i = 0; i < CRV__BINDINGS; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){.binding = i,
                                           .descriptorType = crv__binding_type(i),
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

crv_status crv__pipelines_open(crv__device *d)
{
    d->pipelines = crv__allocate(&d->allocator, 1, sizeof *d->pipelines);
    if (!d->pipelines)
        return crv__fail(&d->logger, CRV_ERROR_OUT_OF_MEMORY, "vulkan: out of memory");
    const VkResult result = create_layouts(d, d->pipelines);
    return result ? crv__device_fail(d, result, "layouts") : CRV_OK;
}

void crv__pipelines_close(crv__device *d)
{
    crv__pipelines *p = d->pipelines;
    if (!p)
        return;
    for (int i = 0; i < CRV__KEPT_PIPELINES; i++)
        d->vk.DestroyPipeline(d->device, p->kept[i].pipeline, d->callbacks);
    d->vk.DestroySampler(d->device, p->sampler, d->callbacks);
    d->vk.DestroyPipelineLayout(d->device, p->layout, d->callbacks);
    d->vk.DestroyDescriptorSetLayout(d->device, p->set_layout, d->callbacks);
    crv__release(&d->allocator, p, 1, sizeof *p);
    d->pipelines = NULL;
}

static int32_t shader_find(const char *name)
{
    for (int32_t i = 0; i < CRV__SHADER_COUNT; i++) {
        if (strcmp(crv__shaders[i].name, name) == 0)
            return i;
    }
    return -1;
}

static VkResult compile(const crv__device *d, int32_t shader,
                        const int32_t specs[CRV__SPECS], VkPipeline *out)
{
    VkSpecializationMapEntry entries[CRV__SPECS];
    for (uint32_t i = 0; i < CRV__SPECS; i++)
        entries[i] =
            (VkSpecializationMapEntry){i, i * (uint32_t)sizeof *specs, sizeof *specs};
    const VkSpecializationInfo specialization = {CRV__SPECS, entries,
                                                 CRV__SPECS * sizeof *specs, specs};
    const VkShaderModuleCreateInfo module = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = crv__shaders[shader].size_bytes,
        .pCode = crv__shaders[shader].words};
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .pName = "main",
                  .pSpecializationInfo = &specialization},
        .layout = d->pipelines->layout};
    VkResult result =
        d->vk.CreateShaderModule(d->device, &module, d->callbacks, &info.stage.module);
    if (result)
        return result;
    result =
        d->vk.CreateComputePipelines(d->device, d->cache, 1, &info, d->callbacks, out);
    d->vk.DestroyShaderModule(d->device, info.stage.module, d->callbacks);
    if (result == VK_SUCCESS)
        crv__device_name(d, VK_OBJECT_TYPE_PIPELINE, (uint64_t)*out,
                         crv__shaders[shader].name);
    return result;
}

/* An empty place, or that of the pipeline that has been idle for longest; NULL: all are
 * in use. */
static crv__kept_pipeline *place_for_another(const crv__device *d)
{
    crv__kept_pipeline *best = NULL;
    for (int i = 0; i < CRV__KEPT_PIPELINES; i++) {
        crv__kept_pipeline *k = &d->pipelines->kept[i];
        if (!k->pipeline)
            return k;
        if (k->users == 0 && (!best || k->last_use < best->last_use))
            best = k;
    }
    if (best) {
        d->vk.DestroyPipeline(d->device, best->pipeline, d->callbacks);
        *best = (crv__kept_pipeline){0};
    }
    return best;
}

crv_status crv__pipeline_take(const crv__device *d, const char *name,
                              const int32_t specs[CRV__SPECS], VkPipeline *out)
{
    crv__pipelines *p = d->pipelines;
    const int32_t shader = shader_find(name);
    if (shader < 0)
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "vulkan: there is no shader %s; use the CPU", name);
    for (int i = 0; i < CRV__KEPT_PIPELINES; i++) {
        crv__kept_pipeline *k = &p->kept[i];
        if (k->pipeline && k->shader == shader
            && memcmp(k->specs, specs, sizeof k->specs) == 0) {
            k->users++;
            k->last_use = ++p->clock;
            *out = k->pipeline;
            return CRV_OK;
        }
    }
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result = compile(d, shader, specs, &pipeline);
    if (result)
        return crv__device_fail(d, result, name);
    crv__kept_pipeline *k = place_for_another(d);
    if (k) {
        *k = (crv__kept_pipeline){
            .pipeline = pipeline, .shader = shader, .users = 1, .last_use = ++p->clock};
        memcpy(k->specs, specs, sizeof k->specs);
    }
    *out = pipeline;
    return CRV_OK;
}

void crv__pipeline_give(const crv__device *d, VkPipeline pipeline)
{
    if (!pipeline)
        return;
    for (int i = 0; i < CRV__KEPT_PIPELINES; i++) {
        if (d->pipelines->kept[i].pipeline == pipeline) {
            d->pipelines->kept[i].users--;
            return;
        }
    }
    d->vk.DestroyPipeline(d->device, pipeline, d->callbacks); /* there was no place */
}

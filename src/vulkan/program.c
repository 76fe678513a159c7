/* SPDX-License-Identifier: MIT */
#include "vulkan/program.h"

#include <stdio.h>
#include <string.h>

/*
 * Rounds of loops for a pixel in one dispatch, at most. That many fetches for a frame of
 * 4K take a fortieth of a second on a device that fetches 10^12 texels a second, and a
 * quarter on one that is ten times slower: drivers take a device for lost after seconds.
 * Lavapipe breaks loops off after 65535 rounds, all loops counted together, those of
 * branches not taken as well: bitmask turns four to eight times for a sample.
 */
enum { PART_ROUNDS = 4096, LAVAPIPE_ROUNDS = 65535 };

/*
 * Rounds of a plan's submission, at most. Between submissions a host is told how far a
 * run is, and a process that is killed waits for no more than one of them. The first is
 * for devices that are CPUs: a sixth of a second with hbao on two cores. A device that
 * fetches 10^10 texels a second takes a fifth of a second for the second.
 */
static const int64_t SOFTWARE_ROUNDS = (int64_t)1 << 26,
                     SUBMISSION_ROUNDS = (int64_t)1 << 31;

static bool has_option(const crv__setup *setup, const char *key)
{
    return crv_option_applies(crv_option_find(key), &setup->method->info, NULL);
}

/* Directions or points: what the parts of an estimate are made of. */
static int32_t unit_count(const crv__setup *setup)
{
    const bool has_points = setup->pattern || setup->method->pattern_fill;
    return has_points ? setup->options.samples : setup->options.directions;
}

/* How often loops turn for one of them, at most. */
static int32_t unit_rounds(const crv__setup *setup)
{
    const crv_options *o = &setup->options;
    const int32_t layers = setup->desc.layers > 1 ? 1 + setup->desc.layers : 1;
    const int32_t march = has_option(setup, "steps") ? o->steps * layers : layers;
    return 1 + march
           + (has_option(setup, "normal_rays") ? o->normal_rays * (1 + march) : 0);
}

static int32_t part_size(const crv__setup *setup)
{
    const int32_t units = PART_ROUNDS / unit_rounds(setup), all = unit_count(setup);
    return units < 1 ? 1 : units < all ? units : all;
}

int32_t crv__deinterleave_edge(const crv__device *d, const crv__setup *setup)
{
    const int32_t edge = setup->options.noise_size;
    const uint32_t layers = (uint32_t)(edge * edge * setup->desc.layers);
    const bool fits =
        edge >= 2 && edge <= 8 && layers <= d->properties.limits.maxImageArrayLayers;
    return fits ? edge : 1;
}

crv_status crv__setup_check(const crv__device *d, const crv__setup *setup)
{
    const uint32_t most = d->properties.limits.maxImageDimension2D;
    if ((uint32_t)setup->desc.width > most || (uint32_t)setup->desc.height > most)
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "vulkan: %s has images of at most %u px, not %d x %d; use the "
                         "CPU",
                         d->properties.deviceName, most, setup->desc.width,
                         setup->desc.height);
    if (d->is_lavapipe && unit_rounds(setup) > LAVAPIPE_ROUNDS)
        return crv__fail(&d->logger, CRV_ERROR_UNSUPPORTED,
                         "vulkan: lavapipe breaks loops off after %d rounds, and gives a "
                         "wrong picture; take fewer steps or normal_rays, or the CPU",
                         LAVAPIPE_ROUNDS);
    return CRV_OK;
}

static void clear_specs(const crv__program *p, crv__pipeline *pipeline, int32_t group,
                        int32_t specs[CRV__SPECS])
{
    *pipeline =
        (crv__pipeline){.group = group, .lanes_x = 1, .lanes_y = 1, .pixel_stride = 1};
    crv__specs_clear(specs, group);
    specs[CRV__SPEC_NORMALS_OCTAHEDRAL] = p->desc.octahedral;
}

static void set_bent(const crv__program *p, bool is_last, int32_t specs[CRV__SPECS])
{
    specs[CRV__SPEC_BENT_NORMAL] = p->desc.bent;
    specs[CRV__SPEC_BENT_FORM] =
        (int32_t)(is_last ? p->desc.bent_form : CRV__BENT_AS_SUMMED);
}

static crv_status take_estimate(crv__program *p, const crv__setup *setup, int32_t group)
{
    const crv_options *o = &setup->options;
    int32_t specs[CRV__SPECS];
    clear_specs(p, &p->estimate, group, specs);
    specs[CRV__SPEC_PIXEL_STRIDE] = specs[CRV__SPEC_DEPTH_EDGE] =
        p->estimate.pixel_stride = p->desc.edge;
    specs[CRV__SPEC_LOD_PX] = p->desc.level_px;
    specs[CRV__SPEC_IN_PARTS] = p->parts > 1;
    specs[CRV__SPEC_FALLOFF] = (int32_t)o->falloff;
    specs[CRV__SPEC_DIRECTIONS] = o->directions;
    specs[CRV__SPEC_STEPS] = o->steps;
    specs[CRV__SPEC_NORMAL_RAYS] = o->normal_rays;
    specs[CRV__SPEC_SAMPLES] = o->samples;
    specs[CRV__SPEC_ATTENUATION] = (int32_t)o->attenuation;
    specs[CRV__SPEC_LAYERS] = setup->desc.layers;
    specs[CRV__SPEC_NOISE_SIZE] = o->noise_size;
    specs[CRV__SPEC_LAYERS_SOLID] = setup->desc.layer_kind == CRV_LAYERS_SOLID;
    specs[CRV__SPEC_SPACING] = (int32_t)o->spacing;
    specs[CRV__SPEC_BIASED] = o->bias_deg > 0;
    set_bent(p, p->passes == 0, specs);
    return crv__pipeline_take(p->device, setup->method->info.name, specs,
                              &p->estimate.pipeline);
}

/* box4 takes taps whole or not at all, which the error of a half float would turn over:
 * 1.8 % of the pixels of a noisy frame differed by more than 2e-3. edges15 was not tried.
 */
static bool has_half(const crv_filter *filter)
{
    return strcmp(filter->name, "box4") != 0 && strcmp(filter->name, "edges15") != 0;
}

/*
 * Angles that half floats tell apart: an error of 2^-12 in each normal changes 1 - cos of
 * an angle by a share of 2^-10 over the angle. half.glsl leaves out surfaces without a
 * normal, which angles beyond 90 degrees let in; at 180 normals do not count. Bent
 * normals are filtered in single precision.
 */
bool crv__program_uses_half(const crv__program *p, const crv_options *options)
{
    const float least_deg = 10, most_deg = 90, angle = options->filter_normal;
    return p->desc.half && !p->desc.bent && p->device->has_half
           && has_half(options->filter)
           && ((angle >= least_deg && angle <= most_deg) || angle >= 180);
}

static crv_status take_filter(crv__program *p, const crv__setup *setup, int32_t group,
                              int32_t pass)
{
    int32_t specs[CRV__SPECS];
    clear_specs(p, &p->filter[pass], group, specs);
    specs[CRV__SPEC_FILTER_SLOPE] = setup->options.filter_slope;
    specs[CRV__SPEC_FILTER_PASS] = pass;
    set_bent(p, pass + 1 == p->passes, specs);
    const bool half = crv__program_uses_half(p, &setup->options);
    char name[32];
    snprintf(name, sizeof name, "%s%s", setup->filter->info.name, half ? "_half" : "");
    if (half) /* lane_step() of the shaders */
        *(pass == 0 ? &p->filter[pass].lanes_y : &p->filter[pass].lanes_x) = 2;
    return crv__pipeline_take(p->device, name, specs, &p->filter[pass].pipeline);
}

static crv_status take_other(crv__program *p, const char *shader, int32_t group,
                             int32_t edge, crv__pipeline *out)
{
    int32_t specs[CRV__SPECS];
    clear_specs(p, out, group, specs);
    specs[CRV__SPEC_PIXEL_STRIDE] = specs[CRV__SPEC_DEPTH_EDGE] = out->pixel_stride =
        edge;
    return crv__pipeline_take(p->device, shader, specs, &out->pipeline);
}

/* Filters share texels in a workgroup: the larger, the fewer are fetched twice. */
static int32_t filter_group(const crv__device *d)
{
    return d->properties.limits.maxComputeWorkGroupInvocations >= 256 ? 16 : 8;
}

static crv_status take_pipelines(crv__program *p, const crv__setup *setup)
{
    enum { GROUP = 8 };
    crv_status status = take_estimate(p, setup, GROUP);
    for (int32_t i = 0; status == CRV_OK && i < p->passes; i++)
        status = take_filter(p, setup, filter_group(p->device), i);
    if (status == CRV_OK && p->desc.converts)
        status = take_other(p, "convert", GROUP, 1, &p->convert);
    if (status == CRV_OK && p->desc.converts && setup->desc.layers > 1)
        status = take_other(p, "depth_convert", GROUP, 1, &p->depth);
    if (status == CRV_OK && p->desc.edge > 1)
        status = take_other(p, "deinterleave", GROUP, p->desc.edge, &p->deinterleave);
    if (status == CRV_OK && p->desc.level_px > 0)
        status = take_other(p, "prefilter", GROUP, 1, &p->prefilter);
    if (status == CRV_OK && setup->map)
        status = take_other(p, setup->map->name, GROUP, p->desc.edge, &p->map);
    return status;
}

crv_status crv__program_create(crv__program *p, const crv__device *device,
                               const crv__setup *setup, const crv__program_desc *desc)
{
    const int32_t size = part_size(setup);
    *p = (crv__program){.device = device,
                        .desc = *desc,
                        .parts = (unit_count(setup) + size - 1) / size,
                        .part_size = size,
                        .part_rounds = size * unit_rounds(setup),
                        .submission_rounds =
                            device->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU
                                ? SOFTWARE_ROUNDS
                                : SUBMISSION_ROUNDS,
                        .passes = setup->filter ? setup->filter->passes : 0};
    return take_pipelines(p, setup);
}

void crv__program_destroy(crv__program *p)
{
    const crv__device *d = p->device;
    if (!d)
        return;
    const VkPipeline pipelines[] = {p->convert.pipeline,   p->depth.pipeline,
                                    p->estimate.pipeline,  p->filter[0].pipeline,
                                    p->filter[1].pipeline, p->deinterleave.pipeline,
                                    p->prefilter.pipeline, p->map.pipeline};
    for (size_t i = 0; i < sizeof pipelines / sizeof pipelines[0]; i++)
        crv__pipeline_give(d, pipelines[i]);
    *p = (crv__program){0};
}

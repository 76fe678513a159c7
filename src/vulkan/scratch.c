/* SPDX-License-Identifier: MIT */
#include "vulkan/scratch.h"

/* One level if coarser ones are not read; else down to 5 texels (level.glsl). */
static int32_t level_count(const crv__program *p, const crv_gbuffer_desc *g)
{
    int32_t levels = 1;
    while (p->desc.level_px > 0 && levels < CRV__MOST_LEVELS && g->width >> levels > 4
           && g->height >> levels > 4)
        levels++;
    return levels;
}

crv_status crv__scratch_create(crv__scratch *s, const crv__program *p,
                               const crv__setup *setup, const crv__scratch_desc *desc)
{
    const crv_gbuffer_desc *g = &setup->desc;
    const crv__rectangle r = crv__setup_rectangle(setup);
    const int32_t edge = p->desc.edge;
    const crv__image_desc depth = {.name = "depth",
                                   .format = VK_FORMAT_R32_SFLOAT,
                                   .width = g->width,
                                   .height = g->height,
                                   .layers = g->layers,
                                   .levels = level_count(p, g)};
    const crv__image_desc normals = {.name = "normals",
                                     .format = desc->normal_format,
                                     .width = g->width,
                                     .height = g->height,
                                     .levels = 1};
    const crv__image_desc accessibility = {.name = "accessibility",
                                           .format = desc->accessibility_format,
                                           .width = r.width,
                                           .height = r.height,
                                           .levels = 1};
    const crv__image_desc deinterleaved = {.name = "deinterleaved depth",
                                           .format = VK_FORMAT_R32_SFLOAT,
                                           .width = (g->width + edge - 1) / edge,
                                           .height = (g->height + edge - 1) / edge,
                                           .layers = g->layers * edge * edge,
                                           .levels = 1};
    crv__image_desc map = deinterleaved; /* not at all if the edge is 1 */
    map.name = "map";
    map.layers = edge * edge;
    const crv__image_desc sums = {.name = "sums",
                                  .format = p->desc.bent ? VK_FORMAT_R32G32B32A32_SFLOAT
                                                         : VK_FORMAT_R32G32_SFLOAT,
                                  .width = r.width,
                                  .height = r.height,
                                  .levels = 1};
    const crv__image_desc bent = {.name = "bent normals",
                                  .format = desc->bent_format,
                                  .width = r.width,
                                  .height = r.height,
                                  .levels = 1};
    const bool has_bent = p->desc.bent, has_bent_sums = has_bent && p->parts > 1;
    const crv__image_desc *const images[CRV__SCRATCH_IMAGES] = {
        [CRV__SCRATCH_DEPTH] = &depth,
        [CRV__SCRATCH_NORMALS] = &normals,
        [CRV__SCRATCH_ACCESSIBILITY] = &accessibility,
        [CRV__SCRATCH_FILTERED] = p->passes ? &accessibility : NULL,
        [CRV__SCRATCH_DEINTERLEAVED] = edge > 1 ? &deinterleaved : NULL,
        [CRV__SCRATCH_MAP] = setup->map ? &map : NULL,
        [CRV__SCRATCH_SUMS] = p->parts > 1 ? &sums : NULL,
        [CRV__SCRATCH_SUMS + 1] = p->parts > 1 ? &sums : NULL,
        [CRV__SCRATCH_BENT] = has_bent ? &bent : NULL,
        [CRV__SCRATCH_BENT_FILTERED] = has_bent && p->passes ? &bent : NULL,
        [CRV__SCRATCH_BENT_SUMS] = has_bent_sums ? &sums : NULL,
        [CRV__SCRATCH_BENT_SUMS + 1] = has_bent_sums ? &sums : NULL};
    crv_status status = CRV_OK;
    *s = (crv__scratch){.device = p->device};
    for (int i = 0; status == CRV_OK && i < CRV__SCRATCH_IMAGES; i++) {
        if (images[i])
            status = crv__image_create(&s->image[i], p->device, images[i]);
    }
    return status;
}

void crv__scratch_destroy(crv__scratch *s)
{
    for (int i = 0; s->device && i < CRV__SCRATCH_IMAGES; i++)
        crv__image_destroy(&s->image[i], s->device);
    *s = (crv__scratch){0};
}

uint64_t crv__scratch_bytes(const crv__scratch *s)
{
    uint64_t bytes = 0;
    for (int i = 0; i < CRV__SCRATCH_IMAGES; i++)
        bytes += s->image[i].size;
    return bytes;
}

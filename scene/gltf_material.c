/* SPDX-License-Identifier: MIT */
/*
 * Colours, and holes by alpha. What blends is taken for a mask at one half: occlusion has
 * no half surfaces.
 */
#include "gltf.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

#define DEFAULT_ALBEDO 0.8

/* The alpha of a PNG; NULL: it has none, or is no PNG that can be read. */
static unsigned char *read_alpha(const gltf_bytes *bytes, int32_t *width, int32_t *height)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    unsigned char *alpha = NULL, *pixels = NULL;
    if (!png_image_begin_read_from_memory(&image, bytes->data, bytes->size))
        return NULL;
    const bool usable = (image.format & PNG_FORMAT_FLAG_ALPHA) && image.width >= 1
                        && image.width <= MESH_MAX_MASK && image.height >= 1
                        && image.height <= MESH_MAX_MASK;
    const size_t count = (size_t)image.width * (size_t)image.height;
    image.format = PNG_FORMAT_GA;
    if (usable) {
        pixels = malloc(2 * count);
        alpha = malloc(count);
    }
    if (!pixels || !alpha || !png_image_finish_read(&image, NULL, pixels, 0, NULL)) {
        free(alpha);
        alpha = NULL;
    }
    for (size_t i = 0; alpha && i < count; i++)
        alpha[i] = pixels[2 * i + 1];
    free(pixels);
    png_image_free(&image);
    *width = (int32_t)image.width;
    *height = (int32_t)image.height;
    return alpha;
}

static int32_t wrap_of(double mode)
{
    return mode > 33647.5   ? MESH_WRAP_MIRROR
           : mode > 33070.5 ? MESH_WRAP_CLAMP
                            : MESH_WRAP_REPEAT;
}

/* KHR_texture_transform: u' = offset + rotation * scale * u. */
static void read_map(const cJSON *info, float map[6])
{
    const cJSON *t = gltf_extension(info, "KHR_texture_transform");
    double offset[2] = {0.0, 0.0}, scale[2] = {1.0, 1.0};
    const double angle = gltf_number(t, "rotation", 0.0), c = cos(angle), s = sin(angle);
    gltf_numbers(t, "offset", 2, offset);
    gltf_numbers(t, "scale", 2, scale);
    map[0] = (float)(c * scale[0]);
    map[1] = (float)(s * scale[1]);
    map[2] = (float)offset[0];
    map[3] = (float)(-s * scale[0]);
    map[4] = (float)(c * scale[1]);
    map[5] = (float)offset[1];
}

static void tell_picture(gltf *g)
{
    if (!g->told_picture)
        scene_log(g->log, CRV_LOG_WARNING, g->path,
                  "has alpha in pictures that are no PNG, or damaged; such surfaces are "
                  "taken for solid: write the textures as PNG");
    g->told_picture = true;
}

/* The mask of a base colour texture whose alpha is multiplied by `factor`; -1: none. */
static int32_t add_mask(gltf *g, const cJSON *info, double factor, double cutoff, mesh *m)
{
    const cJSON *texture = gltf_at(&g->textures, gltf_index(info, "index"));
    const cJSON *image = gltf_at(&g->images, gltf_index(texture, "source"));
    const cJSON *sampler = gltf_at(&g->samplers, gltf_index(texture, "sampler"));
    mesh_mask mask = {.cutoff = (float)(cutoff / fmax(factor, 1e-6)),
                      .wrap = {wrap_of(gltf_number(sampler, "wrapS", 10497.0)),
                               wrap_of(gltf_number(sampler, "wrapT", 10497.0))}};
    const gltf_bytes bytes = image ? gltf_image(g, image) : (gltf_bytes){0};
    const bool is_png =
        bytes.data && bytes.size > 8 && memcmp(bytes.data, "\x89PNG\r\n\x1a\n", 8) == 0;
    const bool is_jpeg =
        bytes.data && bytes.size > 3 && memcmp(bytes.data, "\xff\xd8\xff", 3) == 0;
    if (is_png)
        mask.alpha = read_alpha(&bytes, &mask.width, &mask.height);
    else if (!is_jpeg && !g->failed) /* a JPEG has no alpha */
        tell_picture(g);
    free(bytes.owned);
    if (!mask.alpha)
        return -1;
    read_map(info, mask.map);
    return mesh_add_mask(m, &mask);
}

/* Names of exporters' own defaults: none, and white. */
static void set_colour(const cJSON *material, const double factor[4], mesh *m)
{
    const char *name = gltf_text(material, "name");
    const bool is_default = (!name || !name[0]) && factor[0] == factor[1]
                            && factor[1] == factor[2] && factor[0] == 1.0;
    if (is_default)
        mesh_set_colour(m, DEFAULT_ALBEDO, DEFAULT_ALBEDO, DEFAULT_ALBEDO);
    else
        mesh_set_colour(m, factor[0], factor[1], factor[2]);
}

bool gltf_set_material(gltf *g, int material, mesh *m, int *uv_set)
{
    const cJSON *object = gltf_at(&g->materials, material);
    const cJSON *base = gltf_member(object, "pbrMetallicRoughness");
    const cJSON *gloss = gltf_extension(object, "KHR_materials_pbrSpecularGlossiness");
    const cJSON *info = gltf_member(base, "baseColorTexture");
    const char *mode = gltf_text(object, "alphaMode");
    double factor[4] = {1.0, 1.0, 1.0, 1.0};
    *uv_set = 0;
    if (!gltf_numbers(base, "baseColorFactor", 4, factor)
        && gltf_numbers(gloss, "diffuseFactor", 4, factor))
        info = gltf_member(gloss, "diffuseTexture");
    set_colour(object, factor, m);
    if (!mode || strcmp(mode, "OPAQUE") == 0)
        return true;
    const bool blends = strcmp(mode, "BLEND") == 0;
    const double cutoff = blends ? 0.5 : gltf_number(object, "alphaCutoff", 0.5);
    if (blends && !g->told_blend)
        scene_log(g->log, CRV_LOG_WARNING, g->path,
                  "has surfaces that blend (alphaMode BLEND); they occlude where their "
                  "alpha is at least 0.5, and not elsewhere");
    g->told_blend = g->told_blend || blends;
    if (!info)
        return factor[3] >= cutoff;
    const cJSON *moved = gltf_extension(info, "KHR_texture_transform");
    *uv_set = (int)gltf_number(moved, "texCoord", gltf_number(info, "texCoord", 0.0));
    mesh_set_mask(m, add_mask(g, info, factor[3], cutoff, m));
    return true;
}

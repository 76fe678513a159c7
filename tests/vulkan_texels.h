/* SPDX-License-Identifier: MIT */
/* vulkan_texels.h: what images of the host's hold, bit by bit, as Vulkan's specification
 * defines its formats. */
#ifndef TESTS_VULKAN_TEXELS_H
#define TESTS_VULKAN_TEXELS_H

#include <stddef.h>
#include <vulkan/vulkan.h>

typedef enum texel_kind { TEXEL_FLOAT, TEXEL_SIGNED, TEXEL_UNSIGNED } texel_kind;

typedef struct texel_layout {
    VkFormat format;
    const char *name;
    texel_kind kind;
    size_t size;               /* bytes, as copies between buffers and images take it */
    int bits[4], shift[4];     /* of the components; shift from the lowest bit */
    VkImageAspectFlags aspect; /* that is copied */
} texel_layout;

/* Fails the test if the format is not known here. */
const texel_layout *texel_layout_of(VkFormat format);

/* Writes one component of a texel whose bits are still 0; what it then holds. */
double texel_put(const texel_layout *t, int component, double value, void *texel);
double texel_get(const texel_layout *t, int component, const void *texel);

/* By how much a value in [0, 1] changes at most when it is stored. */
double texel_rounding(const texel_layout *t);

#endif

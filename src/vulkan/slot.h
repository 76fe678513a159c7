/* SPDX-License-Identifier: MIT */
/* What each recording in flight has to itself: numbers, descriptors and timestamps. */
#ifndef CRV_VULKAN_SLOT_H
#define CRV_VULKAN_SLOT_H

#include "vulkan/scratch.h"

/* Upload, or each depth layer; deinterleave, levels, map, estimate, filter, download.
 */
enum { CRV__MOST_STEPS = CRV_MAX_LAYERS + 5 + CRV__MOST_PASSES };
_Static_assert((int)CRV__MOST_STEPS <= CRV_MAX_DEVICE_TIMES, "a time for each step");

typedef struct crv__slot {
    const crv__program *program;
    const crv__scratch *scratch;
    crv__buffer numbers; /* params, noise, directions, pattern */
    VkDescriptorPool pool;
    /* A conversion of each depth layer, the first with the normals; the estimate, its
     * parts before the last; the filter's passes, to and fro. */
    VkDescriptorSet depth_set[CRV_MAX_LAYERS], deinterleave_set, map_set, estimate_set,
        part_set[2], filter_set[CRV__MOST_PASSES],
        level_set[CRV_MAX_LAYERS][CRV__MOST_LEVELS];
    VkQueryPool queries;                /* VK_NULL_HANDLE: none */
    const char *steps[CRV__MOST_STEPS]; /* of the last recording */
    int32_t step_count;                 /* 0: nothing was recorded */
} crv__slot;

/* Destroy also after an error. */
crv_status crv__slot_create(crv__slot *s, const crv__program *program,
                            const crv__scratch *scratch, const crv__setup *setup,
                            bool timestamps);
void crv__slot_destroy(crv__slot *s);

/* Bytes of device memory. */
uint64_t crv__slot_bytes(const crv__slot *s);

/* The numbers of the next recording: the setup's patterns, turned by the noise index. */
void crv__slot_fill(const crv__slot *s, const crv__setup *setup,
                    const crv__params *params, uint32_t noise_index);

void crv__slot_bind_image(const crv__slot *s, VkDescriptorSet set, uint32_t binding,
                          VkImageView view, VkImageLayout layout);

/* The steps of the last recording. UNSUPPORTED: it has no timestamps; NOT_READY: nothing
 * was recorded, or it is still executed. Neither is logged. */
crv_status crv__slot_times(const crv__slot *s, crv_device_time *times, int32_t *count);

#endif

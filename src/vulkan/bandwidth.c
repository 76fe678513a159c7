/* SPDX-License-Identifier: MIT */
/* How fast the device's memory is: a large image copied to another, by the device's
 * clock. */
#include "vulkan/commands.h"
#include "vulkan/memory.h"
#include "vulkan/slot.h"

/* 64 MiB of 16-byte texels each: more than caches hold. */
enum { EDGE = 2048, TEXEL = 16, COPIES = 8, REPEATS = 4 };

typedef struct copying {
    crv__commands commands;
    crv__image images[2];
    crv__stopwatch watch;
} copying;

static crv_status create(copying *c, const crv__device *d)
{
    const crv__image_desc desc = {VK_FORMAT_R32G32B32A32_SFLOAT, EDGE, EDGE, 0, 1};
    crv_status status = crv__stopwatch_create(&c->watch, d);
    if (status == CRV_OK)
        status = crv__commands_create(&c->commands, d, "measurements");
    for (int i = 0; i < 2 && status == CRV_OK; i++)
        status = crv__image_create(&c->images[i], d, &desc);
    return status;
}

static void destroy(copying *c, const crv__device *d)
{
    for (int i = 0; i < 2; i++)
        crv__image_destroy(&c->images[i], d);
    crv__commands_destroy(&c->commands, d);
    crv__stopwatch_destroy(&c->watch, d);
}

/* The copies follow each other to and fro, so that none can be left out. */
static void record(copying *c, const crv__device *d)
{
    const VkImageSubresourceLayers colour = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageCopy whole = {
        .srcSubresource = colour, .dstSubresource = colour, .extent = {EDGE, EDGE, 1}};
    const crv__access copies = {VK_PIPELINE_STAGE_2_COPY_BIT,
                                VK_ACCESS_2_TRANSFER_READ_BIT
                                    | VK_ACCESS_2_TRANSFER_WRITE_BIT};
    const VkCommandBuffer buffer = c->commands.buffer;
    for (int i = 0; i < 2; i++)
        crv__record_layout(d, buffer, c->images[i].image, VK_IMAGE_LAYOUT_UNDEFINED,
                           VK_IMAGE_LAYOUT_GENERAL, CRV__EARLIER, copies);
    crv__stopwatch_start(&c->watch, d, buffer);
    for (int i = 0; i < COPIES; i++) {
        d->vk.CmdCopyImage(buffer, c->images[i % 2].image, VK_IMAGE_LAYOUT_GENERAL,
                           c->images[1 - i % 2].image, VK_IMAGE_LAYOUT_GENERAL, 1,
                           &whole);
        crv__record_barrier(d, buffer, copies, copies);
    }
    crv__stopwatch_stop(&c->watch, d, buffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
}

static crv_status run(copying *c, const crv__device *d, double *seconds)
{
    crv_status status = crv__commands_begin(&c->commands, d);
    if (status)
        return status;
    record(c, d);
    status = crv__commands_run(&c->commands, d);
    return status ? status : crv__stopwatch_read(&c->watch, d, seconds);
}

crv_status crv__device_bandwidth(crv_context *context, double *bytes_per_s)
{
    const crv__device *d = crv__device_of(context);
    const double bytes = 2.0 * COPIES * EDGE * EDGE * TEXEL;
    copying c = {0};
    double best = 0;
    crv_status status = create(&c, d);
    for (int i = 0; i < REPEATS && status == CRV_OK; i++) {
        double seconds = 0;
        status = run(&c, d, &seconds);
        if (status == CRV_OK && seconds > 0 && bytes / seconds > best)
            best = bytes / seconds;
    }
    destroy(&c, d);
    if (status == CRV_OK)
        *bytes_per_s = best;
    return status;
}

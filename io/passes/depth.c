/* SPDX-License-Identifier: MIT */
#include "depth.h"

#include "internal.h"

int io__convert_depth(const char *path, const crv_depth_format *format, io_frame *frame,
                      const crv_logger *log)
{
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    if (log)
        desc.logger = *log;
    crv_status status = crv_context_create(&desc, &context);
    if (status == CRV_OK)
        status = crv_gbuffer_create(context, &frame->desc, &gbuffer);
    if (status == CRV_OK)
        status = crv_gbuffer_set_camera(gbuffer, &frame->camera);
    for (int32_t i = 0; status == CRV_OK && i < frame->desc.layers; i++) {
        const crv_const_image depth = crv_image_const(frame->depth[i]);
        status = crv_gbuffer_set_depth(gbuffer, i, &depth, format);
        if (status == CRV_OK)
            status = crv_gbuffer_get_depth(gbuffer, i, &frame->depth[i]);
    }
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
    if (status == CRV_ERROR_OUT_OF_MEMORY)
        return io__fail(log, path,
                        "no memory to convert its depth; close other programs");
    return status == CRV_OK ? 0 : -1;
}

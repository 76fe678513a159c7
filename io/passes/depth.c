/* SPDX-License-Identifier: MIT */
#include "depth.h"

int io__convert_depth(const crv_depth_format *format, io_frame *frame,
                      const crv_logger *log)
{
    crv_status status = CRV_OK;
    for (int32_t i = 0; status == CRV_OK && i < frame->desc.layers; i++) {
        const crv_const_image depth = crv_image_const(frame->depth[i]);
        status = crv_depth_convert(&depth, format, &frame->camera, &frame->depth[i], log);
    }
    return status == CRV_OK ? 0 : -1;
}

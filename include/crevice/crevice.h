/* SPDX-License-Identifier: MIT */
/*
 * Crevice: ambient occlusion from depth and normal buffers.
 *
 * Give it the depth of a frame (planar, radial, or straight from a depth buffer), normals
 * if there are any, and the camera; get accessibility back, a float for each pixel: 1 is
 * open, 0 is fully occluded. It sees what the depth layers hold and nothing else: what is
 * hidden behind the first surface or lies outside the image does not occlude unless a
 * further layer or a guard band brings it. It renders nothing, loads no files, and keeps
 * no global state.
 *
 *     crv_context *context = NULL;
 *     crv_gbuffer *gbuffer = NULL;
 *     crv_plan *plan = NULL;
 *     crv_gbuffer_desc desc;
 *     crv_options options;
 *
 *     crv_gbuffer_desc_init(&desc, sizeof desc, width, height);
 *     crv_options_init(&options, sizeof options, "hbao");
 *     options.radius = 0.5f;                                  // scene units
 *     crv_context_create(NULL, &context);
 *     crv_gbuffer_create(context, &desc, &gbuffer);
 *     crv_plan_create(context, &options, &desc, &plan);
 *
 *     // for each frame
 *     crv_camera camera = crv_camera_perspective(width, height, vfov_rad);
 *     crv_image depth_image = crv_image_packed(depth, width, height, 1);
 *     crv_image result = crv_image_packed(accessibility, width, height, 1);
 *     crv_gbuffer_set_camera(gbuffer, &camera);
 *     crv_gbuffer_set_depth(gbuffer, 0, &depth_image, NULL);  // planar linear depth
 *     crv_plan_run(plan, gbuffer, &result);
 *
 * Every call returns a crv_status; check it. The reason for a failure goes to the
 * context's logger as one line. Memory is taken when objects are made and when a
 * G-buffer is first given a kind of data, never in crv_plan_run(). A context and what was
 * made with it serve one thread at a time; inside, work runs in parallel.
 */
#ifndef CREVICE_H
#define CREVICE_H

#include "ao.h"
#include "base.h"
#include "camera.h"
#include "context.h"
#include "gbuffer.h"
#include "image.h"
#include "options.h"

#endif

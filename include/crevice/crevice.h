/* SPDX-License-Identifier: MIT */
/*
 * Crevice: ambient occlusion from depth and normal buffers. The short way:
 *
 *     crv_camera camera = crv_camera_perspective(width, height, vfov_rad);
 *     crv_const_image depth_image = crv_const_image_packed(depth, width, height, 1);
 *     crv_image result = crv_image_packed(accessibility, width, height, 1);
 *     crv_ao(&depth_image, NULL, &camera, NULL, &result, NULL);
 *
 * depth is planar, in scene units (crv_depth_convert() for others). accessibility gets a
 * float for each pixel: 1 is open, 0 is fully occluded. The long way takes memory once
 * for all frames:
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
 *     crv_gbuffer_set_camera(gbuffer, &camera);
 *     crv_gbuffer_set_depth(gbuffer, 0, &depth_image, NULL);
 *     crv_plan_run(plan, gbuffer, &result);
 *
 * A renderer has a projection matrix and a depth buffer: standard, reversed, infinite,
 * jittered. They are given so:
 *
 *     crv_camera_from_projection(&camera, matrix, layout, width, height, NULL);
 *     crv_depth_format_from_projection(&format, matrix, layout, clip_range, NULL);
 *     crv_gbuffer_set_camera(gbuffer, &camera);
 *     crv_gbuffer_set_depth(gbuffer, 0, &depth_image, &format);
 *
 * After a resize make a new G-buffer and a new plan. Where things are: methods, filters
 * and options in options.h; bent normals: crv_plan_run_result(), context.h; a renderer's
 * own Vulkan device: vulkan.h, which this file does not include.
 *
 * Only what the depth layers show occludes. Surfaces that are hidden behind the first
 * one, or outside of the image, do not, unless a further layer or a guard band has them.
 *
 * Every call returns a crv_status; check it. The logger gets the reason for a failure as
 * one line. Memory is taken when objects are made and when a G-buffer first gets a kind
 * of data, never in crv_plan_run(). A context and everything made with it serve one
 * thread at a time; a call works in parallel inside. A host may end a run that takes long
 * (crv_progress, base.h). There is no global state.
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

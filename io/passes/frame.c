/* SPDX-License-Identifier: MIT */
#include "passes.h"

#include <math.h>
#include <string.h>

#include "camera.h"
#include "depth.h"
#include "evidence.h"
#include "internal.h"
#include "mixed.h"
#include "names.h"
#include "normals.h"
#include "positions.h"
#include "read.h"
#include "settle_depth.h"
#include "views.h"

static const float pi = 3.14159265358979f;

static int check_request(const char *path, const io_passes_request *request,
                         const crv_logger *log)
{
    const float vfov = request->vfov_rad != 0.0f ? request->vfov_rad : request->hfov_rad;
    const float height = request->view_height;
    if (request->vfov_rad != 0.0f && request->hfov_rad != 0.0f)
        return io__fail(log, path,
                        "both a vertical and a horizontal field of view are given; give "
                        "one of them");
    if (vfov != 0.0f && !(vfov > 0.0f && vfov < pi))
        return io__fail(log, path,
                        "the field of view must lie between 0 and 180 degrees; "
                        "give 60 or the like");
    if (height != 0.0f && !(height > 0.0f && isfinite(height)))
        return io__fail(log, path,
                        "the view height must be a positive number; give 10 or the like");
    if (request->fit_vfov && (vfov != 0.0f || height != 0.0f))
        return io__fail(log, path,
                        "a field of view is given and to be found; give it or leave it "
                        "out");
    if (vfov != 0.0f && height != 0.0f)
        return io__fail(log, path,
                        "both a field of view and an orthographic view height are given; "
                        "give one of them");
    return 0;
}

static bool is_our_gbuffer(const io_image *image)
{
    return !strncmp(image->made, "crevice ", 8) && strstr(image->made, " gbuffer");
}

/* Overscan becomes the guard band, unless it is kept; a data window inside the picture
 * moves the origin. */
static int set_desc(const char *path, const io_passes_request *request,
                    const io_image *image, int32_t layers, crv_gbuffer_desc *desc,
                    const crv_logger *log)
{
    const int64_t right = (int64_t)image->data_x + image->width - image->display_width;
    const int64_t bottom = (int64_t)image->data_y + image->height - image->display_height;
    const bool outside = image->data_x <= -(int64_t)image->width
                         || image->data_y <= -(int64_t)image->height
                         || right >= image->width || bottom >= image->height;
    crv_gbuffer_desc_init(desc, sizeof *desc, image->width, image->height);
    desc->layers = layers;
    if (request->keep_overscan && !is_our_gbuffer(image)) {
        desc->origin_x = image->data_x;
        desc->origin_y = image->data_y;
        if (outside)
            io__warn(log, path,
                     "its data window lies outside its display window: nothing of it is "
                     "seen");
        return 0;
    }
    if (outside)
        return io__fail(log, path,
                        "its data window lies outside its display window; nothing of it "
                        "is seen; render it again");
    desc->guard_left = image->data_x < 0 ? -image->data_x : 0;
    desc->guard_top = image->data_y < 0 ? -image->data_y : 0;
    desc->guard_right = right > 0 ? (int32_t)right : 0;
    desc->guard_bottom = bottom > 0 ? (int32_t)bottom : 0;
    desc->origin_x = image->data_x > 0 ? image->data_x : 0;
    desc->origin_y = image->data_y > 0 ? image->data_y : 0;
    if (desc->guard_left || desc->guard_top || desc->guard_right || desc->guard_bottom)
        io__info(log, path,
                 "overscan is used as guard band: %d left, %d top, %d right, "
                 "%d bottom",
                 (int)desc->guard_left, (int)desc->guard_top, (int)desc->guard_right,
                 (int)desc->guard_bottom);
    return 0;
}

static void settle_mixed(const char *path, io_frame *frame, const crv_logger *log)
{
    const int64_t mixed = io__settle_mixed(frame);
    if (mixed > 0)
        io__info(log, path,
                 "%lld pixels are mixed from two surfaces, as by antialiasing: each is "
                 "given to one of them",
                 (long long)mixed);
}

/* The cameras that may have made the frame, the likeliest first: how many, or -1. */
static int settle_cameras(const char *path, const io_passes_request *request,
                          const io__pass_names *names, io_frame *frame,
                          io__camera_guess cameras[IO__MAX_CAMERAS],
                          const crv_logger *log)
{
    const int count = io__find_cameras(path, &frame->image, request, cameras, log);
    io__camera_guess fitted;
    if (!names->position[0])
        return count ? count : io__fail_camera(path, request, log);
    if (io__settle_positions(path, request, frame, cameras, count, &fitted, log))
        return -1;
    cameras[0] = fitted;
    return 1;
}

/* Axes that the user flipped are those of the file again. */
static void settle_spaces(const io_passes_request *request, const io__verdict *verdict,
                          io_frame *frame)
{
    const io__reading *reading = &verdict->reading;
    for (int i = 0; i < 9; i++) {
        const double identity = i % 4 == 0 ? 1.0 : 0.0;
        const double turn = reading->id ? reading->turn[i] : identity;
        const bool flipped = reading->id && request->flip_normals[i % 3];
        frame->normals_to_view[i] = flipped ? -turn : turn;
    }
    frame->normals_in_world =
        reading->id == IO__READ_METADATA || reading->id >= IO__READ_AXES;
    frame->has_world = frame->normals_in_world || verdict->camera.has_rotation;
    memcpy(frame->world_to_view,
           frame->normals_in_world ? frame->normals_to_view : verdict->camera.to_view,
           sizeof frame->world_to_view);
}

static int settle(const char *path, const io_passes_request *request,
                  const io__pass_names *names, io_frame *frame, const crv_logger *log)
{
    io__camera_guess cameras[IO__MAX_CAMERAS];
    io__verdict verdict;
    io__depth_facts facts;
    const bool given_normals = names->normal[0];
    const int count = settle_cameras(path, request, names, frame, cameras, log);
    if (count < 0)
        return -1;
    for (int32_t i = 0; i < names->layers; i++)
        frame->depth[i] = io_image_view(&frame->image, i, 1);
    if (given_normals) {
        frame->normals = io_image_view(&frame->image, io__depth_channels(names), 3);
        io__decode_normals(path, request, frame, log);
    }
    const crv_depth_format format =
        io__settle_format(path, request, frame, given_normals, &facts, log);
    if (io__judge(path, request, &format, cameras, count, given_normals, frame, &verdict,
                  log))
        return -1;
    io__tell_of_unit_range(path, request, &facts, given_normals, &verdict, log);
    frame->camera = verdict.camera.camera;
    frame->deviation = verdict.reading.deviation;
    frame->zooms = verdict.zooms;
    if (verdict.camera.needs_lens)
        frame->fitted_vfov_rad =
            2.0f * atanf(0.5f * (float)frame->image.display_height / frame->camera.fy_px);
    frame->encoding = verdict.format.encoding;
    if (verdict.camera.has_rotation && io__is_rotation(verdict.camera.to_view))
        for (int i = 0; i < 9; i++)
            frame->camera.world_to_view[i] = (float)verdict.camera.to_view[i];
    settle_mixed(path, frame, log);
    settle_spaces(request, &verdict, frame);
    if (verdict.reading.id)
        io__apply_reading(&verdict.reading, frame);
    io__info(log, path, "camera: %s, %s", verdict.camera.text,
             frame->camera.projection == CRV_PERSPECTIVE ? "perspective"
                                                         : "orthographic");
    return 0;
}

int io_frame_load(const char *path, const io_passes_request *request, io_frame *out,
                  const crv_logger *log)
{
    io_image probed = {0};
    io__pass_names names;
    io_frame frame;
    memset(&frame, 0, sizeof frame);
    if (check_request(path, request, log) || io_probe(path, &probed, log))
        return -1;
    int result = io__keep_view(path, request, &probed, log);
    if (!result)
        result = io__choose_passes(path, &probed, request, &names, log);
    if (!result)
        result = io__read_passes(path, &names, request->watch, &frame.image, log);
    if (!result)
        result = set_desc(path, request, &frame.image, names.layers, &frame.desc, log);
    if (!result) {
        frame.desc.layer_kind = names.layer_kind;
        result = settle(path, request, &names, &frame, log);
    }
    io_image_free(&probed);
    if (result) {
        io_frame_free(&frame);
        return -1;
    }
    *out = frame;
    return 0;
}

void io_frame_free(io_frame *frame)
{
    if (!frame)
        return;
    io_image_free(&frame->image);
    memset(frame, 0, sizeof *frame);
}

crv_status io_frame_to_gbuffer(const io_frame *frame, struct crv_context *context,
                               crv_gbuffer **gbuffer)
{
    crv_gbuffer *made = *gbuffer;
    crv_status status = CRV_OK;
    if (!made)
        status = crv_gbuffer_create(context, &frame->desc, &made);
    if (status == CRV_OK)
        status = crv_gbuffer_set_camera(made, &frame->camera);
    for (int32_t i = 0; status == CRV_OK && i < frame->desc.layers; i++) {
        const crv_const_image depth = crv_image_const(frame->depth[i]);
        status = crv_gbuffer_set_depth(made, i, &depth, NULL);
    }
    const crv_const_image normals = crv_image_const(frame->normals);
    if (status == CRV_OK && frame->has_normals)
        status = crv_gbuffer_set_normals(made, &normals, frame->normal_space);
    if (status == CRV_OK)
        *gbuffer = made;
    else if (!*gbuffer)
        crv_gbuffer_destroy(made);
    return status;
}

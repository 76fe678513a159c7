/* SPDX-License-Identifier: MIT */
#include "passes.h"

#include <math.h>
#include <string.h>

#include "depth.h"
#include "internal.h"
#include "ndc.h"
#include "names.h"
#include "normals.h"

/* Blender writes this if a ray met nothing; no renderer writes more for a surface. */
static const float usual_background = 1e10f;
static const float pi = 3.14159265358979f;

static int check_request(const char *path, const io_passes_request *request,
                         const crv_logger *log)
{
    const float vfov = request->vfov_rad, height = request->view_height;
    if (vfov != 0.0f && !(vfov > 0.0f && vfov < pi))
        return io__fail(log, path,
                        "the vertical field of view must lie between 0 and 180 degrees; "
                        "give 60 or the like");
    if (height != 0.0f && !(height > 0.0f && isfinite(height)))
        return io__fail(log, path,
                        "the view height must be a positive number; give 10 or the like");
    if (vfov != 0.0f && height != 0.0f)
        return io__fail(log, path,
                        "both a field of view and an orthographic view height are given; "
                        "give one of them");
    return 0;
}

/* The camera of the display window, and whether its rotation is known. */
static int find_camera(const char *path, const io_image *probed,
                       const io_passes_request *request, crv_camera *camera,
                       bool *has_rotation, const crv_logger *log)
{
    const int32_t width = probed->display_width, height = probed->display_height;
    const io_camera_metadata *metadata = &probed->camera;
    crv_camera described;
    float rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const bool has_camera = !io__camera_from_ndc(metadata, width, height, &described);
    *has_rotation = has_camera;
    if (has_camera)
        memcpy(rotation, described.world_to_view, sizeof rotation);
    else if (metadata->has_world_to_camera)
        *has_rotation =
            !io__rotation_from_world_to_camera(metadata->world_to_camera, rotation);
    if (metadata->has_world_to_ndc && !has_camera)
        io__warn(log, path, "its worldToNDC metadata is no projection; it is ignored");
    if (request->vfov_rad > 0.0f)
        *camera = crv_camera_perspective(width, height, request->vfov_rad);
    else if (request->view_height > 0.0f)
        *camera = crv_camera_orthographic(width, height, request->view_height);
    else if (has_camera)
        *camera = described;
    else
        return io__fail(log, path, "does not say which camera made it; %s",
                        request->remedies.camera
                            ? request->remedies.camera
                            : "give its field of view, or the height of an orthographic "
                              "view");
    if (request->vfov_rad > 0.0f || request->view_height > 0.0f)
        camera->fx_px /= probed->pixel_aspect;
    else
        io__info(log, path, "camera: from worldToNDC metadata, %s",
                 camera->projection == CRV_PERSPECTIVE ? "perspective" : "orthographic");
    memcpy(camera->world_to_view, rotation, sizeof rotation);
    return 0;
}

static bool same_window(const io_image *a, const io_image *b)
{
    return a->width == b->width && a->height == b->height && a->data_x == b->data_x
           && a->data_y == b->data_y;
}

/* For files whose parts were cropped one by one: depth decides the window. */
static int read_apart(const char *path, const char *const *names, int32_t layers,
                      int32_t count, io_image *out, const crv_logger *log)
{
    io_image depth = {0}, normals = {0}, both = {0};
    if (io_read(path, names, layers, &depth, log))
        return -1;
    int result = io_read(path, names + layers, count - layers, &normals, log);
    if (!result)
        result = io_image_init(&both, depth.width, depth.height, names, count, log);
    if (!result) {
        io_channel *channels = both.channels;
        both = depth;
        both.channels = channels;
        both.channel_count = count;
        for (int32_t i = 0; i < count; i++) {
            const io_image *from = i < layers ? &depth : &normals;
            /* The rest stays zero, which is "no normal here". */
            io_copy_window(from, from->channels[i < layers ? i : i - layers].data, &both,
                           channels[i].data);
        }
        if (!same_window(&depth, &normals))
            io__info(log, path,
                     "normals lie in another data window than depth; they are "
                     "used where they overlap");
        *out = both;
    }
    io_image_free(&depth);
    io_image_free(&normals);
    return result;
}

static int read_passes(const char *path, const io__pass_names *chosen, io_image *out,
                       const crv_logger *log)
{
    const char *names[CRV_MAX_LAYERS + 3];
    int32_t count = 0;
    for (int32_t i = 0; i < chosen->layers; i++)
        names[count++] = chosen->depth[i];
    if (!chosen->normal[0])
        return io_read(path, names, count, out, log);
    for (int c = 0; c < 3; c++)
        names[count++] = chosen->normal[c];
    if (!io_read(path, names, count, out, NULL))
        return 0;
    return read_apart(path, names, chosen->layers, count, out, log);
}

static crv_image view_of(const io_image *image, int32_t first, int32_t channels)
{
    const ptrdiff_t row = (ptrdiff_t)image->width * (ptrdiff_t)sizeof(float);
    return (crv_image){.data = image->channels[first].data,
                       .width = image->width,
                       .height = image->height,
                       .channels = channels,
                       .row_stride = row,
                       .pixel_stride = sizeof(float),
                       .channel_stride = row * image->height};
}

/* Overscan becomes the guard band; a data window inside the picture moves the origin. */
static int set_desc(const char *path, const io_image *image, int32_t layers,
                    crv_gbuffer_desc *desc, const crv_logger *log)
{
    const int64_t right = (int64_t)image->data_x + image->width - image->display_width;
    const int64_t bottom = (int64_t)image->data_y + image->height - image->display_height;
    crv_gbuffer_desc_init(desc, sizeof *desc, image->width, image->height);
    if (image->data_x <= -(int64_t)image->width
        || image->data_y <= -(int64_t)image->height || right >= image->width
        || bottom >= image->height)
        return io__fail(log, path,
                        "its data window lies outside its display window; nothing of it "
                        "is seen; render it again");
    desc->layers = layers;
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

static crv_depth_format settle_format(const io_passes_request *request)
{
    crv_depth_format format = request->depth_format;
    const bool is_distance =
        format.encoding == CRV_DEPTH_PLANAR || format.encoding == CRV_DEPTH_RADIAL;
    /* 0 is what a zeroed request holds; it would make everything background. */
    if (is_distance && (isinf(format.background) || format.background == 0.0f))
        format.background = usual_background;
    return format;
}

static void tell_of_half(const char *path, const io_image *probed, const char *depth,
                         const crv_logger *log)
{
    const io_channel *channel = io_image_find(probed, depth);
    if (channel && channel->is_half)
        io__info(
            log, path,
            "depth \"%s\" is stored in half floats, whose steps darken flat surfaces "
            "far away; write it in 32-bit floats",
            depth);
}

int io_frame_load(const char *path, const io_passes_request *request, io_frame *out,
                  const crv_logger *log)
{
    io_image probed = {0};
    io__pass_names names;
    io_frame frame;
    crv_camera camera;
    bool has_rotation = false;
    memset(&frame, 0, sizeof frame);
    if (check_request(path, request, log) || io_probe(path, &probed, log))
        return -1;
    if (io__choose_passes(path, &probed, request, &names, log)
        || find_camera(path, &probed, request, &camera, &has_rotation, log)
        || read_passes(path, &names, &frame.image, log)
        || set_desc(path, &frame.image, names.layers, &frame.desc, log)) {
        io_image_free(&probed);
        io_frame_free(&frame);
        return -1;
    }
    tell_of_half(path, &probed, names.depth[0], log);
    io_image_free(&probed);
    frame.desc.layer_kind = names.layer_kind;
    const bool given_normals = names.normal[0] != NULL;
    frame.camera = crv_camera_crop(&camera, frame.image.data_x, frame.image.data_y);
    for (int32_t i = 0; i < names.layers; i++)
        frame.depth[i] = view_of(&frame.image, i, 1);
    const crv_depth_format format = settle_format(request);
    if (io__convert_depth(&format, &frame, log)) {
        io_frame_free(&frame);
        return -1;
    }
    if (given_normals) {
        frame.normals = view_of(&frame.image, names.layers, 3);
        io__settle_normals(path, request->normal_space, has_rotation, &frame, log);
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

/* SPDX-License-Identifier: MIT */
#include "passes.h"

#include <math.h>
#include <string.h>

#include "camera.h"
#include "depth.h"
#include "evidence.h"
#include "halves.h"
#include "internal.h"
#include "mixed.h"
#include "names.h"
#include "normals.h"
#include "positions.h"
#include "trial.h"
#include "views.h"

/* Blender writes this if a ray met nothing; no renderer writes more for a surface. */
static const float usual_background = 1e10f;
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

/* How many channels of the image depth or positions take. */
static int32_t depth_channels(const io__pass_names *chosen)
{
    return chosen->position[0] ? 3 : chosen->layers;
}

static int read_passes(const char *path, const io__pass_names *chosen, io_image *out,
                       const crv_logger *log)
{
    const char *names[CRV_MAX_LAYERS + 3];
    int32_t count = depth_channels(chosen);
    memcpy(names, chosen->position[0] ? chosen->position : chosen->depth,
           (size_t)count * sizeof *names);
    if (!chosen->normal[0])
        return io_read(path, names, count, out, log);
    for (int c = 0; c < 3; c++)
        names[count++] = chosen->normal[c];
    if (!io_read(path, names, count, out, NULL))
        return 0;
    return read_apart(path, names, depth_channels(chosen), count, out, log);
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

static bool is_distance(crv_depth_encoding encoding)
{
    return encoding == CRV_DEPTH_PLANAR || encoding == CRV_DEPTH_RADIAL;
}

/* Depth along -z, as view space has it, is positive depth. */
static void negate_depth(const char *path, io_frame *frame, const crv_logger *log)
{
    for (int32_t i = 0; i < frame->desc.layers; i++) {
        float *data = frame->depth[i].data;
        for (size_t k = 0; k < (size_t)frame->desc.width * (size_t)frame->desc.height;
             k++)
            data[k] = -data[k];
    }
    io__info(log, path,
             "depth is negative everywhere, as z of view space; it is negated");
}

/* Steps of half floats darken flat surfaces far away. */
static void smooth_halves(const char *path, const io_passes_request *request,
                          const io_frame *frame, const crv_logger *log)
{
    for (int32_t i = 0; i < frame->desc.layers; i++)
        if (io__smooth_halves(&frame->depth[i])) {
            io__warn(
                log, path,
                "depth holds nothing but half floats, and there is no memory to take "
                "their steps out; write it in 32-bit floats");
            return;
        }
    if (request->is_later)
        return;
    io__warn(
        log, path,
        "depth holds nothing but half floats: their steps are smoothed, detail below "
        "them is lost; write it in 32-bit floats");
}

/* The format that depth is read in, with the background that its numbers tell. */
static crv_depth_format settle_format(const char *path, const io_passes_request *request,
                                      io_frame *frame, bool has_normals,
                                      io__depth_facts *settled, const crv_logger *log)
{
    crv_depth_format format = request->depth_format;
    const crv_image *normals = has_normals ? &frame->normals : NULL;
    /* 0 is what a zeroed request holds; it would make everything background. */
    const bool find_background =
        is_distance(format.encoding)
        && (isinf(format.background) || format.background == 0.0f);
    if (find_background)
        format.background = usual_background;
    const float limit = find_background ? usual_background : INFINITY;
    io__depth_facts facts = io__depth_facts_of(&frame->depth[0], normals, limit);
    if (is_distance(format.encoding) && facts.count && facts.largest <= 0.0f
        && facts.smallest < 0.0f) {
        negate_depth(path, frame, log);
        facts = io__depth_facts_of(&frame->depth[0], normals, limit);
    }
    *settled = facts;
    if (facts.is_half && is_distance(format.encoding))
        smooth_halves(path, request, frame, log);
    if (find_background && io__largest_is_sky(&facts)) {
        format.background = facts.largest;
        io__info(log, path, "depth from %g on is background: %zu pixels hold just that",
                 (double)facts.largest, facts.at_largest);
    }
    return format;
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

/* Directions do not tell how far the planes are, nor can smoothness tell much. */
static void tell_of_unit_range(const char *path, const io_passes_request *request,
                               const io__depth_facts *facts, bool has_normals,
                               const io__verdict *verdict, const crv_logger *log)
{
    const bool fits =
        has_normals && verdict->reading.id && verdict->reading.deviation < IO__DOUBTFUL;
    const bool ends_at_1 = facts->largest == 1.0f && facts->at_largest < facts->count;
    const bool begins_at_0 =
        facts->smallest == 0.0f && facts->largest < 1.0f && !has_normals;
    if (verdict->encoding_told || request->encoding_given || request->is_later
        || !is_distance(request->depth_format.encoding) || facts->smallest < -1.0f
        || !(ends_at_1 || begins_at_0))
        return;
    io__warn(log, path, "depth lies between %g and %g%s but is read as distances; %s",
             (double)facts->smallest, (double)facts->largest,
             fits ? ", and its normals agree: it is normalised, 0 near the eye and 1 at "
                    "far,"
                  : ": it looks normalised, or like a depth buffer,",
             request->remedies.encoding ? request->remedies.encoding
                                        : "say what its numbers mean");
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
        frame->depth[i] = view_of(&frame->image, i, 1);
    if (given_normals) {
        frame->normals = view_of(&frame->image, depth_channels(names), 3);
        io__decode_normals(path, request, frame, log);
    }
    const crv_depth_format format =
        settle_format(path, request, frame, given_normals, &facts, log);
    if (io__judge(path, request, &format, cameras, count, given_normals, frame, &verdict,
                  log))
        return -1;
    tell_of_unit_range(path, request, &facts, given_normals, &verdict, log);
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
        result = read_passes(path, &names, &frame.image, log);
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

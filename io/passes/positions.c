/* SPDX-License-Identifier: MIT */
#include "positions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cloud.h"
#include "depth.h"
#include "internal.h"
#include "pairs.h"
#include "projection.h"

/* Pixels. Up to the first the points are where the camera sees them, for samples lie
 * anywhere in their pixels; beyond the second this is no camera. */
static const double exact_px = 0.3, worst_px = 1.0;

/* Of a focal length: what no rounding explains. */
static const double other_lens = 0.01;

/* Camera space in one of its handednesses. */
static bool fit_camera_space(const io__points *points, bool orthographic,
                             io__projection *out)
{
    static const double origin[3] = {0, 0, 0};
    double z = 0.0; /* what is seen lies on one side of the eye */
    for (size_t i = 0; i < points->count; i++)
        z += points->position[i][2] > 0.0 ? 1.0 : -1.0;
    for (int flips = z > 0.0 ? 1 : 0; flips < 8; flips += 2) {
        const double to_view[9] = {
            flips & 2 ? -1 : 1, 0, 0, 0, flips & 4 ? -1 : 1, 0, 0, 0, flips & 1 ? -1 : 1};
        if (!io__fit_lens(points, orthographic, to_view, origin, out)
            && out->error_px < exact_px)
            return true;
    }
    return false;
}

static bool fit_posed(const io__points *points, const io_pose *pose, bool orthographic,
                      io__projection *out)
{
    return pose->given
           && !io__fit_lens(points, orthographic, pose->to_view, pose->eye, out)
           && out->error_px < worst_px;
}

/* The pose of worldToCamera, whose third axis may point either way. */
static io_pose pose_of_metadata(const io_image *image, const io__camera_guess *known)
{
    io_pose pose = {.given = image->camera.has_world_to_camera && known->has_rotation};
    const float *m = image->camera.world_to_camera;
    for (int row = 0; row < 3 && pose.given; row++) {
        const double *axis = known->to_view + 3 * row;
        double along = 0.0;
        memcpy(pose.to_view + 3 * row, axis, 3 * sizeof *axis);
        for (int k = 0; k < 3; k++)
            along += axis[k] * (double)m[4 * k + row];
        for (int k = 0; k < 3; k++)
            pose.eye[k] -= axis[k] * (double)m[12 + row] / along;
    }
    return pose;
}

static bool is_orthographic(const io__camera_guess *known)
{
    return known && known->camera.projection == CRV_ORTHOGRAPHIC;
}

/* The camera of the points, and in words where it comes from; NULL: they leave it open.
 */
static const char *fit(const io__points *points, const io_passes_request *request,
                       const io_image *image, const io__camera_guess *known,
                       io__projection *out)
{
    const bool orthographic = is_orthographic(known);
    if (fit_camera_space(points, orthographic, out)
        || (!known && fit_camera_space(points, true, out)))
        return "positions in camera space";
    if (fit_posed(points, &request->pose, orthographic, out))
        return "positions in world space and the given camera's place";
    const io_pose pose = known ? pose_of_metadata(image, known) : (io_pose){0};
    if (!request->pose.given && fit_posed(points, &pose, orthographic, out))
        return "positions in world space and worldToCamera metadata";
    return !io__fit_camera(points, out) && out->error_px < worst_px
               ? "positions in world space"
               : NULL;
}

static crv_camera camera_of(const io__projection *p)
{
    crv_camera camera = {.projection =
                             p->orthographic ? CRV_ORTHOGRAPHIC : CRV_PERSPECTIVE,
                         .fx_px = (float)p->fx_px,
                         .fy_px = (float)p->fy_px,
                         .cx_px = (float)p->cx_px,
                         .cy_px = (float)p->cy_px};
    for (int i = 0; i < 9; i++)
        camera.world_to_view[i] = i % 4 == 0 ? 1.0f : 0.0f;
    return camera;
}

/* In words what a camera sees of the display window. */
static void describe(const io_image *image, const crv_camera *camera, char *out,
                     size_t size)
{
    const double height = (double)image->display_height / (double)camera->fy_px;
    if (camera->projection == CRV_ORTHOGRAPHIC)
        snprintf(out, size, "an orthographic view of height %.4g", height);
    else
        snprintf(out, size, "a vertical field of view of %.2f degrees",
                 2.0 * atan(0.5 * height) * 57.29577951308232);
}

static bool agrees(const io_image *image, const crv_camera *fitted,
                   const crv_camera *known)
{
    const double off = fabs((double)(fitted->cx_px - known->cx_px));
    const bool same_centre = off < 0.01 * image->display_width;
    return fitted->projection == known->projection
           && fabs((double)(fitted->fy_px / known->fy_px) - 1.0) < other_lens
           && fabs((double)(fitted->fx_px / known->fx_px) - 1.0) < other_lens
           && (same_centre || fitted->projection == CRV_ORTHOGRAPHIC);
}

/* What the caller says and positions deny is refused; metadata that they deny are told.
 */
static int compare_cameras(const char *path, const io_passes_request *request,
                           const io_image *image, const crv_camera *fitted,
                           const io__camera_guess *known, int count,
                           const crv_logger *log)
{
    const bool is_given = request->vfov_rad > 0.0f || request->hfov_rad > 0.0f
                          || request->view_height > 0.0f;
    char text[2][64];
    for (int i = 0; i < count; i++)
        if (agrees(image, fitted, &known[i].camera))
            return 0;
    if (!count)
        return 0;
    describe(image, fitted, text[0], sizeof text[0]);
    describe(image, &known[0].camera, text[1], sizeof text[1]);
    if (is_given)
        return io__fail(log, path,
                        "its positions were seen with %s, not with %s as given; leave "
                        "that out",
                        text[0], text[1]);
    io__warn(log, path,
             "its positions were seen with %s, but its metadata say %s; that of the "
             "positions is taken",
             text[0], text[1]);
    return 0;
}

/* Depth for the first channel. Returns how many positions are left out, because they are
 * not seen where they stand. */
static size_t write_depth(const io_image *image, const io__projection *p)
{
    const double limit_px = fmax(4.0 * worst_px, 10.0 * p->error_px);
    size_t left_out = 0;
    for (int32_t y = 0; y < image->height; y++)
        for (int32_t x = 0; x < image->width; x++) {
            const size_t i = (size_t)y * (size_t)image->width + (size_t)x;
            const double pixel[2] = {x + 0.5, y + 0.5};
            float position[3];
            double exact[3], depth = 0.0;
            io__load_position(image, i, position);
            for (int c = 0; c < 3; c++) {
                exact[c] = (double)position[c];
                depth -= p->to_view[6 + c] * (exact[c] - p->eye[c]);
            }
            const bool surface = io__is_position(position);
            const bool seen =
                surface && io__projection_error_at(p, exact, pixel) < limit_px;
            left_out += surface && !seen;
            image->channels[0].data[i] = seen ? (float)depth : INFINITY;
        }
    return left_out;
}

/* An orthographic eye may stand anywhere on its axis: before all points. */
static void step_back(const io__points *points, io__projection *p)
{
    double nearest = INFINITY, farthest = -INFINITY;
    for (size_t i = 0; i < points->count; i++) {
        double depth = 0.0;
        for (int c = 0; c < 3; c++)
            depth -= p->to_view[6 + c] * (points->position[i][c] - p->eye[c]);
        nearest = fmin(nearest, depth);
        farthest = fmax(farthest, depth);
    }
    const double back = nearest > 0.0 ? 0.0 : farthest - nearest - nearest;
    for (int c = 0; c < 3; c++)
        p->eye[c] += back * p->to_view[6 + c];
}

static bool are_halves(const io_frame *frame)
{
    for (int c = 0; c < 3; c++) {
        const crv_image plane = crv_image_packed(
            frame->image.channels[c].data, frame->image.width, frame->image.height, 1);
        if (!io__depth_facts_of(&plane, NULL, IO__NOWHERE).is_half)
            return false;
    }
    return true;
}

static int settle(const char *path, const io_passes_request *request, io_frame *frame,
                  const io__camera_guess *known, int count, const io__points *points,
                  io__camera_guess *out, const crv_logger *log)
{
    const io_image *image = &frame->image;
    io__projection p;
    const char *text = fit(points, request, image, count ? &known[0] : NULL, &p);
    if (!text)
        return io__fail(log, path,
                        "its positions do not tell which camera saw them: they lie in "
                        "one plane, are few, or blurred; give the camera's place and "
                        "lens, or take a depth pass");
    const crv_camera camera = camera_of(&p);
    if (compare_cameras(path, request, image, &camera, known, count, log))
        return -1;
    *out = (io__camera_guess){.camera = camera, .has_rotation = true, .text = text};
    memcpy(out->to_view, p.to_view, sizeof out->to_view);
    if (p.orthographic)
        step_back(points, &p);
    if (are_halves(frame) && !request->is_later)
        io__warn(log, path,
                 "positions hold nothing but half floats, whose steps darken flat "
                 "surfaces; write them in 32-bit floats");
    char lens[64];
    describe(image, &camera, lens, sizeof lens);
    io__info(log, path, "its positions were seen with %s (%.2f px off)", lens,
             p.error_px);
    const size_t left_out = write_depth(image, &p);
    if (left_out)
        io__info(
            log, path,
            "%zu positions are not seen at their pixels, as those that are mixed with "
            "nothing: they are left out",
            left_out);
    return 0;
}

/* Whether nothing is seen: then any camera will do. Depth becomes background. */
static bool settle_nothing(const io_image *image, const io__camera_guess *known,
                           int count, io__camera_guess *out)
{
    const int32_t width = image->width, height = image->height;
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++)
            if (io__is_position_at(image, x, y))
                return false;
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        image->channels[0].data[i] = INFINITY;
    *out = (io__camera_guess){.camera = crv_camera_perspective(width, height, 1.0f),
                              .text = "any, for nothing is seen"};
    if (count)
        *out = known[0];
    return true;
}

int io__settle_positions(const char *path, const io_passes_request *request,
                         io_frame *frame, const io__camera_guess *known, int count,
                         io__camera_guess *out, const crv_logger *log)
{
    const crv_image first = crv_image_packed(frame->image.channels[0].data,
                                             frame->image.width, frame->image.height, 1);
    io__cloud c = {0};
    /* The positions tell it better. */
    if (request->fit_vfov)
        count = 0;
    if (request->encoding_given && request->depth_format.encoding != CRV_DEPTH_PLANAR)
        return io__fail(log, path,
                        "its positions have no depth encoding; leave that out, or name a "
                        "depth channel");
    if (settle_nothing(&frame->image, known, count, out))
        return 0;
    int result = io__collect_positions(&frame->image, io__sampling_step(&first), &c);
    const io__points points = {(const double(*)[3])c.position,
                               (const double(*)[2])c.pixel, c.count};
    if (result)
        io__fail(log, path, "no memory for its positions; close other programs");
    else
        result = settle(path, request, frame, known, count, &points, out, log);
    free(c.position);
    free(c.pixel);
    return result;
}

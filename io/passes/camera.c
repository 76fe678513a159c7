/* SPDX-License-Identifier: MIT */
#include "camera.h"

#include <math.h>
#include <string.h>

#include "internal.h"
#include "ndc.h"

/* Rotation without a projection, from worldToCamera; false if it says nothing. */
static bool find_rotation(const io_camera_metadata *metadata, io__camera_guess *guess)
{
    float rotation[9];
    if (!metadata->has_world_to_camera || io__is_identity(metadata->world_to_camera)
        || io__rotation_from_world_to_camera(metadata->world_to_camera, rotation))
        return false;
    for (int i = 0; i < 9; i++)
        guess->to_view[i] = (double)rotation[i];
    return true;
}

static void tell_of_no_camera(const char *path, const io_camera_metadata *metadata,
                              const crv_logger *log)
{
    if (!metadata->has_world_to_ndc)
        return;
    if (io__is_identity(metadata->world_to_ndc))
        io__info(log, path,
                 "its worldToNDC metadata is the identity, which is no camera");
    else
        io__warn(log, path, "its worldToNDC metadata is no projection; it is ignored");
}

static crv_camera of_lens(const io_image *image, float hfov_rad, float vfov_rad)
{
    const int32_t width = image->display_width, height = image->display_height;
    crv_camera camera =
        crv_camera_perspective(width, height, vfov_rad > 0.0f ? vfov_rad : 1.0f);
    if (vfov_rad > 0.0f) {
        camera.fx_px = camera.fy_px / image->pixel_aspect;
    } else {
        camera.fx_px = 0.5f * (float)width / tanf(0.5f * hfov_rad);
        camera.fy_px = camera.fx_px * image->pixel_aspect;
    }
    return camera;
}

/* What an attribute of the file says, if no matrix does. */
static int find_lens(const char *path, const io_image *image, io__camera_guess *guess,
                     const crv_logger *log)
{
    const io_lens *lens = &image->lens;
    if (!(lens->hfov_rad > 0.0f) && !(lens->vfov_rad > 0.0f))
        return 0;
    *guess = (io__camera_guess){.camera = of_lens(image, lens->hfov_rad, lens->vfov_rad),
                                .text = "a field of view in the file's metadata"};
    guess->has_rotation = find_rotation(&image->camera, guess);
    io__info(log, path, "its attribute %s says a %s field of view of %.2f degrees",
             lens->source, lens->vfov_rad > 0.0f ? "vertical" : "horizontal",
             (double)(lens->vfov_rad > 0.0f ? lens->vfov_rad : lens->hfov_rad)
                 * 57.29577951308232);
    return 1;
}

/* What the caller says, with the rotation that the file says. */
static int find_given(const io_image *image, const io_passes_request *request,
                      const io__ndc_camera *described, io__camera_guess *guess)
{
    const int32_t width = image->display_width, height = image->display_height;
    *guess = (io__camera_guess){.text = "as given"};
    if (request->fit_vfov) {
        guess->camera = of_lens(image, 0.0f, 1.0f); /* to begin with */
        guess->text = "fitted to normals and depth";
        guess->needs_lens = true;
    } else if (request->hfov_rad > 0.0f || request->vfov_rad > 0.0f) {
        guess->camera = of_lens(image, request->hfov_rad, request->vfov_rad);
    } else {
        guess->camera = crv_camera_orthographic(width, height, request->view_height);
        guess->camera.fx_px /= image->pixel_aspect;
    }
    guess->has_rotation = described || find_rotation(&image->camera, guess);
    if (described)
        memcpy(guess->to_view, described->to_view, sizeof guess->to_view);
    return 1;
}

int io__fail_camera(const char *path, const io_passes_request *request,
                    const crv_logger *log)
{
    return io__fail(
        log, path, "does not say which camera made it; %s",
        request->remedies.camera
            ? request->remedies.camera
            : "give its field of view, or the height of an orthographic view");
}

int io__find_cameras(const char *path, const io_image *image,
                     const io_passes_request *request,
                     io__camera_guess out[IO__MAX_CAMERAS], const crv_logger *log)
{
    static const float identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    io__ndc_camera described[2];
    int count = io__cameras_from_ndc(&image->camera, image->display_width,
                                     image->display_height, described);
    const bool is_given = request->vfov_rad > 0.0f || request->hfov_rad > 0.0f
                          || request->view_height > 0.0f || request->fit_vfov;
    if (count == 0)
        tell_of_no_camera(path, &image->camera, log);
    if (is_given) {
        count = find_given(image, request, count ? &described[0] : NULL, &out[0]);
    } else if (count == 0 && find_lens(path, image, &out[0], log)) {
        count = 1;
    } else {
        for (int i = 0; i < count; i++) {
            out[i] = (io__camera_guess){.camera = described[i].camera,
                                        .has_rotation = true,
                                        .text = described[i].is_signed
                                                    ? "worldToNDC metadata from -1 to 1"
                                                    : "worldToNDC metadata from 0 to 1"};
            memcpy(out[i].to_view, described[i].to_view, sizeof out[i].to_view);
            memcpy(out[i].camera.world_to_view, identity, sizeof identity);
        }
    }
    for (int i = 0; i < count && request->pose.given; i++) {
        out[i].has_rotation = true;
        memcpy(out[i].to_view, request->pose.to_view, sizeof out[i].to_view);
    }
    for (int i = 0; i < count; i++)
        out[i].camera = crv_camera_crop(&out[i].camera, image->data_x, image->data_y);
    return count;
}

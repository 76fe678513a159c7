/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include <math.h>

enum { MAX_SIDE = 9, MAX_INPUT = 2048 };

static int32_t side(fuzz_bytes *in)
{
    return 1 + (int32_t)(fuzz_byte(in) % MAX_SIDE);
}

static crv_camera choose_camera(fuzz_bytes *in, int32_t width, int32_t height)
{
    const uint32_t kind = fuzz_byte(in);
    crv_camera c = kind & 1 ? crv_camera_perspective(width, height, 1.0f)
                            : crv_camera_orthographic(width, height, 4.0f);
    if ((kind & 6) == 6)
        c = crv_camera_crop(&c, (int32_t)fuzz_word(in), fuzz_int(in, 9));
    if ((kind & 24) == 24)
        c.fx_px = fuzz_float(in, 20.0f);
    return c;
}

static void convert_matrices(fuzz_bytes *in)
{
    float m[16], points[9];
    crv_camera camera;
    crv_depth_format format;
    for (int i = 0; i < 16; i++)
        m[i] = fuzz_byte(in) & 1 ? 0.0f : fuzz_float(in, 1.0f);
    const crv_matrix_layout layout = (crv_matrix_layout)(fuzz_byte(in) % 2);
    if (crv_camera_from_projection(&camera, m, layout, fuzz_int(in, 100),
                                   fuzz_int(in, 100), &fuzz_logger)
        == CRV_OK)
        FUZZ_CHECK(camera.fx_px > 0.0f && isfinite(camera.fx_px) && camera.fy_px > 0.0f
                       && isfinite(camera.fy_px),
                   "%g, %g", (double)camera.fx_px, (double)camera.fy_px);
    if (crv_depth_format_from_projection(
            &format, m, layout, (crv_clip_depth)(fuzz_byte(in) % 3), &fuzz_logger)
        == CRV_OK)
        FUZZ_CHECK(isfinite(format.z_near) && format.z_far > format.z_near,
                   "planes %g, %g", (double)format.z_near, (double)format.z_far);
    camera = crv_camera_perspective(1, 1, 1.0f);
    for (int i = 0; i < 9; i++)
        points[i] = fuzz_float(in, 1.0f);
    if (crv_camera_look_at(&camera, points, points + 3, points + 6) == CRV_OK)
        for (int i = 0; i < 9; i++)
            FUZZ_CHECK(isfinite(camera.world_to_view[i]), "row %d", i / 3);
}

static void convert_texels(fuzz_bytes *in)
{
    const int32_t width = side(in), height = side(in), channels = side(in);
    fuzz_texels from = fuzz_make_texels(in, width, height, channels);
    fuzz_pixels to = fuzz_make_pixels(in, width, height, channels);
    fuzz_spoil(in, &to.image);
    crv_image_convert(&from.texels, &to.image, &fuzz_logger);
    free(from.block);
    free(to.block);
}

static crv_depth_format choose_format(fuzz_bytes *in)
{
    crv_depth_format format = crv_depth_format_planar();
    format.encoding = (crv_depth_encoding)(fuzz_byte(in) % 10);
    format.z_near = fuzz_float(in, 0.1f);
    format.z_far = fuzz_float(in, 100.0f);
    if (fuzz_seldom(in, 4))
        format.background = fuzz_float(in, 100.0f);
    return format;
}

static void convert_depth(fuzz_bytes *in)
{
    const int32_t width = side(in), height = side(in);
    const crv_camera camera = choose_camera(in, width, height);
    const crv_depth_format format = choose_format(in);
    fuzz_pixels depth = fuzz_fill_pixels(in, width, height, 1, 2.0f);
    fuzz_pixels planar = fuzz_make_pixels(in, width, height, 1);
    crv_image given = depth.image;
    fuzz_spoil(in, &given);
    const crv_const_image image = crv_image_const(given);
    if (crv_depth_convert(&image, &format, &camera, &planar.image, &fuzz_logger)
        == CRV_OK)
        fuzz_check_pixels(&planar.image, 0.0f, INFINITY, "planar depth");
    free(depth.block);
    free(planar.block);
}

static crv_options choose_options(fuzz_bytes *in)
{
    crv_options o;
    const int32_t method = (int32_t)(fuzz_byte(in) % (uint32_t)crv_method_count());
    crv_options_init(&o, sizeof o, crv_method_at(method)->name);
    if (crv_options_preset(&o, (crv_preset)(fuzz_byte(in) % 8)) == CRV_OK)
        FUZZ_CHECK(crv_options_check(&o, NULL) == CRV_OK, "a preset of %s",
                   o.method->name);
    o.directions = o.steps = o.samples = 2;
    o.normal_rays = 1;
    o.radius = fuzz_float(in, 1.0f);
    o.max_radius_px = fuzz_float(in, 20.0f);
    return o;
}

static void estimate(fuzz_bytes *in)
{
    const int32_t width = side(in), height = side(in);
    const crv_camera camera = choose_camera(in, width, height);
    const crv_options o = choose_options(in);
    const int32_t guard = crv_guard_px(&o, &camera, fuzz_float(in, 1.0f));
    FUZZ_CHECK(guard >= 0 && guard <= CRV_MAX_SIZE, "%d px", guard);
    fuzz_pixels depth = fuzz_fill_pixels(in, width, height, 1, 2.0f);
    fuzz_pixels normals = fuzz_fill_pixels(in, width, height, 3, 0.5f);
    fuzz_pixels result = fuzz_make_pixels(in, width, height, 1);
    fuzz_spoil(in, &normals.image);
    const crv_const_image z = crv_image_const(depth.image),
                          n = crv_image_const(normals.image);
    if (crv_ao(&z, fuzz_seldom(in, 2) ? &n : NULL, &camera, &o, &result.image,
               &fuzz_logger)
        == CRV_OK)
        fuzz_check_pixels(&result.image, 0.0f, 1.0f, o.method->name);
    free(depth.block);
    free(normals.block);
    free(result.block);
}

void fuzz_convert(const uint8_t *data, size_t size)
{
    /* A picture takes as long as a hundred conversions. */
    static void (*const kinds[])(fuzz_bytes *) = {
        convert_matrices, convert_texels, convert_depth, convert_matrices,
        convert_matrices, convert_texels, convert_depth, estimate};
    fuzz_bytes in = {data, size};
    if (size >= 2 && size <= MAX_INPUT)
        kinds[fuzz_byte(&in) % 8](&in);
}

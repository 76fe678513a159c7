/* SPDX-License-Identifier: MIT */
/* From renderers' passes to frames: names, cameras, windows, spaces of normals. */
#include <math.h>
#include <sys/stat.h>

#include "passes/passes.h"
#include "test_io_support.h"

enum { W = 160, H = 120, PIXELS = W * H };

static const double pi = 3.14159265358979323846;
static const double vfov = 0.9; /* radians */

static double world_to_view[9];
static float depth[PIXELS];
static float world[3][PIXELS], view[3][PIXELS]; /* normals, planes */

static void set_look_at(const double eye[3], const double target[3], const double up[3])
{
    double *r = world_to_view, *u = r + 3, *b = r + 6, length = 0.0;
    for (int c = 0; c < 3; c++)
        length += (eye[c] - target[c]) * (eye[c] - target[c]);
    for (int c = 0; c < 3; c++)
        b[c] = (eye[c] - target[c]) / sqrt(length);
    for (int c = 0; c < 3; c++)
        r[c] = up[(c + 1) % 3] * b[(c + 2) % 3] - up[(c + 2) % 3] * b[(c + 1) % 3];
    length = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    for (int c = 0; c < 3; c++)
        r[c] /= length;
    for (int c = 0; c < 3; c++)
        u[c] = b[(c + 1) % 3] * r[(c + 2) % 3] - b[(c + 2) % 3] * r[(c + 1) % 3];
}

/* Three spheres before a background, as the pixel's ray meets them in view space. */
static void make_spheres(void)
{
    static const double centres[3][3] = {{-1.2, 0.2, -6}, {1.0, -0.3, -5}, {0.2, 1, -8}};
    static const double radius = 1.3;
    const double eye[3] = {3, 2, 5}, target[3] = {0, 0.5, -1}, up[3] = {0, 1, 0};
    const double f = 0.5 * H / tan(0.5 * vfov);
    set_look_at(eye, target, up);
    for (int i = 0; i < PIXELS; i++) {
        const double d[3] = {(i % W + 0.5 - 0.5 * W) / f, -(i / W + 0.5 - 0.5 * H) / f,
                             -1.0};
        depth[i] = 1e10f;
        for (int c = 0; c < 3; c++)
            world[c][i] = view[c][i] = 0.0f;
        for (int s = 0; s < 3; s++) {
            double dd = 0, dc = 0, cc = 0, n[3];
            for (int c = 0; c < 3; c++) {
                dd += d[c] * d[c];
                dc += d[c] * centres[s][c];
                cc += centres[s][c] * centres[s][c];
            }
            const double root = dc * dc - dd * (cc - radius * radius);
            const double t = root > 0 ? (dc - sqrt(root)) / dd : 1e10;
            if (!(t < (double)depth[i]))
                continue;
            depth[i] = (float)t;
            for (int c = 0; c < 3; c++)
                n[c] = (t * d[c] - centres[s][c]) / radius;
            for (int c = 0; c < 3; c++) {
                view[c][i] = (float)n[c];
                world[c][i] =
                    (float)(world_to_view[c] * n[0] + world_to_view[3 + c] * n[1]
                            + world_to_view[6 + c] * n[2]);
            }
        }
    }
}

static io_passes_request default_request(void)
{
    io_passes_request request;
    memset(&request, 0, sizeof request);
    request.depth_format = crv_depth_format_planar();
    request.vfov_rad = (float)vfov;
    return request;
}

static const char *write_frame(float normals[3][PIXELS])
{
    static const char *const names[] = {"Z", "N.X", "N.Y", "N.Z"};
    const char *path = support_path("frame.exr");
    const float *planes[] = {depth, normals[0], normals[1], normals[2]};
    support_make_plain_exr(path, names, 4, W, H, planes);
    support_forget();
    return path;
}

static void load(const char *path, const io_passes_request *request, io_frame *frame)
{
    if (io_frame_load(path, request, frame, support_logger()))
        fail_msg("%s", support_lines.error);
}

/* Degrees between a camera's rotation and the one that is expected. */
static double rotation_error(const float got[9], const double expected[9])
{
    double square = 0.0;
    for (int i = 0; i < 9; i++)
        square += ((double)got[i] - expected[i]) * ((double)got[i] - expected[i]);
    return 2.0 * asin(fmin(1.0, sqrt(square / 8.0))) * 180.0 / pi;
}

/* The library's normals of a frame must be the true ones. */
static void expect_view_normals(const io_frame *frame)
{
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    static float got[PIXELS * 3];
    const crv_image image = crv_image_packed(got, W, H, 3);
    assert_int_equal(crv_context_create(NULL, &context), CRV_OK);
    assert_int_equal(io_frame_to_gbuffer(frame, context, &gbuffer), CRV_OK);
    assert_int_equal(io_frame_to_gbuffer(frame, context, &gbuffer), CRV_OK); /* refill */
    assert_int_equal(crv_gbuffer_get_normals(gbuffer, &image), CRV_OK);
    for (int i = 0; i < PIXELS; i++) {
        double dot = 0.0;
        for (int c = 0; c < 3; c++)
            dot += (double)got[3 * i + c] * (double)view[c][i];
        /* 0.5 degrees: the fit's own error of less than 0.2, and rounding. */
        if (depth[i] < 1e9f && dot < cos(0.5 * pi / 180.0))
            fail_msg("pixel %d: %g degrees off", i, acos(dot) * 180.0 / pi);
    }
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
}

/* The frame knows how the normals of the file are turned to view space. */
static void expect_turn(const io_frame *frame, float given[3][PIXELS], bool in_world)
{
    assert_int_equal(frame->normals_in_world, in_world);
    assert_int_equal(frame->has_world, in_world);
    for (int i = 0; i < PIXELS; i++) {
        double dot = 0.0;
        for (int row = 0; row < 3; row++)
            for (int c = 0; c < 3; c++)
                dot += frame->normals_to_view[3 * row + c] * (double)given[c][i]
                       * (double)view[row][i];
        assert_true(depth[i] > 1e9f || dot > cos(0.5 * pi / 180.0));
    }
    if (in_world)
        assert_memory_equal(frame->world_to_view, frame->normals_to_view,
                            sizeof frame->world_to_view);
}

static void test_world_normals(void **state)
{
    (void)state;
    const io_passes_request request = default_request();
    io_frame frame;
    make_spheres();
    load(write_frame(world), &request, &frame);
    assert_true(frame.has_normals);
    assert_int_equal(frame.normal_space, CRV_NORMAL_WORLD);
    assert_true(rotation_error(frame.camera.world_to_view, world_to_view) < 0.2);
    assert_non_null(strstr(support_lines.text, "world space, rotation found from depth"));
    assert_int_equal(support_lines.warnings, 0);
    for (int i = 0; i < PIXELS; i++)
        assert_true(isinf(*crv_image_at(&frame.depth[0], i % W, i / W, 0))
                    == (depth[i] == 1e10f));
    expect_view_normals(&frame);
    expect_turn(&frame, world, true);
    io_frame_free(&frame);
}

static void test_view_normals(void **state)
{
    (void)state;
    io_passes_request request = default_request();
    io_frame frame;
    make_spheres();
    const char *path = write_frame(view);
    load(path, &request, &frame);
    assert_true(frame.has_normals);
    assert_int_equal(frame.normal_space, CRV_NORMAL_VIEW);
    expect_view_normals(&frame);
    expect_turn(&frame, view, false);
    io_frame_free(&frame);
    request.normal_space = IO_NORMALS_VIEW;
    load(path, &request, &frame);
    assert_int_equal(frame.normal_space, CRV_NORMAL_VIEW);
    io_frame_free(&frame);
    /* Axes that the user flips are those of the file. */
    static float flipped[3][PIXELS];
    memcpy(flipped, view, sizeof view);
    for (int i = 0; i < PIXELS; i++)
        flipped[1][i] = -flipped[1][i];
    request.flip_normals[1] = true;
    load(write_frame(flipped), &request, &frame);
    expect_view_normals(&frame);
    expect_turn(&frame, flipped, false);
    io_frame_free(&frame);
}

static void test_mirrored_normals(void **state)
{
    (void)state;
    static float left_handed[3][PIXELS];
    const io_passes_request request = default_request();
    io_frame frame;
    make_spheres();
    memcpy(left_handed, world, sizeof world);
    for (int i = 0; i < PIXELS; i++)
        left_handed[0][i] = -left_handed[0][i];
    load(write_frame(left_handed), &request, &frame);
    assert_true(frame.has_normals);
    assert_non_null(strstr(support_lines.text, "mirrored"));
    expect_view_normals(&frame);
    expect_turn(&frame, left_handed, true);
    io_frame_free(&frame);
}

static void test_encoded_normals(void **state)
{
    (void)state;
    static float encoded[3][PIXELS];
    const io_passes_request request = default_request();
    io_frame frame;
    /* The background is black; grey, which is 0 encoded; 127 of 255, grey in 8 bits;
     * white. */
    static const float BACKGROUNDS[] = {0.0f, 0.5f, 127.0f / 255.0f, 1.0f};
    make_spheres();
    for (int k = 0; k < 4; k++) {
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < PIXELS; i++)
                encoded[c][i] =
                    depth[i] < 1e9f ? 0.5f * world[c][i] + 0.5f : BACKGROUNDS[k];
        load(write_frame(encoded), &request, &frame);
        assert_true(frame.has_normals);
        assert_non_null(strstr(support_lines.text, "decoded"));
        expect_view_normals(&frame);
        io_frame_free(&frame);
    }
}

static void test_senseless_normals(void **state)
{
    (void)state;
    static float noise[3][PIXELS];
    io_passes_request request = default_request();
    uint32_t seed = 3;
    io_frame frame;
    make_spheres();
    for (int i = 0; i < PIXELS; i++) {
        seed = seed * 1664525u + 1013904223u;
        const double phi = (double)(seed >> 8) / 16777216.0 * 2.0 * pi;
        noise[0][i] = (float)cos(phi);
        noise[1][i] = (float)sin(phi);
        noise[2][i] = 0.0f;
    }
    const char *path = write_frame(noise);
    load(path, &request, &frame);
    assert_false(frame.has_normals);
    assert_int_equal(support_lines.warnings, 1);
    assert_non_null(strstr(support_lines.text, "do not agree with depth"));
    io_frame_free(&frame);
    support_forget();
    request.normal = "none";
    load(path, &request, &frame);
    assert_false(frame.has_normals);
    assert_int_equal(support_lines.warnings, 0);
    io_frame_free(&frame);
}

static void test_too_few_pixels(void **state)
{
    (void)state;
    static const char *const names[] = {"Z", "N.X", "N.Y", "N.Z"};
    const float z[4] = {1, 2, 3, 4}, zero[4] = {0}, ones[4] = {1, 1, 1, 1};
    const float *planes[] = {z, zero, zero, ones};
    const char *path = support_path("tiny.exr");
    const io_passes_request request = default_request();
    io_frame frame;
    support_make_plain_exr(path, names, 4, 2, 2, planes);
    support_forget();
    load(path, &request, &frame);
    assert_false(frame.has_normals);
    assert_int_equal(support_lines.warnings, 1);
    io_frame_free(&frame);
}

/* worldToNDC as OpenEXR defines it, built from the pixel equations of a pinhole camera at
 * `eye`: u = (fx right.q + cx forward.q) / (w forward.q) with q = p - eye. */
static void make_ndc(const double eye[3], double fx, double fy, double cx, double cy,
                     double w, double h, bool signed_range, float out[16])
{
    double rows[4][4];
    for (int c = 0; c < 3; c++) {
        const double right = world_to_view[c], up = world_to_view[3 + c];
        const double forward = -world_to_view[6 + c];
        rows[0][c] = (fx * right + cx * forward) / w;
        rows[1][c] = (-fy * up + cy * forward) / h;
        rows[2][c] = 0.0;
        rows[3][c] = forward;
    }
    for (int r = 0; r < 4; r++)
        rows[r][3] = -(rows[r][0] * eye[0] + rows[r][1] * eye[1] + rows[r][2] * eye[2]);
    for (int c = 0; c < 4 && signed_range; c++) { /* -1 to 1, y up */
        rows[0][c] = 2.0 * rows[0][c] - rows[3][c];
        rows[1][c] = rows[3][c] - 2.0 * rows[1][c];
    }
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            out[4 * c + r] = (float)rows[r][c];
}

static void write_described(const char *path, int32_t data_x, int32_t data_y,
                            int32_t width, int32_t height, const float ndc[16])
{
    static const char *const names[] = {"Z"};
    io_image image;
    assert_int_equal(io_image_init(&image, width, height, names, 1, NULL), 0);
    for (int32_t i = 0; i < width * height; i++)
        image.channels[0].data[i] = (float)i;
    image.data_x = data_x;
    image.data_y = data_y;
    image.display_width = 64;
    image.display_height = 48;
    image.camera.has_world_to_ndc = ndc != NULL;
    if (ndc)
        memcpy(image.camera.world_to_ndc, ndc, sizeof image.camera.world_to_ndc);
    assert_int_equal(io_write(path, &image, NULL, support_logger()), 0);
    io_image_free(&image);
    support_forget();
}

static void expect_near(float got, double expected)
{
    /* Single-precision matrices of numbers up to 100. */
    if (fabs((double)got - expected) > 2e-3)
        fail_msg("%g instead of %g", (double)got, expected);
}

static void test_camera_metadata(void **state)
{
    (void)state;
    const double eye[3] = {7, -2, 3}, target[3] = {1, 1, 0}, up[3] = {0.2, 1, 0};
    const char *path = support_path("described.exr");
    io_passes_request request = default_request();
    io_frame frame;
    float ndc[16];
    set_look_at(eye, target, up);
    request.vfov_rad = 0.0f;
    for (int signed_range = 0; signed_range < 2; signed_range++) {
        make_ndc(eye, 70, 60, 30, 27, 64, 48, signed_range, ndc);
        write_described(path, -5, 3, 64, 40, ndc);
        load(path, &request, &frame);
        assert_int_equal(frame.camera.projection, CRV_PERSPECTIVE);
        expect_near(frame.camera.fx_px, 70);
        expect_near(frame.camera.fy_px, 60);
        expect_near(frame.camera.cx_px, 30 + 5); /* from the data window's left edge */
        expect_near(frame.camera.cy_px, 27 - 3);
        assert_true(rotation_error(frame.camera.world_to_view, world_to_view) < 1e-3);
        io_frame_free(&frame);
    }
    /* A field of view wins, but the rotation is still the file's. */
    request.vfov_rad = (float)(pi / 2.0);
    load(path, &request, &frame);
    expect_near(frame.camera.fy_px, 24);
    expect_near(frame.camera.cx_px, 32 + 5);
    assert_true(rotation_error(frame.camera.world_to_view, world_to_view) < 1e-3);
    io_frame_free(&frame);
}

static void test_orthographic_metadata(void **state)
{
    (void)state;
    const double eye[3] = {7, -2, 3}, target[3] = {1, 1, 0}, up[3] = {0, 1, 0};
    const char *path = support_path("ortho.exr");
    io_passes_request request = default_request();
    io_frame frame;
    float ndc[16] = {0};
    set_look_at(eye, target, up);
    /* 8 x 6 scene units on 64 x 48 pixels: u = right.q / 8 + 0.5, v = -up.q / 6 + 0.5 */
    for (int c = 0; c < 3; c++) {
        ndc[4 * c] = (float)(world_to_view[c] / 8.0);
        ndc[4 * c + 1] = (float)(-world_to_view[3 + c] / 6.0);
        ndc[12] -= (float)(world_to_view[c] * eye[c] / 8.0);
        ndc[13] += (float)(world_to_view[3 + c] * eye[c] / 6.0);
    }
    ndc[12] += 0.5f;
    ndc[13] += 0.5f;
    ndc[15] = 1.0f;
    write_described(path, 0, 0, 64, 48, ndc);
    request.vfov_rad = 0.0f;
    load(path, &request, &frame);
    assert_int_equal(frame.camera.projection, CRV_ORTHOGRAPHIC);
    expect_near(frame.camera.fx_px, 8);
    expect_near(frame.camera.fy_px, 8);
    assert_true(rotation_error(frame.camera.world_to_view, world_to_view) < 1e-3);
    io_frame_free(&frame);
}

static void test_windows(void **state)
{
    (void)state;
    const char *path = support_path("overscan.exr");
    const io_passes_request request = default_request();
    io_frame frame;
    write_described(path, -4, -6, 64 + 4 + 8, 48 + 6 + 10, NULL);
    load(path, &request, &frame);
    assert_int_equal(frame.desc.width, 76);
    assert_int_equal(frame.desc.guard_left, 4);
    assert_int_equal(frame.desc.guard_top, 6);
    assert_int_equal(frame.desc.guard_right, 8);
    assert_int_equal(frame.desc.guard_bottom, 10);
    assert_int_equal(frame.desc.origin_x, 0);
    expect_near(frame.camera.cx_px, 32 + 4);
    expect_near(frame.camera.cy_px, 24 + 6);
    expect_near(frame.camera.fy_px, 24 / tan(vfov / 2));
    io_frame_free(&frame);
    /* Kept on demand: a result for every pixel, in its place. */
    io_passes_request keeping = request;
    keeping.keep_overscan = true;
    load(path, &keeping, &frame);
    assert_int_equal(frame.desc.width, 76);
    assert_int_equal(frame.desc.guard_left + frame.desc.guard_bottom, 0);
    assert_int_equal(frame.desc.origin_x, -4);
    assert_int_equal(frame.desc.origin_y, -6);
    expect_near(frame.camera.cx_px, 32 + 4);
    io_frame_free(&frame);
    write_described(path, 10, 20, 8, 4, NULL); /* a region of the picture */
    load(path, &request, &frame);
    assert_int_equal(frame.desc.guard_left + frame.desc.guard_right, 0);
    assert_int_equal(frame.desc.guard_top + frame.desc.guard_bottom, 0);
    assert_int_equal(frame.desc.origin_x, 10);
    assert_int_equal(frame.desc.origin_y, 20);
    expect_near(frame.camera.cx_px, 32 - 10);
    expect_near(frame.camera.cy_px, 24 - 20);
    io_frame_free(&frame);
    write_described(path, 64, 0, 8, 4, NULL); /* beside the picture */
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "outside its display window");
    load(path, &keeping, &frame);
    assert_int_equal(support_lines.warnings, 1);
    assert_non_null(strstr(support_lines.text, "outside its display window"));
    io_frame_free(&frame);
}

/* Fields of view as renderers write them. By hand: 54.43 degrees over 64 px are
 * 32 / tan(27.215 deg) = 62.226 px; 18 mm before a sensor of 36 mm are 90 degrees. */
static void test_lens_attributes(void **state)
{
    (void)state;
    static const struct {
        const char *names[2];
        float values[2];
        double fx_px;
    } cases[] = {{{"cameraFov", NULL}, {54.43f, 0}, 62.226},
                 {{"fieldOfViewVertical", NULL}, {60, 0}, 24 * 1.7320508},
                 {{"cameraFocalLength", "cameraAperture"}, {18, 36}, 32.0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *path = support_path("lens.exr");
        io_passes_request request = default_request();
        io_frame frame;
        support_make_lens_exr(path, 64, 48, cases[i].names, cases[i].values);
        support_forget();
        request.vfov_rad = 0.0f;
        load(path, &request, &frame);
        expect_near(frame.camera.fx_px, cases[i].fx_px);
        expect_near(frame.camera.fy_px, cases[i].fx_px);
        assert_non_null(strstr(support_lines.text, cases[i].names[0]));
        io_frame_free(&frame);
        request.hfov_rad = (float)(pi / 2.0); /* the user's word wins */
        load(path, &request, &frame);
        expect_near(frame.camera.fx_px, 32);
        io_frame_free(&frame);
    }
}

/* How a picture was made is kept. */
static void test_made(void **state)
{
    (void)state;
    static const char *const files[] = {"made.exr", "made.png", "made.pfm"};
    static const char *const names[] = {"AO"};
    for (int i = 0; i < 3; i++) {
        const char *path = support_path(files[i]);
        io_image image;
        assert_int_equal(io_image_init(&image, 3, 2, names, 1, NULL), 0);
        snprintf(image.made, sizeof image.made, "crevice test radius=1");
        assert_int_equal(io_write(path, &image, NULL, support_logger()), 0);
        io_image_free(&image);
        assert_int_equal(io_keeps_made(path), i < 2);
        assert_int_equal(io_probe(path, &image, NULL), 0);
        assert_string_equal(image.made, i < 2 ? "crevice test radius=1" : "");
        io_image_free(&image);
        assert_int_equal(io_read(path, NULL, 0, &image, NULL), 0);
        assert_string_equal(image.made, i < 2 ? "crevice test radius=1" : "");
        io_image_free(&image);
    }
}

static void test_pixel_aspect(void **state)
{
    (void)state;
    static const char *const names[] = {"Z"};
    const char *path = support_path("anamorphic.exr");
    io_passes_request request = default_request();
    io_image image;
    io_frame frame;
    assert_int_equal(io_image_init(&image, 20, 10, names, 1, NULL), 0);
    image.pixel_aspect = 2.0f; /* a pixel is twice as wide as high */
    assert_int_equal(io_write(path, &image, NULL, NULL), 0);
    io_image_free(&image);
    request.vfov_rad = 0.0f;
    request.view_height = 5.0f;
    load(path, &request, &frame);
    assert_int_equal(frame.camera.projection, CRV_ORTHOGRAPHIC);
    expect_near(frame.camera.fy_px, 2); /* 10 pixels for 5 units */
    expect_near(frame.camera.fx_px, 1); /* 2 units a pixel's width */
    io_frame_free(&frame);
}

static void test_bad_requests(void **state)
{
    (void)state;
    const char *path = support_path("plain.exr");
    io_passes_request request = default_request();
    io_frame frame;
    write_described(path, 0, 0, 64, 48, NULL);
    request.vfov_rad = 0.0f;
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "give its field of view");
    request.vfov_rad = NAN;
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "between 0 and 180");
    request.vfov_rad = 1.0f;
    request.view_height = 1.0f;
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "give one of them");
    request.view_height = 0.0f;
    assert_int_equal(io_frame_load(support_path("none.exr"), &request, &frame, NULL), -1);
}

static void test_parts_with_own_windows(void **state)
{
    (void)state;
    const support_part parts[2] = {
        {.name = "depth",
         .storage = EXR_STORAGE_SCANLINE,
         .compression = EXR_COMPRESSION_ZIP,
         .width = 20,
         .height = 10,
         .channel_count = 1,
         .channels = {"Z"},
         .types = {EXR_PIXEL_FLOAT}},
        {.name = "normal",
         .storage = EXR_STORAGE_SCANLINE,
         .compression = EXR_COMPRESSION_ZIP,
         .min_x = 3,
         .min_y = -2,
         .width = 30,
         .height = 9,
         .channel_count = 3,
         .channels = {"X", "Y", "Z"},
         .types = {EXR_PIXEL_FLOAT, EXR_PIXEL_FLOAT, EXR_PIXEL_FLOAT}}};
    const char *path = support_path("cropped.exr");
    io_passes_request request = default_request();
    io_frame frame;
    request.normal_space = IO_NORMALS_VIEW;
    support_make_exr(path, parts, 2, NULL, NULL, NULL);
    support_forget();
    load(path, &request, &frame);
    assert_int_equal(frame.desc.width, 20);
    for (int32_t y = 0; y < 10; y++)
        for (int32_t x = 0; x < 20; x++) {
            /* Normals begin at (3, -2) and end below row 6. */
            double n[3] = {0}, square = 0.0;
            for (int c = 0; c < 3 && x >= 3 && y <= 6; c++) {
                n[c] = (double)support_value(1, c, x - 3, y + 2);
                square += n[c] * n[c];
            }
            /* They are far longer than 1, and shortened. */
            const float y_part = square > 0.0 ? (float)(n[1] / sqrt(square)) : 0.0f;
            /* A depth of 0 or less is background. */
            const float value = support_value(0, 0, x, y);
            const float got = *crv_image_at(&frame.depth[0], x, y, 0);
            /* Whole numbers are half floats, too: smoothed by half a step at most. */
            assert_true(value > 0.0f ? fabsf(got - value) <= value / 1024.0f
                                     : isinf(got));
            assert_true(*crv_image_at(&frame.normals, x, y, 1) == y_part);
        }
    io_frame_free(&frame);
}

typedef struct blender_view {
    const char *name;
    double eye[3], target[3], vfov_degrees;
} blender_view;

static void test_blender_frames(void **state)
{
    (void)state;
    /* From the cameras.json beside the frames. */
    static const blender_view views[] = {
        {"corner", {5.0, 3.5, 1.0}, {0.8, 0.4, 0.0}, 45},
        {"sponza", {-8.5, 1.2, -0.3}, {0.0, 2.8, 0.3}, 60},
        {"dragon", {4.5, 7.0, 16.5}, {-0.3, 4.3, 0.0}, 40},
        {"engine", {-300, 180, -380}, {-70, -45, 0}, 45}};
    const double up[3] = {0, 1, 0};
    const char *shared = getenv("CREVICE_SHARED");
    struct stat status;
    char path[4096];
    if (shared)
        snprintf(path, sizeof path, "%s/scenes/blender/corner.exr", shared);
    if (!shared || stat(path, &status)) {
        print_message("CREVICE_SHARED names no folder with Blender's frames; skipped\n");
        skip();
    }
    for (size_t i = 0; i < sizeof views / sizeof views[0]; i++) {
        io_passes_request request = default_request();
        io_frame frame;
        request.vfov_rad = (float)(views[i].vfov_degrees * pi / 180.0);
        snprintf(path, sizeof path, "%s/scenes/blender/%s.exr", shared, views[i].name);
        support_forget();
        load(path, &request, &frame);
        assert_true(frame.has_normals);
        set_look_at(views[i].eye, views[i].target, up);
        const double error = rotation_error(frame.camera.world_to_view, world_to_view);
        print_message("%s: rotation off by %.4f degrees\n", views[i].name, error);
        assert_true(error < 0.2);
        assert_int_equal(support_lines.warnings, 0);
        io_frame_free(&frame);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_world_normals),
        cmocka_unit_test(test_view_normals),
        cmocka_unit_test(test_mirrored_normals),
        cmocka_unit_test(test_encoded_normals),
        cmocka_unit_test(test_senseless_normals),
        cmocka_unit_test(test_too_few_pixels),
        cmocka_unit_test(test_camera_metadata),
        cmocka_unit_test(test_orthographic_metadata),
        cmocka_unit_test(test_windows),
        cmocka_unit_test(test_pixel_aspect),
        cmocka_unit_test(test_lens_attributes),
        cmocka_unit_test(test_made),
        cmocka_unit_test(test_bad_requests),
        cmocka_unit_test(test_parts_with_own_windows),
        cmocka_unit_test(test_blender_frames),
    };
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}

/* SPDX-License-Identifier: MIT */
/*
 * What a frame is taken for. One analytic scene (floor, wall, box corner, sphere) is
 * written in every way that renderers write such frames; the G-buffer must be the true
 * one or the line must say what contradicts.
 */
#include <math.h>

#include "passes/passes.h"
#include "test_io_support.h"

enum { W = 160, H = 100, PIXELS = W * H };

static const double pi = 3.14159265358979323846;

/* The frame at distance 1 (perspective) or in scene units (orthographic). */
typedef struct window {
    double left, right, bottom, top;
    bool orthographic;
} window;

static double eye[3], axes[3][3]; /* rows: right, up, back; in a right-handed world */
static double depth[PIXELS], world[3][PIXELS], view[3][PIXELS]; /* depth INFINITY: sky */
static float planes[4][PIXELS];

static void look(const double from[3], const double at[3])
{
    const double up[3] = {0, 1, 0};
    double *r = axes[0], *u = axes[1], *b = axes[2], length = 0.0;
    for (int c = 0; c < 3; c++) {
        eye[c] = from[c];
        b[c] = from[c] - at[c];
        length += b[c] * b[c];
    }
    for (int c = 0; c < 3; c++)
        b[c] /= sqrt(length);
    for (int c = 0; c < 3; c++)
        r[c] = up[(c + 1) % 3] * b[(c + 2) % 3] - up[(c + 2) % 3] * b[(c + 1) % 3];
    length = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    for (int c = 0; c < 3; c++)
        r[c] /= length;
    for (int c = 0; c < 3; c++)
        u[c] = b[(c + 1) % 3] * r[(c + 2) % 3] - b[(c + 2) % 3] * r[(c + 1) % 3];
}

static void put(int i, double t, double nx, double ny, double nz)
{
    if (!(t > 1e-6 && t < depth[i]))
        return;
    depth[i] = t;
    world[0][i] = nx;
    world[1][i] = ny;
    world[2][i] = nz;
}

/* The ray o + t d: t is planar depth, because d has length 1 along the view. */
static void trace_ray(int i, const double o[3], const double d[3])
{
    depth[i] = INFINITY;
    for (int c = 0; c < 3; c++)
        world[c][i] = 0.0;
    const double floor = -o[1] / d[1], x = o[0] + floor * d[0], z = o[2] + floor * d[2];
    if (fabs(x) < 30 && fabs(z) < 30)
        put(i, floor, 0, 1, 0);
    const double wall = (-4 - o[2]) / d[2], wy = o[1] + wall * d[1];
    if (wy > 0 && wy < 1.5)
        put(i, wall, 0, 0, 1);
    const double side = (-1.2 - o[0]) / d[0], sy = o[1] + side * d[1],
                 sz = o[2] + side * d[2];
    if (d[0] < 0 && sy > 0 && sy < 1.4 && sz > -3 && sz < -0.5)
        put(i, side, 1, 0, 0);
    const double centre[3] = {1.2, 0.8, -0.8}, radius = 0.8;
    double a = 0, b = 0, q = 0;
    for (int c = 0; c < 3; c++) {
        a += d[c] * d[c];
        b += (o[c] - centre[c]) * d[c];
        q += (o[c] - centre[c]) * (o[c] - centre[c]);
    }
    const double root = b * b - a * (q - radius * radius);
    if (root > 0) {
        const double t = (-b - sqrt(root)) / a;
        put(i, t, (o[0] + t * d[0] - centre[0]) / radius,
            (o[1] + t * d[1] - centre[1]) / radius,
            (o[2] + t * d[2] - centre[2]) / radius);
    }
}

static void trace(const window *w)
{
    for (int i = 0; i < PIXELS; i++) {
        const double x = w->left + (w->right - w->left) * (i % W + 0.5) / W;
        const double y = w->top - (w->top - w->bottom) * (i / W + 0.5) / H;
        double o[3], d[3];
        for (int c = 0; c < 3; c++) {
            const double across = x * axes[0][c] + y * axes[1][c];
            o[c] = eye[c] + (w->orthographic ? across : 0.0);
            d[c] = (w->orthographic ? 0.0 : across) - axes[2][c];
        }
        trace_ray(i, o, d);
        for (int r = 0; r < 3; r++) {
            view[r][i] = 0.0;
            for (int c = 0; c < 3; c++)
                view[r][i] += axes[r][c] * world[c][i];
        }
    }
}

static window centred(double vfov_deg)
{
    const double t = tan(0.5 * vfov_deg * pi / 180.0);
    return (window){-t * W / H, t * W / H, -t, t, false};
}

static const double usual_eye[3] = {2.2, 2.4, 4.2}, usual_target[3] = {0, 0.6, -1};

static void make_usual(double vfov_deg)
{
    const window w = centred(vfov_deg);
    look(usual_eye, usual_target);
    trace(&w);
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = (float)(isfinite(depth[i]) ? depth[i] : 1e10);
}

/* worldToNDC of OpenEXR's definition (0 to 1, y down) or as clip coordinates (-1 to 1, y
 * up), row vectors; worldToCamera with z along the view. */
static void fill_metadata(const window *w, bool is_signed, io_camera_metadata *out)
{
    const double width = w->right - w->left, height = w->top - w->bottom;
    memset(out, 0, sizeof *out);
    out->has_world_to_camera = out->has_world_to_ndc = true;
    double to_camera[4][4] = {{0}};
    for (int c = 0; c < 3; c++) {
        to_camera[c][0] = axes[0][c];
        to_camera[c][1] = axes[1][c];
        to_camera[c][2] = -axes[2][c];
        for (int k = 0; k < 3; k++)
            to_camera[3][c] -= eye[k] * (c == 2 ? -axes[c][k] : axes[c][k]);
    }
    to_camera[3][3] = 1.0;
    double projection[4][4] = {{0}};
    const double sx = is_signed ? 2 / width : 1 / width;
    const double sy = is_signed ? 2 / height : -1 / height;
    const double cx = is_signed ? -(w->right + w->left) / width : -w->left / width;
    const double cy = is_signed ? -(w->top + w->bottom) / height : w->top / height;
    projection[0][0] = sx;
    projection[1][1] = sy;
    const int row = w->orthographic ? 3 : 2;
    projection[row][0] = cx;
    projection[row][1] = cy;
    projection[2][2] = 0.01; /* near 0, far 100, or so */
    projection[row == 3 ? 3 : 2][3] = 1.0;
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++)
                sum += to_camera[r][k] * projection[k][c];
            out->world_to_ndc[4 * r + c] = (float)sum;
            out->world_to_camera[4 * r + c] = (float)to_camera[r][c];
        }
}

/* planes[0] is depth, planes[1..3] are normals. */
static const char *write_frame(bool normals, const io_camera_metadata *camera)
{
    static const char *const names[] = {"Z", "N.X", "N.Y", "N.Z"};
    const char *path = support_path("evidence.exr");
    io_image image;
    assert_int_equal(io_image_init(&image, W, H, names, normals ? 4 : 1, NULL), 0);
    for (int c = 0; c < (normals ? 4 : 1); c++)
        memcpy(image.channels[c].data, planes[c], sizeof planes[c]);
    if (camera)
        image.camera = *camera;
    assert_int_equal(io_write(path, &image, NULL, support_logger()), 0);
    io_image_free(&image);
    support_forget();
    return path;
}

static void set_normals(double n[3][PIXELS], const double m[9])
{
    for (int i = 0; i < PIXELS; i++)
        for (int r = 0; r < 3; r++)
            planes[1 + r][i] = (float)(m[3 * r] * n[0][i] + m[3 * r + 1] * n[1][i]
                                       + m[3 * r + 2] * n[2][i]);
}

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static io_passes_request request_of(double vfov_deg)
{
    return (io_passes_request){.depth_format = crv_depth_format_planar(),
                               .vfov_rad = (float)(vfov_deg * pi / 180.0)};
}

static void load(const char *path, const io_passes_request *request, io_frame *frame)
{
    if (io_frame_load(path, request, frame, support_logger()))
        fail_msg("%s", support_lines.error);
}

/* Depth and normals as the library has them must be the true ones, within 0.3 degrees (a
 * fit's error) and a part in 10^4 (single precision, through a hardware depth). */
static void expect_truth(const io_frame *frame)
{
    static float got[3 * PIXELS], got_depth[PIXELS];
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    const crv_image image = crv_image_packed(got, W, H, 3);
    const crv_image depths = crv_image_packed(got_depth, W, H, 1);
    assert_true(frame->has_normals);
    assert_int_equal(crv_context_create(NULL, &context), CRV_OK);
    assert_int_equal(io_frame_to_gbuffer(frame, context, &gbuffer), CRV_OK);
    assert_int_equal(crv_gbuffer_get_normals(gbuffer, &image), CRV_OK);
    assert_int_equal(crv_gbuffer_get_depth(gbuffer, 0, &depths), CRV_OK);
    for (int i = 0; i < PIXELS; i++) {
        double dot = 0.0;
        assert_int_equal(isfinite(depth[i]), isfinite(got_depth[i]));
        if (!isfinite(depth[i]))
            continue;
        assert_true(fabs((double)got_depth[i] / depth[i] - 1.0) < 1e-4);
        for (int c = 0; c < 3; c++)
            dot += (double)got[3 * i + c] * view[c][i];
        /* The library bends normals that face away, as a sphere's do at its outline. */
        if (dot < cos(0.3 * pi / 180.0) && view[2][i] > 0.2)
            fail_msg("pixel %d: %g degrees off: %s", i, acos(dot) * 180.0 / pi,
                     support_lines.text);
    }
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
}

/* A level camera over a floor: most normals are the same in world and in view space. */
static void test_level_camera(void **state)
{
    (void)state;
    static const double heights[] = {1.2, 1.04}; /* level, and 2 degrees down */
    const double from[3] = {3.1, 1.2, 1.2};
    for (int k = 0; k < 2; k++)
        for (int kind = 0; kind < 3; kind++) {
            const double at[3] = {0.1, heights[k], -1.8};
            const window w = centred(60);
            const io_passes_request request = request_of(kind == 1 ? 0.0 : 60.0);
            io_camera_metadata camera;
            io_frame frame;
            look(from, at);
            trace(&w);
            fill_metadata(&w, false, &camera);
            for (int i = 0; i < PIXELS; i++)
                planes[0][i] = (float)(isfinite(depth[i]) ? depth[i] : 1e10);
            set_normals(kind == 2 ? view : world, identity);
            load(write_frame(true, kind == 1 ? &camera : NULL), &request, &frame);
            expect_truth(&frame);
            assert_non_null(strstr(support_lines.text,
                                   kind == 0   ? "world space, rotation found"
                                   : kind == 1 ? "world space, rotation from the camera"
                                               : "view space (deviation 0.0"));
            assert_int_equal(support_lines.warnings, 0);
            io_frame_free(&frame);
        }
}

/* Every handedness of view space, and worlds with other axes. */
static void test_flipped_axes(void **state)
{
    (void)state;
    static const double swaps[3][9] = {
        {1, 0, 0, 0, 0, -1, 0, 1, 0},  /* z up */
        {1, 0, 0, 0, 1, 0, 0, 0, -1},  /* left-handed */
        {0, 0, -1, 1, 0, 0, 0, 1, 0}}; /* z up, left-handed */
    const window w = centred(50);
    io_passes_request request = request_of(50);
    io_frame frame;
    make_usual(50);
    for (int flips = 0; flips < 8; flips++) {
        const double m[9] = {flips & 1 ? -1 : 1, 0, 0, 0, flips & 2 ? -1 : 1, 0, 0, 0,
                             flips & 4 ? -1 : 1};
        set_normals(view, m);
        load(write_frame(true, NULL), &request, &frame);
        expect_truth(&frame);
        assert_non_null(
            strstr(support_lines.text, flips == 2 ? "y flipped" : "view space"));
        io_frame_free(&frame);
    }
    io_camera_metadata camera;
    fill_metadata(&w, false, &camera);
    for (int k = 0; k < 3; k++)
        for (int with_camera = 0; with_camera < 2; with_camera++) {
            set_normals(world, swaps[k]);
            load(write_frame(true, with_camera ? &camera : NULL), &request, &frame);
            expect_truth(&frame);
            assert_int_equal(support_lines.warnings, 0);
            io_frame_free(&frame);
        }
    /* Said outright, without a guess. */
    const double green_down[9] = {1, 0, 0, 0, -1, 0, 0, 0, 1};
    set_normals(view, green_down);
    request.normal_space = IO_NORMALS_VIEW;
    request.flip_normals[1] = true;
    load(write_frame(true, NULL), &request, &frame);
    expect_truth(&frame);
    assert_int_equal(support_lines.warnings, 0);
    io_frame_free(&frame);
    request.flip_normals[1] = false;
    load(write_frame(true, NULL), &request, &frame);
    assert_int_equal(support_lines.warnings, 1);
    assert_non_null(
        strstr(support_lines.text, "agree with depth as view space, y flipped"));
    io_frame_free(&frame);
}

/* A frame that cannot tell is read as the shot is. */
static void test_undecided_frame(void **state)
{
    (void)state;
    const double from[3] = {0, 2, 0}, at[3] = {2, 2, 2};
    io_passes_request request = request_of(0);
    window w = {-0.4, 0.4, -0.9, -0.4, false}; /* the floor alone */
    io_camera_metadata camera;
    io_frame frame;
    look(from, at);
    trace(&w);
    fill_metadata(&w, false, &camera);
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = (float)depth[i];
    set_normals(view, identity);
    const char *path = write_frame(true, &camera);
    load(path, &request, &frame);
    assert_false(frame.reading_decided);
    const int first = frame.reading;
    io_frame_free(&frame);
    /* 2 is view space: what another frame of the shot decided. */
    request.usual_reading = 2;
    load(path, &request, &frame);
    assert_int_equal(frame.reading, 2);
    assert_int_not_equal(first, 0);
    assert_int_equal(frame.normal_space, CRV_NORMAL_VIEW);
    io_frame_free(&frame);
}

/* Off-axis frusta and orthographic views, in both ranges of NDC, with every kind of help.
 */
static void test_ranges_of_ndc(void **state)
{
    (void)state;
    static const window windows[] = {
        {-1.7, 0.6, -1.2, 0.8, false}, /* a wall of a cave */
        {-0.9, 0, 0, 0.6, false},      /* a corner tile */
        {0, 0.9, -0.6, 0, false},      /* the opposite one: its centre lies at 0, 0 */
        {-0.9, 0.9, -0.6, 0.6, false},
        {-3, 3, -2, 2, true}};
    for (size_t k = 0; k < sizeof windows / sizeof windows[0]; k++)
        for (int variant = 0; variant < 8; variant++) {
            const window *w = &windows[k];
            const io_passes_request request = request_of(0);
            io_camera_metadata camera;
            io_frame frame;
            look(usual_eye, usual_target);
            trace(w);
            fill_metadata(w, variant & 1, &camera);
            camera.has_world_to_camera = variant & 2;
            for (int i = 0; i < PIXELS; i++)
                planes[0][i] = (float)(isfinite(depth[i]) ? depth[i] : 1e10);
            set_normals(world, identity);
            load(write_frame(variant & 4, &camera), &request, &frame);
            /* From the definition of the window; single precision. */
            const double fx = W / (w->right - w->left), fy = H / (w->top - w->bottom);
            assert_true(fabs((double)frame.camera.fx_px / fx - 1.0) < 1e-4);
            assert_true(fabs((double)frame.camera.fy_px / fy - 1.0) < 1e-4);
            if (!w->orthographic) {
                assert_true(fabs((double)frame.camera.cx_px + w->left * fx) < 1e-2);
                assert_true(fabs((double)frame.camera.cy_px - w->top * fy) < 1e-2);
            }
            if (variant & 4)
                expect_truth(&frame);
            assert_int_equal(support_lines.warnings, 0);
            io_frame_free(&frame);
        }
}

static void test_identity_is_no_camera(void **state)
{
    (void)state;
    const io_passes_request request = request_of(0);
    io_camera_metadata camera = {.has_world_to_camera = true, .has_world_to_ndc = true};
    io_frame frame;
    for (int i = 0; i < 16; i++)
        camera.world_to_camera[i] = camera.world_to_ndc[i] =
            (float)identity[0] * !(i % 5);
    make_usual(50);
    const char *path = write_frame(false, &camera);
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "does not say which camera made it");
}

/* Each part has its own camera: the right eye's depth is not seen by the left one. */
static void test_cameras_of_parts(void **state)
{
    (void)state;
    io_camera_metadata cameras[2];
    const io_passes_request left = {.depth_format = crv_depth_format_planar(),
                                    .depth = "left.Z"};
    const window windows[2] = {{-0.9, 0.9, -0.6, 0.6, false},
                               {-1.2, 0.6, -0.6, 0.6, false}};
    support_part parts[2];
    for (int p = 0; p < 2; p++) {
        look(usual_eye, usual_target);
        fill_metadata(&windows[p], false, &cameras[p]);
        parts[p] = (support_part){.name = p ? "right" : "left",
                                  .storage = EXR_STORAGE_SCANLINE,
                                  .compression = EXR_COMPRESSION_ZIP,
                                  .width = W,
                                  .height = H,
                                  .channel_count = 1,
                                  .channels = {"Z"},
                                  .types = {EXR_PIXEL_FLOAT},
                                  .world_to_ndc = cameras[p].world_to_ndc};
    }
    const char *path = support_path("stereo.exr");
    support_make_exr(path, parts, 2, NULL, NULL, NULL);
    for (int p = 0; p < 2; p++) {
        io_passes_request request = left;
        io_frame frame;
        request.depth = p ? "right.Z" : "left.Z";
        load(path, &request, &frame);
        assert_true(fabs((double)frame.camera.cx_px - (p ? 1.2 : 0.9) * W / 1.8) < 1e-2);
        io_frame_free(&frame);
    }
}

typedef struct encoding_case {
    crv_depth_encoding encoding;
    const char *word; /* in the line */
} encoding_case;

/* Near 0.1 and far 100 for those between planes; 0.001 and 20 for the inverse. */
static double encode(crv_depth_encoding encoding, double d, double length)
{
    const double n = 0.1, f = 100.0,
                 buffer = isfinite(d) ? f * (d - n) / (d * (f - n)) : 1;
    switch (encoding) {
    case CRV_DEPTH_RADIAL:
        return isfinite(d) ? d * length : 1e10;
    case CRV_DEPTH_DISPARITY:
        return isfinite(d) ? 1 / d : 0;
    case CRV_DEPTH_HARDWARE:
        return buffer;
    case CRV_DEPTH_REVERSED:
        return 1 - buffer;
    case CRV_DEPTH_GL:
        return 2 * buffer - 1;
    case CRV_DEPTH_NORMALISED_REVERSED:
        return isfinite(d) ? 1 - d / 40.0 : 0;
    case CRV_DEPTH_LOGARITHMIC:
        return isfinite(d) ? log(1 + d) / log(1 + f) : 1;
    default:
        return d;
    }
}

static void fill_encoded(crv_depth_encoding encoding, const window *w)
{
    for (int i = 0; i < PIXELS; i++) {
        const double x = w->left + (w->right - w->left) * (i % W + 0.5) / W;
        const double y = w->top - (w->top - w->bottom) * (i / W + 0.5) / H;
        planes[0][i] = (float)encode(encoding, depth[i], sqrt(1 + x * x + y * y));
    }
}

static void test_encodings(void **state)
{
    (void)state;
    static const encoding_case cases[] = {
        {CRV_DEPTH_RADIAL, "radial"},
        {CRV_DEPTH_DISPARITY, "disparity"},
        {CRV_DEPTH_HARDWARE, "hardware, far about 1000 times near"},
        {CRV_DEPTH_REVERSED, "far about 1000 times near"},
        {CRV_DEPTH_GL, "gl (-1 to 1), far about 1000 times near"},
        {CRV_DEPTH_NORMALISED_REVERSED, "normalised-reversed"},
        {CRV_DEPTH_LOGARITHMIC, "logarithmic with its far plane at about 100"}};
    const window w = centred(75);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        io_passes_request request = request_of(75);
        io_frame frame;
        make_usual(75);
        set_normals(view, identity);
        fill_encoded(cases[k].encoding, &w);
        const char *path = write_frame(true, NULL);
        load(path, &request, &frame);
        assert_true(support_lines.warnings >= 1);
        if (!strstr(support_lines.text, cases[k].word))
            fail_msg("no \"%s\" in: %s", cases[k].word, support_lines.text);
        if (k == 0) { /* needs no number that is not in the file: taken */
            expect_truth(&frame);
            assert_int_equal(frame.encoding, CRV_DEPTH_RADIAL);
            io_frame_free(&frame);
            /* So are the later frames of the shot, without another word. */
            io_passes_request later = request;
            later.is_later = true;
            later.depth_format.encoding = CRV_DEPTH_RADIAL;
            support_forget();
            load(path, &later, &frame);
            expect_truth(&frame);
            assert_int_equal(support_lines.warnings, 0);
        }
        io_frame_free(&frame);
        /* Said outright it is right, and silent. */
        support_forget();
        request.encoding_given = true;
        request.depth_format.encoding = cases[k].encoding;
        request.depth_format.z_near = 0.1f;
        request.depth_format.z_far = 100.0f;
        if (cases[k].encoding == CRV_DEPTH_NORMALISED_REVERSED) {
            request.depth_format.z_near = 0.0f;
            request.depth_format.z_far = 40.0f;
        }
        load(path, &request, &frame);
        expect_truth(&frame);
        assert_int_equal(support_lines.warnings, 0);
        io_frame_free(&frame);
    }
}

/* Without normals, walls and floors are flat in the right encoding only. */
static void test_radial_without_normals(void **state)
{
    (void)state;
    const window w = centred(75);
    const io_passes_request request = request_of(75);
    io_frame frame;
    make_usual(75);
    load(write_frame(false, NULL), &request, &frame);
    assert_int_equal(support_lines.warnings, 0);
    io_frame_free(&frame);
    fill_encoded(CRV_DEPTH_RADIAL, &w);
    load(write_frame(false, NULL), &request, &frame);
    assert_int_equal(support_lines.warnings, 1);
    assert_non_null(strstr(support_lines.text, "flat if depth were radial"));
    io_frame_free(&frame);
    fill_encoded(CRV_DEPTH_HARDWARE, &w);
    load(write_frame(false, NULL), &request, &frame);
    assert_non_null(
        strstr(support_lines.text, "looks normalised, or like a depth buffer"));
    io_frame_free(&frame);
}

static void test_wrong_field_of_view(void **state)
{
    (void)state;
    const io_passes_request request = request_of(25);
    io_frame frame;
    make_usual(50);
    set_normals(view, identity);
    load(write_frame(true, NULL), &request, &frame);
    assert_int_equal(support_lines.warnings, 1);
    /* The steps of the search are 3.5 %: 50 degrees to within 2. */
    const char *at = strstr(support_lines.text, "field of view were about ");
    assert_non_null(at);
    assert_true(fabs(atof(at + strlen("field of view were about ")) - 50.0) < 2.0);
    io_frame_free(&frame);
}

static void test_negative_depth(void **state)
{
    (void)state;
    const io_passes_request request = request_of(50);
    io_frame frame;
    make_usual(50);
    set_normals(view, identity);
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = -planes[0][i];
    load(write_frame(true, NULL), &request, &frame);
    expect_truth(&frame);
    assert_non_null(strstr(support_lines.text, "negated"));
    io_frame_free(&frame);
}

/* Whatever number a renderer writes into the sky, the sky is background. */
static void test_unmarked_sky(void **state)
{
    (void)state;
    static const double numbers[] = {65504, 1e9, 1e6, 1000, 100, 1e10, INFINITY};
    for (int normals = 0; normals < 2; normals++)
        for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++) {
            const io_passes_request request = request_of(75);
            io_frame frame;
            make_usual(75);
            set_normals(view, identity);
            int sky = 0;
            for (int i = 0; i < PIXELS; i++) {
                sky += !isfinite(depth[i]);
                planes[0][i] = (float)(isfinite(depth[i]) ? depth[i] : numbers[k]);
            }
            assert_true(sky > PIXELS / 100);
            load(write_frame(normals, NULL), &request, &frame);
            for (int i = 0; i < PIXELS; i++)
                assert_int_equal(
                    isfinite(*crv_image_at(&frame.depth[0], i % W, i / W, 0)),
                    isfinite(depth[i]));
            assert_int_equal(support_lines.warnings, 0);
            io_frame_free(&frame);
        }
    /* A wall that is seen from in front is no sky, though it holds one number. */
    const io_passes_request request = request_of(50);
    io_frame frame;
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = i % W < W / 2 ? 5.0f : 3.0f + 0.01f * (float)(i % 7);
    load(write_frame(false, NULL), &request, &frame);
    assert_true(*crv_image_at(&frame.depth[0], 0, 0, 0) == 5.0f);
    io_frame_free(&frame);
}

/* To the nearest of 11 bits. */
static float rounded_to_half(float value)
{
    int exponent;
    const float fraction = frexpf(value, &exponent);
    return ldexpf(roundf(ldexpf(fraction, 11)), exponent - 11);
}

/* Halves in a float channel: no wall may come out rough. */
static void test_halves_in_floats(void **state)
{
    (void)state;
    const io_passes_request request = request_of(40);
    io_frame frame;
    make_usual(40);
    set_normals(view, identity);
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = rounded_to_half(planes[0][i]);
    load(write_frame(true, NULL), &request, &frame);
    assert_int_equal(support_lines.warnings, 1);
    assert_non_null(strstr(support_lines.text, "half floats"));
    double rough = 0.0;
    int count = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float d = *crv_image_at(&frame.depth[0], i % W, i / W, 0);
        if (!isfinite(depth[i]))
            continue;
        /* Half a step of the half float, twice: rounding, and smoothing. */
        assert_true(fabs((double)d - depth[i]) <= depth[i] / 1024.0);
        if (world[1][i] < 0.999 || i % W < 2 || i % W >= W - 2)
            continue;
        /* The floor: 1/d has no second differences along a row. */
        const float a = *crv_image_at(&frame.depth[0], i % W - 1, i / W, 0);
        const float b = *crv_image_at(&frame.depth[0], i % W + 1, i / W, 0);
        if (world[1][i - 1] < 0.999 || world[1][i + 1] < 0.999)
            continue;
        rough += fabs(1.0 / (double)a + 1.0 / (double)b - 2.0 / (double)d) * (double)d;
        count++;
    }
    /* Rounding alone leaves about half a step, 1/4096 of d. */
    assert_true(count > 1000);
    assert_true(rough / count < 1.0 / 4096.0 / 8.0);
    io_frame_free(&frame);
}

/* Under depth of field each pixel is an average of its own few rays. */
static void test_noisy_depth(void **state)
{
    (void)state;
    const io_passes_request request = request_of(50);
    uint32_t seed = 1;
    io_frame frame;
    make_usual(50);
    for (int i = 0; i < PIXELS; i++) {
        seed = seed * 1664525u + 1013904223u;
        planes[0][i] *= 1.0f + 0.01f * ((float)(seed >> 8) / 16777216.0f - 0.5f);
    }
    load(write_frame(false, NULL), &request, &frame);
    assert_int_equal(support_lines.warnings, 1);
    assert_non_null(strstr(support_lines.text, "depth is noise"));
    io_frame_free(&frame);
}

/* An antialiased column between a near and a far plane belongs to one of them; without a
 * filter nothing is mixed. */
static void test_mixed_pixels(void **state)
{
    (void)state;
    for (int variant = 0; variant < 4; variant++) {
        const bool normals = variant & 1, filtered = variant & 2;
        io_passes_request request = request_of(50);
        io_frame frame;
        request.normal_space = IO_NORMALS_VIEW;
        for (int i = 0; i < PIXELS; i++) {
            const int x = i % W;
            const bool mixed = filtered && x == 80;
            const bool left = x < 80;
            /* Inverse depth is linear in x on both planes. */
            const double near = 1 / (0.25 + 0.0002 * x), far = 1 / (0.1 + 0.0001 * x);
            planes[0][i] = (float)(mixed ? 0.5 * (near + far) : left ? near : far);
            planes[1][i] = mixed ? 0.0f : left ? 0.6f : -0.6f;
            planes[2][i] = 0.0f;
            planes[3][i] = 0.8f;
        }
        load(write_frame(normals, NULL), &request, &frame);
        for (int y = 0; y < H; y++) {
            const double d = (double)*crv_image_at(&frame.depth[0], 80, y, 0);
            const double near = 1 / (0.25 + 0.0002 * 80), far = 1 / (0.1 + 0.0001 * 80);
            /* Predicted from single precision: a part in 10^4. */
            assert_true(fabs(d / near - 1) < 1e-4 || fabs(d / far - 1) < 1e-4);
            if (normals)
                assert_true(fabsf(*crv_image_at(&frame.normals, 80, y, 0)) > 0.59f);
        }
        assert_int_equal(!filtered, !strstr(support_lines.text, "100 pixels are mixed"));
        assert_int_equal(!filtered, !strstr(support_lines.text, "mixed from two"));
        io_frame_free(&frame);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_level_camera),
        cmocka_unit_test(test_flipped_axes),
        cmocka_unit_test(test_undecided_frame),
        cmocka_unit_test(test_ranges_of_ndc),
        cmocka_unit_test(test_identity_is_no_camera),
        cmocka_unit_test(test_cameras_of_parts),
        cmocka_unit_test(test_encodings),
        cmocka_unit_test(test_radial_without_normals),
        cmocka_unit_test(test_wrong_field_of_view),
        cmocka_unit_test(test_negative_depth),
        cmocka_unit_test(test_unmarked_sky),
        cmocka_unit_test(test_halves_in_floats),
        cmocka_unit_test(test_noisy_depth),
        cmocka_unit_test(test_mixed_pixels),
    };
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}

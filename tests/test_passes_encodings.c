/* SPDX-License-Identifier: MIT */
/* What the numbers of a depth channel are taken for: encoding, sky, and pixels that a
 * filter mixed. */
#include "passes_scene.h"

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

/* Planes are flat in all projective encodings: without normals the numbers must tell
 * which one it is. */
static void test_projective_without_normals(void **state)
{
    (void)state;
    static const double fields[] = {40, 75};
    for (int k = 0; k < 6; k++) {
        const double vfov = fields[k % 2];
        const io_passes_request request = request_of(vfov);
        io_frame frame;
        make_usual(vfov);
        /* 1/d, reversed with an infinite far plane and near 0.1, and negated. */
        for (int i = 0; i < PIXELS; i++)
            planes[0][i] = (float)(isfinite(depth[i]) ? (k < 2   ? 1.0
                                                         : k < 4 ? 0.1
                                                                 : -1.0)
                                                            / depth[i]
                                                      : 0.0);
        load(write_frame(false, NULL), &request, &frame);
        assert_int_equal(support_lines.warnings, 1);
        if (!strstr(support_lines.text, "flat if depth were disparity"))
            fail_msg("%d: %s", k, support_lines.text);
        io_frame_free(&frame);
    }
}

/* Depth that was written in 8 bits, or as whole numbers of a small unit, is told; a ramp
 * along one axis has as few numbers, but no stairs. */
static void test_stairs(void **state)
{
    (void)state;
    const io_passes_request request = request_of(50);
    io_frame frame;
    make_usual(50);
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = (float)(isfinite(depth[i]) ? round(10.0 * depth[i]) / 10.0 : 1e10);
    load(write_frame(false, NULL), &request, &frame);
    assert_non_null(strstr(support_lines.text, " steps of 0.1, as if written in 8 bits"));
    io_frame_free(&frame);
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = (float)(5 + i % W) / 7.0f;
    load(write_frame(false, NULL), &request, &frame);
    assert_null(strstr(support_lines.text, "8 bits"));
    io_frame_free(&frame);
}

/* Distances over a number: directions agree, but lengths do not. */
static void test_normalised(void **state)
{
    (void)state;
    static const double near_planes[] = {0.0, 1.5};
    const io_passes_request request = request_of(50);
    for (int k = 0; k < 2; k++) {
        io_frame frame;
        make_usual(50);
        set_normals(view, identity);
        for (int i = 0; i < PIXELS; i++)
            planes[0][i] =
                (float)(isfinite(depth[i]) ? (depth[i] - near_planes[k]) / 50.0 : 1.0);
        load(write_frame(true, NULL), &request, &frame);
        assert_int_equal(support_lines.warnings, 1);
        assert_non_null(strstr(support_lines.text,
                               k ? "if depth were normalised (0 at near, 1 at far), far "
                                   "about 30 times near"
                                 : "its normals agree: it is normalised"));
        io_frame_free(&frame);
    }
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

/* A filter mixes sky and surfaces: the sky is found nevertheless. */
static void test_filtered_sky(void **state)
{
    (void)state;
    const io_passes_request request = request_of(75);
    io_frame frame;
    int outline = 0;
    make_usual(75);
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = (float)(isfinite(depth[i]) ? depth[i] : 1000.0);
    for (int i = W; i < PIXELS; i++)
        if (isfinite(depth[i]) && !isfinite(depth[i - W])) {
            planes[0][i] = (float)(0.1 * depth[i] + 0.9 * 1000.0);
            outline++;
        }
    assert_true(outline > 50);
    load(write_frame(false, NULL), &request, &frame);
    for (int i = 0; i < PIXELS; i++)
        if (!isfinite(depth[i]))
            assert_true(!isfinite(*crv_image_at(&frame.depth[0], i % W, i / W, 0)));
    io_frame_free(&frame);
}

/* Poles one pixel wide lie between what is before and behind them, as mixed pixels do;
 * silhouettes that are sharp tell that there was no filter. */
static void test_thin_things(void **state)
{
    (void)state;
    const io_passes_request request = request_of(50);
    io_frame frame;
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % W, stripe = x / 10;
        const bool pole = x % 30 == 0 && x > 0;
        planes[0][i] = pole ? 4.0f : stripe % 2 ? 8.0f : 3.0f;
    }
    load(write_frame(false, NULL), &request, &frame);
    assert_null(strstr(support_lines.text, "mixed"));
    for (int i = 0; i < PIXELS; i++)
        assert_true(*crv_image_at(&frame.depth[0], i % W, i / W, 0) == planes[0][i]);
    io_frame_free(&frame);
}

/* An antialiased column between a near and a far plane belongs to one of them; without a
 * filter nothing is mixed. */
static void test_mixed_pixels(void **state)
{
    (void)state;
    for (int variant = 0; variant < 6; variant++) {
        const bool normals = variant & 1, filtered = variant > 1;
        /* Normals that were not filtered with depth: of the left plane. */
        const bool plain = variant > 3;
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
            planes[1][i] = mixed && !plain ? 0.0f : left || mixed ? 0.6f : -0.6f;
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
        cmocka_unit_test(test_encodings),
        cmocka_unit_test(test_radial_without_normals),
        cmocka_unit_test(test_projective_without_normals),
        cmocka_unit_test(test_stairs),
        cmocka_unit_test(test_normalised),
        cmocka_unit_test(test_unmarked_sky),
        cmocka_unit_test(test_filtered_sky),
        cmocka_unit_test(test_mixed_pixels),
        cmocka_unit_test(test_thin_things),
    };
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}

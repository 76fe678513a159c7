/* SPDX-License-Identifier: MIT */
/* G-buffers: depth encodings, strides, normals, layers, guard band. */
#include "fixture.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 96, HEIGHT = 64, COUNT = WIDTH * HEIGHT };

static const double ONE = 1;

static fixture spheres(int orthographic)
{
    crv_camera camera = orthographic ? crv_camera_orthographic(WIDTH, HEIGHT, 4)
                                     : crv_camera_perspective(WIDTH, HEIGHT, 0.8f);
    camera.cx_px += 7; /* off-axis, and pixels that are not square */
    camera.fy_px *= 1.1f;
    return fixture_make(fixture_spheres, &ONE, &camera, WIDTH, HEIGHT);
}

typedef struct bench {
    crv_context *context;
    crv_gbuffer *gbuffer;
    crv_plan *plan;
    float result[COUNT];
} bench;

static void open_bench(bench *b, int32_t layers, const crv_logger *logger)
{
    crv_context_desc context_desc;
    crv_context_desc_init(&context_desc, sizeof context_desc);
    context_desc.logger = logger ? *logger : fixture_strict_logger();
    crv_gbuffer_desc desc;
    crv_gbuffer_desc_init(&desc, sizeof desc, WIDTH, HEIGHT);
    desc.layers = layers;
    crv_options options = fixture_options(NULL);
    assert_int_equal(crv_context_create(&context_desc, &b->context), CRV_OK);
    assert_int_equal(crv_gbuffer_create(b->context, &desc, &b->gbuffer), CRV_OK);
    assert_int_equal(crv_plan_create(b->context, &options, &desc, &b->plan), CRV_OK);
}

static void close_bench(bench *b)
{
    crv_plan_destroy(b->plan);
    crv_gbuffer_destroy(b->gbuffer);
    crv_context_destroy(b->context);
}

static void run_bench(bench *b)
{
    crv_image result = crv_image_packed(b->result, WIDTH, HEIGHT, 1);
    assert_int_equal(crv_plan_run(b->plan, b->gbuffer, &result), CRV_OK);
}

/* The inverse of each encoding, written down from its definition. */
static double encode(const fixture *f, const crv_depth_format *format, int32_t i)
{
    const double d = (double)f->depth[i], n = (double)format->z_near,
                 far = (double)format->z_far;
    const crv_camera *c = &f->camera;
    const int flat = c->projection == CRV_ORTHOGRAPHIC;
    const double u = (i % WIDTH + 0.5 - (double)c->cx_px) / (double)c->fx_px;
    const double v = (i / WIDTH + 0.5 - (double)c->cy_px) / (double)c->fy_px;
    double standard;
    switch (format->encoding) {
    case CRV_DEPTH_RADIAL:
        return flat ? d : d * sqrt(1 + u * u + v * v);
    case CRV_DEPTH_DISPARITY:
        return 1 / d;
    case CRV_DEPTH_HARDWARE:
    case CRV_DEPTH_REVERSED:
        if (isinf(d))
            standard = 1;
        else if (flat)
            standard = (d - n) / (far - n);
        else if (isinf(far))
            standard = 1 - n / d;
        else
            standard = far * (d - n) / (d * (far - n));
        return format->encoding == CRV_DEPTH_REVERSED ? 1 - standard : standard;
    case CRV_DEPTH_NORMALISED:
        return isinf(d) ? 1 : (d - n) / (far - n);
    case CRV_DEPTH_NORMALISED_REVERSED:
        return isinf(d) ? 0 : (far - d) / (far - n);
    case CRV_DEPTH_GL: /* z / w of glFrustum's and glOrtho's matrices */
        if (isinf(d))
            return 1;
        return flat ? (2 * d - far - n) / (far - n)
                    : ((far + n) * d - 2 * far * n) / ((far - n) * d);
    case CRV_DEPTH_LOGARITHMIC:
        return isinf(d) ? 1 : log(1 + d) / log(1 + far);
    case CRV_DEPTH_PLANAR:
        break;
    }
    return d;
}

static void set_frame(bench *b, const fixture *f, const crv_depth_format *format,
                      const float *values)
{
    crv_const_image depth = crv_const_image_packed(values, WIDTH, HEIGHT, 1);
    crv_const_image normals = crv_const_image_packed(f->normals, WIDTH, HEIGHT, 3);
    assert_int_equal(crv_gbuffer_set_camera(b->gbuffer, &f->camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(b->gbuffer, 0, &depth, format), CRV_OK);
    assert_int_equal(crv_gbuffer_set_normals(b->gbuffer, &normals, CRV_NORMAL_VIEW),
                     CRV_OK);
}

static void compare_encoding(const fixture *f, const crv_depth_format *format)
{
    static float values[COUNT], planar[COUNT], expected[COUNT];
    bench b;
    open_bench(&b, 1, NULL);
    set_frame(&b, f, NULL, f->depth);
    run_bench(&b);
    memcpy(expected, b.result, sizeof expected);
    for (int32_t i = 0; i < COUNT; i++)
        values[i] = (float)encode(f, format, i);
    set_frame(&b, f, format, values);
    run_bench(&b);
    crv_image out = crv_image_packed(planar, WIDTH, HEIGHT, 1);
    assert_int_equal(crv_gbuffer_get_depth(b.gbuffer, 0, &out), CRV_OK);
    int32_t different = 0;
    for (int32_t i = 0; i < COUNT; i++) {
        assert_int_equal(isinf(planar[i]), isinf(f->depth[i]));
        /* A 24-bit mantissa near 1 resolves 1 - n/d to 6e-8, which is 6e-8 d/n of
         * d: 1.4e-6 at d = 12, n = 0.5. */
        if (isfinite(f->depth[i]))
            assert_true(fabs((double)planar[i] / (double)f->depth[i] - 1) < 3e-6);
        different += fabs((double)b.result[i] - (double)expected[i]) > 1e-3;
    }
    /* Rounding decides a few samples at the edge of the radius. */
    assert_true(different <= COUNT / 200);
    close_bench(&b);
}

static void encodings_have_names(void **state)
{
    (void)state;
    crv_depth_encoding found = CRV_DEPTH_GL;
    assert_string_equal(crv_depth_encoding_name(CRV_DEPTH_PLANAR), "planar");
    assert_string_equal(crv_depth_encoding_name(CRV_DEPTH_NORMALISED_REVERSED),
                        "normalised-reversed");
    assert_string_equal(crv_depth_encoding_name(CRV_DEPTH_LOGARITHMIC), "logarithmic");
    assert_null(crv_depth_encoding_name((crv_depth_encoding)9));
    assert_null(crv_depth_encoding_name((crv_depth_encoding)-1));
    for (int i = 0; i <= CRV_DEPTH_LOGARITHMIC; i++) {
        const char *name = crv_depth_encoding_name((crv_depth_encoding)i);
        assert_true(crv_depth_encoding_find(name, &found));
        assert_int_equal(found, i);
    }
    assert_false(crv_depth_encoding_find("Planar", &found));
    assert_false(crv_depth_encoding_find(NULL, &found));
    assert_int_equal(found, CRV_DEPTH_LOGARITHMIC);
}

static void every_encoding_gives_the_same_image(void **state)
{
    (void)state;
    static const crv_depth_format FORMATS[] = {
        {CRV_DEPTH_RADIAL, 0, 0, INFINITY},
        {CRV_DEPTH_DISPARITY, 0, 0, 0},
        {CRV_DEPTH_HARDWARE, 0.5f, 100, 0},
        {CRV_DEPTH_REVERSED, 0.5f, 100, 0},
        {CRV_DEPTH_NORMALISED, 0.5f, 20, 0},
        {CRV_DEPTH_NORMALISED_REVERSED, 0, 20, 0},
        {CRV_DEPTH_GL, 0.5f, 100, 0},
        {CRV_DEPTH_LOGARITHMIC, 0, 20, 0},
        {CRV_DEPTH_HARDWARE, 0.5f, INFINITY, 0},
        {CRV_DEPTH_REVERSED, 0.5f, INFINITY, 0},
    };
    fixture perspective = spheres(0), orthographic = spheres(1);
    for (int k = 0; k < 10; k++) {
        compare_encoding(&perspective, &FORMATS[k]);
        if (k < 8) /* an orthographic projection has a finite far plane */
            compare_encoding(&orthographic, &FORMATS[k]);
    }
    fixture_free(&perspective);
    fixture_free(&orthographic);
}

static void a_background_threshold_is_kept(void **state)
{
    (void)state;
    fixture f = spheres(0);
    static float values[COUNT], planar[COUNT];
    for (int32_t i = 0; i < COUNT; i++)
        values[i] = isinf(f.depth[i]) ? 1e10f : f.depth[i];
    bench b;
    open_bench(&b, 1, NULL);
    set_frame(&b, &f, &(crv_depth_format){CRV_DEPTH_PLANAR, 0, 0, 1e10f}, values);
    crv_image out = crv_image_packed(planar, WIDTH, HEIGHT, 1);
    assert_int_equal(crv_gbuffer_get_depth(b.gbuffer, 0, &out), CRV_OK);
    assert_memory_equal(planar, f.depth, sizeof planar);
    close_bench(&b);
    fixture_free(&f);
}

/* The same pixels bottom-up, planar and with gaps give the same image, and nothing is
 * written between them. */
static void strides_are_honoured(void **state)
{
    (void)state;
    enum { GAP = 3, PITCH = WIDTH * GAP + 5 };
    const float guard = -123;
    fixture f = spheres(0);
    static float depth[HEIGHT * PITCH], normals[3][COUNT], out[HEIGHT * PITCH];
    for (int32_t i = 0; i < HEIGHT * PITCH; i++)
        depth[i] = out[i] = guard;
    for (int32_t i = 0; i < COUNT; i++) {
        depth[(HEIGHT - 1 - i / WIDTH) * PITCH + i % WIDTH * GAP] = f.depth[i];
        for (int k = 0; k < 3; k++)
            normals[k][i] = f.normals[3 * i + k];
    }
    bench b;
    open_bench(&b, 1, NULL);
    set_frame(&b, &f, NULL, f.depth);
    run_bench(&b);

    const ptrdiff_t unit = sizeof(float);
    crv_const_image depth_image = {
        depth + (HEIGHT - 1) * PITCH, WIDTH, HEIGHT, 1, -PITCH * unit, GAP * unit, unit};
    crv_const_image normal_image = {normals[0],   WIDTH, HEIGHT,      3,
                                    WIDTH * unit, unit,  COUNT * unit};
    crv_image result = {
        out + (HEIGHT - 1) * PITCH, WIDTH, HEIGHT, 1, -PITCH * unit, GAP * unit, unit};
    assert_int_equal(crv_gbuffer_set_camera(b.gbuffer, &f.camera), CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth(b.gbuffer, 0, &depth_image, NULL), CRV_OK);
    assert_int_equal(crv_gbuffer_set_normals(b.gbuffer, &normal_image, CRV_NORMAL_VIEW),
                     CRV_OK);
    assert_int_equal(crv_plan_run(b.plan, b.gbuffer, &result), CRV_OK);
    for (int32_t i = 0; i < HEIGHT * PITCH; i++) {
        const int32_t y = HEIGHT - 1 - i / PITCH, x = i % PITCH / GAP;
        if (i % PITCH % GAP == 0 && x < WIDTH)
            assert_true(out[i] == b.result[y * WIDTH + x]);
        else
            assert_true(out[i] == guard);
    }
    close_bench(&b);
    fixture_free(&f);
}

/* A G-buffer of 8 x 1 on one set. */
static crv_gbuffer *open_row(crv_isa isa, crv_context **context)
{
    crv_context_desc context_desc;
    crv_gbuffer_desc desc;
    crv_gbuffer *gbuffer = NULL;
    const crv_camera camera = crv_camera_perspective(8, 1, 1);
    crv_context_desc_init(&context_desc, sizeof context_desc);
    context_desc.isa_mask = 1u << isa;
    crv_gbuffer_desc_init(&desc, sizeof desc, 8, 1);
    assert_int_equal(crv_context_create(&context_desc, context), CRV_OK);
    assert_int_equal(crv_gbuffer_create(*context, &desc, &gbuffer), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(gbuffer, &camera), CRV_OK);
    return gbuffer;
}

static void take_row(crv_gbuffer *gbuffer, const crv_texels *texels,
                     const crv_depth_format *format, float out[8])
{
    const crv_image to = crv_image_packed(out, 8, 1, 1);
    assert_int_equal(crv_gbuffer_set_depth_texels(gbuffer, 0, texels, format), CRV_OK);
    assert_int_equal(crv_gbuffer_get_depth(gbuffer, 0, &to), CRV_OK);
}

/* IEEE 754-2008, table 3.5: 1, 3, the largest, the least normal and subnormal numbers;
 * infinity, NaN and what is negative are background. Normals lie in four halves a pixel.
 * All of them are exact. */
static void check_halves(crv_gbuffer *gbuffer)
{
    static const uint16_t HALVES[8] = {0x3c00, 0x4200, 0x7bff, 0x0400,
                                       0x0001, 0x7c00, 0x7e01, 0xc000};
    static const float VALUES[8] = {1,        3,        65504,    0x1p-14f,
                                    0x1p-24f, INFINITY, INFINITY, INFINITY};
    static const float NORMAL[3] = {0, 0.6f, 0.8f}; /* of -0, 0.75, 1 */
    float out[8], normals[8][3];
    uint16_t four[8][4];
    crv_texels from = crv_texels_packed(HALVES, CRV_TEXEL_HALF, 8, 1, 1);
    take_row(gbuffer, &from, NULL, out);
    assert_memory_equal(out, VALUES, sizeof out);
    for (int i = 0; i < 8; i++)
        memcpy(four[i], (uint16_t[4]){0x8000, 0x3a00, 0x3c00, 0x7e00}, sizeof four[i]);
    from = crv_texels_packed(four, CRV_TEXEL_HALF, 8, 1, 4);
    from.channels = 3;
    assert_int_equal(crv_gbuffer_set_normals_texels(gbuffer, &from, CRV_NORMAL_VIEW),
                     CRV_OK);
    const crv_image to = crv_image_packed(normals[0], 8, 1, 3);
    assert_int_equal(crv_gbuffer_get_normals(gbuffer, &to), CRV_OK);
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 3; k++)
            assert_float_equal(normals[i][k], i < 5 ? NORMAL[k] : 0, 1e-6);
    }
}

/* A reversed buffer of 16 bits: d = near / v; 0 is background. Then signed millimetres,
 * three numbers apart and at an odd address. */
static void check_16_bits(crv_gbuffer *gbuffer)
{
    static const uint16_t BUFFER[8] = {65535, 0, 32768, 1, 13107, 65534, 2, 3};
    static const crv_depth_format REVERSED = {CRV_DEPTH_REVERSED, 0.5f, INFINITY,
                                              INFINITY};
    float out[8];
    unsigned char bytes[8 * 6 + 1];
    crv_texels from = crv_texels_packed(BUFFER, CRV_TEXEL_UINT16, 8, 1, 1);
    from.scale = 1 / 65535.0;
    take_row(gbuffer, &from, &REVERSED, out);
    assert_true(out[0] == 0.5f && isinf(out[1]));
    for (int i = 2; i < 8; i++) /* two roundings to floats */
        assert_float_equal(out[i] * BUFFER[i] / (0.5f * 65535), 1, 2e-7);
    for (int i = 0; i < 8; i++) {
        const int16_t mm = (int16_t)(i == 3 ? -7 : 1000 * i + 500);
        memcpy(bytes + 1 + 6 * i, &mm, sizeof mm);
    }
    from = crv_texels_packed(bytes + 1, CRV_TEXEL_INT16, 8, 1, 1);
    from.pixel_stride = 6;
    from.scale = 1e-3;
    take_row(gbuffer, &from, NULL, out);
    for (int i = 0; i < 8; i++)
        assert_true(i == 3 ? isinf(out[i]) : fabs((double)out[i] / (i + 0.5) - 1) < 2e-7);
}

static void pixels_of_other_types_are_taken(void **state)
{
    (void)state;
    for (int isa = 0; crv_isa_name((crv_isa)isa); isa++) {
        if (!(crv_isa_available() >> isa & 1))
            continue;
        crv_context *context = NULL;
        crv_gbuffer *gbuffer = open_row((crv_isa)isa, &context);
        check_halves(gbuffer);
        check_16_bits(gbuffer);
        crv_gbuffer_destroy(gbuffer);
        crv_context_destroy(context);
    }
}

static void texels_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    static const uint16_t HALVES[8] = {0x3c00};
    const crv_texels good = crv_texels_packed(HALVES, CRV_TEXEL_HALF, 8, 1, 1);
    crv_texels bad[6] = {good, good, good, good, good, good};
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = open_row(CRV_ISA_SCALAR, &context);
    bad[0].data = NULL;
    bad[1].type = (crv_texel)6;
    bad[2].width = 7;
    bad[3].channels = 2;
    bad[4].scale = NAN;
    bad[5].offset = 1e300;
    for (int i = 0; i < 6; i++)
        assert_int_equal(crv_gbuffer_set_depth_texels(gbuffer, 0, &bad[i], NULL),
                         CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_set_depth_texels(gbuffer, 0, NULL, NULL),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_set_depth_texels(NULL, 0, &good, NULL),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_set_depth_texels(gbuffer, 1, &good, NULL),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_set_normals_texels(gbuffer, &good, CRV_NORMAL_VIEW),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_gbuffer_set_normals_texels(gbuffer, NULL, CRV_NORMAL_VIEW),
                     CRV_OK);
    assert_int_equal(crv_gbuffer_set_depth_texels(gbuffer, 0, &good, NULL), CRV_OK);
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
}

/* Degrees between two unit vectors. */
static double angle(const float *a, const float *b)
{
    double dot = 0;
    for (int k = 0; k < 3; k++)
        dot += (double)a[k] * (double)b[k];
    return acos(fmin(1, fmax(-1, dot))) * 57.29577951308232;
}

static void get_normals(bench *b, float *out)
{
    crv_image image = crv_image_packed(out, WIDTH, HEIGHT, 3);
    assert_int_equal(crv_gbuffer_get_normals(b->gbuffer, &image), CRV_OK);
}

static void normals_come_back_from_depth(void **state)
{
    (void)state;
    static float normals[3 * COUNT];
    for (int flat = 0; flat < 2; flat++) {
        fixture f = spheres(flat);
        bench b;
        open_bench(&b, 1, NULL);
        set_frame(&b, &f, NULL, f.depth);
        assert_int_equal(crv_gbuffer_set_normals(b.gbuffer, NULL, CRV_NORMAL_VIEW),
                         CRV_OK);
        get_normals(&b, normals);
        int32_t surface = 0, good = 0;
        for (int32_t i = 0; i < COUNT; i++) {
            const float *n = normals + 3 * i;
            if (isinf(f.depth[i])) {
                assert_true(n[0] == 0 && n[1] == 0 && n[2] == 0);
                continue;
            }
            surface++;
            /* A one-sided difference over one pixel of a sphere of some 15 px radius
             * turns by up to 4 degrees, more towards the silhouette. */
            good += angle(n, f.normals + 3 * i) < 6;
        }
        assert_true(good > surface * 85 / 100);
        close_bench(&b);
        fixture_free(&f);
    }
}

/* Beside a step in depth the normal must be that of the pixel's own plane. */
static void reconstruction_does_not_cross_edges(void **state)
{
    (void)state;
    crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 0.8f);
    const double near_plane[3] = {0.6, 5, 0.3}, far_plane[3] = {0.9, 9, 1.2};
    fixture a = fixture_make(fixture_plane, near_plane, &camera, WIDTH, HEIGHT);
    fixture c = fixture_make(fixture_plane, far_plane, &camera, WIDTH, HEIGHT);
    static float normals[3 * COUNT];
    for (int32_t i = 0; i < COUNT; i++) {
        if ((i % WIDTH / 8 + i / WIDTH / 8) % 2) { /* a chequerboard of the two */
            a.depth[i] = c.depth[i];
            memcpy(a.normals + 3 * i, c.normals + 3 * i, 3 * sizeof(float));
        }
    }
    bench b;
    open_bench(&b, 1, NULL);
    set_frame(&b, &a, NULL, a.depth);
    assert_int_equal(crv_gbuffer_set_normals(b.gbuffer, NULL, CRV_NORMAL_VIEW), CRV_OK);
    get_normals(&b, normals);
    for (int32_t i = 0; i < COUNT;
         i++) /* depth rounds to 3e-7 of a pixel's width of 0.06 */
        assert_true(angle(normals + 3 * i, a.normals + 3 * i) < 0.1);
    close_bench(&b);
    fixture_free(&a);
    fixture_free(&c);
}

static void world_space_normals_are_turned(void **state)
{
    (void)state;
    fixture f = spheres(0);
    const float eye[3] = {1, 2, 3}, target[3] = {-2, 0.5f, 1}, up[3] = {0.1f, 1, 0};
    assert_int_equal(crv_camera_look_at(&f.camera, eye, target, up), CRV_OK);
    static float world[3 * COUNT], normals[3 * COUNT];
    const float *m = f.camera.world_to_view;
    for (int32_t i = 0; i < COUNT; i++) {
        for (int k = 0; k < 3;
             k++) { /* transpose = inverse: view to world; any length will do */
            world[3 * i + k] =
                2.5f
                * (m[k] * f.normals[3 * i] + m[3 + k] * f.normals[3 * i + 1]
                   + m[6 + k] * f.normals[3 * i + 2]);
        }
    }
    bench b;
    open_bench(&b, 1, NULL);
    set_frame(&b, &f, NULL, f.depth);
    crv_const_image image = crv_const_image_packed(world, WIDTH, HEIGHT, 3);
    assert_int_equal(crv_gbuffer_set_normals(b.gbuffer, &image, CRV_NORMAL_WORLD),
                     CRV_OK);
    get_normals(&b, normals);
    for (int32_t i = 0; i < COUNT; i++) {
        if (isfinite(
                f.depth[i])) /* single precision, and silhouettes bent by 0.06 degrees */
            assert_true(angle(normals + 3 * i, f.normals + 3 * i) < 0.1);
    }
    close_bench(&b);
    fixture_free(&f);
}

static void unusable_normals_are_mended(void **state)
{
    (void)state;
    fixture f = spheres(0);
    static float damaged[3 * COUNT], normals[3 * COUNT], from_depth[3 * COUNT];
    bench b;
    open_bench(&b, 1, NULL);
    set_frame(&b, &f, NULL, f.depth);
    assert_int_equal(crv_gbuffer_set_normals(b.gbuffer, NULL, CRV_NORMAL_VIEW), CRV_OK);
    get_normals(&b, from_depth);
    for (int32_t i = 0; i < COUNT; i++) {
        for (int k = 0; k < 3; k++) {
            const float n = f.normals[3 * i + k];
            damaged[3 * i + k] = i % 4 == 0   ? 0
                                 : i % 4 == 1 ? NAN
                                 : i % 4 == 2 ? -n
                                              : n * 1e-30f;
        }
    }
    crv_const_image image = crv_const_image_packed(damaged, WIDTH, HEIGHT, 3);
    assert_int_equal(crv_gbuffer_set_normals(b.gbuffer, &image, CRV_NORMAL_VIEW), CRV_OK);
    get_normals(&b, normals);
    for (int32_t i = 0; i < COUNT; i++) {
        if (isinf(f.depth[i]))
            continue;
        if (i % 4 < 2) /* zero, NaN: as reconstructed */
            assert_memory_equal(normals + 3 * i, from_depth + 3 * i, 3 * sizeof(float));
        else if (angle(f.normals + 3 * i, from_depth + 3 * i)
                 < 45) /* turned round, or scaled */
            assert_true(angle(normals + 3 * i, f.normals + 3 * i) < 0.1);
    }
    close_bench(&b);
    fixture_free(&f);
}

/* n.V is -0.2: interpolated, for depth shows a surface that faces the camera. */
static void normals_that_look_away_are_bent(void **state)
{
    (void)state;
    const crv_camera camera = crv_camera_orthographic(WIDTH, HEIGHT, 8);
    const double plane[3] = {0.785, 10, 0};
    fixture f = fixture_make(fixture_plane, plane, &camera, WIDTH, HEIGHT);
    static float away[3 * COUNT], normals[3 * COUNT];
    for (int32_t i = 0; i < COUNT; i++) { /* sideways as the plane's, but leaning back */
        const double x = (double)f.normals[3 * i], y = (double)f.normals[3 * i + 1];
        away[3 * i] = (float)(x / hypot(x, y) * sqrt(1 - 0.04));
        away[3 * i + 1] = (float)(y / hypot(x, y) * sqrt(1 - 0.04));
        away[3 * i + 2] = -0.2f;
    }
    bench b;
    open_bench(&b, 1, NULL);
    set_frame(&b, &f, NULL, f.depth);
    const crv_const_image image = crv_const_image_packed(away, WIDTH, HEIGHT, 3);
    assert_int_equal(crv_gbuffer_set_normals(b.gbuffer, &image, CRV_NORMAL_VIEW), CRV_OK);
    get_normals(&b, normals);
    /* n + 0.3 V, of unit length: 0.1 / sqrt(1 - 0.04 + 0.01) */
    for (int32_t i = 0; i < COUNT; i++)
        assert_true(fabs((double)normals[3 * i + 2] - 0.1 / sqrt(0.97)) < 1e-5);
    close_bench(&b);
    fixture_free(&f);
}

/* A far surface seen in the second layer occludes what the first layer's near bar hides.
 */
static void a_second_layer_occludes(void **state)
{
    (void)state;
    crv_camera camera = crv_camera_orthographic(WIDTH, HEIGHT, 6.4f); /* 10 px a unit */
    const double depth = 10;
    fixture f = fixture_make(fixture_groove, &depth, &camera, WIDTH, HEIGHT);
    static float second[COUNT];
    memcpy(second, f.depth, sizeof second);
    fixture one = f;
    crv_options options = fixture_options(NULL);
    options.filter = NULL;
    options.radius = 3;
    options.falloff = CRV_FALLOFF_NONE;
    options.directions = 64;
    options.steps = 64;
    float *whole = fixture_compute(&f, &options, NULL);
    /* A bar far in front hides the right wall but for the columns that are looked at. */
    const int32_t probe = HEIGHT / 2 * WIDTH + WIDTH / 2 - 10;
    for (int32_t i = 0; i < COUNT; i++) {
        if (i % WIDTH > WIDTH / 2)
            one.depth[i] = 1;
        else
            second[i] = INFINITY;
    }
    float *hidden = fixture_compute(&one, &options, NULL);
    float *layered =
        fixture_compute(&one, &options, &(fixture_run){.second_layer = second});
    assert_true(hidden[probe] - whole[probe] > 0.1);
    assert_true(fabsf(layered[probe] - whole[probe]) < 1e-6f); /* the same samples */
    free(whole);
    free(hidden);
    free(layered);
    fixture_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(encodings_have_names),
        cmocka_unit_test(every_encoding_gives_the_same_image),
        cmocka_unit_test(a_background_threshold_is_kept),
        cmocka_unit_test(strides_are_honoured),
        cmocka_unit_test(pixels_of_other_types_are_taken),
        cmocka_unit_test(texels_that_do_not_fit_are_refused),
        cmocka_unit_test(normals_come_back_from_depth),
        cmocka_unit_test(reconstruction_does_not_cross_edges),
        cmocka_unit_test(world_space_normals_are_turned),
        cmocka_unit_test(unusable_normals_are_mended),
        cmocka_unit_test(normals_that_look_away_are_bent),
        cmocka_unit_test(a_second_layer_occludes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

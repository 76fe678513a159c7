/* SPDX-License-Identifier: MIT */
#include "test_scene_support.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 96, HEIGHT = 64, PIXELS = WIDTH * HEIGHT };

/* A floor with a large plate over it, seen from above and to the side. */
static const char *const plate_over_floor =
    "v -9 0 9\nv 9 0 9\nv 9 0 -9\nv -9 0 -9\nf 1 2 3 4\n"
    "v -1.5 1.5 1.5\nv 1.5 1.5 1.5\nv 1.5 1.5 -1.5\nv -1.5 1.5 -1.5\nf 5 6 7 8\n";

typedef struct picture {
    scene *scene;
    scene_gbuffer gbuffer;
    float open[PIXELS], dark[PIXELS];
    float plain[3 * PIXELS], with_open[3 * PIXELS], with_dark[3 * PIXELS];
} picture;

static void shade(const picture *p, float *accessibility, float *rgb, int32_t threads)
{
    crv_image image = crv_image_packed(rgb, WIDTH, HEIGHT, 3);
    scene_occlusion ao = {0};
    if (accessibility)
        ao.accessibility = crv_const_image_packed(accessibility, WIDTH, HEIGHT, 1);
    assert_int_equal(scene_shade(p->scene, &p->gbuffer, NULL, accessibility ? &ao : NULL,
                                 &image, threads, NULL),
                     0);
}

static int make_picture(void **state)
{
    static const double eye[3] = {4, 8, 9}, target[3] = {0, 1.5, 0};
    picture *p = calloc(1, sizeof *p);
    scene_view view = look(CRV_PERSPECTIVE, eye, target, 0.0);
    scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    assert_non_null(p);
    request.guard_px = 4;
    p->scene = load_text("plate.obj", plate_over_floor);
    p->gbuffer = render(p->scene, &request);
    for (int i = 0; i < PIXELS; i++)
        p->open[i] = 1.0f;
    shade(p, NULL, p->plain, 0);
    shade(p, p->open, p->with_open, 1);
    shade(p, p->dark, p->with_dark, 3);
    *state = p;
    return 0;
}

static int free_picture(void **state)
{
    picture *p = *state;
    scene_gbuffer_free(&p->gbuffer);
    scene_free(p->scene);
    free(p);
    remove_files(NULL);
    return 0;
}

static bool is_background(const picture *p, int pixel)
{
    int x = pixel % WIDTH + 4, y = pixel / WIDTH + 4;
    return isinf(p->gbuffer.depth[0][y * p->gbuffer.desc.width + x]);
}

static void test_open_is_as_without(void **state)
{
    const picture *p = *state;
    assert_memory_equal(p->plain, p->with_open, sizeof p->plain);
}

static void test_values_are_sound(void **state)
{
    const picture *p = *state;
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_true(p->plain[i] >= 0.0f && p->plain[i] <= 1.0f);
}

/* Where no sky reaches, shadow is black and the key light is all there is: the floor has
 * the same brightness everywhere in the light. */
static void test_key_light_is_not_darkened(void **state)
{
    const picture *p = *state;
    int lit = 0, shadowed = 0;
    float bright = 0.0f;
    for (int i = 0; i < PIXELS; i++)
        if (!is_background(p, i))
            bright = fmaxf(bright, p->with_dark[3 * i]);
    assert_true(bright > 0.2f);
    for (int i = 0; i < PIXELS; i++) {
        float value = p->with_dark[3 * i];
        if (is_background(p, i))
            continue;
        if (value == 0.0f)
            shadowed++;
        else if (fabsf(value - bright) < 1e-4f)
            lit++;
        else
            fail(); /* floor and plate are parallel: there is no third brightness */
        assert_true(p->plain[3 * i] > value);
    }
    assert_true(lit > PIXELS / 3);
    assert_true(shadowed > PIXELS / 100);
}

static void test_background_is_sky(void **state)
{
    const picture *p = *state;
    int background = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float *sky = p->with_dark + 3 * i;
        if (!is_background(p, i))
            continue;
        background++;
        assert_memory_equal(sky, p->plain + 3 * i, 3 * sizeof *sky);
        assert_true(sky[2] > sky[0] && sky[2] > 0.3f);
    }
    assert_true(background > 20);
}

/* A white floor under this light, seen from above: every pixel alike but for
 * accessibility. */
static void shade_floor(const scene_lighting *light, float *accessibility, float *rgb)
{
    static const double eye[3] = {0, 5, 1}, target[3] = {0, 0, 0};
    scene *s = load_text("floor.obj", "v -99 0 99\nv 99 0 99\nv 0 0 -99\nf 1 2 3\n");
    scene_view view = look(CRV_PERSPECTIVE, eye, target, 0.0);
    scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    scene_gbuffer g = render(s, &request);
    crv_image image = crv_image_packed(rgb, WIDTH, HEIGHT, 3);
    const scene_occlusion ao = {
        .accessibility = crv_const_image_packed(accessibility, WIDTH, HEIGHT, 1)};
    for (int i = 0; i < PIXELS; i++)
        accessibility[i] = (float)i / PIXELS;
    assert_int_equal(scene_shade(s, &g, light, &ao, &image, 0, NULL), 0);
    scene_gbuffer_free(&g);
    scene_free(s);
}

/* Albedo 0.8 (sky accessibility + key). A gradient's integral is a sum over 256 heights,
 * good to about 1e-5. */
static void assert_floor(const scene_lighting *light, const double sky[3],
                         const double key[3])
{
    float *buffer = calloc(4 * PIXELS, sizeof *buffer), *rgb = buffer + PIXELS;
    assert_non_null(buffer);
    shade_floor(light, buffer, rgb);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            double expected = 0.8 * (sky[c] * (double)buffer[i] + key[c]);
            if (fabs((double)rgb[3 * i + c] - expected) > 5e-5)
                fail_msg("%g is not %g", (double)rgb[3 * i + c], expected);
        }
    free(buffer);
}

static const double none[3] = {0, 0, 0};

static void test_lights_add_up(void **state)
{
    static const double constant[3] = {0.25, 0.5, 2.0}, painted[3] = {0.30, 0.36, 0.46};
    static const double key[3] = {0.6 * 3.0, 0.6 * 2.0, 0.6};
    scene_lighting l = scene_lighting_default();
    (void)state;
    memset(l.key_colour, 0, sizeof l.key_colour);
    assert_floor(&l, painted, none);
    l.sky = SCENE_SKY_CONSTANT;
    for (int c = 0; c < 3; c++) {
        l.constant[c] = (float)constant[c];
        l.key_colour[c] = 3.0f - (float)c;
    }
    l.key_direction[0] = 8.0f; /* any length; 0.6 is the cosine to the floor's normal */
    l.key_direction[1] = 6.0f;
    assert_floor(&l, constant, key);
    l.key_direction[1] = -6.0f; /* from below */
    assert_floor(&l, constant, none);
}

/* The floor sees the zenith, wherever that is turned to. */
static void test_sky_turns_with_its_up(void **state)
{
    static const double up[3] = {0.8 * 3 + 0.2, 0.8 * 2 + 0.2, 0.8 + 0.2};
    static const double ground[3] = {0.25, 0.5, 0.75};
    scene_lighting l = scene_lighting_default();
    (void)state;
    memset(l.key_colour, 0, sizeof l.key_colour);
    l.sky = SCENE_SKY_GRADIENT;
    for (int c = 0; c < 3; c++) {
        l.zenith[c] = 3.0f - (float)c;
        l.horizon[c] = 1.0f;
        l.ground[c] = (float)ground[c];
    }
    assert_floor(&l, up, none);
    l.sky_up[1] = 20.0f;
    assert_floor(&l, up, none);
    l.sky_up[1] = -3.0f;
    assert_floor(&l, ground, none);
    /* An environment 2 d.a + 1 in red, whose irradiance / pi is 4/3 n.a + 1: with the
     * zenith turned to +X, what was in -X is above. */
    l.sky = SCENE_SKY_ENVIRONMENT;
    memset(l.environment, 0, sizeof l.environment);
    l.environment[0][0] = (float)sqrt(4 * PI);
    l.environment[3][0] = (float)(-2 * sqrt(4 * PI / 3)); /* a = -X */
    l.sky_up[0] = 2.0f;
    l.sky_up[1] = 0.0f;
    assert_floor(&l, (const double[3]){7. / 3, 0, 0}, none);
    l.sky_up[0] = 0.0f;
    l.sky_up[1] = 1.0f;
    assert_floor(&l, (const double[3]){1, 0, 0}, none);
    l.sky_up[1] = -1.0f;
    assert_floor(&l, (const double[3]){1, 0, 0}, none);
}

/* Each pixel of the background shows its direction's radiance. */
static void test_background_directions(void **state)
{
    const picture *p = *state;
    float rgb[3 * PIXELS], sky[3 * 16 * 8];
    crv_image image = crv_image_packed(rgb, WIDTH, HEIGHT, 3);
    scene_lighting l = scene_lighting_default();
    int background = 0;
    for (int i = 0; i < 3 * 16 * 8; i++)
        sky[i] = (float)(i * 37 % 101) / 64.0f;
    assert_int_equal(scene_sky_from_equirect(sky, 16, 8, "sky", &l, NULL), 0);
    for (int kind = 1; kind <= 4; kind++) {
        l.sky = kind == 4 ? SCENE_SKY_ENVIRONMENT : (scene_sky)kind;
        l.picture = kind == 4 ? NULL : sky;
        assert_int_equal(scene_shade(p->scene, &p->gbuffer, &l, NULL, &image, 0, NULL),
                         0);
        for (int i = 0; i < PIXELS; i++) {
            ray r = ray_of_pixel(&p->gbuffer, i % WIDTH + 4, i / WIDTH + 4);
            double length = sqrt(dot(r.direction, r.direction));
            float direction[3], expected[3];
            if (!is_background(p, i))
                continue;
            background++;
            for (int k = 0; k < 3; k++)
                direction[k] = (float)(r.direction[k] / length);
            scene_sky_radiance(&l, direction, expected);
            for (int c = 0; c < 3; c++)
                assert_true(fabsf(rgb[3 * i + c] - expected[c]) < 1e-4f);
        }
    }
    assert_true(background > 4 * 20);
}

static void test_default_light(void **state)
{
    const picture *p = *state;
    static float rgb[3 * PIXELS];
    const scene_lighting l = scene_lighting_default();
    crv_image image = crv_image_packed(rgb, WIDTH, HEIGHT, 3);
    assert_int_equal(scene_shade(p->scene, &p->gbuffer, &l, NULL, &image, 0, NULL), 0);
    assert_memory_equal(rgb, p->plain, sizeof rgb);
}

static void note_rows(void *user, int32_t rows)
{
    int32_t *last = user;
    assert_int_equal(rows, *last + 1);
    *last = rows;
}

static void test_rows_are_told(void **state)
{
    static float rgb[3 * PIXELS];
    const picture *p = *state;
    const crv_image image = crv_image_packed(rgb, WIDTH, HEIGHT, 3);
    scene_lighting l = scene_lighting_default();
    int32_t last = 0;
    l.watch = note_rows;
    l.user = &last;
    assert_int_equal(scene_shade(p->scene, &p->gbuffer, &l, NULL, &image, 1, NULL), 0);
    assert_int_equal(last, HEIGHT);
    assert_memory_equal(rgb, p->plain, sizeof rgb);
}

static void test_refuses_other_sizes(void **state)
{
    picture *p = *state;
    messages m;
    crv_logger log = catch_messages(&m);
    static float rgb[3 * (WIDTH + 1) * HEIGHT];
    crv_image wide = crv_image_packed(rgb, WIDTH + 1, HEIGHT, 3);
    crv_image grey = crv_image_packed(rgb, WIDTH, HEIGHT, 1);
    crv_image good = crv_image_packed(rgb, WIDTH, HEIGHT, 3);
    assert_int_equal(scene_shade(p->scene, &p->gbuffer, NULL, NULL, &wide, 0, &log), -1);
    assert_error_line(&m, "picture");
    assert_int_equal(scene_shade(p->scene, &p->gbuffer, NULL, NULL, &grey, 0, NULL), -1);
    const scene_occlusion wrong[] = {
        {.accessibility = crv_const_image_packed(rgb, WIDTH, HEIGHT, 2)},
        {.accessibility = crv_const_image_packed(rgb, WIDTH + 1, HEIGHT, 1)},
        {.bent_normal = crv_const_image_packed(rgb, WIDTH, HEIGHT, 1)}};
    for (size_t i = 0; i < 3; i++)
        assert_int_equal(
            scene_shade(p->scene, &p->gbuffer, NULL, &wrong[i], &good, 0, NULL), -1);
}

/* Each colour has its own accessibility; one channel stands for all three. */
static void test_accessibility_of_colours(void **state)
{
    picture *p = *state;
    static float access[3 * PIXELS], rgb[3 * PIXELS];
    crv_image image = crv_image_packed(rgb, WIDTH, HEIGHT, 3);
    const scene_occlusion ao = {.accessibility =
                                    crv_const_image_packed(access, WIDTH, HEIGHT, 3)};
    for (int i = 0; i < PIXELS; i++)
        access[3 * i + 1] = 1.0f;
    assert_int_equal(scene_shade(p->scene, &p->gbuffer, NULL, &ao, &image, 0, NULL), 0);
    for (int i = 0; i < PIXELS; i++) {
        assert_memory_equal(&rgb[3 * i], &p->with_dark[3 * i], sizeof *rgb);
        assert_memory_equal(&rgb[3 * i + 1], &p->plain[3 * i + 1], sizeof *rgb);
        assert_memory_equal(&rgb[3 * i + 2], &p->with_dark[3 * i + 2], sizeof *rgb);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_open_is_as_without),
                                       cmocka_unit_test(test_accessibility_of_colours),
                                       cmocka_unit_test(test_values_are_sound),
                                       cmocka_unit_test(test_key_light_is_not_darkened),
                                       cmocka_unit_test(test_background_is_sky),
                                       cmocka_unit_test(test_lights_add_up),
                                       cmocka_unit_test(test_sky_turns_with_its_up),
                                       cmocka_unit_test(test_background_directions),
                                       cmocka_unit_test(test_default_light),
                                       cmocka_unit_test(test_rows_are_told),
                                       cmocka_unit_test(test_refuses_other_sizes)};
    return cmocka_run_group_tests(tests, make_picture, free_picture);
}

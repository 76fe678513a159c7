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
    crv_image ao, image = crv_image_packed(rgb, WIDTH, HEIGHT, 3);
    if (accessibility)
        ao = crv_image_packed(accessibility, WIDTH, HEIGHT, 1);
    assert_int_equal(scene_shade(p->scene, &p->gbuffer, accessibility ? &ao : NULL,
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
    remove_files();
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

static void test_refuses_other_sizes(void **state)
{
    picture *p = *state;
    messages m;
    crv_logger log = catch_messages(&m);
    static float rgb[3 * (WIDTH + 1) * HEIGHT];
    crv_image wide = crv_image_packed(rgb, WIDTH + 1, HEIGHT, 3);
    crv_image grey = crv_image_packed(rgb, WIDTH, HEIGHT, 1);
    crv_image good = crv_image_packed(rgb, WIDTH, HEIGHT, 3);
    assert_int_equal(scene_shade(p->scene, &p->gbuffer, NULL, &wide, 0, &log), -1);
    assert_error_line(&m, "picture");
    assert_int_equal(scene_shade(p->scene, &p->gbuffer, NULL, &grey, 0, NULL), -1);
    assert_int_equal(scene_shade(p->scene, &p->gbuffer, &good, &good, 0, NULL), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_open_is_as_without),
                                       cmocka_unit_test(test_values_are_sound),
                                       cmocka_unit_test(test_key_light_is_not_darkened),
                                       cmocka_unit_test(test_background_is_sky),
                                       cmocka_unit_test(test_refuses_other_sizes)};
    return cmocka_run_group_tests(tests, make_picture, free_picture);
}

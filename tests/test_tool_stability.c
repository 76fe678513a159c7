/* SPDX-License-Identifier: MIT */
/* Change from frame to frame, against values known by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "study/stability.h"

enum { WIDTH = 16, HEIGHT = 12, PIXELS = WIDTH * HEIGHT };

/* A wall that faces the camera, 2 units away. */
typedef struct picture {
    stability_frame frame;
    float depth[PIXELS], normals[3 * PIXELS], accessibility[PIXELS], repetition[PIXELS];
    uint8_t mask[PIXELS];
} picture;

static void make(picture *p, crv_camera camera)
{
    memset(p, 0, sizeof *p);
    for (int i = 0; i < PIXELS; i++) {
        p->depth[i] = 2.0f;
        p->normals[3 * i + 2] = 1.0f;
        p->mask[i] = 1;
    }
    p->frame = (stability_frame){.camera = camera,
                                 .width = WIDTH,
                                 .height = HEIGHT,
                                 .depth = p->depth,
                                 .normals = p->normals,
                                 .accessibility = p->accessibility,
                                 .mask = p->mask};
}

/* 4 pixels a unit. */
static crv_camera orthographic(void)
{
    return crv_camera_orthographic(WIDTH, HEIGHT, HEIGHT / 4.0f);
}

/* Values without order, in [0, 1). */
static float picture_at(int x, int y)
{
    return (float)((x * 7919 + y * 104729 + 40) % 101) / 101.0f;
}

static stability change(const picture *former, const picture *latter)
{
    stability sum = {0};
    stability_add(&sum, &former->frame, &latter->frame);
    return sum;
}

static void a_still_camera_sees_no_change(void **state)
{
    static picture a, b;
    stability s;
    (void)state;
    make(&a, crv_camera_perspective(WIDTH, HEIGHT, 1.0f));
    for (int i = 0; i < PIXELS; i++) {
        a.depth[i] = i % WIDTH < 5 ? 1.0f : 3.0f;
        a.accessibility[i] = picture_at(i % WIDTH, i / WIDTH);
    }
    a.depth[7] = INFINITY;
    make(&b, a.frame.camera);
    memcpy(b.depth, a.depth, sizeof b.depth);
    memcpy(b.accessibility, a.accessibility, sizeof b.accessibility);
    s = change(&a, &b);
    assert_int_equal(s.points, PIXELS - 1);
    assert_int_equal(s.lost, 0);
    /* Positions are floats: 1e-6 pixel of 16. */
    assert_true(fabs(s.change2) < 1e-9);
    assert_true(s.motion2_px < 1e-9);
}

/* The camera moves three pixels to the right and two up, the picture the other way. */
static void a_pan_by_whole_pixels_changes_nothing(void **state)
{
    static picture a, b;
    stability s;
    (void)state;
    make(&a, orthographic());
    make(&b, orthographic());
    b.frame.eye[0] = 0.75f;
    b.frame.eye[1] = 0.5f;
    for (int i = 0; i < PIXELS; i++) {
        a.accessibility[i] = picture_at(10 + i % WIDTH, 10 + i / WIDTH);
        b.accessibility[i] = picture_at(10 + i % WIDTH + 3, 10 + i / WIDTH - 2);
    }
    s = change(&a, &b);
    assert_int_equal(s.points, (WIDTH - 3) * (HEIGHT - 2));
    assert_int_equal(s.lost, PIXELS - (WIDTH - 3) * (HEIGHT - 2));
    assert_true(fabs(s.change2) < 1e-9);
    assert_true(fabs(s.motion2_px / (double)s.points - 13.0) < 1e-4);
}

static void a_known_flicker_is_what_it_is(void **state)
{
    static picture a, b;
    stability s;
    (void)state;
    make(&a, orthographic());
    make(&b, orthographic());
    for (int i = 0; i < PIXELS; i++) {
        a.accessibility[i] = 0.5f;
        b.accessibility[i] = i % 3 == 0 ? 0.75f : 0.25f;
    }
    s = change(&a, &b);
    assert_int_equal(s.points, PIXELS);
    assert_true(fabs(s.change2 - PIXELS * 0.0625) < 1e-9);
}

/* 0.5 in one estimate, -0.25 in the other: independent errors cancel. */
static void a_repetition_multiplies(void **state)
{
    static picture a, b;
    stability s;
    (void)state;
    make(&a, orthographic());
    make(&b, orthographic());
    a.frame.repetition = a.repetition;
    b.frame.repetition = b.repetition;
    for (int i = 0; i < PIXELS; i++) {
        b.accessibility[i] = 0.5f;
        a.repetition[i] = 0.25f;
    }
    s = change(&a, &b);
    assert_true(fabs(s.change2 + PIXELS * 0.125) < 1e-9);
}

/* Half a pixel to the right: every point is midway between two texels. */
static void between_texels_the_picture_is_bilinear(void **state)
{
    static picture a, b;
    stability s;
    (void)state;
    make(&a, orthographic());
    make(&b, orthographic());
    b.frame.eye[0] = 0.125f;
    for (int i = 0; i < PIXELS; i++) {
        a.accessibility[i] = (float)(i % WIDTH) / 16.0f;
        b.accessibility[i] = ((float)(i % WIDTH) + 0.5f) / 16.0f;
        b.mask[i] = i % WIDTH < WIDTH - 1; /* the last has no second texel */
    }
    s = change(&a, &b);
    assert_int_equal(s.points + s.lost, PIXELS - HEIGHT);
    assert_int_equal(s.lost, 0);
    assert_true(fabs(s.change2) < 1e-9);
    for (int i = 0; i < PIXELS; i++) {
        a.accessibility[i] = (float)(i % 2); /* stripes: 0.5 between them */
        b.accessibility[i] = (float)(i % 2);
    }
    s = change(&a, &b);
    assert_true(fabs(s.change2 - 0.25 * (PIXELS - HEIGHT)) < 1e-4);
}

/*
 * A bar 1 unit away before a wall 2 units away; 8 pixels of focal length. The camera
 * moves a quarter of a unit to the right: the bar moves 2 pixels to the left, from
 * columns 8..11 to 6..9, the wall 1. Column 10 shows what was column 11, behind the bar;
 * what column 15 shows was outside.
 */
static void what_was_hidden_is_left_out(void **state)
{
    static picture a, b;
    stability s;
    crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 1.0f);
    (void)state;
    camera.fx_px = camera.fy_px = 8.0f;
    make(&a, camera);
    make(&b, camera);
    b.frame.eye[0] = 0.25f;
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % WIDTH;
        const int bar_a = x >= 8 && x < 12, bar_b = x >= 6 && x < 10;
        a.depth[i] = bar_a ? 1.0f : 2.0f;
        b.depth[i] = bar_b ? 1.0f : 2.0f;
        a.accessibility[i] = bar_a ? 0.25f : 0.75f;
        b.accessibility[i] = x == 10 || x == 15 ? 0.0f : bar_b ? 0.25f : 0.75f;
    }
    s = change(&a, &b);
    assert_int_equal(s.lost, 2 * HEIGHT);
    assert_int_equal(s.points, (WIDTH - 2) * HEIGHT);
    assert_true(fabs(s.change2) < 1e-9);
    /* Four columns move by 2, ten by 1. */
    assert_true(fabs(s.motion2_px - HEIGHT * (4 * 4.0 + 10.0)) < 1e-3);
}

/* A texel in the point's plane that faces elsewhere is of another surface. */
static void another_normal_is_another_surface(void **state)
{
    static picture a, b;
    stability s;
    (void)state;
    make(&a, orthographic());
    make(&b, orthographic());
    for (int i = 0; i < PIXELS; i += 2) {
        a.normals[3 * i] = 0.6f; /* 37 degrees */
        a.normals[3 * i + 2] = 0.8f;
        b.accessibility[i] = 1.0f;
    }
    s = change(&a, &b);
    assert_int_equal(s.lost, PIXELS / 2);
    assert_true(fabs(s.change2) < 1e-9);
}

/*
 * The camera turned by 90 degrees about its axis: view = (-Y, X, Z), so that world (X, Y)
 * at column cx + 4 X and row cy - 4 Y before is at column cx - 4 Y and row cy - 4 X.
 * About the centre (8, 6), pixel (x, y) shows what was at column 8 - (y - 5.5) - 0.5 = 13
 * - y and row 6 + (x - 7.5) - 0.5 = x - 2.
 */
static void a_turned_camera_finds_its_points(void **state)
{
    static const float turn[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
    static picture a, b;
    int found = 0;
    (void)state;
    make(&a, orthographic());
    make(&b, orthographic());
    memcpy(b.frame.camera.world_to_view, turn, sizeof turn);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            const int column = 13 - y, row = x - 2;
            stability_taps taps;
            double weight = 0.0;
            stability_find(&a.frame, &b.frame, x, y, &taps);
            for (int k = 0; k < taps.count; k++)
                if (taps.index[k] == row * WIDTH + column)
                    weight = taps.weight[k];
            if (row < 0 || row >= HEIGHT) {
                assert_int_equal(taps.count, 0);
                continue;
            }
            assert_true(weight > 1.0 - 1e-4);
            found++;
        }
    }
    assert_int_equal(found, HEIGHT * HEIGHT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_still_camera_sees_no_change),
        cmocka_unit_test(a_pan_by_whole_pixels_changes_nothing),
        cmocka_unit_test(a_known_flicker_is_what_it_is),
        cmocka_unit_test(a_repetition_multiplies),
        cmocka_unit_test(between_texels_the_picture_is_bilinear),
        cmocka_unit_test(what_was_hidden_is_left_out),
        cmocka_unit_test(another_normal_is_another_surface),
        cmocka_unit_test(a_turned_camera_finds_its_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

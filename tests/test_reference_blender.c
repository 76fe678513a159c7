/* SPDX-License-Identifier: MIT */
/*
 * The reference against the ambient occlusion pass of another path tracer, Blender's
 * Cycles: cosine weighting, no falloff, 512 rays. The scenes are not part of the project:
 * without CREVICE_SHARED the test skips.
 */
#include "test_scene_support.h"

#include <stdio.h>
#include <stdlib.h>

#include "io.h"
#include "reference.h"

/* Every STEP-th pixel both ways: centres coincide and the test stays short. */
enum { WIDTH = 1280, HEIGHT = 720, STEP = 6, RAYS = 512 };

typedef struct frame {
    const char *name;
    double eye[3], target[3];
    double vfov_deg, radius;
} frame;

static const frame frames[] = {{"corner", {5, 3.5, 1}, {0.8, 0.4, 0}, 45, 1},
                               {"sponza", {-8.5, 1.2, -0.3}, {0, 2.8, 0.3}, 60, 1},
                               {"dragon", {4.5, 7, 16.5}, {-0.3, 4.3, 0}, 40, 1.2},
                               {"engine", {-300, 180, -380}, {-70, -45, 0}, 45, 40}};

typedef struct comparison {
    int pixels, outside;    /* beyond five deviations of both samplings */
    double error, error2;   /* of all */
    double inside2, noise2; /* without those outside; what the samplings explain */
} comparison;

static void compare_pixel(comparison *c, double own, double claimed, double other)
{
    double a = fmin(fmax(0.5 * (own + other), 0.5 / RAYS), 1.0 - 0.5 / RAYS);
    /* Theirs is counted as independent rays, the most that it can be. */
    double noise2 = a * (1.0 - a) / RAYS + claimed * claimed;
    double error = own - other;
    c->pixels++;
    c->error += error;
    c->error2 += error * error;
    c->noise2 += noise2;
    if (error * error > 25.0 * noise2)
        c->outside++;
    else
        c->inside2 += error * error;
}

static comparison compare_images(const reference *r, const io_image *blender)
{
    comparison c = {0};
    for (int32_t y = STEP / 2; y < HEIGHT; y += STEP) {
        for (int32_t x = STEP / 2; x < WIDTH; x += STEP) {
            size_t pixel = (size_t)y * WIDTH + (size_t)x;
            double n[3];
            for (int i = 0; i < 3; i++)
                n[i] = (double)blender->channels[1 + i].data[pixel];
            /* Background, and where samples of two surfaces were averaged. */
            if (fabs(sqrt(dot(n, n)) - 1.0) > 0.01)
                continue;
            reference_value value = reference_pixel(r, x, y);
            if (value.rays > 0)
                compare_pixel(&c, (double)value.accessibility, (double)value.error,
                              (double)blender->channels[0].data[pixel]);
        }
    }
    return c;
}

static void compare_frame(const char *shared, const frame *f)
{
    static const char *const names[4] = {"AO", "N.X", "N.Y", "N.Z"};
    reference_options options = {.weighting = CRV_WEIGHTING_COSINE,
                                 .falloff = CRV_FALLOFF_NONE,
                                 .u = 0.1f,
                                 .radius = (float)f->radius,
                                 .rays = RAYS};
    char path[1024];
    scene *s = NULL;
    scene_view view = look(CRV_PERSPECTIVE, f->eye, f->target, 0.0);
    reference *r = NULL;
    io_image blender;
    view.vfov_rad = (float)(f->vfov_deg * PI / 180.0);
    scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    snprintf(path, sizeof path, "%s/scenes/%s.glb", shared, f->name);
    assert_int_equal(scene_load(path, &s, NULL), 0);
    scene_gbuffer g = render(s, &request);
    assert_int_equal(reference_create(s, &g, &options, &r, NULL), 0);
    snprintf(path, sizeof path, "%s/scenes/blender/%s.exr", shared, f->name);
    assert_int_equal(io_read(path, names, 4, &blender, NULL), 0);
    comparison c = compare_images(r, &blender);
    print_message("%s: %d pixels, RMSE %.5f, sampling explains %.5f, mean difference "
                  "%+.5f; beyond five deviations %.3f %%, RMSE without those %.5f\n",
                  f->name, c.pixels, sqrt(c.error2 / c.pixels), sqrt(c.noise2 / c.pixels),
                  c.error / c.pixels, 100.0 * c.outside / c.pixels,
                  sqrt(c.inside2 / c.pixels));
    assert_true(c.pixels > 15000);
    assert_true(c.inside2 <= c.noise2);
    assert_true(fabs(c.error / c.pixels) < 0.001);
    /* Coincident surfaces, where theirs reads 0, and steep edges, whose samples lie up to
     * 0.01 pixel off the centre. */
    assert_true(c.outside < c.pixels / 200);
    assert_true(sqrt(c.error2 / c.pixels) < 0.022);
    io_image_free(&blender);
    reference_free(r);
    scene_gbuffer_free(&g);
    scene_free(s);
}

static void test_frames(void **state)
{
    const char *shared = getenv("CREVICE_SHARED");
    char path[1024];
    FILE *file = NULL;
    (void)state;
    if (shared) {
        snprintf(path, sizeof path, "%s/scenes/blender/corner.exr", shared);
        file = fopen(path, "rb");
    }
    if (!file) {
        print_message("skipped: CREVICE_SHARED names no folder with large scenes\n");
        skip();
    }
    fclose(file);
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++)
        compare_frame(shared, &frames[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_frames)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/*
 * Depth and normals of large scenes against the passes that Blender's path tracer wrote.
 * The scenes are not part of the project: without CREVICE_SHARED the test skips.
 */
#include "test_scene_support.h"

#include <stdio.h>
#include <stdlib.h>

#include "io.h"

enum { WIDTH = 1280, HEIGHT = 720, PIXELS = WIDTH * HEIGHT };

typedef struct frame {
    const char *name;
    double eye[3], target[3];
    double vfov_deg;
} frame;

static const frame frames[] = {{"corner", {5, 3.5, 1}, {0.8, 0.4, 0}, 45},
                               {"sponza", {-8.5, 1.2, -0.3}, {0, 2.8, 0.3}, 60},
                               {"dragon", {4.5, 7, 16.5}, {-0.3, 4.3, 0}, 40},
                               {"engine", {-300, 180, -380}, {-70, -45, 0}, 45}};

typedef struct counts {
    int background_differs, surface, depth_agrees;
    int comparable, normal_agrees;
} counts;

static scene_gbuffer cast(const char *shared, const frame *f)
{
    char path[1024];
    scene *s = NULL;
    scene_view view = look(CRV_PERSPECTIVE, f->eye, f->target, 0.0);
    view.vfov_rad = (float)(f->vfov_deg * PI / 180.0);
    scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    snprintf(path, sizeof path, "%s/scenes/%s.glb", shared, f->name);
    assert_int_equal(scene_load(path, &s, NULL), 0);
    scene_gbuffer g = render(s, &request);
    scene_free(s);
    return g;
}

static void count_pixel(counts *c, const scene_gbuffer *g, const io_image *blender,
                        int32_t pixel)
{
    double depth = (double)g->depth[0][pixel];
    double expected = (double)blender->channels[0].data[pixel];
    double n[3], own[3];
    if (isinf(depth) != (expected >= 1e10)) {
        c->background_differs++;
        return;
    }
    if (isinf(depth))
        return;
    c->surface++;
    c->depth_agrees += fabs(depth - expected) < 1e-4 * expected;
    for (int i = 0; i < 3; i++)
        n[i] = (double)blender->channels[1 + i].data[pixel];
    const double length = sqrt(dot(n, n));
    /* Where samples of two surfaces were averaged the normal is shorter. */
    if (fabs(length - 1.0) > 0.01)
        return;
    to_world(g, g->normals + 3 * pixel, own);
    c->comparable++;
    /* Normals were stored as halves: 5e-4 a component, 0.05 degrees. */
    c->normal_agrees += dot(n, own) / length > cos(0.2 * PI / 180.0);
}

static void compare_frame(const char *shared, const frame *f)
{
    static const char *const names[4] = {"Z", "N.X", "N.Y", "N.Z"};
    scene_gbuffer g = cast(shared, f);
    io_image blender;
    char path[1024];
    counts c = {0};
    snprintf(path, sizeof path, "%s/scenes/blender/%s.exr", shared, f->name);
    assert_int_equal(io_read(path, names, 4, &blender, NULL), 0);
    assert_true(blender.width == WIDTH && blender.height == HEIGHT);
    for (int32_t pixel = 0; pixel < PIXELS; pixel++)
        count_pixel(&c, &g, &blender, pixel);
    print_message("%s: background differs in %d pixels, depth agrees in %.4f %%, normals "
                  "in %.4f %%\n",
                  f->name, c.background_differs, 100.0 * c.depth_agrees / c.surface,
                  100.0 * c.normal_agrees / c.comparable);
    /* Blender's samples lie up to 0.01 pixel off the centre: silhouettes move by that. */
    assert_true(c.background_differs < PIXELS / 10000);
    assert_true(c.depth_agrees > 0.999 * c.surface);
    assert_true(c.normal_agrees > 0.999 * c.comparable);
    io_image_free(&blender);
    scene_gbuffer_free(&g);
}

static void test_frames(void **state)
{
    const char *shared = getenv("CREVICE_SHARED");
    char path[1024];
    FILE *file = NULL;
    (void)state;
    if (shared) {
        snprintf(path, sizeof path, "%s/scenes/corner.glb", shared);
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

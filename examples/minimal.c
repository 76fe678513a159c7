/* SPDX-License-Identifier: MIT */
/*
 * The library from a depth buffer to a picture: a sphere on a floor, ray-traced in a few
 * lines, its ambient occlusion written as ao.pgm (or the file named as the argument).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "crevice/crevice.h"

enum { WIDTH = 640, HEIGHT = 480 };

/* Planar depth along the ray (x, y, -1) of a unit sphere that touches a floor at y = -1.
 * INFINITY, the background, where the ray meets neither. */
static float trace(float x, float y)
{
    const float centre_z = -4.0f;
    float floor_depth = y < 0.0f ? -1.0f / y : INFINITY;
    float a = x * x + y * y + 1.0f;
    float b = -centre_z;
    float discriminant = b * b - a * (centre_z * centre_z - 1.0f);
    if (discriminant < 0.0f)
        return floor_depth;
    return fminf(floor_depth, (b - sqrtf(discriminant)) / a);
}

static void fill_depth(float *depth, const crv_camera *camera)
{
    for (int j = 0; j < HEIGHT; j++) {
        for (int i = 0; i < WIDTH; i++) {
            float x = ((float)i + 0.5f - camera->cx_px) / camera->fx_px;
            float y = -((float)j + 0.5f - camera->cy_px) / camera->fy_px;
            depth[j * WIDTH + i] = trace(x, y);
        }
    }
}

static void print_line(void *user, crv_log_level level, const char *line)
{
    (void)user;
    fprintf(stderr, "%s%s\n", level == CRV_LOG_ERROR ? "error: " : "", line);
}

/* Depth in, accessibility out. */
static crv_status occlude(float *depth, float *accessibility, const crv_camera *camera)
{
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    crv_context_desc context_desc;
    crv_gbuffer_desc desc;
    crv_options options;
    crv_const_image depth_image = crv_const_image_packed(depth, WIDTH, HEIGHT, 1);
    crv_image result = crv_image_packed(accessibility, WIDTH, HEIGHT, 1);

    crv_context_desc_init(&context_desc, sizeof context_desc);
    context_desc.logger.fn = print_line;
    crv_gbuffer_desc_init(&desc, sizeof desc, WIDTH, HEIGHT);
    crv_status status = crv_options_init(&options, sizeof options, "hbao");
    options.radius = 1.0f; /* scene units: the sphere's radius */

    if (status == CRV_OK)
        status = crv_context_create(&context_desc, &context);
    if (status == CRV_OK)
        status = crv_gbuffer_create(context, &desc, &gbuffer);
    if (status == CRV_OK)
        status = crv_plan_create(context, &options, &desc, &plan);
    /* From here on it is once for each frame. */
    if (status == CRV_OK)
        status = crv_gbuffer_set_camera(gbuffer, camera);
    if (status == CRV_OK)
        status = crv_gbuffer_set_depth(gbuffer, 0, &depth_image, NULL);
    if (status == CRV_OK)
        status = crv_plan_run(plan, gbuffer, &result);

    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
    return status;
}

static int write_pgm(const char *path, const float *grey)
{
    FILE *file = fopen(path, "wb");
    if (!file) {
        perror(path);
        return -1;
    }
    fprintf(file, "P5\n%d %d\n255\n", WIDTH, HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        putc((int)(grey[i] * 255.0f + 0.5f), file);
    int failed = ferror(file);
    if (fclose(file) != 0 || failed) {
        perror(path);
        return -1;
    }
    return 0;
}

int main(int argc, char **argv)
{
    const char *path = argc > 1 ? argv[1] : "ao.pgm";
    const float vfov_rad = 0.9f;
    crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, vfov_rad);
    float *depth = malloc(sizeof(float) * WIDTH * HEIGHT);
    float *accessibility = malloc(sizeof(float) * WIDTH * HEIGHT);
    int done = 0;

    if (depth && accessibility) {
        fill_depth(depth, &camera);
        crv_status status = occlude(depth, accessibility, &camera);
        if (status == CRV_OK)
            done = write_pgm(path, accessibility) == 0;
        else
            fprintf(stderr, "%s\n", crv_status_string(status));
    }
    free(depth);
    free(accessibility);
    return done ? EXIT_SUCCESS : EXIT_FAILURE;
}

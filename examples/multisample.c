/* SPDX-License-Identifier: MIT */
/*
 * Ambient occlusion in a frame with four depth samples in each pixel: spheres on a floor,
 * ray-traced in a few lines. The G-buffer has one depth for each pixel, so there is one
 * accessibility for each pixel too. multisample_pixel.pgm gives it to all four samples:
 * along silhouettes, floor wears the sphere's and the other way round, in stairs.
 * multisample_gathered.pgm lets every sample gather from its own surface before the four
 * are averaged. Both go to the folder named as the argument (default: here).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "crevice/crevice.h"

enum { WIDTH = 320, HEIGHT = 240, SAMPLES = 4 };

/* Where the samples lie in a pixel: the usual rotated grid. */
static const float POSITIONS[SAMPLES][2] = {
    {0.375f, 0.125f}, {0.875f, 0.375f}, {0.125f, 0.625f}, {0.625f, 0.875f}};

/* Planar depth along the ray (x, y, -1): three spheres on a floor at y = -1, and sky. */
static float trace(float x, float y)
{
    static const float SPHERES[3][4] = {{-1.1f, -0.3f, -4.2f, 0.7f},
                                        {0.5f, 0.0f, -4.8f, 1.0f},
                                        {0.3f, -0.75f, -3.4f, 0.25f}};
    float nearest = y < 0 ? -1 / y : INFINITY;
    for (int i = 0; i < 3; i++) {
        const float *s = SPHERES[i];
        const float a = x * x + y * y + 1, b = x * s[0] + y * s[1] - s[2];
        const float c = s[0] * s[0] + s[1] * s[1] + s[2] * s[2] - s[3] * s[3];
        const float discriminant = b * b - a * c;
        if (discriminant > 0)
            nearest = fminf(nearest, (b - sqrtf(discriminant)) / a);
    }
    return nearest;
}

/* What a renderer leaves behind: a depth for every sample, and one for the pixel. */
static void render(const crv_camera *camera, float *depth, float *sample_depth)
{
    for (int j = 0; j < HEIGHT; j++) {
        for (int i = 0; i < WIDTH; i++) {
            const int pixel = j * WIDTH + i;
            for (int s = -1; s < SAMPLES; s++) {
                const float at_x = s < 0 ? 0.5f : POSITIONS[s][0];
                const float at_y = s < 0 ? 0.5f : POSITIONS[s][1];
                const float d = trace(((float)i + at_x - camera->cx_px) / camera->fx_px,
                                      -((float)j + at_y - camera->cy_px) / camera->fy_px);
                if (s < 0)
                    depth[pixel] = d;
                else
                    sample_depth[pixel * SAMPLES + s] = d;
            }
        }
    }
}

static void print_line(void *user, crv_log_level level, const char *line)
{
    (void)user;
    fprintf(stderr, "%s%s\n", level == CRV_LOG_ERROR ? "error: " : "", line);
}

/* One accessibility for each pixel, then one for each sample. */
static crv_status occlude(const crv_camera *camera, float *depth, float *sample_depth,
                          float *accessibility, float *gathered)
{
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    crv_context_desc context_desc;
    crv_gbuffer_desc desc;
    crv_options options;
    crv_const_image depth_image = crv_const_image_packed(depth, WIDTH, HEIGHT, 1);
    crv_const_image sample_image =
        crv_const_image_packed(sample_depth, WIDTH, HEIGHT, SAMPLES);
    crv_image pixel_result = crv_image_packed(accessibility, WIDTH, HEIGHT, 1);
    crv_const_image pixel_input = crv_image_const(pixel_result);
    crv_image sample_result = crv_image_packed(gathered, WIDTH, HEIGHT, SAMPLES);

    crv_context_desc_init(&context_desc, sizeof context_desc);
    context_desc.logger.fn = print_line;
    crv_gbuffer_desc_init(&desc, sizeof desc, WIDTH, HEIGHT);
    crv_status status = crv_options_init(&options, sizeof options, "alchemy");
    options.radius = 0.6f;
    if (status == CRV_OK)
        status = crv_context_create(&context_desc, &context);
    if (status == CRV_OK)
        status = crv_gbuffer_create(context, &desc, &gbuffer);
    if (status == CRV_OK)
        status = crv_plan_create(context, &options, &desc, &plan);
    if (status == CRV_OK)
        status = crv_gbuffer_set_camera(gbuffer, camera);
    if (status == CRV_OK)
        status = crv_gbuffer_set_depth(gbuffer, 0, &depth_image, NULL);
    if (status == CRV_OK)
        status = crv_plan_run(plan, gbuffer, &pixel_result);
    if (status == CRV_OK)
        status =
            crv_multisample_gather(gbuffer, &pixel_input, &sample_image, NULL,
                                   options.filter_depth * options.radius, &sample_result);
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
    return status;
}

/* Resolves a pixel. Here the occlusion is all there is to see; a renderer multiplies each
 * sample's ambient light first. */
static float resolve(const float *samples)
{
    float sum = 0;
    for (int s = 0; s < SAMPLES; s++)
        sum += samples[s];
    return sum / SAMPLES;
}

/* As resolve(), with the pixel's one value for every sample but the sky's. */
static float resolve_pixel(float accessibility, const float *sample_depth)
{
    float samples[SAMPLES];
    for (int s = 0; s < SAMPLES; s++)
        samples[s] = sample_depth[s] < INFINITY ? accessibility : 1;
    return resolve(samples);
}

static int write_pgm(const char *folder, const char *name, const float *grey)
{
    char path[4096];
    const int length = snprintf(path, sizeof path, "%s/%s", folder, name);
    if (length < 0 || (size_t)length >= sizeof path)
        return -1;
    FILE *file = fopen(path, "wb");
    if (!file) {
        perror(path);
        return -1;
    }
    fprintf(file, "P5\n%d %d\n255\n", WIDTH, HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        putc((int)(grey[i] * 255.0f + 0.5f), file);
    const int failed = ferror(file);
    if (fclose(file) != 0 || failed) {
        perror(path);
        return -1;
    }
    return 0;
}

int main(int argc, char **argv)
{
    static float depth[WIDTH * HEIGHT], sample_depth[WIDTH * HEIGHT * SAMPLES];
    static float accessibility[WIDTH * HEIGHT], gathered[WIDTH * HEIGHT * SAMPLES];
    static float plain[WIDTH * HEIGHT], smooth[WIDTH * HEIGHT];
    const char *folder = argc > 1 ? argv[1] : ".";
    const float vfov_rad = 0.8f;
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, vfov_rad);

    render(&camera, depth, sample_depth);
    const crv_status status =
        occlude(&camera, depth, sample_depth, accessibility, gathered);
    if (status != CRV_OK) {
        fprintf(stderr, "%s\n", crv_status_string(status));
        return EXIT_FAILURE;
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const ptrdiff_t first = (ptrdiff_t)i * SAMPLES;
        plain[i] = resolve_pixel(accessibility[i], sample_depth + first);
        smooth[i] = resolve(gathered + first);
    }
    const int done = write_pgm(folder, "multisample_pixel.pgm", plain) == 0
                     && write_pgm(folder, "multisample_gathered.pgm", smooth) == 0;
    return done ? EXIT_SUCCESS : EXIT_FAILURE;
}

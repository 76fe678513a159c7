/* SPDX-License-Identifier: MIT */
/*
 * Ambient occlusion of implicit surfaces: spheres, a torus and a gyroid, each given as a
 * function that is negative inside. For each a sheet of six pictures is written to the
 * folder named as the argument (default: here): above vao, below containment; from left
 * to right the occlusion that the depth buffer tells, the one that the function tells,
 * and that of both. The function knows what lies behind the first surface.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "crevice/crevice.h"

enum { WIDTH = 320, HEIGHT = 240, COLUMNS = 3, ROWS = 2 };
enum { SHEET_WIDTH = WIDTH * COLUMNS, SHEET_HEIGHT = HEIGHT * ROWS };

static const float CENTRE_Z = -4.0f;

/* The signed distance of a sphere and its gradient. */
static float sphere(const float p[3], float x, float y, float z, float radius, float g[3])
{
    const float to[3] = {p[0] - x, p[1] - y, p[2] - z};
    const float length = sqrtf(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
    for (int i = 0; i < 3; i++)
        g[i] = length > 0 ? to[i] / length : 0;
    return length - radius;
}

static float spheres(void *user, const float p[3], float gradient[3])
{
    static const float SPHERES[4][4] = {{-0.8f, -0.3f, -4.2f, 0.9f},
                                        {0.7f, -0.2f, -3.9f, 0.8f},
                                        {0.0f, 0.8f, -4.3f, 0.6f},
                                        {0.0f, -0.9f, -3.5f, 0.4f}};
    float nearest = INFINITY;
    (void)user;
    for (int i = 0; i < 4; i++) {
        float g[3];
        const float *s = SPHERES[i];
        const float distance = sphere(p, s[0], s[1], s[2], s[3], g);
        if (distance < nearest) {
            nearest = distance;
            for (int k = 0; k < 3; k++)
                gradient[k] = g[k];
        }
    }
    return nearest;
}

/* A torus whose axis leans 50 degrees from the viewing axis to the top. */
static float torus(void *user, const float p[3], float gradient[3])
{
    const float large = 0.95f, small = 0.55f, axis[3] = {0, 0.766f, 0.643f};
    const float to[3] = {p[0], p[1], p[2] - CENTRE_Z};
    const float along = to[1] * axis[1] + to[2] * axis[2];
    float flat[3];
    (void)user;
    for (int i = 0; i < 3; i++)
        flat[i] = to[i] - along * axis[i];
    const float out = sqrtf(flat[0] * flat[0] + flat[1] * flat[1] + flat[2] * flat[2]);
    const float ring = out - large, length = sqrtf(ring * ring + along * along);
    for (int i = 0; i < 3; i++) {
        const float away = out > 0 ? flat[i] / out * ring : 0;
        gradient[i] = length > 0 ? (away + along * axis[i]) / length : 0;
    }
    return length - small;
}

/* A ball, of which only one side of the gyroid sin x cos y + sin y cos z + sin z cos x =
 * 0 is left. */
static float gyroid(void *user, const float p[3], float gradient[3])
{
    const float scale = 4.5f;
    const float x = scale * p[0], y = scale * p[1], z = scale * (p[2] - CENTRE_Z);
    (void)user;
    const float ball = sphere(p, 0, 0, CENTRE_Z, 1.4f, gradient);
    const float value =
        (sinf(x) * cosf(y) + sinf(y) * cosf(z) + sinf(z) * cosf(x)) / scale;
    if (ball > value)
        return ball;
    gradient[0] = cosf(x) * cosf(y) - sinf(z) * sinf(x);
    gradient[1] = cosf(y) * cosf(z) - sinf(x) * sinf(y);
    gradient[2] = cosf(z) * cosf(x) - sinf(y) * sinf(z);
    return value;
}

typedef struct shape {
    const char *name;
    crv_implicit_fn function;
} shape;

static const shape SHAPES[] = {
    {"spheres", spheres}, {"torus", torus}, {"gyroid", gyroid}};

/* Planar depth along the ray (x, y, -1), INFINITY where it meets nothing: steps of a part
 * of the function's value, whose slope is below 2 for all shapes. */
static float march(crv_implicit_fn function, float x, float y, float gradient[3])
{
    const float pace = 0.5f / sqrtf(1 + x * x + y * y), far_depth = 7;
    for (float depth = 1; depth < far_depth;) {
        const float p[3] = {x * depth, y * depth, -depth};
        const float value = function(NULL, p, gradient);
        if (value < 1e-5f)
            return depth;
        depth += fmaxf(pace * value, 1e-6f);
    }
    return INFINITY;
}

/* Depth and, as the gradient is at hand, normals. */
static void fill(const shape *s, const crv_camera *camera, float *depth, float *normals)
{
    for (int j = 0; j < HEIGHT; j++) {
        for (int i = 0; i < WIDTH; i++) {
            const float x = ((float)i + 0.5f - camera->cx_px) / camera->fx_px;
            const float y = -((float)j + 0.5f - camera->cy_px) / camera->fy_px;
            depth[j * WIDTH + i] =
                march(s->function, x, y, normals + (ptrdiff_t)3 * (j * WIDTH + i));
        }
    }
}

static void print_line(void *user, crv_log_level level, const char *line)
{
    (void)user;
    fprintf(stderr, "%s%s\n", level == CRV_LOG_ERROR ? "error: " : "", line);
}

/* One of the sheet's pictures; the result's strides let the plan write it in place. */
static crv_status occlude(crv_context *context, crv_gbuffer *gbuffer,
                          const crv_gbuffer_desc *desc, const char *method,
                          crv_characteristic characteristic, float *pixels)
{
    crv_plan *plan = NULL;
    crv_options options;
    crv_image result = crv_image_packed(pixels, SHEET_WIDTH, SHEET_HEIGHT, 1);
    result.width = WIDTH;
    result.height = HEIGHT;
    crv_status status = crv_options_init(&options, sizeof options, method);
    if (status == CRV_OK) {
        options.radius = 1.2f;
        options.characteristic = characteristic;
        status = crv_plan_create(context, &options, desc, &plan);
    }
    if (status == CRV_OK)
        status = crv_plan_run(plan, gbuffer, &result);
    crv_plan_destroy(plan);
    return status;
}

/* Sky is open, that is white; grey lets the shapes be seen. */
static void grey_sky(const float *depth, float *sheet)
{
    for (int y = 0; y < SHEET_HEIGHT; y++) {
        for (int x = 0; x < SHEET_WIDTH; x++) {
            if (isinf(depth[y % HEIGHT * WIDTH + x % WIDTH]))
                sheet[y * SHEET_WIDTH + x] = 0.5f;
        }
    }
}

static crv_status fill_sheet(const shape *s, float *depth, float *normals, float *sheet)
{
    static const char *const METHODS[ROWS] = {"vao", "containment"};
    static const crv_characteristic CHARACTERISTICS[COLUMNS] = {
        CRV_CHARACTERISTIC_DEPTH, CRV_CHARACTERISTIC_FIELD, CRV_CHARACTERISTIC_PRODUCT};
    const float vfov_rad = 0.8f;
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, vfov_rad);
    crv_const_image depth_image = crv_const_image_packed(depth, WIDTH, HEIGHT, 1);
    crv_const_image normal_image = crv_const_image_packed(normals, WIDTH, HEIGHT, 3);
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    crv_context_desc context_desc;
    crv_gbuffer_desc desc;
    crv_context_desc_init(&context_desc, sizeof context_desc);
    context_desc.logger.fn = print_line;
    crv_gbuffer_desc_init(&desc, sizeof desc, WIDTH, HEIGHT);
    fill(s, &camera, depth, normals);
    crv_status status = crv_context_create(&context_desc, &context);
    if (status == CRV_OK)
        status = crv_gbuffer_create(context, &desc, &gbuffer);
    if (status == CRV_OK)
        status = crv_gbuffer_set_camera(gbuffer, &camera);
    if (status == CRV_OK)
        status = crv_gbuffer_set_depth(gbuffer, 0, &depth_image, NULL);
    if (status == CRV_OK)
        status = crv_gbuffer_set_normals(gbuffer, &normal_image, CRV_NORMAL_VIEW);
    if (status == CRV_OK)
        status = crv_gbuffer_set_implicit(gbuffer, s->function, NULL);
    for (int i = 0; status == CRV_OK && i < ROWS * COLUMNS; i++) {
        const int row = i / COLUMNS, column = i % COLUMNS;
        status = occlude(context, gbuffer, &desc, METHODS[row], CHARACTERISTICS[column],
                         sheet + (ptrdiff_t)row * HEIGHT * SHEET_WIDTH + column * WIDTH);
    }
    if (status == CRV_OK)
        grey_sky(depth, sheet);
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
    fprintf(file, "P5\n%d %d\n255\n", SHEET_WIDTH, SHEET_HEIGHT);
    for (int i = 0; i < SHEET_WIDTH * SHEET_HEIGHT; i++)
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
    const char *folder = argc > 1 ? argv[1] : ".";
    float *depth = malloc(sizeof(float) * WIDTH * HEIGHT);
    float *normals = malloc(sizeof(float) * WIDTH * HEIGHT * 3);
    float *sheet = malloc(sizeof(float) * SHEET_WIDTH * SHEET_HEIGHT);
    int done = depth && normals && sheet;

    for (size_t i = 0; done && i < sizeof SHAPES / sizeof SHAPES[0]; i++) {
        char path[4096];
        const int length =
            snprintf(path, sizeof path, "%s/implicit_%s.pgm", folder, SHAPES[i].name);
        const crv_status status = fill_sheet(&SHAPES[i], depth, normals, sheet);
        if (status != CRV_OK)
            fprintf(stderr, "%s: %s\n", SHAPES[i].name, crv_status_string(status));
        done = status == CRV_OK && length > 0 && (size_t)length < sizeof path
               && write_pgm(path, sheet) == 0;
    }
    free(depth);
    free(normals);
    free(sheet);
    return done ? EXIT_SUCCESS : EXIT_FAILURE;
}

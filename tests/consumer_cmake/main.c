/* SPDX-License-Identifier: MIT */
/* The smallest host: is what was installed complete, and does it compute? */
#include <stdio.h>
#include <string.h>

#include "crevice/crevice.h"

#define SIZE 32

/* Accessibility of depth at the picture's centre, or -1. */
static float centre_of(const crv_options *options, float *depth)
{
    static float accessibility[SIZE * SIZE];
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    crv_gbuffer_desc desc;
    crv_camera camera = crv_camera_orthographic(SIZE, SIZE, 2.0f);
    crv_const_image input = crv_const_image_packed(depth, SIZE, SIZE, 1);
    crv_image result = crv_image_packed(accessibility, SIZE, SIZE, 1);

    crv_gbuffer_desc_init(&desc, sizeof desc, SIZE, SIZE);
    int done = crv_context_create(NULL, &context) == CRV_OK
               && crv_gbuffer_create(context, &desc, &gbuffer) == CRV_OK
               && crv_plan_create(context, options, &desc, &plan) == CRV_OK
               && crv_gbuffer_set_camera(gbuffer, &camera) == CRV_OK
               && crv_gbuffer_set_depth(gbuffer, 0, &input, NULL) == CRV_OK
               && crv_plan_run(plan, gbuffer, &result) == CRV_OK;
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
    return done ? accessibility[SIZE / 2 * SIZE + SIZE / 2] : -1.0f;
}

int main(void)
{
    static float flat[SIZE * SIZE], pit[SIZE * SIZE];
    char version[32];
    crv_options options;

    snprintf(version, sizeof version, "%d.%d.%d", CRV_VERSION_MAJOR, CRV_VERSION_MINOR,
             CRV_VERSION_PATCH);
    if (strcmp(version, crv_version()) != 0) {
        fprintf(stderr, "headers are %s, the library is %s\n", version, crv_version());
        return 1;
    }
    if (crv_options_init(&options, sizeof options, "hbao") != CRV_OK)
        return 1;
    options.radius = 0.9f;
    for (int i = 0; i < SIZE * SIZE; i++) {
        int dx = i % SIZE - SIZE / 2, dy = i / SIZE - SIZE / 2;
        flat[i] = 5.0f;
        pit[i] = dx * dx + dy * dy < 16 ? 5.0f : 4.5f; /* 0.25 in radius, 0.5 deep */
    }
    float open = centre_of(&options, flat), closed = centre_of(&options, pit);
    printf("crevice %s: flat %.3f, pit %.3f\n", crv_version(), (double)open,
           (double)closed);
    /* From the pit's floor walls rise to 63 degrees; the falloff leaves a third. */
    return open > 0.98f && closed >= 0.0f && closed < 0.8f ? 0 : 1;
}

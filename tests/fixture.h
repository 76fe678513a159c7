/* SPDX-License-Identifier: MIT */
/* fixture.h: analytic depth buffers, and a frame computed in one call. */
#ifndef TESTS_FIXTURE_H
#define TESTS_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "crevice/crevice.h"

/* The nearest surface along a view ray: origin + t * direction, in view space. */
typedef struct fixture_hit {
    double t; /* INFINITY: none */
    double normal[3];
} fixture_hit;
typedef fixture_hit (*fixture_surface)(const double origin[3], const double direction[3],
                                       const double *parameters);

/* A plane through (0, 0, -parameters[1]), tilted by parameters[0] radians about the axis
 * that lies in the image at the angle parameters[2]. */
fixture_hit fixture_plane(const double origin[3], const double direction[3],
                          const double *parameters);

/* A V groove of 90 degrees that opens towards the camera, its edge along y at depth
 * parameters[0]: depth = parameters[0] - |x|. */
fixture_hit fixture_groove(const double origin[3], const double direction[3],
                           const double *parameters);

/* A floor at y = -1, three spheres on it, and nothing behind. parameters[0] scales the
 * scene. */
fixture_hit fixture_spheres(const double origin[3], const double direction[3],
                            const double *parameters);

typedef struct fixture {
    int32_t width, height;
    crv_camera camera;
    float *depth;   /* planar */
    float *normals; /* interleaved, view space */
} fixture;

/* Looks at every pixel's centre; guard pixels are wanted on each side of width x height.
 */
fixture fixture_make(fixture_surface surface, const double *parameters,
                     const crv_camera *camera, int32_t width, int32_t height);
void fixture_free(fixture *f);

/* What a run may vary beside the options. Zeroed: all defaults. */
typedef struct fixture_run {
    int32_t threads;
    int32_t exact; /* as in crv_context_desc */
    crv_parallel parallel;
    int32_t guard_left, guard_top, guard_right, guard_bottom;
    int32_t origin_x, origin_y;
    int32_t without_normals;
    const float *second_layer;
    const crv_depth_format *format; /* what the fixture's depth holds; NULL: planar */
    float *bent; /* room for the bent normals, packed; NULL: not wanted */
} fixture_run;

/* Whether frames are computed on a Vulkan device: CREVICE_TEST_DEVICE is "vulkan". */
int fixture_on_vulkan(void);

/* A context with the strict logger: a new one on the CPU, or the one of the process on
 * the Vulkan device. */
crv_context *fixture_context_open(void);
void fixture_context_close(crv_context *context);

/* Computes a frame and returns the result's pixels, which the caller frees. Any error
 * fails the test. */
float *fixture_compute(const fixture *f, const crv_options *options,
                       const fixture_run *run);

/* Default options of a method. */
crv_options fixture_options(const char *method);

/* A logger that fails the test on an error line and is silent otherwise. */
crv_logger fixture_strict_logger(void);

#endif

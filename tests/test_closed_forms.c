/* SPDX-License-Identifier: MIT */
/* Estimators against integrals that are known in closed form. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>

static const double PI = 3.14159265358979323846;

/* Methods name the closed forms that their integral has; new methods add their rows. */
typedef struct closed_form {
    const char *method;
    crv_falloff falloff;
    double (*occlusion)(double c); /* 1 - A at distance c radii from the wall */
} closed_form;

static double uniform_none(double c)
{
    return (1 - c) / 2;
}

static double uniform_linear(double c)
{
    return (1 - c + c * log(c)) / 2;
}

static const closed_form FORMS[] = {
    {"hbao", CRV_FALLOFF_NONE, uniform_none},
    {"hbao", CRV_FALLOFF_LINEAR, uniform_linear},
};

enum { FORM_COUNT = sizeof FORMS / sizeof FORMS[0] };

/* The radius of influence in pixels: fine enough that texels do not limit the accuracy.
 */
static const double PX_PER_RADIUS = 200;

/* A point of the groove in the middle of a buffer that reaches one radius on every side.
 */
typedef struct groove {
    fixture buffers;
    int32_t reach_px;
    double c; /* distance from the edge in radii */
} groove;

static groove make_groove(double c)
{
    groove g = {.reach_px = (int32_t)PX_PER_RADIUS + 2};
    const int32_t size = 2 * g.reach_px + 1;
    const int32_t offset_px = (int32_t)lround(c * PX_PER_RADIUS * sqrt(0.5));
    crv_camera camera =
        crv_camera_orthographic(size, size, (float)(size / PX_PER_RADIUS));
    camera.cx_px -= (float)offset_px;
    const double depth = 10;
    g.buffers = fixture_make(fixture_groove, &depth, &camera, size, size);
    g.c = fmin(1, offset_px / PX_PER_RADIUS * sqrt(2));
    return g;
}

/* Accessibility of the groove's point, radius 1; everything but its pixel is guard band.
 */
static double estimate(const groove *g, const closed_form *form, int32_t directions,
                       int32_t steps, int32_t seed)
{
    crv_options options = fixture_options(form->method);
    options.filter = NULL;
    options.radius = 1;
    options.falloff = form->falloff;
    options.directions = directions;
    options.steps = steps;
    options.bias_deg = 0;
    options.noise_size = 1;
    options.seed = seed;
    const fixture_run run = {.guard_left = g->reach_px,
                             .guard_top = g->reach_px,
                             .guard_right = g->reach_px,
                             .guard_bottom = g->reach_px};
    float *result = fixture_compute(&g->buffers, &options, &run);
    const double a = (double)result[0];
    free(result);
    return a;
}

static void converged_methods_meet_the_groove(void **state)
{
    (void)state;
    static const double C[] = {0.1, 0.25, 0.5, 0.75, 1};
    for (int k = 0; k < 5; k++) {
        groove g = make_groove(C[k]);
        for (int i = 0; i < FORM_COUNT; i++) {
            const double exact = 1 - FORMS[i].occlusion(g.c);
            const double a = estimate(&g, &FORMS[i], 128, 128, 0);
            printf("%s falloff %d c %.3f: %.4f, exact %.4f, error %+.4f\n",
                   FORMS[i].method, (int)FORMS[i].falloff, g.c, a, exact, a - exact);
            /* What the documentation promises. At 128 x 128 samples and 200 texels to the
             * radius the quadrature's own error is a few thousandths. */
            assert_true(fabs(a - exact) < 0.01);
        }
        fixture_free(&g.buffers);
    }
}

/* Over four points and eight draws of the noise. */
static double rms_error(const groove grooves[4], const closed_form *form,
                        int32_t directions, int32_t steps)
{
    double sum = 0;
    for (int k = 0; k < 4 * 8; k++) {
        const groove *g = &grooves[k / 8];
        const double a = estimate(g, form, directions, steps, 1 + k % 8);
        const double error = a - (1 - form->occlusion(g->c));
        sum += error * error;
    }
    return sqrt(sum / (4 * 8));
}

static void error_falls_with_directions_and_steps(void **state)
{
    (void)state;
    static const int32_t N[] = {4, 8, 16, 32, 64};
    groove grooves[4] = {make_groove(0.1), make_groove(0.25), make_groove(0.5),
                         make_groove(0.75)};
    for (int i = 0; i < FORM_COUNT; i++) {
        double nd[5], ns[5];
        for (int k = 0; k < 5; k++) {
            nd[k] = rms_error(grooves, &FORMS[i], N[k], 128);
            ns[k] = rms_error(grooves, &FORMS[i], 128, N[k]);
            printf("%s falloff %d: rms error %.5f at Nd %d (Ns 128), %.5f at Ns %d (Nd "
                   "128)\n",
                   FORMS[i].method, (int)FORMS[i].falloff, nd[k], N[k], ns[k], N[k]);
        }
        /* Jittered equal steps err by O(1/Ns), so 16 times the steps leave a sixteenth;
         * directions converge faster, down to the floor that steps and texels set. Room
         * of a factor of two. */
        assert_true(ns[4] < ns[0] / 8);
        assert_true(nd[4] < nd[0] / 8);
    }
    for (int k = 0; k < 4; k++)
        fixture_free(&grooves[k].buffers);
}

static double lowest_on_plane(const char *method, double tilt_deg, int orthographic,
                              const crv_filter *filter, int without_normals)
{
    const int32_t width = 96, height = 64;
    /* Tilted by 85 degrees the orthographic view spans 120 units of depth; all are in
     * front. */
    const double depth = orthographic ? 100 : 10;
    crv_camera camera = orthographic ? crv_camera_orthographic(width, height, 8)
                                     : crv_camera_perspective(width, height, 0.9f);
    const double parameters[3] = {tilt_deg * PI / 180, depth, 0.7};
    fixture f = fixture_make(fixture_plane, parameters, &camera, width, height);
    crv_options options = fixture_options(method);
    options.filter = filter;
    options.radius = 2;
    options.bias_deg = 0; /* the bias would hide self-occlusion */
    const fixture_run run = {.without_normals = without_normals};
    float *result = fixture_compute(&f, &options, &run);
    double lowest = 1;
    for (int32_t i = 0; i < width * height; i++)
        lowest = fmin(lowest, (double)result[i]);
    free(result);
    fixture_free(&f);
    return lowest;
}

static void a_plane_does_not_occlude_itself(void **state)
{
    (void)state;
    static const double TILTS[] = {0, 10, 30, 45, 60, 75, 80, 85};
    for (int32_t m = 0; m < crv_method_count(); m++) {
        const char *method = crv_method_at(m)->name;
        for (int k = 0; k < 8 * 4; k++) {
            const int orthographic = k & 1, without_normals = k >> 1 & 1;
            const double tilt = TILTS[k >> 2];
            for (int32_t i = -1; i < crv_filter_count(); i++) {
                double a = lowest_on_plane(method, tilt, orthographic, crv_filter_at(i),
                                           without_normals);
                if (a <= 0.98)
                    fail_msg("%s, tilt %g, %s, normals %s, filter %d: %g", method, tilt,
                             orthographic ? "orthographic" : "perspective",
                             without_normals ? "from depth" : "given", (int)i, a);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(converged_methods_meet_the_groove),
        cmocka_unit_test(error_falls_with_directions_and_steps),
        cmocka_unit_test(a_plane_does_not_occlude_itself),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

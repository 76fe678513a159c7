/* SPDX-License-Identifier: MIT */
/* Estimators against integrals that are known in closed form. */
#include "fixture.h"
#include "quadrature.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* Methods name the closed forms that their integral has; new methods add their rows. */
typedef struct closed_form {
    const char *method;
    crv_weighting weighting; /* set for the methods that read it */
    crv_falloff falloff;
    double (*occlusion)(double c); /* 1 - A at distance c radii from the wall */
    double tolerance;              /* of the converged estimate */
} closed_form;

static double uniform_none(double c)
{
    return (1 - c) / 2;
}

static double uniform_linear(double c)
{
    return (1 - c + c * log(c)) / 2;
}

static double cosine_none(double c)
{
    return (acos(c) - c * sqrt(1 - c * c)) / PI;
}

static double cosine_linear(double c)
{
    const double s = sqrt(1 - c * c);
    return (acos(c) + c * s - 2 * c * log((1 + s) / c)) / PI;
}

/* The share of the tangent sphere, radius 1/2, that the wall cuts off. */
static double tangent_sphere(double c)
{
    const double rho = 0.5, e = fmax(0, rho - c);
    return e * e * (3 * rho - e) / (4 * rho * rho * rho);
}

/* The share of the ball around the point that is behind the floor or the wall: one half,
 * and half of the cap that the wall cuts off. */
static double ball(double c)
{
    const double h = 1 - c;
    return 0.5 + h * h * (3 - h) / 8;
}

/* alchemy and vo have no closed form here: their own sums, by quadrature. */
static double alchemy_sum(double c)
{
    const quadrature_site site = {c * sqrt(0.5), 10, 1};
    const quadrature_alchemy numbers = {1, 1e-4, 1e-4}; /* the defaults, radius 1 */
    return 1 - quadrature_of_alchemy(&site, &numbers);
}

static double vo_sum(double c)
{
    const quadrature_site site = {c * sqrt(0.5), 10, 1};
    return 1 - quadrature_of_vo(&site);
}

/* Rays that are marched may stop one step late. */
static const double EXACT = 0.01, MARCHED = 0.02, SUM = 0.005;

static const closed_form FORMS[] = {
    {"hbao", CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_NONE, uniform_none, EXACT},
    {"hbao", CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_LINEAR, uniform_linear, EXACT},
    {"gtao", CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, cosine_none, EXACT},
    {"gtao", CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR, cosine_linear, EXACT},
    {"gtao", CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_NONE, uniform_none, EXACT},
    {"gtao", CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_LINEAR, uniform_linear, EXACT},
    {"bitmask", CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, cosine_none, EXACT},
    {"bitmask", CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR, cosine_linear, EXACT},
    {"bitmask", CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_NONE, uniform_none, EXACT},
    {"bitmask", CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_LINEAR, uniform_linear, EXACT},
    {"hsao", CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, cosine_none, MARCHED},
    {"hsao", CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR, cosine_linear, MARCHED},
    {"raymarch", CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, cosine_none, MARCHED},
    {"raymarch", CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR, cosine_linear, MARCHED},
    {"containment", CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, cosine_none, EXACT},
    {"containment", CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR, cosine_linear, EXACT},
    {"vao", CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR, tangent_sphere, EXACT},
    {"ssao", CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_LINEAR, ball, EXACT},
    {"alchemy", CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR, alchemy_sum, SUM},
    {"vo", CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_LINEAR, vo_sum, SUM},
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

/* How much work an estimate may do; a method reads what applies to it. */
typedef struct effort {
    int32_t directions, steps, normal_rays, samples, seed;
    float thickness; /* 0: the groove is solid without end */
    crv_thickness thickness_rule;
} effort;

/* Accessibility of the groove's point, radius 1, unfiltered; everything but its pixel is
 * guard band. */
static double of_groove(const groove *g, crv_options options)
{
    options.filter = NULL;
    options.radius = 1;
    options.noise_size = 1;
    const fixture_run run = {.threads = 1,
                             .guard_left = g->reach_px,
                             .guard_top = g->reach_px,
                             .guard_right = g->reach_px,
                             .guard_bottom = g->reach_px};
    float *result = fixture_compute(&g->buffers, &options, &run);
    const double a = (double)result[0];
    free(result);
    return a;
}

static double estimate(const groove *g, const closed_form *form, effort e)
{
    crv_options options = fixture_options(form->method);
    options.falloff = form->falloff;
    options.weighting = form->weighting;
    options.directions = e.directions;
    options.steps = e.steps;
    options.normal_rays = e.normal_rays;
    options.samples = e.samples;
    options.seed = e.seed;
    options.thickness = e.thickness;
    options.thickness_rule = e.thickness_rule;
    return of_groove(g, options);
}

static void converged_methods_meet_the_groove(void **state)
{
    (void)state;
    static const double C[] = {0.1, 0.25, 0.5, 0.75, 1};
    static const effort MUCH = {128, 128, 16, 4096, 0, 0.5f, CRV_THICKNESS_WIDTH};
    for (int k = 0; k < 5; k++) {
        groove g = make_groove(C[k]);
        for (int i = 0; i < FORM_COUNT; i++) {
            const closed_form *form = &FORMS[i];
            const double exact = 1 - form->occlusion(g.c);
            const double a = estimate(&g, form, MUCH);
            printf(
                "%-11s weighting %d, falloff %d, c %.3f: %.4f, exact %.4f, error %+.4f\n",
                form->method, (int)form->weighting, (int)form->falloff, g.c, a, exact,
                a - exact);
            assert_true(fabs(a - exact) < form->tolerance);
        }
        fixture_free(&g.buffers);
    }
}

/* Over four points and four draws of the noise. */
static double rms_error(const groove grooves[4], const closed_form *form, effort e)
{
    double sum = 0;
    for (int k = 0; k < 4 * 4; k++) {
        const groove *g = &grooves[k / 4];
        e.seed = 1 + k % 4;
        const double a = estimate(g, form, e);
        const double error = a - (1 - form->occlusion(g->c));
        sum += error * error;
    }
    return sqrt(sum / (4 * 4));
}

/* What a method is refined by: from `coarse` in four steps of `growth`, after which the
 * error must be `gain` times smaller. */
typedef struct refinement {
    const char *option;
    effort coarse;
    int32_t growth;
    double gain;
} refinement;

static effort refined(const refinement *r, int steps)
{
    effort e = r->coarse;
    int32_t factor = 1;
    while (steps-- > 0)
        factor *= r->growth;
    e.directions *= strcmp(r->option, "directions") == 0 ? factor : 1;
    e.steps *= strcmp(r->option, "steps") == 0 ? factor : 1;
    e.samples *= strcmp(r->option, "samples") == 0 ? factor : 1;
    return e;
}

static void refine(const groove grooves[4], const closed_form *form, const refinement *r)
{
    double error[5];
    printf("%-11s falloff %d, rms error over %s x%d:", form->method, (int)form->falloff,
           r->option, r->growth);
    for (int k = 0; k < 5; k++) {
        error[k] = rms_error(grooves, form, refined(r, k));
        printf("  %.5f", error[k]);
    }
    printf("\n");
    if (!(error[4] < error[0] / r->gain))
        fail_msg("%s: %g to %g", form->method, error[0], error[4]);
}

static void error_falls_with_samples(void **state)
{
    (void)state;
    if (fixture_on_vulkan())
        return; /* the estimators are those of the CPU: test_vulkan_agreement */
    /* bitmask without its widths, which take long for whole buffers. */
    static const refinement REFINEMENTS[] = {
        /* Equally spaced directions of a smooth integrand converge faster than 1/Nd, down
         * to the floor that steps and texels set. */
        {"directions", {4, 256, 8, 1, 0, 0, CRV_THICKNESS_RUN}, 2, 4},
        /* Jittered steps err by O(1/Ns), a sixteenth; a horizon is found late where
         * the wall is nearer than one coarse step, so less is asked. */
        {"steps", {128, 4, 8, 1, 0, 0, CRV_THICKNESS_RUN}, 2, 5},
        /* Poisson-disk and low-discrepancy points do better than the 1/sqrt(n) of random
         * ones, which is a sixteenth. */
        {"samples", {1, 1, 1, 4, 0, 0, CRV_THICKNESS_RUN}, 4, 16},
    };
    groove grooves[4] = {make_groove(0.1), make_groove(0.25), make_groove(0.5),
                         make_groove(0.75)};
    for (int i = 0; i < FORM_COUNT * 3; i++) {
        const closed_form *form = &FORMS[i / 3];
        const refinement *r = &REFINEMENTS[i % 3];
        /* A ray meets the groove once, so that containment knows all of it from one point
         * and its steps find nothing more. */
        if (strcmp(r->option, "steps") == 0 && strcmp(form->method, "containment") == 0)
            continue;
        if (crv_option_applies(crv_option_find(r->option), crv_method_find(form->method),
                               NULL))
            refine(grooves, form, r);
    }
    for (int k = 0; k < 4; k++)
        fixture_free(&grooves[k].buffers);
}

/* Of a plane's accessibility. */
static double lowest_with(crv_options options, double tilt_deg, int orthographic,
                          int without_normals)
{
    const int32_t width = 96, height = 64;
    /* Tilted by 88 degrees the orthographic view spans 400 units of depth; all are in
     * front. */
    const double depth = orthographic ? 300 : 10;
    crv_camera camera = orthographic ? crv_camera_orthographic(width, height, 8)
                                     : crv_camera_perspective(width, height, 0.9f);
    const double parameters[3] = {tilt_deg * PI / 180, depth, 0.7};
    fixture f = fixture_make(fixture_plane, parameters, &camera, width, height);
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

static double lowest_on_plane(const char *method, double tilt_deg, int orthographic,
                              const crv_filter *filter, int without_normals)
{
    crv_options options = fixture_options(method);
    options.filter = filter;
    return lowest_with(options, tilt_deg, orthographic, without_normals);
}

static void plane_stays_open(const char *method, const crv_filter *filter)
{
    static const double TILTS[] = {0, 10, 30, 45, 60, 75, 80, 85};
    for (int k = 0; k < 8 * 4; k++) {
        const int orthographic = k & 1, without_normals = k >> 1 & 1;
        const double tilt = TILTS[k >> 2];
        const double a =
            lowest_on_plane(method, tilt, orthographic, filter, without_normals);
        if (a <= 0.98)
            fail_msg("%s, tilt %g, %s, normals %s, filter %s: %g", method, tilt,
                     orthographic ? "orthographic" : "perspective",
                     without_normals ? "from depth" : "given",
                     filter ? filter->name : "none", a);
    }
}

static void a_plane_does_not_occlude_itself(void **state)
{
    (void)state;
    for (int32_t m = 0; m < crv_method_count(); m++) {
        const char *method = crv_method_at(m)->name;
        if (strcmp(method, "ssao") != 0) /* half of its points lie behind any surface */
            plane_stays_open(method, NULL);
    }
    /* A filter does not know whose accessibility it is given. */
    for (int32_t i = 0; i < crv_filter_count(); i++)
        plane_stays_open("hbao", crv_filter_at(i));
}

/* Slices end at the tangent of the same plane: what is left is the rounding of depth. */
static void slices_leave_steep_planes_open(void **state)
{
    (void)state;
    static const char *const METHODS[] = {"gtao", "bitmask"};
    static const crv_weighting WEIGHTINGS[] = {CRV_WEIGHTING_UNIFORM,
                                               CRV_WEIGHTING_COSINE};
    static const double TILTS[] = {0, 45, 75, 85, 88};
    for (int k = 0; k < 2 * 2 * 2 * 5; k++) {
        const char *method = METHODS[k & 1];
        const crv_weighting weighting = WEIGHTINGS[k >> 1 & 1];
        const double tilt = TILTS[k >> 3];
        const int orthographic = k >> 2 & 1;
        crv_options options = fixture_options(method);
        options.filter = NULL;
        options.weighting = weighting;
        const double a = lowest_with(options, tilt, orthographic, 0);
        if (!(a > 1 - 5e-4))
            fail_msg("%s, weighting %d, tilt %g: %g", method, (int)weighting, tilt, a);
    }
}

/* Depth off a plane by 0.07 footprints along the normal, either way: at 80 degrees P is
 * raised by 1/4 - cos(80)/2 = 0.163 of one, more than two pixels are apart. */
static void slices_leave_rough_planes_open(void **state)
{
    (void)state;
    enum { WIDTH = 96, HEIGHT = 64 };
    const double tilt = 80 * PI / 180, parameters[3] = {tilt, 300, 0.7};
    const crv_camera camera = crv_camera_orthographic(WIDTH, HEIGHT, 8);
    fixture f = fixture_make(fixture_plane, parameters, &camera, WIDTH, HEIGHT);
    const double off = 0.07 / (double)camera.fx_px / cos(tilt);
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++)
        f.depth[i] += (float)(i * 7 % 11 < 5 ? off : -off);
    static const char *const METHODS[] = {"gtao", "bitmask"};
    for (int k = 0; k < 4; k++) {
        crv_options options = fixture_options(METHODS[k & 1]);
        options.filter = NULL;
        options.weighting = k >> 1 ? CRV_WEIGHTING_UNIFORM : CRV_WEIGHTING_COSINE;
        options.radius = 2;
        options.border = CRV_BORDER_BACKGROUND; /* roughness is not to be extrapolated */
        float *result = fixture_compute(&f, &options, NULL);
        for (int32_t i = 0; i < WIDTH * HEIGHT; i++)
            if (!(result[i] > 1 - 5e-4f))
                fail_msg("%s, %d: %g", METHODS[k & 1], k >> 1, (double)result[i]);
        free(result);
    }
    fixture_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(converged_methods_meet_the_groove),
        cmocka_unit_test(error_falls_with_samples),
        cmocka_unit_test(a_plane_does_not_occlude_itself),
        cmocka_unit_test(slices_leave_steep_planes_open),
        cmocka_unit_test(slices_leave_rough_planes_open),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

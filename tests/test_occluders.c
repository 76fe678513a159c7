/* SPDX-License-Identifier: MIT */
/* What the papers say of occluders that a depth buffer shows badly: above the point, in
 * front of it, behind something thin. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static double lesser(double a, double b)
{
    return a < b ? a : b;
}

/* Where a ray enters and leaves an axis-aligned box; INFINITY and -INFINITY: it does not.
 * *axis: of the face that it enters by. */
static void cross_box(const double origin[3], const double direction[3],
                      const double box[6], double *entry, double *exit, int *axis)
{
    *entry = -INFINITY;
    *exit = INFINITY;
    for (int i = 0; i < 3; i++) {
        const double a = (box[i] - origin[i]) / direction[i];
        const double b = (box[i + 3] - origin[i]) / direction[i];
        const double first = lesser(a, b), last = a < b ? b : a;
        if (isnan(first) || isnan(last))
            continue; /* parallel to the face and in its plane */
        if (first > *entry) {
            *entry = first;
            *axis = i;
        }
        *exit = lesser(*exit, last);
    }
    if (!(*entry <= *exit && *entry > 0)) {
        *entry = INFINITY;
        *exit = -INFINITY;
    }
}

static fixture_hit hit_box(const double origin[3], const double direction[3],
                           const double box[6])
{
    double entry, exit;
    int axis = 0;
    cross_box(origin, direction, box, &entry, &exit, &axis);
    fixture_hit hit = {entry, {0, 0, 0}};
    hit.normal[axis] = direction[axis] < 0 ? 1 : -1;
    return hit;
}

static fixture_hit hit_floor(const double direction[3], double y)
{
    const double t = y / direction[1];
    return (fixture_hit){direction[1] < 0 ? t : INFINITY, {0, 1, 0}};
}

static fixture_hit nearer(fixture_hit a, fixture_hit b)
{
    return a.t < b.t ? a : b;
}

/* A slab over a floor at y = -1, without pillars. */
static const double BRIDGE[6] = {-3, -0.6, -5.3, 3, -0.5, -4.8};

static fixture_hit hit_bridge(const double origin[3], const double direction[3],
                              const double *parameters)
{
    (void)parameters;
    return nearer(hit_floor(direction, -1), hit_box(origin, direction, BRIDGE));
}

/* The pixel that shows a point of view space. */
static int32_t pixel_of(const fixture *f, double x, double y, double z)
{
    const crv_camera *c = &f->camera;
    const int32_t i = (int32_t)floor((double)c->cx_px + (double)c->fx_px * x / -z);
    const int32_t j = (int32_t)floor((double)c->cy_px - (double)c->fy_px * y / -z);
    assert_true(i >= 0 && j >= 0 && i < f->width && j < f->height);
    return j * f->width + i;
}

/*
 * 2008a, Figure 1: the horizon alone does not see what hangs over the point. Along the
 * floor no ray runs behind anything; the bridge is only met by rays that rise. What it
 * covers as seen from the point, cosine-weighted: between the elevations to its near and
 * far edge, 0.4 up, 0.2 before and 0.3 behind: half the sum of the sines of the angles
 * from the normal, (sin 26.6 + sin 36.9) / 2 = 0.52 if the bridge is long and the radius
 * does not end it. The depth buffer shows the bridge's front alone, and the marcher takes
 * it for as deep as the radius.
 */
static void rays_find_what_the_horizon_misses(void **state)
{
    (void)state;
    enum { WIDTH = 320, HEIGHT = 180 };
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 0.6f);
    fixture f = fixture_make(hit_bridge, NULL, &camera, WIDTH, HEIGHT);
    const int32_t under = pixel_of(&f, 0, -1, -5), open = pixel_of(&f, 0, -1, -3.95);
    assert_true(fabsf(f.depth[under] - 5) < 0.1f);
    double at[2], away[2];
    for (int rays = 0; rays < 2; rays++) {
        crv_options options = fixture_options("hsao");
        options.filter = NULL;
        options.radius = 0.8f;
        options.falloff = CRV_FALLOFF_NONE;
        options.normal_rays = rays;
        options.directions = 32;
        options.steps = 32;
        float *a = fixture_compute(&f, &options, NULL);
        at[rays] = (double)a[under];
        away[rays] = (double)a[open];
        free(a);
    }
    printf("hsao under a bridge: Nn = 0 %.3f, Nn = 1 %.3f, "
           "0.48 by hand; a radius before "
           "it %.3f, %.3f\n",
           at[0], at[1], away[0], away[1]);
    assert_true(at[0] > 0.95);
    assert_true(at[1] < 0.65);
    assert_true(away[0] > 0.98 && away[1] > 0.98);
    fixture_free(&f);
}

/* A bar that hangs two radii in front of a groove, and hides a part of it. */
enum { SIZE = 200, PIXELS = SIZE * SIZE, LAYERS = 4 };

static const double EDGE_DEPTH = 10, BAR[4] = {0.1, 0.35, 6.9, 7.0}; /* x, depth */

typedef struct peeled {
    fixture f; /* depth is that of layer 0 */
    float layers[LAYERS][PIXELS];
    int is_bar[PIXELS];
} peeled;

static const crv_camera *groove_camera(void)
{
    static crv_camera camera;
    camera = crv_camera_orthographic(SIZE, SIZE, 2.5f);
    return &camera;
}

/* The bar's front, its back, the groove, and nothing behind: pairs where the layers are
 * solid. Surfaces want the groove next. */
static void peel(peeled *p, int with_bar, crv_layers kind)
{
    p->f = fixture_make(fixture_groove, &EDGE_DEPTH, groove_camera(), SIZE, SIZE);
    for (int i = 0; i < PIXELS; i++) {
        const double x = (i % SIZE + 0.5) * 2.5 / SIZE - 1.25;
        const float wall = p->f.depth[i];
        p->is_bar[i] = x > BAR[0] && x < BAR[1];
        for (int k = 0; k < LAYERS; k++)
            p->layers[k][i] = INFINITY;
        p->layers[0][i] = wall;
        if (!with_bar || !p->is_bar[i])
            continue;
        p->layers[0][i] = p->f.depth[i] = (float)BAR[2];
        p->layers[1][i] = kind == CRV_LAYERS_SOLID ? (float)BAR[3] : wall;
        if (kind == CRV_LAYERS_SOLID)
            p->layers[2][i] = wall;
        const float towards[3] = {0, 0, 1};
        memcpy(p->f.normals + (ptrdiff_t)3 * i, towards, sizeof towards);
    }
}

/* Computes a frame with this many of the layers. */
static void compute(const peeled *p, const crv_options *options, int32_t layers,
                    crv_layers kind, float out[PIXELS])
{
    crv_context_desc hooks;
    crv_context_desc_init(&hooks, sizeof hooks);
    hooks.logger = fixture_strict_logger();
    crv_gbuffer_desc desc;
    crv_gbuffer_desc_init(&desc, sizeof desc, SIZE, SIZE);
    desc.layers = layers;
    desc.layer_kind = kind;
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    assert_int_equal(crv_context_create(&hooks, &context), CRV_OK);
    assert_int_equal(crv_gbuffer_create(context, &desc, &gbuffer), CRV_OK);
    assert_int_equal(crv_plan_create(context, options, &desc, &plan), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(gbuffer, &p->f.camera), CRV_OK);
    for (int32_t k = 0; k < layers; k++) {
        crv_const_image depth = crv_const_image_packed(p->layers[k], SIZE, SIZE, 1);
        assert_int_equal(crv_gbuffer_set_depth(gbuffer, k, &depth, NULL), CRV_OK);
    }
    crv_const_image normals = crv_const_image_packed(p->f.normals, SIZE, SIZE, 3);
    crv_image result = crv_image_packed(out, SIZE, SIZE, 1);
    assert_int_equal(crv_gbuffer_set_normals(gbuffer, &normals, CRV_NORMAL_VIEW), CRV_OK);
    assert_int_equal(crv_plan_run(plan, gbuffer, &result), CRV_OK);
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
}

/* Over the pixels that show the groove with and without the bar. */
static double rms_beside_the_bar(const peeled *p, const float *a, const float *b)
{
    double sum = 0;
    int32_t count = 0;
    for (int i = 0; i < PIXELS; i++) {
        if (!p->is_bar[i]) {
            sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
            count++;
        }
    }
    return sqrt(sum / count);
}

/*
 * 2008a, section 4.3; 2010, section 6: what is behind a thin thing is lost to one layer.
 * Beside the bar the groove's occlusion should be that of a groove without a bar, which
 * is more than a radius away. Layers that block where they are (surfaces), or in pairs
 * with a thickness (solid), bring the wall behind it back.
 */
static void further_layers_see_behind_thin_occluders(void **state)
{
    (void)state;
    static const struct {
        const char *method;
        crv_layers kind;
        int32_t layers;
    } CASES[] = {
        {"hbao", CRV_LAYERS_SURFACES, 2},
        {"hsao", CRV_LAYERS_SURFACES, 2},
        {"raymarch", CRV_LAYERS_SURFACES, 2},
        {"alchemy", CRV_LAYERS_SURFACES, 2},
        {"hsao", CRV_LAYERS_SOLID, 4},
        {"containment", CRV_LAYERS_SOLID, 4},
        {"vao", CRV_LAYERS_SOLID, 4},
        {"vo", CRV_LAYERS_SOLID, 4},
        {"containment", CRV_LAYERS_SURFACES, 2},
    };
    static peeled with, without;
    static float reference[PIXELS], one[PIXELS], more[PIXELS];
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        const crv_layers kind = CASES[i].kind;
        crv_options options = fixture_options(CASES[i].method);
        options.filter = NULL;
        options.radius = 1;
        options.falloff = CRV_FALLOFF_NONE;
        peel(&with, 1, kind);
        peel(&without, 0, kind);
        compute(&without, &options, 1, CRV_LAYERS_SURFACES, reference);
        compute(&with, &options, 1, CRV_LAYERS_SURFACES, one);
        compute(&with, &options, CASES[i].layers, kind, more);
        const double error = rms_beside_the_bar(&with, one, reference);
        const double error_more = rms_beside_the_bar(&with, more, reference);
        printf("%-11s behind a bar: RMS error with 1 layer %.4f, with %d (%s) %.4f\n",
               CASES[i].method, error, CASES[i].layers,
               kind == CRV_LAYERS_SOLID ? "solid" : "surfaces", error_more);
        assert_true(error > 0.01);
        assert_true(error_more < error / 4);
        fixture_free(&with.f);
        fixture_free(&without.f);
    }
}

/* A wall at depth 10 that faces the camera, and a bar along y before it: from x = 0.1 to
 * 0.3, its front 0.35 above the wall. */
static fixture_hit hit_bar(const double origin[3], const double direction[3],
                           const double *parameters)
{
    static const double BEFORE[6] = {0.1, -9, -9.7, 0.3, 9, -9.65};
    static const double WALL[6] = {-90, -90, -13, 90, 90, -10};
    (void)parameters;
    return nearer(hit_box(origin, direction, BEFORE), hit_box(origin, direction, WALL));
}

/* The middle of a square buffer; all else is guard band. */
static double middle_of(const fixture *f, const crv_options *options)
{
    const int32_t guard = f->width / 2;
    const fixture_run run = {.guard_left = guard,
                             .guard_top = guard,
                             .guard_right = guard,
                             .guard_bottom = guard};
    float *a = fixture_compute(f, options, &run);
    const double result = (double)a[0];
    free(a);
    return result;
}

/* Accessibility of the wall at x = 0. */
static double beside_the_bar(const char *method, double thickness, int32_t steps)
{
    enum { ACROSS = 201 };
    const crv_camera camera = crv_camera_orthographic(ACROSS, ACROSS, 2.4f);
    fixture f = fixture_make(hit_bar, NULL, &camera, ACROSS, ACROSS);
    crv_options options = fixture_options(method);
    options.filter = NULL;
    options.radius = 1;
    options.falloff = CRV_FALLOFF_NONE;
    options.thickness = (float)thickness;
    options.directions = 64;
    options.steps = steps;
    options.normal_rays = 16;
    options.samples = 4096;
    options.noise_size = 1;
    const double result = middle_of(&f, &options);
    fixture_free(&f);
    return result;
}

/*
 * How much of a long bar's cross-section is seen from the wall: half the difference of
 * the sines of the angles from the normal to its ends. Seen to be 0.05 thick, the bar
 * begins at atan(0.1 / 0.35) and ends at atan(0.3 / 0.3); taken to be solid down to the
 * wall, it ends in the wall. The radius cuts off what is far along the bar: the cosine
 * falls with the fourth power of the distance there, which leaves a few percent of it.
 */
static void thickness_opens_what_is_behind(void **state)
{
    (void)state;
    static const char *const METHODS[] = {"raymarch", "hsao", "containment"};
    const double first = 0.1 / hypot(0.1, 0.35), last = sqrt(0.5);
    const double thin = 1 - (last - first) / 2, solid = 1 - (1 - first) / 2;
    for (int m = 0; m < 3; m++) {
        const double a = beside_the_bar(METHODS[m], 0.05, 128);
        const double b = beside_the_bar(METHODS[m], 0, 128);
        printf("%-11s beside a bar: thickness 0.05 %.3f, by hand %.3f; without end %.3f, "
               "by hand %.3f\n",
               METHODS[m], a, thin, b, solid);
        assert_true(fabs(a - thin) < 0.02);
        assert_true(fabs(b - solid) < 0.02);
    }
}

/* At the radius, rays are past the bar: the paper's single test finds it open. */
static void containment_tests_points_on_the_way(void **state)
{
    (void)state;
    const double one = beside_the_bar("containment", 0.05, 1);
    const double many = beside_the_bar("containment", 0.05, 128);
    printf("containment beside a thin bar: 1 step %.3f, 128 steps %.3f\n", one, many);
    assert_true(one > 0.98);
    assert_true(many < 0.82);
}

/* A ridge along y on the wall at depth 10: from x = 0.05 to 0.1, 0.05 high. */
static fixture_hit hit_ridge(const double origin[3], const double direction[3],
                             const double *parameters)
{
    static const double RIDGE[6] = {0.05, -9, -10.1, 0.1, 9, -9.95};
    static const double WALL[6] = {-90, -90, -13, 90, 90, -10};
    (void)parameters;
    return nearer(hit_box(origin, direction, RIDGE), hit_box(origin, direction, WALL));
}

/*
 * Seen from x = 0 the ridge's edge is at the elevation atan(0.05 cos theta / 0.05) in the
 * direction theta from x, so that uniform weighting without falloff gives
 * 1 - 1/(2 pi) Int cos theta / sqrt(1 + cos^2 theta) dtheta over the half turn around x,
 * which is 1 - asin(sqrt(1/2)) / pi = 3/4. The ridge lies before the first of eight equal
 * steps, which find it by chance; of quadratic ones
 * two or three lie there.
 */
static void quadratic_steps_find_what_is_near(void **state)
{
    (void)state;
    enum { ACROSS = 401, SEEDS = 16 };
    const crv_camera camera = crv_camera_orthographic(ACROSS, ACROSS, 2.2f);
    fixture f = fixture_make(hit_ridge, NULL, &camera, ACROSS, ACROSS);
    double error[2] = {0, 0};
    for (int i = 0; i < 2 * SEEDS; i++) {
        crv_options options = fixture_options("hbao");
        options.filter = NULL;
        options.radius = 1;
        options.falloff = CRV_FALLOFF_NONE;
        options.spacing = i % 2 ? CRV_SPACING_QUADRATIC : CRV_SPACING_EQUAL;
        options.directions = 64;
        options.noise_size = 1;
        options.seed = i / 2;
        const double wrong = middle_of(&f, &options) - 0.75;
        error[i % 2] += wrong * wrong / SEEDS;
    }
    printf("hbao, 8 steps, beside a low ridge: RMS error of equal steps %.4f, of "
           "quadratic ones %.4f\n",
           sqrt(error[0]), sqrt(error[1]));
    assert_true(error[1] < error[0] / 2);
    fixture_free(&f);
}

/* A column on a floor, and a wall far behind it. */
static const double COLUMN[6] = {-0.5, -1, -5.5, 0.5, 1, -4.5};

static fixture_hit hit_column(const double origin[3], const double direction[3],
                              const double *parameters)
{
    static const double WALL[6] = {-90, -90, -13, 90, 90, -12};
    (void)parameters;
    return nearer(nearer(hit_floor(direction, -1), hit_box(origin, direction, COLUMN)),
                  hit_box(origin, direction, WALL));
}

/*
 * 2011, Figure 8: where a near thing stands before a far one, volumetric obscurance wraps
 * it in a dark halo that floats on what is behind: at the silhouette half of the lines
 * are closed, so that 2 * 1/2 * 1/2 is left. Alchemy drops samples beyond the radius and
 * leaves the wall white, but darkens the floor where the column stands on it.
 */
static void alchemy_keeps_to_the_surface_where_vo_floats(void **state)
{
    (void)state;
    enum { WIDTH = 480, HEIGHT = 270 };
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 0.8f);
    fixture f = fixture_make(hit_column, NULL, &camera, WIDTH, HEIGHT);
    static const char *const METHODS[2] = {"alchemy", "vo"};
    double beside[2], away[2], contact[2];
    for (int m = 0; m < 2; m++) {
        crv_options options = fixture_options(METHODS[m]);
        options.filter = NULL;
        options.radius = 0.5f;
        options.samples = 256;
        float *a = fixture_compute(&f, &options, NULL);
        /* The column's right edge is seen at x / d = 0.5 / 4.5; at the wall's depth, 12,
         * that is at 1.333. */
        beside[m] = (double)a[pixel_of(&f, 1.333 + 0.05, 0, -12)];
        away[m] = (double)a[pixel_of(&f, 1.333 + 0.6, 0, -12)];
        contact[m] = (double)a[pixel_of(&f, 0, -1, -4.45)];
        free(a);
        printf("%-8s wall beside the column's silhouette %.3f, a radius away %.3f; floor "
               "at its foot %.3f\n",
               METHODS[m], beside[m], away[m], contact[m]);
    }
    assert_true(beside[0] > 0.99 && away[0] > 0.99);
    assert_true(contact[0] < 0.6);
    assert_true(beside[1] < 0.65 && away[1] > 0.97);
    fixture_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_find_what_the_horizon_misses),
        cmocka_unit_test(further_layers_see_behind_thin_occluders),
        cmocka_unit_test(thickness_opens_what_is_behind),
        cmocka_unit_test(quadratic_steps_find_what_is_near),
        cmocka_unit_test(containment_tests_points_on_the_way),
        cmocka_unit_test(alchemy_keeps_to_the_surface_where_vo_floats),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/* bitmask's thickness: the widths of what is seen, and light that passes behind. */
#include "fixture.h"

#include "methods/width.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

enum { SIZE = 160 };

/* ---- widths ---- */

/* A frame of one depth layer, seen at 100 px a radian. */
typedef struct map_case {
    crv__params params;
    crv__plane depth;
    float *pixels;
} map_case;

static map_case make_case(void)
{
    map_case c = {.params = {.width = SIZE,
                             .height = SIZE,
                             .layers = 1,
                             .radius = 1,
                             .inv_fx = 0.01f,
                             .inv_fy = 0.01f}};
    c.pixels = malloc(SIZE * SIZE * sizeof *c.pixels);
    c.depth = (crv__plane){c.pixels, SIZE, 0, 0, SIZE, SIZE};
    for (int32_t i = 0; i < SIZE * SIZE; i++)
        c.pixels[i] = INFINITY;
    return c;
}

static double width_at(const map_case *c, int32_t x, int32_t y)
{
    const crv__frame frame = {.params = &c->params, .depth = &c->depth};
    return (double)crv__map_width.value(&frame, x, y);
}

static void a_post_is_as_wide_as_it_is(void **state)
{
    (void)state;
    map_case c = make_case();
    for (int32_t i = 0; i < SIZE * SIZE; i++)
        c.pixels[i] =
            i % SIZE >= 70 && i % SIZE < 77 ? 5 : 8; /* 7 px, 3 radii in front */
    for (int32_t x = 70; x < 77; x++)
        assert_true(fabs(width_at(&c, x, 80) - 7 * 5 * 0.01) < 1e-5); /* rounding */
    assert_true(isinf(width_at(&c, 60, 80))); /* hidden behind the post on one side */
    free(c.pixels);
}

static void a_diagonal_bar_is_measured_across(void **state)
{
    (void)state;
    map_case c = make_case();
    for (int32_t i = 0; i < SIZE * SIZE; i++)
        c.pixels[i] = abs(i % SIZE - i / SIZE) <= 4 ? 5 : INFINITY;
    /* Across lie 5 of the 9 diagonals, from every other pixel 4. */
    const double step = sqrt(2) * 5 * 0.01;
    for (int32_t x = 78; x < 82; x++) {
        const double expected = (x % 2 == 0 ? 5 : 4) * step;
        assert_true(fabs(width_at(&c, x, 80) - expected) < 1e-5);
    }
    free(c.pixels);
}

static void surfaces_without_silhouettes_have_no_width(void **state)
{
    (void)state;
    map_case c = make_case();
    /* A floor that recedes steeply, 1/d linear: up to 1.2 radii from row to row. */
    for (int32_t i = 0; i < SIZE * SIZE; i++)
        c.pixels[i] = 1 / (0.0135f + 0.0025f * (float)(i / SIZE));
    for (int32_t y = 0; y < SIZE; y++)
        assert_true(isinf(width_at(&c, 80, y)));
    free(c.pixels);
}

/* ---- light behind a bar ---- */

static const double WALL = 10, BAR = 0.25, ABOVE = 0.5, RADIUS = 1.5;

/* A bar of square cross-section along y, parameters[0] before a wall. */
static fixture_hit bar_before_a_wall(const double origin[3], const double direction[3],
                                     const double *parameters)
{
    (void)direction;
    const bool on_bar = fabs(origin[0]) < BAR / 2;
    return (fixture_hit){on_bar ? WALL - parameters[0] - BAR : WALL, {0, 0, 1}};
}

/* Whether the ray from the wall at x meets the bar within the radius. */
static bool meets_bar(double x, double dx, double dz)
{
    double first = ABOVE / dz, last = (ABOVE + BAR) / dz;
    const double a = (-BAR / 2 - x) / dx, b = (BAR / 2 - x) / dx;
    first = fmax(first, fmin(a, b));
    last = fmin(last, fmax(a, b));
    return first < last && first < RADIUS;
}

/* Accessibility of the wall at x, cosine weighting, by quadrature over directions of
 * equal weight. */
static double wall_accessibility(double x)
{
    enum { COUNT = 800 };
    int64_t open = 0;
    for (int i = 0; i < COUNT * COUNT; i++) {
        const double z2 = (i / COUNT + 0.5) / COUNT;
        const double phi = 2 * PI * (i % COUNT + 0.5) / COUNT;
        open += !meets_bar(x, sqrt(1 - z2) * cos(phi), sqrt(z2));
    }
    return (double)open / (COUNT * COUNT);
}

/* The middle row; all others are guard band. */
static float *middle_row(const fixture *f, const char *method)
{
    crv_options options = fixture_options(method);
    options.radius = (float)RADIUS;
    options.falloff = CRV_FALLOFF_NONE;
    options.filter = NULL;
    options.noise_size = 1;
    options.directions = 64;
    options.steps = 128;
    const int32_t middle = f->height / 2;
    return fixture_compute(
        f, &options,
        &(fixture_run){.guard_top = middle, .guard_bottom = f->height - middle - 1});
}

static void light_passes_behind_a_bar(void **state)
{
    (void)state;
    enum { PX = 240 }; /* 60 px a unit */
    const crv_camera camera = crv_camera_orthographic(PX, PX, 4);
    fixture f = fixture_make(bar_before_a_wall, &ABOVE, &camera, PX, PX);
    float *bitmask = middle_row(&f, "bitmask"), *gtao = middle_row(&f, "gtao");
    static const int32_t OFFSETS_PX[] = {18, 30, 48, 66};
    for (int i = 0; i < 4; i++) {
        const int32_t column = PX / 2 + OFFSETS_PX[i];
        const double truth = wall_accessibility((OFFSETS_PX[i] + 0.5) / 60);
        printf("%d px off: true %.4f, bitmask %.4f, gtao %.4f\n", OFFSETS_PX[i], truth,
               (double)bitmask[column], (double)gtao[column]);
        /* The back is guessed from the front: as deep as wide, which the bar is, so that
         * what is left is the cells' slants. gtao takes all behind it for solid. */
        const double error = fabs((double)bitmask[column] - truth);
        assert_true(error < 0.02);
        assert_true(3 * error < truth - (double)gtao[column]);
    }
    free(bitmask);
    free(gtao);
    fixture_free(&f);
}

/* Beyond the radius a bar does nothing, by gtao too, though that takes all behind it for
 * solid. */
static void a_far_bar_does_not_occlude(void **state)
{
    (void)state;
    enum { PX = 240 };
    const double above = RADIUS + 0.01;
    const crv_camera camera = crv_camera_orthographic(PX, PX, 4);
    fixture f = fixture_make(bar_before_a_wall, &above, &camera, PX, PX);
    float *a = middle_row(&f, "gtao");
    for (int32_t x = PX / 2 + 9; x < PX; x++) /* the wall beside the bar */
        assert_true(a[x] > 0.9999f);          /* rounding */
    free(a);
    fixture_free(&f);
}

/* ---- plans ---- */

static void keep_line(void *user, crv_log_level level, const char *line)
{
    (void)level;
    snprintf(user, 200, "%s", line);
}

static void a_plan_without_widths_says_so(void **state)
{
    (void)state;
    static char line[200];
    crv_context_desc context_desc;
    crv_gbuffer_desc desc;
    crv_context *context = NULL;
    crv_plan *plan = NULL;
    crv_context_desc_init(&context_desc, sizeof context_desc);
    context_desc.logger = (crv_logger){keep_line, line};
    crv_gbuffer_desc_init(&desc, sizeof desc, 32, 32);
    assert_int_equal(crv_context_create(&context_desc, &context), CRV_OK);
    crv_options options = fixture_options("bitmask"), run = options;
    run.thickness_rule = CRV_THICKNESS_RUN;
    assert_int_equal(crv_plan_create(context, &run, &desc, &plan), CRV_OK);
    assert_true(crv_plan_set_options(plan, &options) != CRV_OK);
    assert_non_null(strstr(line, "thickness_rule"));
    crv_plan_destroy(plan);
    /* There and back again takes no memory. */
    assert_int_equal(crv_plan_create(context, &options, &desc, &plan), CRV_OK);
    assert_int_equal(crv_plan_set_options(plan, &run), CRV_OK);
    assert_int_equal(crv_plan_set_options(plan, &options), CRV_OK);
    crv_plan_destroy(plan);
    crv_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_post_is_as_wide_as_it_is),
        cmocka_unit_test(a_diagonal_bar_is_measured_across),
        cmocka_unit_test(surfaces_without_silhouettes_have_no_width),
        cmocka_unit_test(light_passes_behind_a_bar),
        cmocka_unit_test(a_far_bar_does_not_occlude),
        cmocka_unit_test(a_plan_without_widths_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/* The fit of options to a truth: its search, its truths, cases with a known answer. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "common/metrics_fit.h"
#include "common/pattern_search.h"
#include "common/target.h"
#include "common/tune.h"

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not %.9g within %g", value, expected, tolerance);
}

/* A valley that lies askew, least at (1, -0.5); the third number does not matter. */
typedef struct valley {
    int calls, calls_max;
    bool second; /* whether the second number does */
} valley;

static void valley_value(void *user, search_point *at)
{
    valley *v = user;
    const double x = at->number[0] - 1.0, y = at->number[1] + 0.5;
    v->calls++;
    at->value = x * x + 4.0 * y * y + 3.0 * x * y;
}

static bool valley_depends(void *user, const search_point *at, int number)
{
    (void)at;
    return number == 0 || (number == 1 && ((const valley *)user)->second);
}

static bool valley_stop(void *user)
{
    const valley *v = user;
    return v->calls >= v->calls_max;
}

static search_point go_down(valley *v, double low, double high)
{
    search s = {.evaluate = valley_value,
                .depends = valley_depends,
                .stop = valley_stop,
                .user = v};
    search_point at = {.number = {-3.0, 2.0, 7.0}};
    for (int i = 0; i < SEARCH_NUMBERS; i++) {
        s.low[i] = low;
        s.high[i] = high;
    }
    valley_value(v, &at);
    search_downhill(&s, 7u, 1.0, 1e-4, &at);
    return at;
}

static void test_search(void **state)
{
    (void)state;
    valley v = {.calls_max = 100000, .second = true};
    search_point at = go_down(&v, -10.0, 10.0);
    /* No point is better at the last step, 1e-4 to 2e-4. The gradient is then below
     * twice that by the largest curvature, 8; the least curvature is 0.76: 4e-3. */
    assert_near(at.number[0], 1.0, 4e-3);
    assert_near(at.number[1], -0.5, 4e-3);
    assert_near(at.number[2], 7.0, 0.0);
    assert_true(v.calls < 1000);

    /* The least of x^2 + 25 + 7.5 x - ..., by hand: at y = 2, x - 1 = -1.5 (y + 0.5). */
    v = (valley){.calls_max = 100000};
    at = go_down(&v, -10.0, 10.0);
    assert_near(at.number[0], 1.0 - 1.5 * 2.5, 2e-4);
    assert_near(at.number[1], 2.0, 0.0);

    /* The range ends before it. */
    v = (valley){.calls_max = 100000, .second = true};
    at = go_down(&v, -10.0, 0.5);
    assert_near(at.number[0], 0.5, 0.0);

    v = (valley){.calls_max = 9, .second = true};
    go_down(&v, -10.0, 10.0);
    assert_in_range(v.calls, 1, 9);
}

static void test_scan(void **state)
{
    (void)state;
    valley v = {.calls_max = 1000, .second = true};
    search s = {.low = {-10, -10},
                .high = {10, 10},
                .evaluate = valley_value,
                .depends = valley_depends,
                .stop = valley_stop,
                .user = &v};
    search_point at = {.number = {-3.0, -0.5}};
    valley_value(&v, &at);
    search_scan(&s, 0, 1.5, 3, &at);
    assert_near(at.number[0], 1.5, 0.0); /* of -7.5, -6 ... 1.5 the nearest to 1 */
    assert_int_equal(v.calls, 7);
}

static void test_words(void **state)
{
    (void)state;
    char words[64];
    assert_int_equal(tune_parse("radius,contrast"), TUNE_RADIUS | TUNE_CONTRAST);
    assert_int_equal(tune_parse("radius,thickness,falloff,intensity,contrast"), TUNE_ALL);
    assert_int_equal(tune_parse("radius,"), 0);
    assert_int_equal(tune_parse("radi"), 0);
    assert_int_equal(tune_parse(""), 0);
    assert_string_equal(tune_words(TUNE_FALLOFF | TUNE_RADIUS, words), "radius, falloff");
    /* Read by every method; ssao reads nothing else of them. */
    const unsigned all = TUNE_RADIUS | TUNE_INTENSITY | TUNE_CONTRAST;
    assert_int_equal(tune_applicable(TUNE_ALL, crv_method_find("ssao")) & all, all);
    assert_int_equal(tune_applicable(TUNE_ALL, crv_method_find("ssao")) & TUNE_FALLOFF,
                     0);
    assert_int_equal(tune_applicable(TUNE_ALL, crv_method_find("raymarch")), TUNE_ALL);
    assert_int_equal(tune_applicable(TUNE_RADIUS, crv_method_find("hbao")), TUNE_RADIUS);
}

/* Curves by their own formula; what may not change stays. */
static void test_curve_near(void **state)
{
    enum { COUNT = 300 };
    float a[COUNT], b[COUNT];
    (void)state;
    for (int i = 0; i < COUNT; i++) {
        a[i] = 0.3f + 0.7f * (float)i / (COUNT - 1);
        b[i] = (float)pow(1.0 - 1.2 * (1.0 - (double)a[i]), 0.7);
    }
    metrics_curve curve = {.intensity = 1.0, .power = 1.0};
    assert_true(metrics_fit_near(a, b, COUNT, METRICS_INTENSITY | METRICS_POWER, &curve));
    assert_near(curve.intensity, 1.2, 1e-5); /* as test_tool_metrics_fit.c has it */
    assert_near(curve.power, 0.7, 1e-5);
    curve = (metrics_curve){.intensity = 1.0, .power = 0.7};
    assert_true(metrics_fit_near(a, b, COUNT, METRICS_INTENSITY, &curve));
    assert_near(curve.intensity, 1.2, 1e-5);
    assert_near(curve.power, 0.7, 0.0);
    curve = (metrics_curve){.intensity = 1.2, .power = 1.0};
    assert_true(metrics_fit_near(a, b, COUNT, METRICS_POWER, &curve));
    assert_near(curve.intensity, 1.2, 0.0);
    assert_near(curve.power, 0.7, 1e-5);
}

/* A view of the courtyard, with its truth still to come. */
typedef struct place {
    scene *model;
    scene_gbuffer g;
    crv_context *context;
    crv_gbuffer *gbuffer;
    tune_view view;
    float radius; /* that suits it */
} place;

enum { WIDTH = 96, HEIGHT = 54, COUNT = WIDTH * HEIGHT };

static place make_place(int32_t most)
{
    place p = {0};
    scene_gbuffer_request request = {
        .width = WIDTH, .height = HEIGHT, .guard_px = 6, .layers = 1};
    crv_context_desc desc;
    assert_int_equal(scene_builtin("courtyard", &p.model, NULL), 0);
    scene_frame(p.model, 0.8f, (float)WIDTH / HEIGHT, &request.view);
    assert_int_equal(scene_render_gbuffer(p.model, &request, &p.g, NULL), 0);
    assert_int_equal(crv_context_desc_init(&desc, sizeof desc), CRV_OK);
    assert_int_equal(crv_context_create(&desc, &p.context), CRV_OK);
    assert_int_equal(scene_gbuffer_upload(&p.g, p.context, &p.gbuffer), CRV_OK);
    assert_true(
        tune_view_open(&p.view, p.context, p.gbuffer, &p.g.desc, p.g.depth[0], most));
    p.radius = scene_suggest_radius(p.model, &p.g.view);
    return p;
}

static void free_place(place *p)
{
    tune_view_free(&p->view);
    crv_gbuffer_destroy(p->gbuffer);
    crv_context_destroy(p->context);
    scene_gbuffer_free(&p->g);
    scene_free(p->model);
}

static crv_options options_of(const place *p, const char *method)
{
    crv_options o;
    assert_int_equal(crv_options_init(&o, sizeof o, method), CRV_OK);
    o.radius = p->radius;
    return o;
}

/* The truth is what the method gives with these options. */
static void take_own(place *p, const crv_options *answer)
{
    float *plane = malloc(COUNT * sizeof *plane);
    assert_non_null(plane);
    assert_int_equal(tune_view_run(&p->view, answer), CRV_OK);
    memcpy(plane, p->view.result, COUNT * sizeof *plane);
    tune_view_take(&p->view, plane);
    free(plane);
}

static tune_result fit(place *p, const crv_options *start, unsigned fits, int32_t runs)
{
    tune_result found;
    const tune_request q = {.view = &p->view,
                            .start = *start,
                            .fits = fits,
                            .evaluations = runs,
                            .seconds = INFINITY};
    assert_int_equal(tune_fit(&q, &found), CRV_OK);
    assert_true(found.after.mean_square <= found.before.mean_square);
    return found;
}

/* Radius, intensity and contrast make up for each other along a valley, in which the
 * search stops some steps of 0.2 % before the answer. A percent of any of them moves a
 * result by a percent of its occlusion, 0.003 in the mean. */
static void assert_found(const tune_result *found, const crv_options *answer)
{
    assert_true(found->before.rmse > 0.02);
    assert_true(found->after.rmse < 0.005);
    assert_near((double)found->options.radius / (double)answer->radius, 1.0, 0.02);
    assert_near((double)found->options.contrast / (double)answer->contrast, 1.0, 0.04);
    assert_near((double)found->options.intensity / (double)answer->intensity, 1.0, 0.04);
    assert_int_equal(found->options.falloff, answer->falloff);
}

static void test_known_answer(void **state)
{
    (void)state;
    place p = make_place(0);
    const crv_options start = options_of(&p, "gtao");
    crv_options answer = start;
    answer.radius *= 2.7f;
    answer.falloff = CRV_FALLOFF_CUBIC;
    answer.contrast = 1.6f;
    take_own(&p, &answer);
    const tune_result found = fit(&p, &start, TUNE_ALL, 400);
    assert_found(&found, &answer);
    assert_true(found.finished);
    /* What is not fitted stays. */
    const tune_result some = fit(&p, &start, TUNE_RADIUS | TUNE_CONTRAST, 400);
    assert_int_equal(some.options.falloff, start.falloff);
    assert_near((double)some.options.intensity, 1.0, 0.0);
    assert_true(some.after.rmse < 0.5 * some.before.rmse);
    free_place(&p);
}

static void test_known_thickness(void **state)
{
    (void)state;
    place p = make_place(0);
    const crv_options start = options_of(&p, "bitmask");
    crv_options answer = start;
    answer.radius *= 1.7f;
    answer.thickness_rule = CRV_THICKNESS_CONSTANT;
    answer.thickness = 0.22f;
    answer.intensity = 0.9f;
    take_own(&p, &answer);
    const tune_result found = fit(&p, &start, TUNE_ALL, 600);
    assert_found(&found, &answer);
    assert_int_equal(found.options.thickness_rule, CRV_THICKNESS_CONSTANT);
    assert_near((double)found.options.thickness / (double)answer.thickness, 1.0, 0.02);
    /* A rule without a number leaves that of the start. */
    take_own(&p, &start);
    const tune_result same = fit(&p, &start, TUNE_ALL, 50);
    assert_near(same.after.rmse, 0.0, 0.0);
    assert_near((double)same.options.thickness, (double)start.thickness, 0.0);
    free_place(&p);
}

/* The same number of runs: the same options. Another limit ends it, too. */
static bool stop_at_once(void *user)
{
    ++*(int *)user;
    return true;
}

static void test_limits(void **state)
{
    (void)state;
    place p = make_place(1000); /* on a grid of every third pixel */
    assert_in_range(p.view.count, COUNT / 18, COUNT / 9);
    const crv_options start = options_of(&p, "hbao");
    crv_options answer = start;
    answer.radius *= 3.0f;
    take_own(&p, &answer);
    const tune_result a = fit(&p, &start, TUNE_ALL, 40),
                      b = fit(&p, &start, TUNE_ALL, 40);
    assert_int_equal(a.evaluations, b.evaluations);
    assert_in_range(a.evaluations, 2, 44); /* "about": stages end with a run or two */
    assert_false(a.finished);
    for (int32_t i = 0; i < crv_option_count(); i++)
        assert_near(crv_options_get(&a.options, crv_option_at(i)),
                    crv_options_get(&b.options, crv_option_at(i)), 0.0);

    tune_result found;
    int asked = 0;
    const tune_request q = {.view = &p.view,
                            .start = start,
                            .fits = TUNE_ALL,
                            .seconds = INFINITY,
                            .stop = stop_at_once,
                            .user = &asked};
    assert_int_equal(tune_fit(&q, &found), CRV_OK);
    assert_true(asked > 0 && found.evaluations < 6);
    free_place(&p);
}

/* The noise that passes tell of is that which they have: against a truth of many rays the
 * mean square is the noise of both, or a little less, as rays are stratified. Squares of
 * some thousand pixels, whose spread is about their size, leave a tenth. */
static void test_traced(void **state)
{
    (void)state;
    place p = make_place(0);
    crv_options o = options_of(&p, "gtao");
    tune_trace t = {.model = p.model, .g = &p.g, .target = target_of(&o), .rays = 32};
    assert_in_range(p.view.count, 2000, COUNT);
    assert_int_equal(tune_view_trace(&p.view, &t, NULL), 0);
    assert_int_equal(p.view.rays, 32);
    assert_false(tune_view_is_open(&p.view));
    reference *many = NULL;
    t.target.rays = 512;
    t.target.seed = 77;
    assert_int_equal(reference_create(p.model, &p.g, &t.target, &many, NULL), 0);
    double sum = 0.0, noise = 0.0;
    for (int32_t i = 0; i < p.view.count; i++) {
        const reference_value v =
            reference_pixel(many, p.view.pixel[i] % WIDTH, p.view.pixel[i] / WIDTH);
        const double error = (double)p.view.truth[i] - (double)v.accessibility;
        sum += error * error;
        noise += (double)v.error * (double)v.error;
    }
    const double expected = p.view.noise + noise / p.view.count;
    assert_near(sum / p.view.count / expected, 0.9, 0.2);
    reference_free(many);

    /* A method that estimates it follows it; the other way round it does not. */
    tune_error e;
    assert_int_equal(tune_view_measure(&p.view, &o, &e), CRV_OK);
    assert_true(e.correlation > 0.5);
    for (int32_t i = 0; i < p.view.count; i++)
        p.view.truth[i] = 1.0f - p.view.truth[i];
    assert_int_equal(tune_view_measure(&p.view, &o, &e), CRV_OK);
    assert_true(e.correlation < -0.5);
    for (int32_t i = 0; i < p.view.count; i++)
        p.view.truth[i] = 1.0f;
    assert_true(tune_view_is_open(&p.view));
    int asked = 0;
    t.stop = stop_at_once;
    t.user = &asked;
    assert_int_equal(tune_view_trace(&p.view, &t, NULL), -1);
    free_place(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_search),       cmocka_unit_test(test_scan),
        cmocka_unit_test(test_words),        cmocka_unit_test(test_curve_near),
        cmocka_unit_test(test_known_answer), cmocka_unit_test(test_known_thickness),
        cmocka_unit_test(test_limits),       cmocka_unit_test(test_traced),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

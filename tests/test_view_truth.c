/* SPDX-License-Identifier: MIT */
/* The truth that the viewer refines in the background, and the threads around it. */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "session.h"
#include "common/target.h"

enum { WIDTH = 48, HEIGHT = 27, COUNT = WIDTH * HEIGHT };

static atomic_int changes;

static void changed(void *user)
{
    (void)user;
    atomic_fetch_add(&changes, 1);
}

static void nap(void)
{
    const struct timespec short_time = {.tv_nsec = 2000000};
    nanosleep(&short_time, NULL);
}

static scene *load(const char *name)
{
    scene *s = NULL;
    assert_int_equal(scene_builtin(name, &s, NULL), 0);
    return s;
}

static buffers *cast(const scene *s)
{
    scene_gbuffer_request request = {
        .width = WIDTH, .height = HEIGHT, .guard_px = 3, .layers = 1};
    scene_gbuffer g = {0};
    scene_frame(s, 0.8f, (float)WIDTH / HEIGHT, &request.view);
    assert_int_equal(scene_render_gbuffer(s, &request, &g, NULL), 0);
    buffers *b = buffers_make(&g);
    assert_non_null(b);
    return b;
}

static reference_options integral(float radius)
{
    crv_options o;
    assert_int_equal(crv_options_init(&o, sizeof o, "gtao"), CRV_OK);
    o.radius = radius;
    return target_of(&o);
}

static truth_state wait_for(truth *t, int slot, int32_t passes)
{
    truth_state state = {0};
    while (!truth_progress(t, slot, &state) || state.passes < passes)
        nap();
    return state;
}

static void read_plane(truth *t, int slot, const buffers *b, float out[COUNT])
{
    truth_state state;
    assert_true(truth_read(t, slot, b, out, &state));
    assert_int_equal(state.known, COUNT);
}

/* The mean of many passes is what `crevice reference` computes with as many rays, within
 * what both say of their errors: the root mean square of the differences is about
 * sqrt(2) errors; 2 leaves room for the estimate's own spread. */
static void compare_with_reference(const scene *model, const scene *traced,
                                   reference_kind kind)
{
    buffers *b = cast(model);
    reference_options o = integral(0.4f);
    reference *r = NULL;
    static float mean[COUNT];
    double sum = 0.0, theirs = 0.0;
    int surfaces = 0;
    o.kind = kind;
    o.thickness = 0.5f;
    truth *t = truth_start(traced, 1, changed, NULL);
    assert_non_null(t);
    truth_want(t, 0, b, &o);
    wait_for(t, 0, 16);
    truth_hold(t, true);
    truth_state state;
    assert_true(truth_read(t, 0, b, mean, &state));
    o.rays = 16 * TRUTH_PASS_RAYS;
    o.seed = 12345;
    assert_int_equal(reference_create(model, &b->g, &o, &r, NULL), 0);
    reference_advance(r, COUNT, 1);
    for (int i = 0; i < COUNT; i++) {
        if (!b->surface[i])
            continue;
        surfaces++;
        sum += pow((double)mean[i] - (double)reference_accessibility(r)[i], 2.0);
        theirs += pow((double)reference_error(r)[i], 2.0);
    }
    assert_true(surfaces > COUNT / 4);
    const double found = sqrt(sum / surfaces), error = sqrt(theirs / surfaces);
    assert_true(state.error > 0.0 && state.error < 0.05);
    assert_true(found < 2.0 * fmax(error, state.error));
    reference_free(r);
    truth_stop(t);
    truth_free(t);
    buffers_release(b);
}

static void test_truth_is_the_reference(void **state)
{
    (void)state;
    scene *s = load("courtyard");
    compare_with_reference(s, s, REFERENCE_FULL);
    compare_with_reference(s, s, REFERENCE_VISIBLE);
    compare_with_reference(s, NULL, REFERENCE_VISIBLE); /* as for a frame */
    scene_free(s);
}

/* Nothing occludes a plane, and no error is claimed to be 0 after the first pass. */
static void test_plane_is_open(void **state)
{
    (void)state;
    static float mean[COUNT];
    scene *s = load("plane");
    buffers *b = cast(s);
    reference_options o = integral(0.5f);
    truth *t = truth_start(s, 1, changed, NULL);
    truth_want(t, 0, b, &o);
    wait_for(t, 0, 3);
    read_plane(t, 0, b, mean);
    for (int i = 0; i < COUNT; i++)
        assert_true(mean[i] > 0.999f);
    truth_stop(t);
    truth_free(t);
    buffers_release(b);
    scene_free(s);
}

/* Two slots that want the same share the work; one that wants something else
 * has its own, and a new wish begins anew. */
static void test_slots(void **state)
{
    (void)state;
    static float a[COUNT], c[COUNT];
    scene *s = load("corner");
    buffers *b = cast(s), *other = cast(s);
    reference_options o = integral(0.5f), p = integral(0.1f);
    truth *t = truth_start(s, 1, changed, NULL);
    truth_want(t, 0, b, &o);
    truth_want(t, 1, b, &o);
    wait_for(t, 1, 2);
    truth_hold(t, true);
    read_plane(t, 0, b, a);
    read_plane(t, 1, b, c);
    assert_memory_equal(a, c, sizeof a);
    truth_want(t, 1, b, &p);
    truth_hold(t, false);
    wait_for(t, 1, 2);
    truth_hold(t, true);
    read_plane(t, 1, b, c);
    assert_true(memcmp(a, c, sizeof a) != 0);
    truth_state now;
    assert_false(truth_read(t, 0, other, a, &now));
    truth_want(t, 0, other, &o);
    assert_true(truth_progress(t, 0, &now));
    assert_int_equal(now.passes, 0);
    truth_want(t, 0, NULL, &o);
    assert_false(truth_progress(t, 0, &now));
    truth_stop(t);
    truth_free(t);
    buffers_release(b);
    buffers_release(other);
    scene_free(s);
}

/* What a session is opened with. */
typedef struct opened {
    report r;
    viewer_settings settings;
} opened;

static void open_session(opened *o, session *s)
{
    report_init(&o->r);
    o->r.quiet = true;
    o->settings = (viewer_settings){.view.model = "builtin:courtyard",
                                    .view.size = {.width = WIDTH, .height = HEIGHT},
                                    .view.layers.value = 1};
    assert_int_equal(
        crv_options_init(&o->settings.view.common.options, sizeof(crv_options), NULL),
        CRV_OK);
    assert_int_equal(session_open(s, &o->settings, changed, NULL, &o->r), EXIT_DONE);
}

/* A whole session: many wishes, of which the last is served and measured. */
static void test_session(void **state)
{
    (void)state;
    opened o;
    session s;
    shown got = {0};
    uint64_t number = 0, wanted = 0;
    open_session(&o, &s);
    for (int i = 1; i <= 20; i++) {
        s.wish.view.eye[0] += 0.01;
        s.wish.half[0].options.radius = 0.02f * (float)i;
        wanted = session_ask(&s);
    }
    for (;;) {
        if (worker_take(s.worker, &got, &number)) {
            if (number == wanted && got.half[0].measured
                && got.half[0].truth.passes >= 32)
                break;
            shown_free(&got);
        }
        nap();
    }
    assert_string_equal(got.problem, "");
    assert_true(fabsf(got.wish.half[0].options.radius - 0.4f) < 1e-6f);
    assert_int_equal(got.buffers->width, WIDTH);
    /* The picture is small and full of grass; what is wrong is wrong by more. */
    assert_true(got.half[0].rmse > 0.0 && got.half[0].rmse < 0.3);
    assert_true(fabs(got.half[0].bias) < got.half[0].rmse);
    assert_true(got.half[0].time_ms > 0.0);
    assert_false(got.half[1].measured); /* it is the truth */
    shown_free(&got);
    assert_true(session_set_method(&s, 0, "vao"));
    assert_false(session_set_method(&s, 0, "nothing"));
    assert_string_equal(s.wish.half[0].options.method->name, "vao");
    assert_true(fabsf(s.wish.half[0].options.radius - 0.4f) < 1e-6f);
    session_close(&s);
}

static tuning wait_for_fit(session *s)
{
    tuning t;
    do {
        nap();
        worker_tuning(s->worker, &t);
    } while (t.phase == TUNING_RUNS);
    return t;
}

/* A half's options are fitted to the truth; once they are taken over, the truth is still
 * what it was. Another wish ends a fit. */
static void test_tuning(void **state)
{
    (void)state;
    opened o;
    session s;
    char text[TUNING_TEXT_SIZE];
    open_session(&o, &s);
    const float radius = s.wish.half[0].options.radius;
    session_ask(&s);
    worker_tune(s.worker, 0, 1.0);
    tuning t = wait_for_fit(&s);
    assert_int_equal(t.phase, TUNING_DONE);
    assert_true(t.has_other);
    assert_true(t.found.after.mean_square <= t.found.before.mean_square);
    assert_true(fabsf(t.target.radius - radius) < 1e-6f);
    assert_non_null(strstr(tuning_text(&t, text), "fitted: RMSE 0."));
    assert_non_null(strstr(text, "another view: RMSE 0."));

    assert_true(session_take_over(&s, &t));
    s.wish.half[0].options.radius = 3.0f;
    s.wish.half[0].options.falloff = CRV_FALLOFF_NONE;
    const reference_options kept = wish_target(&s.wish, 1);
    assert_true(fabsf(kept.radius - radius) < 1e-6f);
    assert_int_equal(kept.falloff, CRV_FALLOFF_LINEAR);
    assert_true(session_set_method(&s, 0, "gtao"));
    assert_true(fabsf(wish_target(&s.wish, 1).radius - 3.0f) < 1e-6f);
    assert_false(session_take_over(&s, &t)); /* of another method */

    session_ask(&s);
    worker_tune(s.worker, 0, 1e5);
    do {
        nap();
        worker_tuning(s.worker, &t);
    } while (t.runs < 5);
    s.wish.view.eye[0] += 0.1;
    session_ask(&s);
    t = wait_for_fit(&s);
    assert_int_equal(t.phase, TUNING_DONE);
    worker_tune(s.worker, 0, 1e5);
    worker_stop_tuning(s.worker); /* also one that has not begun */
    t = wait_for_fit(&s);
    assert_true(t.phase == TUNING_DONE || t.phase == TUNING_FAILED);
    session_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_truth_is_the_reference),
        cmocka_unit_test(test_plane_is_open),
        cmocka_unit_test(test_slots),
        cmocka_unit_test(test_session),
        cmocka_unit_test(test_tuning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

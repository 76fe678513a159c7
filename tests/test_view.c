/* SPDX-License-Identifier: MIT */
/* The viewer without its window: cameras, sliders, texts, pictures. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "command_text.h"
#include "engine.h"
#include "explain.h"
#include "knob.h"
#include "common/motion.h"
#include "common/option_text.h"
#include "common/target.h"

static const double pi = 3.14159265358979323846;

static scene_view from_z(void)
{
    return (scene_view){
        .eye = {0, 0, 4}, .up = {0, 1, 0}, .vfov_rad = 0.9f, .view_height = 2.0f};
}

static void assert_near3(const double a[3], double x, double y, double z)
{
    const double b[3] = {x, y, z};
    for (int i = 0; i < 3; i++)
        assert_true(fabs(a[i] - b[i]) < 1e-9); /* a few ulps of numbers below 10 */
}

/* By hand: the eye on +Z goes a quarter to +X, then up; the poles are not reached. */
static void test_orbit(void **state)
{
    (void)state;
    scene_view v = from_z();
    motion_orbit(&v, 0.5 * pi, 0.0);
    assert_near3(v.eye, 4, 0, 0);
    motion_orbit(&v, 0.0, pi / 6.0);
    assert_near3(v.eye, 4 * cos(pi / 6), 2, 0);
    motion_orbit(&v, 0.0, 10.0);
    assert_near3(v.eye, 4 * cos(89 * pi / 180), 4 * sin(89 * pi / 180), 0);
    assert_near3(v.target, 0, 0, 0);
}

static void test_other_motions(void **state)
{
    (void)state;
    scene_view v = from_z();
    motion_dolly(&v, 0.5);
    assert_near3(v.eye, 0, 0, 2);
    assert_true(fabsf(v.view_height - 1.0f) < 1e-6f);
    /* At distance 2 the picture is 4 tan(0.45) high. */
    motion_pan(&v, 0.5, 0.25);
    assert_near3(v.target, -2 * tan(0.45f), tan(0.45f), 0);
    v = from_z();
    motion_fly(&v, 0.25, 0.5, 1.0);
    assert_near3(v.eye, 1, 2, 0);
    assert_near3(v.target, 1, 2, -4);
    /* A point 1 to the right, 2 up and 3 before the eye, from half the distance. */
    v = from_z();
    motion_focus(&v, (const double[]){1, 2, -3}, 0.5);
    assert_near3(v.target, 1, 2, 1);
    assert_near3(v.eye, 0.5, 1, 2.5);
    v = from_z();
    motion_look(&v, 0.5 * pi, 0.0);
    assert_near3(v.eye, 0, 0, 4);
    assert_near3(v.target, 4, 0, 4);
}

/* Every number of the table: ends at 0 and 1, there and back again, never falling. */
static void test_knobs(void **state)
{
    (void)state;
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        if (!knob_is_slider(option))
            continue;
        const knob k = knob_of(option, 0.0);
        assert_true(k.min >= option->min && k.max <= option->max && k.min < k.max);
        assert_true(option->default_value >= k.min && option->default_value <= k.max);
        assert_true(fabs(knob_position(&k, k.min)) < 1e-12);
        assert_true(fabs(knob_position(&k, k.max) - 1.0) < 1e-12);
        double last = k.min;
        for (int step = 0; step <= 100; step++) {
            const double value = knob_value(&k, step / 100.0);
            assert_true(value >= last && value <= k.max);
            last = value;
            if (!k.whole)
                /* Three digits: half a degree of the 179 that filter_normal spans. */
                assert_true(fabs(knob_position(&k, value) - step / 100.0) < 3e-3);
            else
                assert_true(fabs(knob_value(&k, knob_position(&k, value)) - value) < 0.5);
        }
    }
    assert_int_equal(knob_of(crv_option_find("radius"), 0.3).scale, KNOB_LOG);
    assert_int_equal(knob_of(crv_option_find("bias_deg"), 0.0).scale, KNOB_LINEAR);
    assert_int_equal(knob_of(crv_option_find("max_radius_px"), 0.0).scale, KNOB_LOG_ZERO);
    assert_false(knob_is_slider(crv_option_find("seed")));
}

static crv_options options_of(const char *method)
{
    crv_options o;
    assert_int_equal(crv_options_init(&o, sizeof o, method), CRV_OK);
    return o;
}

/* The papers' integrals, as docs/methods.md lists them. */
static void test_targets(void **state)
{
    (void)state;
    crv_options o = options_of("hbao");
    reference_options t = target_of(&o);
    assert_int_equal(t.weighting, CRV_WEIGHTING_UNIFORM);
    assert_int_equal(t.falloff, CRV_FALLOFF_LINEAR);
    o = options_of("gtao");
    o.weighting = CRV_WEIGHTING_UNIFORM;
    assert_int_equal(target_of(&o).weighting, CRV_WEIGHTING_UNIFORM);
    o = options_of("vao");
    assert_int_equal(target_of(&o).definition, REFERENCE_TANGENT_SPHERE);
    o = options_of("alchemy");
    assert_int_equal(target_of(&o).falloff, CRV_FALLOFF_ALCHEMY);
    assert_int_equal(target_of(&o).weighting, CRV_WEIGHTING_COSINE);
    reference_options other = t;
    assert_true(target_equal(&t, &other));
    other.tau = 9.0f; /* of a falloff that is not used */
    assert_true(target_equal(&t, &other));
    other.radius *= 2.0f;
    assert_false(target_equal(&t, &other));
}

/* What is written is read again, to the same options. */
static void test_option_text(void **state)
{
    (void)state;
    crv_options o = options_of("gtao"), again = options_of("gtao");
    char text[OPTION_TEXT_SIZE];
    o.radius = 0.1f;
    o.falloff = CRV_FALLOFF_CUBIC;
    o.filter = NULL;
    assert_string_equal(option_flags(&o, text),
                        " --method gtao --filter none --radius 0.1 --falloff cubic");
    option_lines(&o, text);
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        char *value = strchr(line, '=');
        *value = '\0';
        assert_int_equal(crv_options_set(&again, line, value + 1, NULL), CRV_OK);
    }
    assert_true(estimate_same_options(&o, &again));
}

/* Meaning, range and default; the default is the method's, or that of the view. */
static void test_tooltips(void **state)
{
    (void)state;
    char text[OPTION_TOOLTIP_SIZE];
    const crv_option *falloff = crv_option_find("falloff");
    option_tooltip(falloff, crv_method_find("hbao"), 0.0, text);
    assert_non_null(strstr(text, falloff->help));
    assert_non_null(strstr(text, "none|linear|"));
    assert_non_null(strstr(text, "default linear")); /* as `crevice methods hbao` says */
    option_tooltip(crv_option_find("steps"), crv_method_find("hbao"), 0.0, text);
    assert_non_null(strstr(text, "default 8"));
    option_tooltip(crv_option_find("radius"), crv_method_find("hbao"), 0.25, text);
    assert_non_null(strstr(text, "default 0.25, that of the first view"));
}

/* An engine on a small built-in scene. */
typedef struct bench {
    report r;
    viewer_settings settings;
    source source;
    engine engine;
    wish wish;
} bench;

static void quiet(void *user, crv_log_level level, const char *line)
{
    (void)user;
    (void)level;
    (void)line;
}

static void open_bench(bench *b, const char *model)
{
    *b = (bench){.r.logger.fn = quiet, .r.quiet = true};
    view_settings *v = &b->settings.view;
    *v = (view_settings){.common.options = options_of(NULL), .model = model};
    v->size = (arg_size){.width = 96, .height = 54};
    v->layers.value = 1;
    assert_int_equal(source_open(&b->source, &b->settings, &b->r), EXIT_DONE);
    assert_int_equal(engine_open(&b->engine, &b->source, NULL, &v->common, &b->r),
                     EXIT_DONE);
    b->wish = (wish){.width = 96, .height = 54, .heat_scale = 0.25};
    assert_int_equal(view_choose(v, b->source.model, &b->wish.view, &b->r), EXIT_DONE);
    for (int i = 0; i < HALVES; i++) {
        b->wish.half[i].options = options_of(NULL);
        b->wish.half[i].options.radius = 0.3f;
    }
}

static void close_bench(bench *b)
{
    engine_close(&b->engine);
    source_free(&b->source);
}

static void render(bench *b, shown *out)
{
    assert_true(engine_render(&b->engine, &b->wish, out));
    assert_string_equal(out->problem, "");
}

/* Options that go to and fro give what they gave at first, and what another engine gives;
 * all that a method or a preset changes is taken over. */
static void test_engine_keeps_nothing_stale(void **state)
{
    (void)state;
    static const char *const methods[] = {"gtao", "vao", "bitmask", "hbao"};
    bench b, fresh;
    shown first, other, again;
    open_bench(&b, "builtin:courtyard");
    render(&b, &first);
    for (size_t i = 0; i < sizeof methods / sizeof methods[0]; i++) {
        b.wish.half[0].options = options_of(methods[i]);
        b.wish.half[0].options.radius = 0.5f;
        b.wish.half[0].options.filter = i % 2 ? NULL : b.wish.half[1].options.filter;
        render(&b, &other);
        open_bench(&fresh, "builtin:courtyard");
        fresh.wish = b.wish;
        render(&fresh, &again);
        const size_t count = (size_t)96 * 54;
        assert_memory_equal(other.half[0].accessibility, again.half[0].accessibility,
                            count * sizeof(float));
        assert_memory_equal(first.half[1].pixels, other.half[1].pixels, 4 * count);
        assert_true(memcmp(first.half[0].pixels, other.half[0].pixels, 4 * count) != 0);
        shown_free(&other);
        shown_free(&again);
        close_bench(&fresh);
    }
    shown_free(&first);
    close_bench(&b);
}

/* What did not change is not made anew: the same memory is shown. */
static void test_engine_makes_what_changed(void **state)
{
    (void)state;
    bench b;
    shown first, second, third;
    open_bench(&b, "builtin:corner");
    render(&b, &first);
    b.wish.half[0].options.radius = 0.4f;
    render(&b, &second);
    assert_ptr_not_equal(first.half[0].accessibility, second.half[0].accessibility);
    assert_ptr_not_equal(first.half[0].pixels, second.half[0].pixels);
    assert_ptr_equal(first.half[1].accessibility, second.half[1].accessibility);
    assert_ptr_equal(first.half[1].pixels, second.half[1].pixels);
    b.wish.half[1].look = LOOK_DIFFERENCE;
    render(&b, &third);
    assert_ptr_equal(second.half[0].pixels, third.half[0].pixels);
    assert_ptr_not_equal(second.half[1].pixels, third.half[1].pixels);
    /* What is shown stays when the engine is gone. */
    const uint32_t before = first.half[0].pixels[96 * 27 + 48];
    close_bench(&b);
    assert_int_equal(first.half[0].pixels[96 * 27 + 48], before);
    shown_free(&first);
    shown_free(&second);
    shown_free(&third);
}

/* A run of seconds is left off if another wish waits, a short one comes to its end; the
 * picture that is made then is none of a run that was left off. */
static void test_overtaken_runs(void **state)
{
    (void)state;
    bench b;
    shown s, again;
    open_bench(&b, "builtin:courtyard");
    b.wish.width = 512; /* eight tiles */
    b.wish.height = 64;
    render(&b, &s);
    b.engine.overtaken = true;
    b.wish.half[0].options.radius = 0.31f;
    render(&b, &again); /* milliseconds */
    shown_free(&again);
    b.wish.half[0].options = options_of("raymarch");
    b.wish.half[0].options.directions = 64; /* some 1e9 steps a tile, half a second */
    b.wish.half[0].options.normal_rays = 32;
    b.wish.half[0].options.steps = 128;
    assert_false(engine_render(&b.engine, &b.wish, &again));
    b.engine.overtaken = false;
    b.wish.half[0].options = b.wish.half[1].options;
    render(&b, &again);
    assert_memory_equal(again.half[0].accessibility, again.half[1].accessibility,
                        sizeof(float) * 512 * 64);
    assert_memory_equal(again.half[0].pixels, s.half[0].pixels, 4 * 512 * 64);
    shown_free(&s);
    shown_free(&again);
    close_bench(&b);
}

/* Grey is the PNG's grey, no difference is the heat map's white, lit is dark where
 * closed. */
static void test_looks(void **state)
{
    (void)state;
    bench b;
    shown s;
    open_bench(&b, "builtin:corner");
    b.wish.half[1].look = LOOK_DIFFERENCE;
    render(&b, &s);
    for (size_t i = 0; i < (size_t)96 * 54; i++) {
        assert_int_equal(s.half[0].pixels[i] & 255u,
                         io_quantise(s.half[0].accessibility[i], false, 255));
        if (s.buffers->surface[i])
            assert_true((s.half[1].pixels[i] >> 8 & 255u) > 240);
    }
    shown_free(&s);
    b.wish.half[0].look = LOOK_LIT;
    b.wish.half[1].look = LOOK_LIT;
    b.wish.half[1].content = HALF_OPEN;
    render(&b, &s);
    int darker = 0;
    for (size_t i = 0; i < (size_t)96 * 54; i++) {
        for (int shift = 0; shift < 24; shift += 8)
            assert_true((s.half[0].pixels[i] >> shift & 255u)
                        <= (s.half[1].pixels[i] >> shift & 255u));
        darker += s.half[0].pixels[i] < s.half[1].pixels[i];
    }
    assert_true(darker > 0);
    shown_free(&s);
    close_bench(&b);
}

/* A frame's own picture, darkened: linear light times accessibility, as sRGB. A valley,
 * made by hand: depth 4 in the middle, 1 on both sides. */
static void test_lit_frame(void **state)
{
    (void)state;
    enum { WIDTH = 64, HEIGHT = 32 };
    static const char *const names[] = {"Z", "View.Combined.R", "View.Combined.G",
                                        "View.Combined.B"};
    static const float colour[] = {0.9f, 0.5f, 0.1f};
    const char *path = "test_view_lit.exr";
    bench b;
    shown s;
    io_image image = {0};
    assert_int_equal(io_image_init(&image, WIDTH, HEIGHT, names, 4, NULL), 0);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const float x = (float)(i % WIDTH) / WIDTH;
        image.channels[0].data[i] = 4.0f - 6.0f * fabsf(x - 0.5f);
        for (int c = 0; c < 3; c++)
            image.channels[1 + c].data[i] = colour[c];
    }
    assert_int_equal(io_write(path, &image, NULL, NULL), 0);
    io_image_free(&image);
    b = (bench){.r.logger.fn = quiet, .r.quiet = true};
    b.settings.view = (view_settings){.common.options = options_of(NULL), .model = path};
    b.settings.view.vfov_deg = (arg_number){.given = true, .value = 60.0};
    assert_int_equal(source_open(&b.source, &b.settings, &b.r), EXIT_DONE);
    assert_true(b.source.has_beauty);
    assert_int_equal(
        engine_open(&b.engine, &b.source, NULL, &b.settings.view.common, &b.r),
        EXIT_DONE);
    b.wish = (wish){.width = WIDTH, .height = HEIGHT, .heat_scale = 0.25};
    for (int i = 0; i < HALVES; i++) {
        b.wish.half[i].options = options_of(NULL);
        b.wish.half[i].look = LOOK_LIT;
    }
    b.wish.half[1].content = HALF_OPEN;
    render(&b, &s);
    double darkest = 1.0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++)
        for (int c = 0; c < 3; c++) {
            const float ao = s.half[0].accessibility[i];
            const int shown_byte = s.half[0].pixels[i] >> (16 - 8 * c) & 255;
            const int open_byte = s.half[1].pixels[i] >> (16 - 8 * c) & 255;
            /* The curve is tabulated: one step of 255. */
            assert_true(abs(shown_byte - (int)io_quantise(colour[c] * ao, true, 255))
                        <= 1);
            assert_true(abs(open_byte - (int)io_quantise(colour[c], true, 255)) <= 1);
            darkest = fmin(darkest, (double)ao);
        }
    assert_true(darkest < 0.9);
    char text[COMMAND_SIZE];
    command_text(&b.source, &b.wish, 0, text);
    assert_non_null(strstr(text, "crevice ao test_view_lit.exr --vfov 60"));
    assert_non_null(strstr(text, " --apply View.Combined -o lit.exr"));
    shown_free(&s);
    close_bench(&b);
    remove(path);
}

/* While the camera moves the picture is coarse, with the same framing. */
static void test_moving_is_coarse(void **state)
{
    (void)state;
    bench b;
    shown s;
    open_bench(&b, "builtin:corner");
    b.wish.moving = true;
    render(&b, &s);
    assert_true(s.coarseness > 1);
    assert_int_equal(s.buffers->width, (96 + s.coarseness - 1) / s.coarseness);
    shown_free(&s);
    b.wish.moving = false;
    render(&b, &s);
    assert_int_equal(s.coarseness, 1);
    assert_int_equal(s.buffers->width, 96);
    shown_free(&s);
    close_bench(&b);
}

/* A floor that meets a wall at a right angle: y = 0 and x = 0. From a point of the floor
 * at distance d from the wall, what rises most within R is the wall at distance R: its
 * elevation has the sine sqrt(1 - (d / R)^2). Towards the floor nothing rises. */
static void test_explanation(void **state)
{
    (void)state;
    const double radius = 1.0;
    bench b;
    shown s;
    explanation e;
    open_bench(&b, "builtin:corner");
    b.wish.width = 480;
    b.wish.height = 270;
    /* From above, looking down along the wall. */
    b.wish.view = (scene_view){.eye = {1, 5, 0.5}, .target = {1, 0, 0}, .up = {0, 1, 0}};
    b.wish.view.vfov_rad = 0.5f;
    render(&b, &s);
    /* The target is in the middle, at 240, 135; a scene unit there is this wide: */
    const double px = 135.0 / tan(0.25) / sqrt(25.25);
    for (double d = 0.3; d < 0.9; d += 0.2) {
        const int32_t x = (int32_t)lround(240.0 - (1.0 - d) * px);
        assert_true(explain_pixel(s.buffers, x, 135, radius, &e));
        assert_true(fabs(e.radius_px - px) < 0.02 * px);
        double most = 0.0;
        for (int i = 0; i < EXPLAIN_DIRECTIONS; i++)
            most = fmax(most, e.horizon[i].sine);
        /* A texel is 0.01 of R wide, and the wall is seen at a slant: its steps are 0.05
         * high. */
        assert_true(fabs(most - sqrt(1.0 - d * d)) < 0.05);
        assert_false(e.horizon[0].found); /* to the right: floor */
        assert_true(e.horizon[EXPLAIN_DIRECTIONS / 2].found);
    }
    assert_false(explain_pixel(s.buffers, -1, 0, radius, &e));
    shown_free(&s);
    close_bench(&b);
}

static bool never(void *user)
{
    (void)user;
    return false;
}

/* hbao with D directions and S steps reads no more than D S texels, each within the
 * radius, none of them twice, and more directions read more. On the floor in front of the
 * wall some of them count, and all of those rise over the floor. Far from the wall none
 * counts. */
static void test_samples(void **state)
{
    (void)state;
    bench b;
    shown s;
    samples found;
    crv_context_desc desc;
    crv_context *context = NULL;
    assert_int_equal(crv_context_desc_init(&desc, sizeof desc), CRV_OK);
    desc.threads = desc.exact = 1;
    assert_int_equal(crv_context_create(&desc, &context), CRV_OK);
    open_bench(&b, "builtin:corner");
    b.wish.width = 320;
    b.wish.height = 180;
    b.wish.view = (scene_view){.eye = {1, 5, 0.5}, .target = {1, 0, 0}, .up = {0, 1, 0}};
    b.wish.view.vfov_rad = 0.5f;
    render(&b, &s);
    const double px = 90.0 / tan(0.25) / sqrt(25.25);    /* as in test_explanation */
    const int32_t x = (int32_t)lround(160.0 - 0.8 * px); /* 0.2 from the wall */
    crv_options o = options_of("hbao");
    o.radius = 0.6f;
    o.steps = 5;
    int32_t before = 0;
    for (o.directions = 4; o.directions <= 8; o.directions += 4) {
        assert_true(samples_find(context, s.buffers, &o, x, 90, never, NULL, &found));
        assert_true(found.is_whole);
        assert_true(found.count <= o.directions * o.steps);
        assert_true(found.count >= o.directions * o.steps / 2);
        assert_true(found.count > before);
        before = found.count;
        int32_t counting = 0;
        for (int32_t i = 0; i < found.count; i++) {
            const sample *at = &found.list[i];
            assert_true(hypot(at->x - x, at->y - 90) <= 0.6 * px + 2.0);
            for (int32_t k = 0; k < i; k++)
                assert_true(at->x != found.list[k].x || at->y != found.list[k].y);
            counting += at->counts;
            /* The wall is on the left, where the floor ends at x = 0. */
            if (at->counts)
                assert_true(at->x < 160.0 - (1.0 - 0.1) * px);
        }
        assert_true(counting > 0 && counting < found.count);
    }
    assert_true(samples_find(context, s.buffers, &o, 250, 90, never, NULL, &found));
    for (int32_t i = 0; i < found.count; i++)
        assert_false(found.list[i].counts);
    shown_free(&s);
    /* Every method is explained, as part of a picture. */
    b.wish.explains = true;
    b.wish.explained_x = x;
    b.wish.explained_y = 90;
    for (int32_t i = 0; crv_method_at(i); i++) {
        b.wish.half[0].options = options_of(crv_method_at(i)->name);
        b.wish.half[0].options.radius = 0.3f;
        render(&b, &s);
        assert_true(s.more_follows);
        engine_complete(&b.engine, &s, never, NULL);
        assert_false(s.more_follows);
        assert_non_null(s.samples);
        assert_true(s.samples->count > 0);
        shown_free(&s);
        render(&b, &s);
        assert_false(s.more_follows); /* known already */
        assert_true(s.samples->count > 0);
        shown_free(&s);
    }
    close_bench(&b);
    crv_context_destroy(context);
}

static void test_commands(void **state)
{
    (void)state;
    bench b;
    char text[COMMAND_SIZE];
    open_bench(&b, "builtin:corner");
    wish *w = &b.wish;
    w->view = (scene_view){.eye = {0.5, 1, 4}, .up = {0, 1, 0}};
    w->view.vfov_rad = (float)(40.0 * pi / 180.0);
    command_text(&b.source, w, 0, text);
    assert_string_equal(text, "crevice render builtin:corner --size 96x54 --eye 0.5,1,4 "
                              "--target 0,0,0 --up 0,1,0 --vfov 40 --method bitmask "
                              "--radius 0.3 -o ao.png");
    w->half[1].content = HALF_TRUTH;
    command_text(&b.source, w, 1, text);
    assert_non_null(strstr(text, "crevice reference builtin:corner --size 96x54"));
    assert_non_null(
        strstr(text, "--radius 0.3 --weighting cosine --falloff linear --rays 1024"));
    w->half[1].look = LOOK_DIFFERENCE;
    command_text(&b.source, w, 1, text);
    assert_non_null(strstr(text, "&& crevice compare left.exr right.exr --heat-scale"));
    b.settings.view.model = "it's a model.glb";
    w->half[0].look = LOOK_LIT;
    command_text(&b.source, w, 0, text);
    assert_non_null(strstr(text, "crevice render 'it'\\''s a model.glb' --size"));
    assert_non_null(strstr(text, " --shade lit -o lit.png"));
    close_bench(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_orbit),
        cmocka_unit_test(test_other_motions),
        cmocka_unit_test(test_knobs),
        cmocka_unit_test(test_targets),
        cmocka_unit_test(test_option_text),
        cmocka_unit_test(test_tooltips),
        cmocka_unit_test(test_engine_keeps_nothing_stale),
        cmocka_unit_test(test_engine_makes_what_changed),
        cmocka_unit_test(test_overtaken_runs),
        cmocka_unit_test(test_looks),
        cmocka_unit_test(test_lit_frame),
        cmocka_unit_test(test_moving_is_coarse),
        cmocka_unit_test(test_explanation),
        cmocka_unit_test(test_samples),
        cmocka_unit_test(test_commands),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

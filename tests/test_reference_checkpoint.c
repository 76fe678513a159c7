/* SPDX-License-Identifier: MIT */
/*
 * The same bits for any number of threads and any interruption; checkpoints that are
 * damaged or of something else.
 */
#define _POSIX_C_SOURCE 200809L
#include "reference.h"
#include "system/file.h"
#include "system/new_file.h"
#include "system/process.h"
#include "test_scene_support.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

enum { WIDTH = 40, HEIGHT = 30, PIXELS = WIDTH * HEIGHT };

typedef struct fixture {
    scene *s;
    scene_gbuffer g;
    reference_options options;
    char path[1024];
} fixture;

static fixture open_fixture(reference_kind kind)
{
    fixture f = {0};
    scene_view view;
    assert_int_equal(scene_builtin("sphere", &f.s, NULL), 0);
    scene_frame(f.s, 0.7f, (float)WIDTH / HEIGHT, &view);
    scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    request.guard_px = 3;
    f.g = render(f.s, &request);
    f.options = (reference_options){.weighting = CRV_WEIGHTING_COSINE,
                                    .falloff = CRV_FALLOFF_LINEAR,
                                    .kind = kind,
                                    .tau = 1.0f,
                                    .u = 0.1f,
                                    .radius = 0.8f,
                                    .rays = 200,
                                    .max_error = 0.01f};
    snprintf(f.path, sizeof f.path, "%s", write_text("work.checkpoint", ""));
    return f;
}

static void close_fixture(fixture *f)
{
    scene_gbuffer_free(&f->g);
    scene_free(f->s);
}

static reference *make(const fixture *f)
{
    reference *r = NULL;
    assert_int_equal(reference_create(f->s, &f->g, &f->options, &r, NULL), 0);
    return r;
}

static reference *complete(const fixture *f, int32_t threads)
{
    reference *r = make(f);
    reference_advance(r, INT64_MAX, threads);
    assert_int_equal(reference_total(r), PIXELS);
    assert_int_equal(reference_done(r), PIXELS);
    return r;
}

static void assert_same(const reference *a, const reference *b)
{
    size_t size = PIXELS * sizeof(float);
    assert_memory_equal(reference_accessibility(a), reference_accessibility(b), size);
    assert_memory_equal(reference_error(a), reference_error(b), size);
    assert_memory_equal(reference_bent_normal(a), reference_bent_normal(b), 3 * size);
}

static void test_threads(void **state)
{
    (void)state;
    for (int kind = 0; kind <= 1; kind++) {
        fixture f = open_fixture((reference_kind)kind);
        reference *one = complete(&f, 1);
        for (int32_t threads = 2; threads <= 7; threads += 5) {
            reference *many = complete(&f, threads);
            assert_same(one, many);
            reference_free(many);
        }
        /* Something is occluded and something is not. */
        assert_true(reference_pixel(one, WIDTH / 2, 2 * HEIGHT / 3).rays > 0);
        reference_free(one);
        close_fixture(&f);
    }
}

static void test_resume(void **state)
{
    fixture f = open_fixture(REFERENCE_FULL);
    reference *whole = complete(&f, 0);
    (void)state;
    for (int64_t stop = 0; stop <= PIXELS; stop += PIXELS / 4) {
        reference *first = make(&f), *second = make(&f);
        reference_advance(first, stop, 2);
        assert_int_equal(reference_save(first, f.path, NULL), 0);
        reference_free(first);
        assert_int_equal(reference_load(second, f.path, NULL), 0);
        assert_int_equal(reference_done(second), stop);
        reference_advance(second, 7, 1);
        reference_advance(second, INT64_MAX, 2);
        assert_same(whole, second);
        reference_free(second);
    }
    reference_free(whole);
    close_fixture(&f);
}

static void assert_refused(const fixture *f, const char *phrase)
{
    reference *r = make(f);
    messages m;
    crv_logger log = catch_messages(&m);
    assert_int_equal(reference_load(r, f->path, &log), -1);
    assert_error_line(&m, f->path);
    assert_non_null(strstr(m.error, phrase));
    assert_int_equal(reference_done(r), 0);
    reference_free(r);
}

/* Every option, the view and the scene are part of what a checkpoint belongs to. */
static void test_foreign(void **state)
{
    fixture f = open_fixture(REFERENCE_FULL), other;
    reference *r = make(&f);
    reference_options *o = &other.options;
    (void)state;
    reference_advance(r, 100, 0);
    assert_int_equal(reference_save(r, f.path, NULL), 0);
    for (int change = 0; change < 11; change++) {
        other = f;
        o->radius += change == 0 ? 0.1f : 0.0f;
        o->rays += change == 1;
        o->seed += change == 2;
        o->max_error += change == 3 ? 0.001f : 0.0f;
        o->tau += change == 4 ? 0.5f : 0.0f;
        o->u += change == 5 ? 0.1f : 0.0f;
        o->kind = change == 6 ? REFERENCE_VISIBLE : o->kind;
        o->weighting = change == 7 ? CRV_WEIGHTING_UNIFORM : o->weighting;
        o->falloff = change == 8 ? CRV_FALLOFF_SQRT : o->falloff;
        o->definition = change == 9 ? REFERENCE_TANGENT_SPHERE : o->definition;
        other.g.view.eye[1] += change == 10 ? 0.25 : 0.0;
        assert_refused(&other, "another scene, view or setting");
    }
    other = f;
    assert_int_equal(scene_builtin("groove", &other.s, NULL), 0);
    assert_refused(&other, "another scene, view or setting");
    scene_free(other.s);
    reference_free(r);
    close_fixture(&f);
}

static size_t read_back(const char *path, char *data, size_t size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t count = fread(data, 1, size, file);
    fclose(file);
    return count;
}

static void test_damaged(void **state)
{
    static char data[65536], changed[65536];
    fixture f = open_fixture(REFERENCE_FULL);
    reference *r = make(&f);
    (void)state;
    reference_advance(r, 500, 0);
    assert_int_equal(reference_save(r, f.path, NULL), 0);
    size_t size = read_back(f.path, data, sizeof data);
    assert_true(size > 20 * PIXELS && size < sizeof data);
    for (size_t cut = 0; cut < size; cut += 1 + size / 37) {
        write_file("work.checkpoint", data, cut);
        assert_refused(&f, "damaged");
    }
    for (size_t at = 0; at < size; at += 1 + size / 101) {
        if (at >= 24 && at < 40) /* what tells whose it is, tested above */
            continue;
        memcpy(changed, data, size);
        changed[at] = (char)(changed[at] ^ 0x10);
        write_file("work.checkpoint", changed, size);
        assert_refused(&f, "damaged");
    }
    memcpy(changed, data, size);
    write_file("work.checkpoint", changed, size + 1);
    assert_refused(&f, "damaged");
    write_file("work.checkpoint", data, size);
    assert_int_equal(reference_load(r, f.path, NULL), 0);
    assert_int_equal(remove(f.path), 0);
    assert_refused(&f, "cannot be read");
    reference_free(r);
    close_fixture(&f);
}

static void test_unwritable(void **state)
{
    fixture f = open_fixture(REFERENCE_FULL);
    reference *r = make(&f);
    messages m;
    crv_logger log = catch_messages(&m);
    (void)state;
    assert_int_equal(reference_save(r, "/nowhere/at/all.checkpoint", &log), -1);
    assert_error_line(&m, "/nowhere/at/all.checkpoint");
    reference_free(r);
    close_fixture(&f);
}

typedef struct saving {
    reference *r;
    const char *path;
} saving;

/* The limit on file sizes ends it in the middle of the file. */
static int save_until_killed(void *user)
{
    const saving *s = user;
    const struct rlimit small = {1000, 1000}, no_core = {0, 0};
    signal(SIGXFSZ, SIG_DFL);
    setrlimit(RLIMIT_CORE, &no_core);
    setrlimit(RLIMIT_FSIZE, &small);
    return reference_save(s->r, s->path, NULL);
}

/* What a killed run leaves is found by the next that writes there, whatever it writes. */
static void test_killed(void **state)
{
    fixture f = open_fixture(REFERENCE_FULL);
    reference *r = make(&f);
    saving s = {.r = r, .path = f.path};
    process child;
    process_end end;
    (void)state;
    reference_advance(r, 500, 1);
    assert_int_equal(reference_save(r, f.path, NULL), 0);
    char *folder = file_beside(f.path, ".");
    assert_non_null(folder);
    assert_int_equal(new_file_remove_leftovers(folder), 0);
    assert_true(process_start(&child, false, save_until_killed, &s));
    assert_true(process_wait(child, &end));
    assert_int_equal(end.signal, SIGXFSZ);
    assert_int_equal(reference_load(r, f.path, NULL), 0); /* as it was before */
    assert_int_equal(new_file_remove_leftovers(folder), 1);
    free(folder);
    assert_int_equal(remove(f.path), 0);
    reference_free(r);
    close_fixture(&f);
}

/* Options that make no reference. */
static void test_options(void **state)
{
    fixture f = open_fixture(REFERENCE_FULL);
    (void)state;
    for (int change = 0; change < 9; change++) {
        reference_options o = f.options;
        reference *r = NULL;
        messages m;
        crv_logger log = catch_messages(&m);
        o.radius = change == 0 ? 0.0f : change == 1 ? NAN : change == 2 ? INFINITY : 1.0f;
        o.rays = change == 3 ? 0 : change == 4 ? REFERENCE_MAX_RAYS + 1 : 16;
        o.max_error = change == 5 ? -0.1f : change == 6 ? NAN : 0.0f;
        o.tau = change == 7 ? -1.0f : 1.0f;
        o.u = change == 8 ? 0.0f : 0.1f;
        assert_int_equal(reference_create(f.s, &f.g, &o, &r, &log), -1);
        assert_null(r);
        assert_error_line(&m, "reference");
    }
    close_fixture(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads), cmocka_unit_test(test_resume),
        cmocka_unit_test(test_foreign), cmocka_unit_test(test_damaged),
        cmocka_unit_test(test_killed),  cmocka_unit_test(test_unwritable),
        cmocka_unit_test(test_options)};
    int result = cmocka_run_group_tests(tests, NULL, NULL);
    remove_files(NULL);
    return result;
}

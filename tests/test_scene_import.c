/* SPDX-License-Identifier: MIT */
/*
 * Files on which readers crash, hang or take all memory: each ends as one error line.
 */
#define _POSIX_C_SOURCE 200809L
#include "system/sanitized.h"
#include "test_scene_support.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char triangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n";

static void refuse(const char *path, const scene_limits *limits, const char *cause)
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    assert_int_equal(scene_load_limited(path, limits, &s, &log), -1);
    assert_null(s);
    assert_error_line(&m, path);
    if (!strstr(m.error, cause))
        fail_msg("'%s' does not say '%s'", m.error, cause);
    assert_int_equal(scene_load_limited(path, limits, &s, NULL), -1);
}

static void test_timeout(void **state)
{
    const scene_limits brief = {.timeout_s = 1e-9}, ample = {.timeout_s = 1000.0};
    const char *path = write_text("triangle.obj", triangle);
    scene *s = NULL;
    (void)state;
    refuse(path, &brief, "was not read within 1e-09 s");
    assert_int_equal(scene_load_limited(path, &ample, &s, NULL), 0);
    scene_free(s);
}

static void count_waits(void *user, double seconds)
{
    int *waits = user;
    assert_true(seconds > 0.0);
    ++*waits;
}

/* A material that is a pipe, to which nobody writes. */
static void test_waiting(void **state)
{
    int waits = 0;
    const scene_limits limits = {.timeout_s = 2.5, .waits = count_waits, .user = &waits};
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    char text[300];
    (void)state;
    snprintf(text, sizeof text, "mtllib pipe.mtl\n%s", triangle);
    const char *path = write_text("waits.obj", text);
    char *pipe = malloc(strlen(path) + 1);
    assert_non_null(pipe);
    strcpy(pipe, path);
    strcpy(strrchr(pipe, '/'), "/pipe.mtl");
    assert_int_equal(mkfifo(pipe, 0600), 0);
    assert_int_equal(scene_load_limited(path, &limits, &s, &log), -1);
    assert_error_line(&m, path);
    assert_int_equal(unlink(pipe), 0);
    free(pipe);
    assert_in_range(waits, 2, 3); /* once a second, and perhaps at the end */
}

/* A million lines do not fit 4 MiB more than the process has already. */
static void test_memory(void **state)
{
    /* AddressSanitizer measures the rest of the text anew at every line of it. */
    enum { LINES = SANITIZED ? 1000 : 1000000 };
    const scene_limits little = {.memory_bytes = 4 << 20};
    const size_t size = sizeof "v 0 0 0\n" - 1;
    char *text = malloc(LINES * size + sizeof triangle);
    (void)state;
    assert_non_null(text);
    for (size_t i = 0; i < LINES; i++)
        memcpy(text + i * size, "v 0 0 0\n", size);
    memcpy(text + LINES * size, triangle, sizeof triangle);
    const char *path = write_text("many.obj", text);
    free(text);
    if (!SANITIZED)
        refuse(path, &little, "");
    scene *s = NULL;
    assert_int_equal(scene_load(path, &s, NULL), 0);
    scene_free(s);
}

/* Quake 2's format, with a triangle but without vertices, and counts that are not there:
 * readers of it are known to follow them. */
static void test_reader_that_crashes(void **state)
{
    int32_t md2[64] = {0x32504449, 8, 1, 1, 40, 0, 0, 0, 1, 0, 1, 0, 68, 80, 0, 256};
    (void)state;
    refuse(write_file("none.md2", md2, sizeof md2), NULL, "");
    md2[6] = 1 << 28;
    md2[8] = 1 << 28;
    refuse(write_file("many.md2", md2, sizeof md2), NULL, "");
}

/* An object of colours only: the reader counts a child that it does not make. */
static void test_children_that_are_not_there(void **state)
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    (void)state;
    const char *path = write_text("colours.raw", "first\n1 0 0 0 0 0 1 0 0 0 1 0\n\n"
                                                 "second\n0 1 0 0 0 5 1 0 5 0 1 5\n");
    if (scene_load(path, &s, &log) == 0)
        assert_true(scene_triangle_count(s) >= 1);
    else
        assert_error_line(&m, path);
    scene_free(s);
}

static void test_ply_headers(void **state)
{
    static const char *const headers[] = {
        "ply\n", "ply\nformat ascii 1.0\n", "ply\nformat ascii 1.",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty lend_header\n0 0 0\n",
        "ply\nelement vertex 1\nend_header\n"};
    (void)state;
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++)
        refuse(write_text("header.ply", headers[i]), NULL, "PLY header");
}

/* What a format means and its reader does not give is told. */
static void test_holes_that_are_not_read(void **state)
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    (void)state;
    write_text("leaf.mtl", "newmtl leaf\nKd 0.2 0.5 0.1\nmap_d leaf.png\n");
    const char *path =
        write_text("leaf.obj", "mtllib leaf.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                               "usemtl leaf\nf 1 2 3\n");
    assert_int_equal(scene_load(path, &s, &log), 0);
    assert_int_equal(m.warnings, 1);
    assert_non_null(strstr(m.warning, "opacity textures"));
    scene_free(s);
}

/* A skin in the pose in which its vertices are stored (Valve's SMD) needs no word. */
static void test_skin_at_rest(void **state)
{
    static const char text[] =
        "version 1\nnodes\n0 \"a\" -1\nend\nskeleton\ntime 0\n0 0 0 0 0 0 0\nend\n"
        "triangles\nskin\n0 0 0 0 0 0 1 0 0\n0 1 0 0 0 0 1 1 0\n0 0 1 0 0 0 1 0 1\nend\n";
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    (void)state;
    assert_int_equal(scene_load(write_text("rest.smd", text), &s, &log), 0);
    assert_int_equal(m.warnings, 0);
    scene_free(s);
}

static void ignore_signal(int number)
{
    (void)number;
}

/* A host that handles or blocks signals still gets its model, and its handlers and mask
 * are as before. */
static void test_signals_of_the_host(void **state)
{
    const char *path = write_text("triangle.obj", triangle);
    struct sigaction own = {.sa_handler = ignore_signal}, former, after;
    sigset_t mask, old, now;
    scene *s = NULL;
    (void)state;
    sigemptyset(&own.sa_mask);
    sigemptyset(&mask);
    sigaddset(&mask, SIGTERM);
    sigaction(SIGINT, &own, &former);
    sigprocmask(SIG_BLOCK, &mask, &old);
    assert_int_equal(scene_load(path, &s, NULL), 0);
    sigprocmask(SIG_SETMASK, &old, &now);
    sigaction(SIGINT, &former, &after);
    assert_true(sigismember(&now, SIGTERM) == 1);
    assert_true(after.sa_handler == ignore_signal);
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_timeout),
        cmocka_unit_test(test_waiting),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_reader_that_crashes),
        cmocka_unit_test(test_children_that_are_not_there),
        cmocka_unit_test(test_ply_headers),
        cmocka_unit_test(test_holes_that_are_not_read),
        cmocka_unit_test(test_skin_at_rest),
        cmocka_unit_test(test_signals_of_the_host),
    };
    return cmocka_run_group_tests(tests, NULL, remove_files);
}

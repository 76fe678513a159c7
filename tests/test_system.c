/* SPDX-License-Identifier: MIT */
/* The layer over the operating system: text, files, processes and threads. */
#include <errno.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include "system/clock.h"
#include "system/file.h"
#include "system/monitor.h"
#include "system/process.h"
#include "system/text.h"
#include "test_io_support.h"

static void test_text(void **state)
{
    (void)state;
    assert_true(text_is_same("Depth.Z", "dEPTH.z"));
    assert_false(text_is_same("Depth", "Depth.Z"));
    assert_false(text_is_same("Depth.Z", "Depth"));
    assert_false(text_is_same("[", "{")); /* as far apart as letters and their capitals */
    assert_true(text_is_same_start("Depth.Z", "depth.V", 6));
    assert_false(text_is_same_start("Depth.Z", "depth.V", 7));
    assert_true(text_is_same_start("ao", "AO", 9));
    assert_true(text_ends_with("shot.0001.EXR", ".exr"));
    assert_false(text_ends_with("exr", ".exr"));
    assert_true(text_fits("tree_12", "tree_*"));
    assert_true(text_fits("tree_12", "tree_[0-9]?"));
    assert_false(text_fits("Tree_12", "tree_*"));
    assert_int_equal(text_distance("kitten", "Sitting"), 3); /* Levenshtein's own */
    assert_int_equal(text_distance("", "depth"), 5);
}

static void test_texts_from_outside(void **state)
{
    /* ESC, DEL, U+009B, U+202E, a byte alone, a surrogate; and letters that stay. */
    char text[] =
        "a\033b\177c\302\233d\342\200\256e\377f\355\240\200 \303\244\342\202\254";
    (void)state;
    text_clean(text);
    assert_string_equal(text, "a?b?c?d?e?f??? \303\244\342\202\254");
    assert_int_equal(text_character_length("\342\202\254"), 3);
    assert_int_equal(text_character_length("\300\257"), 0); /* a slash, overlong */
}

static void test_files(void **state)
{
    const char *path = support_path("a"), *pipe = support_path("pipe");
    file_facts facts;
    (void)state;
    support_write_file(path, "0123456789", 10);
    assert_true(file_look(path, &facts));
    assert_true(facts.is_regular && !facts.is_folder);
    assert_int_equal(facts.size, 10);
    char *folder = file_beside(path, ".");
    assert_non_null(folder);
    assert_true(file_look(folder, &facts));
    assert_true(facts.is_folder && !facts.is_regular);
    assert_true(folder_may_be_written(folder));
    assert_false(folder_may_be_written(path));
    free(folder);
    char digits[8] = "";
    FILE *file = file_open(path);
    assert_non_null(file);
    assert_int_equal(file_read_at(file, digits, 3, 4), 3);
    assert_memory_equal(digits, "456", 3);
    assert_int_equal(file_read_at(file, digits, 8, 8), 2);
    assert_int_equal(fclose(file), 0);
    /* Nobody writes to it, and nobody waits. */
    assert_int_equal(mkfifo(pipe, 0600), 0);
    errno = 0;
    assert_null(file_open(pipe));
    assert_int_equal(errno, EINVAL);
    assert_null(file_open(support_path("missing")));
    assert_int_equal(errno, ENOENT);
    assert_false(file_exists(support_path("missing")));
    char *beside = file_beside("/a/b/c.exr", "d"), *absolute = file_beside("a/b", "/d");
    assert_string_equal(beside, "/a/b/d");
    assert_string_equal(absolute, "/d");
    free(beside);
    free(absolute);
}

static int greet(void *user)
{
    const pipe_ends *ends = user;
    pipe_close(ends->from);
    return pipe_write(ends->to, "hello", 5) ? 7 : 8;
}

static int wait_for_ever(void *user)
{
    (void)user;
    pause();
    return 0;
}

static void test_processes(void **state)
{
    pipe_ends ends;
    process child;
    process_end end;
    char text[8] = "";
    (void)state;
    assert_true(pipe_open(&ends));
    assert_int_equal(pipe_wait(ends.from, 0.01), 0);
    assert_true(process_start(&child, false, greet, &ends));
    pipe_close(ends.to);
    assert_int_equal(pipe_wait(ends.from, 60.0), 1);
    assert_int_equal(pipe_read(ends.from, text, sizeof text), 5);
    assert_string_equal(text, "hello");
    assert_int_equal(pipe_read(ends.from, text, sizeof text), 0);
    pipe_close(ends.from);
    assert_true(process_wait(child, &end));
    assert_int_equal(end.code, 7);
    assert_int_equal(end.signal, 0);
    assert_true(process_start(&child, false, wait_for_ever, NULL));
    process_kill(child);
    assert_true(process_wait(child, &end));
    assert_int_equal(end.signal, SIGKILL);
    assert_true(end.was_killed);
    assert_false(process_wait(child, &end)); /* it is gone */
}

typedef struct counter {
    monitor *m;
    int count;
    bool go;
} counter;

static void count_when_told(void *user)
{
    counter *c = user;
    monitor_enter(c->m);
    while (!c->go)
        monitor_wait(c->m);
    c->count++;
    monitor_leave(c->m);
}

static void test_threads(void **state)
{
    counter c = {.m = monitor_create()};
    (void)state;
    assert_non_null(c.m);
    assert_true(monitor_start(c.m, count_when_told, &c));
    monitor_enter(c.m);
    assert_int_equal(c.count, 0);
    c.go = true;
    monitor_wake(c.m);
    monitor_leave(c.m);
    monitor_join(c.m);
    assert_int_equal(c.count, 1);
    /* Nobody wakes this one. */
    const double start = clock_seconds();
    monitor_enter(c.m);
    while (clock_seconds() - start < 0.05)
        monitor_wait_for(c.m, 0.05);
    monitor_leave(c.m);
    monitor_free(c.m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_text),    cmocka_unit_test(test_texts_from_outside),
        cmocka_unit_test(test_files),   cmocka_unit_test(test_processes),
        cmocka_unit_test(test_threads),
    };
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}

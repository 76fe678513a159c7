/* SPDX-License-Identifier: MIT */
/* The threads of a build without OpenMP. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/parallel.h"

enum { COUNT = 5000 };

typedef struct tally {
    atomic_int done[COUNT];
    atomic_int at_once;
} tally;

static void count_task(void *data, uint32_t index)
{
    tally *t = data;
    atomic_fetch_add(&t->done[index], 1);
}

/* Two tasks that wait for each other end only if two threads run them. */
static void meet(void *data, uint32_t index)
{
    tally *t = data;
    atomic_fetch_add(&t->at_once, 1);
    while (atomic_load(&t->at_once) < 2)
        ;
    atomic_fetch_add(&t->done[index], 1);
}

static void every_task_runs_once(void **state)
{
    (void)state;
    static const int32_t THREADS[] = {0, 1, 2, 7, 1024};
    const crv_parallel none = {.run = NULL};
    for (int i = 0; i < 5; i++) {
        static tally t;
        for (uint32_t count = 0; count <= COUNT; count = count ? COUNT + 1 : 1) {
            for (int k = 0; k < COUNT; k++)
                atomic_store(&t.done[k], 0);
            crv__parallel_for(&none, THREADS[i], NULL, count, count_task, &t);
            for (uint32_t k = 0; k < COUNT; k++)
                assert_int_equal(atomic_load(&t.done[k]), k < count);
        }
        crv__parallel_for(&none, THREADS[i], NULL, COUNT, count_task, &t);
        for (int k = 0; k < COUNT; k++)
            assert_int_equal(atomic_load(&t.done[k]), k < 1 ? 2 : 1);
    }
}

static void tasks_run_at_once(void **state)
{
    (void)state;
    static tally t;
    const crv_parallel none = {.run = NULL};
    assert_false(crv__parallel_is_openmp());
    crv__parallel_for(&none, 2, NULL, 2, meet, &t);
    assert_int_equal(atomic_load(&t.done[0]) + atomic_load(&t.done[1]), 2);
}

static int32_t end_at_ten(void *user, int32_t done, int32_t total)
{
    int32_t *last = user;
    assert_true(done > *last && done < total);
    *last = done;
    return done >= 10;
}

/* The rest is left out: at most the other threads' tasks of that moment are done. */
static void the_caller_ends_a_loop(void **state)
{
    (void)state;
    static tally t;
    const crv_parallel none = {.run = NULL};
    int32_t last = 0, done = 0;
    const crv_progress progress = {.fn = end_at_ten, .user = &last};
    assert_false(crv__parallel_for(&none, 1, &progress, COUNT, count_task, &t));
    assert_int_equal(last, 10);
    for (int k = 0; k < COUNT; k++)
        done += atomic_load(&t.done[k]);
    assert_int_equal(done, 10);
    last = 0;
    assert_true(crv__parallel_for(&none, 1, &progress, 10, count_task, &t));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_task_runs_once),
        cmocka_unit_test(tasks_run_at_once),
        cmocka_unit_test(the_caller_ends_a_loop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

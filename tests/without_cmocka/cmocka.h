/* SPDX-License-Identifier: MIT */
/* What the tests of the library use of cmocka, for targets that it is not packaged for.
 * The first failure ends the program. */
#ifndef TESTS_WITHOUT_CMOCKA_H
#define TESTS_WITHOUT_CMOCKA_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct CMUnitTest {
    const char *name;
    void (*run)(void **state);
};

#define cmocka_unit_test(function)                                                       \
    {                                                                                    \
        .name = #function, .run = (function)                                             \
    }

#define cmocka_run_group_tests(tests, setup, teardown)                                   \
    ((void)(setup), (void)(teardown),                                                    \
     standin_run((tests), sizeof(tests) / sizeof(tests)[0]))

static inline int standin_run(const struct CMUnitTest *tests, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        void *state = NULL;
        printf("[ RUN      ] %s\n", tests[i].name);
        fflush(stdout); /* a crash should not hide where it was */
        tests[i].run(&state);
        printf("[       OK ] %s\n", tests[i].name);
    }
    return 0;
}

#define fail_msg(...)                                                                    \
    (printf("%s:%d: ", __FILE__, __LINE__), printf(__VA_ARGS__), printf("\n"), exit(1))

#define assert_true(c)         ((c) ? (void)0 : fail_msg("%s", #c))
#define assert_false(c)        assert_true(!(c))
#define assert_non_null(p)     assert_true(p)
#define assert_null(p)         assert_true(!(p))
#define assert_ptr_equal(a, b) assert_true((const void *)(a) == (const void *)(b))
#define assert_int_equal(a, b)                                                           \
    standin_int_equal((long long)(a), (long long)(b), #a " == " #b, __FILE__, __LINE__)
#define assert_float_equal(a, b, epsilon)                                                \
    assert_true(fabs((double)(a) - (double)(b)) <= (double)(epsilon))
#define assert_string_equal(a, b)           assert_true(strcmp((a), (b)) == 0)
#define assert_memory_equal(a, b, size)     assert_true(memcmp((a), (b), (size)) == 0)
#define assert_memory_not_equal(a, b, size) assert_true(memcmp((a), (b), (size)) != 0)

static inline void standin_int_equal(long long a, long long b, const char *what,
                                     const char *file, int line)
{
    if (a == b)
        return;
    printf("%s:%d: %s: %lld and %lld\n", file, line, what, a, b);
    exit(1);
}

#endif

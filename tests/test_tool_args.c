/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "common/args.h"
#include "common/frames.h"
#include "common/nearest.h"

typedef struct settings {
    common_settings common;
    const char *input, *output;
    arg_int count, kind;
    arg_number angle;
    arg_vector point;
    arg_size size;
} settings;

static const char *const kinds[] = {"first", "second", NULL};

static const arg rows[] = {
    {.name = "IN",
     .type = ARG_TEXT,
     .required = true,
     .offset = offsetof(settings, input)},
    {.name = "--output",
     .short_name = 'o',
     .value = "FILE",
     .type = ARG_TEXT,
     .required = true,
     .offset = offsetof(settings, output)},
    {.name = "--count",
     .value = "N",
     .type = ARG_INT,
     .min = -2,
     .max = 9,
     .initial = "3",
     .offset = offsetof(settings, count)},
    {.name = "--angle",
     .value = "X",
     .type = ARG_NUMBER,
     .min = 0.5,
     .max = INFINITY,
     .offset = offsetof(settings, angle)},
    {.name = "--point",
     .value = "X,Y,Z",
     .type = ARG_VECTOR,
     .offset = offsetof(settings, point)},
    {.name = "--size",
     .value = "WxH",
     .type = ARG_SIZE,
     .initial = "4x3",
     .offset = offsetof(settings, size)},
    {.name = "--kind",
     .value = "KIND",
     .type = ARG_CHOICE,
     .choices = kinds,
     .initial = "second",
     .offset = offsetof(settings, kind)},
};
static const arg_table table = ARG_TABLE("All", rows);
static const arg_table *const tables[] = {&table, &args_threads, &args_output_lines,
                                          NULL};
static const command test_command = {.name = "test",
                                     .tables = tables,
                                     .library_options = true,
                                     .method_flag = "--kind",
                                     .method_of_flag = "vao"};

#define PARSE(s, ...) parse((s), (const char *[]){__VA_ARGS__, NULL})

static int parse(settings *s, const char *const *words)
{
    char *argv[16];
    int argc = 0;
    report r;

    report_init(&r);
    r.logger.fn = NULL; /* the library's lines; the tool's own go to stderr */
    *s = (settings){0};
    for (; words[argc] != NULL; argc++)
        argv[argc] = (char *)(uintptr_t)words[argc];
    return args_parse(&test_command, argc, argv, s, &r);
}

static void test_defaults(void **state)
{
    settings s;

    (void)state;
    assert_int_equal(PARSE(&s, "in", "-o", "out"), EXIT_DONE);
    assert_string_equal(s.input, "in");
    assert_string_equal(s.output, "out");
    assert_int_equal(s.count.value, 3);
    assert_false(s.count.given);
    assert_false(s.angle.given);
    assert_int_equal(s.size.width, 4);
    assert_int_equal(s.size.height, 3);
    assert_int_equal(s.kind.value, 1);
    assert_false(s.common.radius_given);
    assert_string_equal(s.common.options.method->name, "bitmask");
}

static void test_values(void **state)
{
    settings s;

    (void)state;
    assert_int_equal(PARSE(&s, "--count=-2", "--point", "-8.5,1.25,-3e2", "in", "--angle",
                           "inf", "--output=o", "--kind", "first", "--size", "32768X1"),
                     EXIT_DONE);
    assert_true(s.count.given);
    assert_int_equal(s.count.value, -2);
    assert_true(s.point.value[0] == -8.5f && s.point.value[1] == 1.25f
                && s.point.value[2] == -300.0f);
    assert_true(isinf(s.angle.value));
    assert_int_equal(s.kind.value, 0);
    assert_int_equal(s.size.width, 32768);
}

static void test_library_options(void **state)
{
    settings s;

    (void)state;
    assert_int_equal(PARSE(&s, "in", "-o", "out", "--radius", "0.5", "--filter", "none",
                           "--max-radius-px=64", "-q", "--method", "hbao"),
                     EXIT_DONE);
    assert_true(s.common.radius_given && s.common.quiet);
    assert_true(s.common.options.radius == 0.5f);
    assert_true(s.common.options.max_radius_px == 64.0f);
    assert_null(s.common.options.filter);
}

/* Method, preset, single options, whatever their order. */
static void test_presets(void **state)
{
    crv_options expected;
    settings s;

    (void)state;
    assert_int_equal(crv_options_init(&expected, sizeof expected, "hsao"), CRV_OK);
    assert_int_equal(crv_options_preset(&expected, CRV_PRESET_ULTRA), CRV_OK);
    assert_int_equal(PARSE(&s, "--steps", "3", "--preset", "ultra", "in", "-o", "out",
                           "--method=hsao"),
                     EXIT_DONE);
    assert_string_equal(s.common.options.method->name, "hsao");
    assert_int_equal(s.common.options.steps, 3);
    assert_int_not_equal(expected.steps, 3);
    assert_int_equal(s.common.options.directions, expected.directions);
    assert_int_equal(s.common.options.normal_rays, expected.normal_rays);
    /* The last one counts, and only that. */
    assert_int_equal(PARSE(&s, "--preset=ultra", "--preset=medium", "in", "-o", "out"),
                     EXIT_DONE);
    assert_int_equal(crv_options_init(&expected, sizeof expected, "bitmask"), CRV_OK);
    assert_int_equal(s.common.options.directions, expected.directions);
}

static void test_a_flag_brings_its_method(void **state)
{
    settings s;

    (void)state;
    assert_int_equal(PARSE(&s, "in", "-o", "out", "--kind", "first"), EXIT_DONE);
    assert_string_equal(s.common.options.method->name, "vao");
    assert_int_equal(PARSE(&s, "in", "-o", "out", "--kind", "first", "--method", "ssao"),
                     EXIT_DONE);
    assert_string_equal(s.common.options.method->name, "ssao");
    assert_int_equal(PARSE(&s, "-o", "out", "--", "--kind"), EXIT_DONE);
    assert_string_equal(s.common.options.method->name, "bitmask");
}

static void test_after_two_dashes_all_is_a_name(void **state)
{
    settings s;

    (void)state;
    assert_int_equal(PARSE(&s, "-o", "out", "--", "--count"), EXIT_DONE);
    assert_string_equal(s.input, "--count");
}

static void test_wrong_usage(void **state)
{
    static const char *const pairs[][2] = {
        {"--count", "10"},
        {"--count", "2.5"},
        {"--count", "3x"},
        {"--count", ""},
        {"--count", " 3"},
        {"--count", "nan"},
        {"--angle", "0.4"},
        {"--angle", "nan"},
        {"--angle", "1,"},
        {"--point", "1,2"},
        {"--point", "1,2,3,4"},
        {"--point", "1,,3"},
        {"--point", "1,2,inf"},
        {"--point", "1,2,nan"},
        {"--size", "0x0"},
        {"--size", "1x0"},
        {"--size", "32769x1"},
        {"--size", "100000x100000"},
        {"--size", "-4x3"},
        {"--size", "4x3x2"},
        {"--size", "4"},
        {"--size", "4x3 "},
        {"--size", "99999999999999999999x1"},
        {"--kind", "third"},
        {"--radius", "0"},
        {"--radius", "-1"},
        {"--radius", "nan"},
        {"--radius", "1e30"},
        {"--radius", "12abc"},
        {"--method", "hbaoo"},
        {"--filter", "blur"},
        {"--preset", "hihg"},
        {"--preset", ""},
        {"--preset", "-1"},
        {"--threads", "1025"},
        {"--none", "such"},
        {"-x", "1"},
        {"--quiet=1", "--quiet"},
        {"--count", "--quiet"},
        {"extra", "--quiet"},
        {"--quiet", "-"},
    };
    settings s;

    (void)state;
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++)
        if (PARSE(&s, "in", "-o", "out", pairs[i][0], pairs[i][1]) != EXIT_USAGE)
            fail_msg("taken: %s %s", pairs[i][0], pairs[i][1]);
    assert_int_equal(PARSE(&s, "in"), EXIT_USAGE);
    assert_int_equal(PARSE(&s, "-o", "out"), EXIT_USAGE);
    assert_int_equal(PARSE(&s, "in", "-o"), EXIT_USAGE);
    assert_int_equal(PARSE(&s, "", "-o", "out"), EXIT_USAGE);
}

typedef struct list_settings {
    common_settings common;
    const char *first;
    arg_texts files, only;
} list_settings;

static const arg list_rows[] = {
    {.name = "FIRST", .type = ARG_TEXT, .offset = offsetof(list_settings, first)},
    {.name = "FILE",
     .type = ARG_TEXTS,
     .required = true,
     .offset = offsetof(list_settings, files)},
    {.name = "--only", .type = ARG_TEXTS, .offset = offsetof(list_settings, only)},
};
static const arg_table list_table = ARG_TABLE("All", list_rows);
static const arg_table *const list_tables[] = {&list_table, NULL};
static const command list_command = {.name = "list", .tables = list_tables};

static void test_texts_may_be_given_again(void **state)
{
    char first[] = "first", a[] = "a", b[] = "b", c[] = "c", flag[] = "--only",
         empty[] = "";
    char *words[] = {first, a, flag, b, c, flag, a};
    list_settings s = {0};
    report r;

    (void)state;
    report_init(&r);
    assert_int_equal(args_parse(&list_command, 7, words, &s, &r), EXIT_DONE);
    assert_string_equal(s.first, "first");
    assert_int_equal(s.files.count, 2);
    assert_string_equal(s.files.value[0], "a");
    assert_string_equal(s.files.value[1], "c");
    assert_int_equal(s.only.count, 2);
    assert_string_equal(s.only.value[0], "b");
    assert_string_equal(s.only.value[1], "a");

    s = (list_settings){0};
    assert_int_equal(args_parse(&list_command, 1, words, &s, &r), EXIT_USAGE);
    assert_int_equal(r.errors, 1); /* FILE is missing */
    words[1] = empty;
    s = (list_settings){0};
    assert_int_equal(args_parse(&list_command, 2, words, &s, &r), EXIT_USAGE);
    assert_int_equal(r.errors, 2);
}

static void test_texts_have_a_limit(void **state)
{
    char first[] = "first", file[] = "file";
    char *words[ARG_TEXTS_MAX + 2];
    list_settings s = {0};
    report r;

    (void)state;
    report_init(&r);
    words[0] = first;
    for (int i = 1; i < ARG_TEXTS_MAX + 2; i++)
        words[i] = file;
    assert_int_equal(args_parse(&list_command, ARG_TEXTS_MAX + 1, words, &s, &r),
                     EXIT_DONE);
    assert_int_equal(s.files.count, ARG_TEXTS_MAX);
    s = (list_settings){0};
    assert_int_equal(args_parse(&list_command, ARG_TEXTS_MAX + 2, words, &s, &r),
                     EXIT_USAGE);
    assert_int_equal(r.errors, 1);
}

static void test_frame_ranges(void **state)
{
    static const char *const wrong[] = {"",     "a",      "1-",    "--3", "5-1", "1-9x0",
                                        "1-9x", "1-9x2y", "1 - 2", "1,",  ",1",  "1x2"};
    frame_list list;

    (void)state;
    assert_true(frames_parse("1-240x2", &list));
    assert_int_equal(frames_count(&list), 120);
    assert_int_equal(frames_at(&list, 0), 1);
    assert_int_equal(frames_at(&list, 119), 239);
    assert_true(frames_parse("007", &list));
    assert_int_equal(frames_count(&list), 1);
    assert_int_equal(frames_at(&list, 0), 7);
    assert_true(frames_parse("1,3,10-20x2,-5--3", &list));
    static const int32_t expected[] = {1, 3, 10, 12, 14, 16, 18, 20, -5, -4, -3};
    assert_int_equal(frames_count(&list), 11);
    for (int32_t i = 0; i < 11; i++)
        assert_int_equal(frames_at(&list, i), expected[i]);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        if (frames_parse(wrong[i], &list))
            fail_msg("taken: %s", wrong[i]);
}

static void test_frame_names(void **state)
{
    char name[32];

    (void)state;
    assert_int_equal(frames_places("a/shot.####.exr"), 1);
    assert_int_equal(frames_places("shot.%04d.%d"), 2);
    assert_int_equal(frames_places("100%.exr"), 0);
    assert_true(frames_name("s h.####.exr", 12, name, sizeof name));
    assert_string_equal(name, "s h.0012.exr");
    assert_true(frames_name("s%03d", 12345, name, sizeof name));
    assert_string_equal(name, "s12345");
    assert_true(frames_name("%d#", 5, name, sizeof name));
    assert_string_equal(name, "55");
    assert_true(frames_name("%s%n.#", 5, name, sizeof name));
    assert_string_equal(name, "%s%n.5");
    assert_true(frames_name("s.@@@@.exr", 7, name, sizeof name));
    assert_string_equal(name, "s.0007.exr");
    assert_true(frames_name("s.$F4.exr", 7, name, sizeof name));
    assert_string_equal(name, "s.0007.exr");
    assert_true(frames_name("s.$F.exr", 7, name, sizeof name));
    assert_string_equal(name, "s.7.exr");
    assert_true(frames_name("s.<frame>.exr", 12, name, sizeof name));
    assert_string_equal(name, "s.12.exr");
    assert_true(frames_name("s.####.exr", -7, name, sizeof name));
    assert_string_equal(name, "s.-007.exr");
    assert_false(frames_name("shot.####.exr", 1, name, 13));
    assert_true(frames_name("shot.####.exr", 1, name, 14));
}

static void misspellings_find_the_nearest_name(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"radius", "directions", "steps", NULL};
    assert_string_equal(nearest_name("raduis", NAMES, -1), "radius");
    assert_string_equal(nearest_name("DIRECTION", NAMES, 3), "directions");
    assert_string_equal(nearest_name("step", NAMES, 3), "steps");
    assert_null(nearest_name("step", NAMES, 2));
    assert_null(nearest_name("banana", NAMES, -1));
    assert_null(nearest_name(NULL, NAMES, -1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(misspellings_find_the_nearest_name),
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_library_options),
        cmocka_unit_test(test_presets),
        cmocka_unit_test(test_a_flag_brings_its_method),
        cmocka_unit_test(test_after_two_dashes_all_is_a_name),
        cmocka_unit_test(test_wrong_usage),
        cmocka_unit_test(test_texts_may_be_given_again),
        cmocka_unit_test(test_texts_have_a_limit),
        cmocka_unit_test(test_frame_ranges),
        cmocka_unit_test(test_frame_names),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}

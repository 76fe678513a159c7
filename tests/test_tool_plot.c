/* SPDX-License-Identifier: MIT */
/* The Pareto front, the ticks of axes, and text as HTML: expected values by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "study/plot.h"
#include "study/plot_axis.h"
#include "common/text.h"

static void check_front(const double *x, const double *y, int32_t count,
                        const char *expected)
{
    bool on_front[16];

    plot_pareto(x, y, count, on_front);
    for (int32_t i = 0; i < count; i++)
        if (on_front[i] != (expected[i] == '+'))
            fail_msg("point %d (%g, %g): on the front: %d", i, x[i], y[i], on_front[i]);
}

static void front_has_what_nothing_beats(void **state)
{
    (void)state;
    /* A staircase, a point above it, one that only ties in x, one that only ties in y. */
    check_front((const double[]){1, 2, 4, 3, 2, 5}, (const double[]){9, 5, 1, 6, 7, 1}, 6,
                "+++---");
}

static void equal_points_are_both_on_it(void **state)
{
    (void)state;
    check_front((const double[]){2, 2, 3}, (const double[]){1, 1, 1}, 3, "++-");
    check_front((const double[]){7}, (const double[]){7}, 1, "+");
}

static void points_that_are_none_do_not_count(void **state)
{
    (void)state;
    check_front((const double[]){NAN, 1, -INFINITY, 2},
                (const double[]){0, 5, 0, INFINITY}, 4, "-+--");
}

static void check_ends(double low, double high, bool is_log, bool zero, double from,
                       double to)
{
    plot_axis a = plot_axis_make(low, high, is_log, zero);

    assert_true(fabs(a.low - from) <= 1e-9 * fabs(to));
    assert_true(fabs(a.high - to) <= 1e-9 * fabs(to));
    assert_true(a.tick_count >= 2 && a.tick_count <= PLOT_MAX_TICKS);
    assert_true(fabs(a.ticks[0].value - from) <= 1e-9 * fabs(to));
    assert_true(fabs(a.ticks[a.tick_count - 1].value - to) <= 1e-9 * fabs(to));
    assert_true(fabs(plot_axis_place(&a, a.low)) < 1e-9);
    assert_true(fabs(plot_axis_place(&a, a.high) - 1.0) < 1e-9);
}

static void axes_end_at_round_numbers(void **state)
{
    (void)state;
    check_ends(0.13, 0.94, false, true, 0.0, 1.0);
    check_ends(13.0, 28.0, false, false, 10.0, 30.0); /* 2 would make more than six */
    check_ends(3.2, 870.0, true, false, 3.0, 900.0);
    check_ends(0.001, 1000.0, true, false, 0.001, 1000.0);
}

static void axes_without_extent_get_some(void **state)
{
    plot_axis a = plot_axis_make(5.0, 5.0, false, false);
    plot_axis b = plot_axis_make(5.0, 5.0, true, false);
    plot_axis c = plot_axis_make(0.0, 0.0, false, true);

    (void)state;
    assert_true(a.low < 5.0 && a.high > 5.0);
    assert_true(b.low < 5.0 && b.low > 0.0 && b.high > 5.0);
    assert_true(c.low <= 0.0 && c.high > 0.0);
}

static void logarithms_place_decades_evenly(void **state)
{
    plot_axis a = plot_axis_make(1.0, 10000.0, true, false);

    (void)state;
    assert_true(fabs(plot_axis_place(&a, 100.0) - 0.5) < 1e-12);
    assert_true(fabs(plot_axis_place(&a, 10.0) - 0.25) < 1e-12);
}

static void check_label(double value, const char *expected)
{
    char label[32];

    plot_axis_label(value, label, sizeof label);
    assert_string_equal(label, expected);
}

static void labels_are_short(void **state)
{
    (void)state;
    check_label(0.1 + 0.2, "0.3");
    check_label(1e-5, "1e-5");
    check_label(2e7, "2e7");
    check_label(1e-17, "0");
    check_label(-250.0, "-250");
}

static void check_escaped(const char *words, const char *expected)
{
    text t = {0};

    text_add_escaped(&t, words);
    assert_false(t.failed);
    assert_string_equal(t.data, expected);
    text_free(&t);
}

static void markup_becomes_text(void **state)
{
    (void)state;
    check_escaped("<b a=\"1\">x & 'y'</b>",
                  "&lt;b a=&quot;1&quot;&gt;x &amp; &#39;y&#39;&lt;/b&gt;");
    check_escaped("&amp;", "&amp;amp;");
}

/* U+FFFD is EF BF BD. */
static void what_is_not_utf8_is_replaced(void **state)
{
    (void)state;
    check_escaped("\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80", /* e acute, euro, a smiley */
                  "\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80");
    check_escaped("a\xff"
                  "b",
                  "a\xef\xbf\xbd"
                  "b");
    check_escaped("\xc3", "\xef\xbf\xbd");                 /* cut short */
    check_escaped("\xc0\xaf", "\xef\xbf\xbd\xef\xbf\xbd"); /* an overlong slash */
    check_escaped("\xed\xa0\x80", "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"); /* surrogate */
    check_escaped("\x01\t\n", "\xef\xbf\xbd\t\n");
}

static void text_grows(void **state)
{
    text t = {0};

    (void)state;
    for (int i = 0; i < 1000; i++)
        text_addf(&t, "%03d", i);
    assert_int_equal(t.length, 3000);
    assert_int_equal(strlen(t.data), 3000);
    assert_memory_equal(t.data + 3 * 256, "256257", 6);
    text_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(front_has_what_nothing_beats),
        cmocka_unit_test(equal_points_are_both_on_it),
        cmocka_unit_test(points_that_are_none_do_not_count),
        cmocka_unit_test(axes_end_at_round_numbers),
        cmocka_unit_test(axes_without_extent_get_some),
        cmocka_unit_test(logarithms_place_decades_evenly),
        cmocka_unit_test(labels_are_short),
        cmocka_unit_test(markup_becomes_text),
        cmocka_unit_test(what_is_not_utf8_is_replaced),
        cmocka_unit_test(text_grows),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}

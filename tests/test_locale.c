/* SPDX-License-Identifier: MIT */
/* Options read and print numbers alike, whatever locale the host has set. Skipped without
 * a locale that has a decimal comma and without localedef to make one. */
#define _POSIX_C_SOURCE 200809L
#include "fixture.h"

#include <locale.h>
#include <stdio.h>
#include <string.h>

static void keep_line(void *user, crv_log_level level, const char *line)
{
    (void)level;
    snprintf(user, 512, "%s", line);
}

static bool has_comma(const char *locale)
{
    char text[8];
    if (!setlocale(LC_ALL, locale))
        return false;
    snprintf(text, sizeof text, "%.1f", 0.5);
    return strcmp(text, "0,5") == 0;
}

static bool set_comma_locale(void)
{
    if (has_comma("de_DE.UTF-8"))
        return true;
    if (system("localedef -i de_DE -f UTF-8 ./de_DE.UTF-8 2>/dev/null") != 0)
        return false;
    return setenv("LOCPATH", ".", 1) == 0 && has_comma("de_DE.UTF-8");
}

static void a_decimal_comma_changes_nothing(void **state)
{
    (void)state;
    if (!set_comma_locale())
        skip();
    crv_options options;
    char line[512] = "";
    const crv_logger logger = {keep_line, line};
    for (int32_t m = 0; m < crv_method_count(); m++) {
        assert_int_equal(
            crv_options_init(&options, sizeof options, crv_method_at(m)->name), CRV_OK);
        for (int p = 0; p < CRV_PRESET_COUNT; p++)
            assert_int_equal(crv_options_preset(&options, (crv_preset)p), CRV_OK);
    }
    assert_int_equal(crv_options_set(&options, "radius", "0.5", &logger), CRV_OK);
    assert_true(options.radius == 0.5f);
    assert_int_equal(crv_options_set(&options, "radius", " 1e-1 ", &logger), CRV_OK);
    assert_true(options.radius == 0.1f);
    assert_int_equal(crv_options_set(&options, "radius", "0,5", &logger),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_options_set(&options, "u", "1.5", &logger),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(line, "1.5 is out of range; it is from 0.001 to 1"));
    assert_true(has_comma(NULL)); /* the host's locale is as it was */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_decimal_comma_changes_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/* The option table, the registries, options from text. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct recorder {
    int32_t errors, warnings;
    char last[512];
} recorder;

static void record(void *user, crv_log_level level, const char *line)
{
    recorder *r = user;
    r->errors += level == CRV_LOG_ERROR;
    r->warnings += level == CRV_LOG_WARNING;
    snprintf(r->last, sizeof r->last, "%s", line);
    assert_null(strchr(line, '\n'));
}

static crv_status set(crv_options *o, const char *key, const char *value, recorder *r)
{
    *r = (recorder){0};
    const crv_logger logger = {record, r};
    crv_options before = *o;
    crv_status status = crv_options_set(o, key, value, &logger);
    assert_int_equal(r->errors, status != CRV_OK);
    if (status)
        assert_memory_equal(&before, o, sizeof before);
    return status;
}

static void registries_are_sound(void **state)
{
    (void)state;
    assert_null(crv_method_at(-1));
    assert_null(crv_method_at(crv_method_count()));
    assert_null(crv_filter_at(crv_filter_count()));
    assert_null(crv_method_find(NULL));
    assert_non_null(crv_method_find("hbao"));
    for (int32_t i = 0; i < crv_method_count(); i++) {
        const crv_method *m = crv_method_at(i);
        assert_ptr_equal(crv_method_find(m->name), m);
        assert_true(strlen(m->title) > 0 && strlen(m->paper) > 0);
        for (int k = 0; m->options[k]; k++)
            assert_non_null(crv_option_find(m->options[k]));
    }
    for (int32_t i = 0; i < crv_filter_count(); i++) {
        const crv_filter *f = crv_filter_at(i);
        assert_ptr_equal(crv_filter_find(f->name), f);
        for (int k = 0; f->options[k]; k++)
            assert_non_null(crv_option_find(f->options[k]));
    }
}

static void every_option_is_used_and_in_range(void **state)
{
    (void)state;
    crv_options o = fixture_options("hbao"); /* its preset changes none */
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        assert_true(option->min <= option->default_value
                    && option->default_value <= option->max);
        assert_true(strlen(option->help) > 0);
        assert_true(fabs(crv_options_get(&o, option) - option->default_value) < 1e-6);
        int used = 0;
        for (int32_t m = 0; m < crv_method_count(); m++) {
            for (int32_t f = -1; f < crv_filter_count(); f++)
                used |= crv_option_applies(option, crv_method_at(m), crv_filter_at(f));
        }
        if (!used)
            fail_msg("%s is read by no method and no filter", option->key);
    }
}

static void text_sets_values(void **state)
{
    (void)state;
    crv_options o = fixture_options(NULL);
    recorder r;
    assert_int_equal(set(&o, "radius", "2.5e-1", &r), CRV_OK);
    assert_true(o.radius == 0.25f);
    assert_int_equal(set(&o, "max-radius-px", "64", &r), CRV_OK);
    assert_true(o.max_radius_px == 64);
    assert_int_equal(set(&o, "directions", "12", &r), CRV_OK);
    assert_int_equal(o.directions, 12);
    assert_int_equal(set(&o, "falloff", "cubic", &r), CRV_OK);
    assert_int_equal(o.falloff, CRV_FALLOFF_CUBIC);
    assert_int_equal(set(&o, "filter_slope", "off", &r), CRV_OK);
    assert_int_equal(o.filter_slope, 0);
    assert_int_equal(set(&o, "filter", "none", &r), CRV_OK);
    assert_null(o.filter);
    assert_int_equal(set(&o, "filter", "box4", &r), CRV_OK);
    assert_string_equal(o.filter->name, "box4");
    assert_int_equal(set(&o, "method", "hbao", &r), CRV_OK);
    assert_true(isnan(crv_options_get(NULL, crv_option_at(0))));
}

static void bad_text_is_refused_with_a_reason(void **state)
{
    (void)state;
    static const struct {
        const char *key, *value, *reason;
    } CASES[] = {
        {"radius", "0", "range"},          {"radius", "-1", "range"},
        {"radius", "nan", "number"},       {"radius", "1e30", "range"},
        {"radius", "inf", "range"},        {"radius", "12abc", "number"},
        {"radius", "", "number"},          {"directions", "2.5", "whole"},
        {"directions", "0", "range"},      {"directions", "99999999999", "range"},
        {"falloff", "quadratic", "there"}, {"falloff", "liner", "'linear'"},
        {"filter_slope", "maybe", "on"},   {"method", "hbaoo", "'hbao'"},
        {"filter", "box5", "'box4'"},      {"radios", "1", "'radius'"},
        {"xyzzyxyzzy", "1", "there are"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        crv_options o = fixture_options(NULL);
        recorder r;
        assert_int_equal(set(&o, CASES[i].key, CASES[i].value, &r),
                         CRV_ERROR_INVALID_ARGUMENT);
        if (!strstr(r.last, CASES[i].reason))
            fail_msg("%s=%s: \"%s\" does not say %s", CASES[i].key, CASES[i].value,
                     r.last, CASES[i].reason);
    }
}

static void unread_options_are_reported(void **state)
{
    (void)state;
    crv_options o = fixture_options(NULL);
    recorder r = {0};
    const crv_logger logger = {record, &r};
    assert_int_equal(crv_options_check(&o, &logger), CRV_OK);
    assert_int_equal(r.warnings, 0);
    o.filter = NULL;
    o.filter_depth = 0.5f;
    assert_int_equal(crv_options_check(&o, &logger), CRV_OK);
    assert_int_equal(r.warnings, 1);
    assert_non_null(strstr(r.last, "filter_depth"));
}

static void options_are_checked(void **state)
{
    (void)state;
    crv_options o = fixture_options(NULL);
    recorder r = {0};
    const crv_logger logger = {record, &r};
    assert_int_equal(crv_options_init(&o, 3, NULL), CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_options_init(&o, sizeof o, "nope"), CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_options_init(NULL, sizeof o, NULL), CRV_ERROR_INVALID_ARGUMENT);
    o.radius = NAN;
    assert_int_equal(crv_options_check(&o, &logger), CRV_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(r.last, "radius"));
    o = fixture_options(NULL);
    o.falloff = (crv_falloff)17;
    assert_int_equal(crv_options_check(&o, &logger), CRV_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(r.last, "falloff"));
    o = fixture_options(NULL);
    o.steps = 0;
    assert_int_equal(crv_options_check(&o, &logger), CRV_ERROR_INVALID_ARGUMENT);
    o = fixture_options(NULL);
    o.method = NULL;
    assert_int_equal(crv_options_check(&o, &logger), CRV_ERROR_INVALID_ARGUMENT);
    crv_options zeroed;
    memset(&zeroed, 0, sizeof zeroed);
    assert_int_equal(crv_options_check(&zeroed, &logger), CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_options_check(NULL, NULL), CRV_ERROR_INVALID_ARGUMENT);
}

/* Every preset of every method is understood, sets only what the method reads, and
 * changes something from one level to the next. */
static void presets_are_sound(void **state)
{
    (void)state;
    for (int32_t i = 0; i < crv_method_count(); i++) {
        const crv_method *method = crv_method_at(i);
        const char *before = NULL;
        for (int k = 0; k < CRV_PRESET_COUNT; k++) {
            crv_options o = fixture_options(method->name);
            recorder r = {0};
            const crv_logger logger = {record, &r};
            const char *text = crv_preset_text(method, (crv_preset)k);
            assert_non_null(crv_preset_name((crv_preset)k));
            assert_int_equal(crv_options_preset(&o, (crv_preset)k), CRV_OK);
            assert_int_equal(crv_options_check(&o, &logger), CRV_OK);
            assert_int_equal(r.warnings, 0);
            assert_true(!before || strcmp(before, text) != 0);
            before = text;
            char key[32], value[32];
            int length = 0;
            for (; sscanf(text, " %31[^=]=%31s%n", key, value, &length) == 2;
                 text += length) {
                if (strcmp(key, "filter") == 0)
                    continue;
                assert_true(crv_option_applies(crv_option_find(key), method, o.filter));
            }
            assert_int_equal(*text, 0); /* nothing was left over */
        }
    }
    crv_options o = fixture_options("hbao");
    assert_int_equal(crv_options_preset(&o, CRV_PRESET_LOW), CRV_OK);
    assert_int_equal(o.directions, 4);
    assert_int_equal(crv_options_preset(&o, (crv_preset)9), CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_options_preset(NULL, CRV_PRESET_LOW),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_null(crv_preset_name((crv_preset)-1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(registries_are_sound),
        cmocka_unit_test(every_option_is_used_and_in_range),
        cmocka_unit_test(text_sets_values),
        cmocka_unit_test(bad_text_is_refused_with_a_reason),
        cmocka_unit_test(unread_options_are_reported),
        cmocka_unit_test(options_are_checked),
        cmocka_unit_test(presets_are_sound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
/* Options from text. */
#include "core/options.h"

#include "base/log.h"
#include "base/names.h"
#include "base/numbers.h"
#include "core/registry.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NAMES = 64 };

static crv_status unknown(const crv_logger *logger, const char *what, const char *word,
                          const char *const *names, int32_t count)
{
    const char *nearest = crv__nearest_name(word, names, count);
    if (nearest)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "%s: unknown name '%s'; did you mean '%s'?", what, word,
                         nearest);
    char list[256] = "";
    for (int32_t i = 0; count < 0 ? names[i] != NULL : i < count; i++) {
        if (strlen(list) + strlen(names[i]) + 3 > sizeof list)
            break;
        strcat(strcat(list, i ? ", " : ""), names[i]);
    }
    return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                     "%s: unknown name '%s'; there are %s", what, word, list);
}

static crv_status set_method(crv_options *options, const char *value,
                             const crv_logger *logger)
{
    const crv_method *method = crv_method_find(value);
    if (method) {
        options->method = method;
        return CRV_OK;
    }
    const char *names[MAX_NAMES];
    int32_t count = 0;
    for (; count < MAX_NAMES && crv_method_at(count); count++)
        names[count] = crv_method_at(count)->name;
    return unknown(logger, "method", value, names, count);
}

static crv_status set_filter(crv_options *options, const char *value,
                             const crv_logger *logger)
{
    const crv_filter *filter = crv_filter_find(value);
    if (filter || strcmp(value, "none") == 0) {
        options->filter = filter;
        return CRV_OK;
    }
    const char *names[MAX_NAMES] = {"none"};
    int32_t count = 1;
    for (; count < MAX_NAMES && crv_filter_at(count - 1); count++)
        names[count] = crv_filter_at(count - 1)->name;
    return unknown(logger, "filter", value, names, count);
}

/* 1, 0, or -1 where the text is neither. */
static int parse_bool(const char *text)
{
    static const char *const YES[] = {"1", "true", "on", "yes"};
    static const char *const NO[] = {"0", "false", "off", "no"};
    for (int i = 0; i < 4; i++) {
        if (strcmp(text, YES[i]) == 0)
            return 1;
        if (strcmp(text, NO[i]) == 0)
            return 0;
    }
    return -1;
}

static crv_status parse_value(const crv_option *option, const char *text, double *value,
                              const crv_logger *logger)
{
    if (option->type == CRV_OPTION_CHOICE) {
        for (int i = 0; option->choices[i]; i++) {
            if (strcmp(option->choices[i], text) == 0) {
                *value = i;
                return CRV_OK;
            }
        }
        return unknown(logger, option->key, text, option->choices, -1);
    }
    if (option->type == CRV_OPTION_BOOL) {
        *value = parse_bool(text);
        if (*value < 0)
            return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                             "%s: '%s' is neither on nor off", option->key, text);
        return CRV_OK;
    }
    *value = crv__number_parse(text);
    if (isnan(*value) || (option->type == CRV_OPTION_INT && *value != floor(*value)))
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "%s: '%s' is not a%s number; it is from %g to %g%s%s",
                         option->key, text,
                         option->type == CRV_OPTION_INT ? " whole" : "", option->min,
                         option->max, option->unit[0] ? " " : "", option->unit);
    return crv__option_check(option, *value, logger);
}

static crv_status unknown_key(const char *key, const crv_logger *logger)
{
    const char *names[MAX_NAMES] = {"method", "filter"};
    int32_t count = 2;
    for (; count < MAX_NAMES && crv_option_at(count - 2); count++)
        names[count] = crv_option_at(count - 2)->key;
    return unknown(logger, "options", key, names, count);
}

crv_status crv_options_set(crv_options *options, const char *key, const char *value,
                           const crv_logger *logger)
{
    if (!crv__options_known(options) || !key || !value)
        return crv__fail(
            logger, CRV_ERROR_INVALID_ARGUMENT,
            "options: NULL or not initialised; begin with crv_options_init()");
    if (strcmp(key, "method") == 0)
        return set_method(options, value, logger);
    if (strcmp(key, "filter") == 0)
        return set_filter(options, value, logger);
    const crv_option *option = crv_option_find(key);
    if (!option)
        return unknown_key(key, logger);
    if (!crv__options_have(options, option))
        return crv__fail(logger, CRV_ERROR_UNSUPPORTED,
                         "%s: this program was built with headers that do not have it; "
                         "build it again with those of libcrevice %s",
                         option->key, crv_version());
    double number = 0;
    crv_status status = parse_value(option, value, &number, logger);
    if (status == CRV_OK)
        crv__options_put(options, option, number);
    return status;
}

const char *crv_preset_name(crv_preset preset)
{
    static const char *const NAMES[CRV_PRESET_COUNT] = {"low", "medium", "high", "ultra",
                                                        "paper"};
    return (int)preset >= 0 && preset < CRV_PRESET_COUNT ? NAMES[preset] : NULL;
}

const char *crv_preset_text(const crv_method *method, crv_preset preset)
{
    if (!method || !crv_preset_name(preset))
        return NULL;
    return crv__method_of(method)->presets[preset];
}

crv_status crv_options_preset(crv_options *options, crv_preset preset)
{
    if (!crv__options_known(options) || !options->method || !crv_preset_name(preset))
        return CRV_ERROR_INVALID_ARGUMENT;
    const char *text = crv_preset_text(options->method, preset);
    char key[32], value[32];
    int length = 0;
    /* The texts are the methods' own, and a test reads every one of them. */
    while (sscanf(text, " %31[^=]=%31s%n", key, value, &length) == 2) {
        const crv_status status = crv_options_set(options, key, value, NULL);
        if (status && status != CRV_ERROR_UNSUPPORTED) /* an earlier struct_size */
            return status;
        text += length;
    }
    return CRV_OK;
}

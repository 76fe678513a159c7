/* SPDX-License-Identifier: MIT */
#include "option_text.h"

#include <stdio.h>
#include <string.h>

#include "text.h"
#include "exact.h"
#include "help.h"

const char *option_value_text(const crv_option *option, double value, char out[64])
{
    char number[32];
    switch (option->type) {
    case CRV_OPTION_FLOAT:
        snprintf(out, 64, "%s", exact_number((float)value, 1.0, number));
        break;
    case CRV_OPTION_INT:
        snprintf(out, 64, "%.0f", value);
        break;
    case CRV_OPTION_BOOL:
        snprintf(out, 64, "%s", value > 0.0 ? "on" : "off");
        break;
    case CRV_OPTION_CHOICE:
        snprintf(out, 64, "%s", option->choices[(int)value]);
        break;
    }
    return out;
}

const char *option_tooltip(const crv_option *option, const crv_method *method,
                           double usual, char out[OPTION_TOOLTIP_SIZE])
{
    char values[256], initial[64];
    help_option_values(option, values, sizeof values);
    if (usual > 0.0)
        option_value_text(option, usual, initial);
    else
        help_option_default(option, method, initial, sizeof initial);
    snprintf(out, OPTION_TOOLTIP_SIZE, "%s\n%s\ndefault %s%s", option->help, values,
             initial, usual > 0.0 ? ", that of the first view" : "");
    return out;
}

const char *option_lines(const crv_options *o, char out[OPTION_TEXT_SIZE])
{
    out[0] = '\0';
    append_to(out, OPTION_TEXT_SIZE, "method=%s\nfilter=%s\n", o->method->name,
              o->filter ? o->filter->name : "none");
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        char value[64];
        if (crv_option_applies(option, o->method, o->filter))
            append_to(out, OPTION_TEXT_SIZE, "%s=%s\n", option->key,
                      option_value_text(option, crv_options_get(o, option), value));
    }
    return out;
}

const char *option_flags(const crv_options *o, char out[OPTION_TEXT_SIZE])
{
    crv_options usual;
    crv_options_init(&usual, sizeof usual, o->method->name);
    out[0] = '\0';
    append_to(out, OPTION_TEXT_SIZE, " --method %s", o->method->name);
    if (o->filter != usual.filter)
        append_to(out, OPTION_TEXT_SIZE, " --filter %s",
                  o->filter ? o->filter->name : "none");
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        const double value = crv_options_get(o, option);
        const double standard = crv_options_get(&usual, option);
        char flag[64], text[64];
        if (!crv_option_applies(option, o->method, o->filter)
            || (strcmp(option->key, "radius") != 0
                && !(value < standard || value > standard)))
            continue;
        help_option_flag(option, flag, sizeof flag);
        append_to(out, OPTION_TEXT_SIZE, " %s %s", flag,
                  option_value_text(option, value, text));
    }
    return out;
}

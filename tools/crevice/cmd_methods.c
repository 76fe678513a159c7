/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "common/help.h"
#include "common/json.h"
#include "common/nearest.h"

typedef struct methods_settings {
    common_settings common;
    const char *name;
    bool json;
} methods_settings;

static const arg methods_rows[] = {
    {.name = "NAME",
     ARG_INTO(ARG_TEXT, methods_settings, name),
     .help = "a method or filter to tell all about; without it, all are listed"},
    {.name = "--json", ARG_INTO(ARG_FLAG, methods_settings, json), .help = "write JSON"},
};
static const arg_table methods_table = ARG_TABLE("What to list", methods_rows);

static const arg_table *const tables[] = {&methods_table, &args_output_lines, NULL};

static const char *const examples[] = {
    "what there is",
    "crevice methods",
    "one method and every option that it reads",
    "crevice methods hbao",
    NULL,
};

static const char *weighting_name(crv_weighting weighting)
{
    return weighting == CRV_WEIGHTING_COSINE ? "cosine" : "uniform";
}

/* The options read by the method alone: a filter's are listed with the filter. */
static bool method_reads(const crv_option *option, const crv_method *method)
{
    return crv_option_applies(option, method, NULL) != 0;
}

static bool filter_reads(const crv_option *option, const crv_filter *filter)
{
    return crv_option_applies(option, NULL, filter) != 0
           && crv_option_applies(option, NULL, NULL) == 0;
}

/* method NULL: an option of a filter. */
static void print_option_brief(const crv_option *option, const crv_method *method)
{
    char flag[80], values[256], initial[64];
    help_option_flag(option, flag, sizeof flag);
    help_option_values(option, values, sizeof values);
    help_option_default(option, method, initial, sizeof initial);
    printf("    %-18s %s (%s)\n", flag, initial, values);
}

static void print_method(const crv_method *method, bool all)
{
    printf("%s: %s\n", method->name, method->title);
    printf("    %s\n", method->paper);
    printf("    %s weighting of the hemisphere\n", weighting_name(method->weighting));
    if (all)
        printf("\n");
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        if (!method_reads(option, method))
            continue;
        if (all)
            help_library_option(stdout, option, method);
        else
            print_option_brief(option, method);
    }
    printf("%s    presets (--preset):\n", all ? "\n" : "");
    help_presets(stdout, method, 6);
}

static void print_filter(const crv_filter *filter, bool all)
{
    printf("%s: %s\n", filter->name, filter->title);
    printf("    %s\n", filter->paper);
    if (all)
        printf("\n");
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        if (!filter_reads(option, filter))
            continue;
        if (all)
            help_library_option(stdout, option, NULL);
        else
            print_option_brief(option, NULL);
    }
}

static void print_all(void)
{
    printf(
        "Methods (--method), with the options that each reads, default and range:\n\n");
    for (int32_t i = 0; i < crv_method_count(); i++) {
        print_method(crv_method_at(i), false);
        printf("\n");
    }
    printf("Filters (--filter, or none):\n");
    for (int32_t i = 0; i < crv_filter_count(); i++) {
        printf("\n");
        print_filter(crv_filter_at(i), false);
    }
}

/* method NULL: an option of a filter. */
static cJSON *option_json(const crv_option *option, const crv_method *method)
{
    static const char *const types[] = {"float", "int", "bool", "choice"};
    cJSON *object = cJSON_CreateObject();
    char flag[80], initial[64];
    help_option_flag(option, flag, sizeof flag);
    help_option_default(option, method, initial, sizeof initial);
    cJSON_AddStringToObject(object, "key", option->key);
    cJSON_AddStringToObject(object, "flag", flag);
    cJSON_AddStringToObject(object, "type", types[option->type]);
    cJSON_AddStringToObject(object, "unit", option->unit);
    if (option->type == CRV_OPTION_CHOICE) {
        cJSON *choices = cJSON_AddArrayToObject(object, "choices");
        for (int32_t i = 0; option->choices[i]; i++)
            cJSON_AddItemToArray(choices, cJSON_CreateString(option->choices[i]));
        cJSON_AddStringToObject(object, "default", initial);
    } else if (option->type == CRV_OPTION_BOOL) {
        cJSON_AddBoolToObject(object, "default",
                              help_default_value(option, method) > 0.0);
    } else {
        cJSON_AddNumberToObject(object, "default", help_default_value(option, method));
        cJSON_AddNumberToObject(object, "min", option->min);
        cJSON_AddNumberToObject(object, "max", option->max);
    }
    cJSON_AddStringToObject(object, "help", option->help);
    return object;
}

static void add_method(cJSON *list, const crv_method *method)
{
    cJSON *object = cJSON_CreateObject();
    crv_options defaults;
    crv_options_init(&defaults, sizeof defaults, method->name);

    cJSON_AddStringToObject(object, "name", method->name);
    cJSON_AddStringToObject(object, "title", method->title);
    cJSON_AddStringToObject(object, "paper", method->paper);
    cJSON_AddStringToObject(object, "weighting", weighting_name(method->weighting));
    cJSON_AddStringToObject(object, "filter",
                            defaults.filter ? defaults.filter->name : "none");
    cJSON *options = cJSON_AddArrayToObject(object, "options");
    for (int32_t i = 0; i < crv_option_count(); i++)
        if (method_reads(crv_option_at(i), method))
            cJSON_AddItemToArray(options, option_json(crv_option_at(i), method));
    cJSON *presets = cJSON_AddObjectToObject(object, "presets");
    for (int i = 0; i < CRV_PRESET_COUNT; i++)
        cJSON_AddStringToObject(presets, crv_preset_name((crv_preset)i),
                                crv_preset_text(method, (crv_preset)i));
    cJSON_AddItemToArray(list, object);
}

static void add_filter(cJSON *list, const crv_filter *filter)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "name", filter->name);
    cJSON_AddStringToObject(object, "title", filter->title);
    cJSON_AddStringToObject(object, "paper", filter->paper);
    cJSON *options = cJSON_AddArrayToObject(object, "options");
    for (int32_t i = 0; i < crv_option_count(); i++)
        if (filter_reads(crv_option_at(i), filter))
            cJSON_AddItemToArray(options, option_json(crv_option_at(i), NULL));
    cJSON_AddItemToArray(list, object);
}

/* method and filter NULL: all of both. */
static int print_json(const crv_method *method, const crv_filter *filter, report *r)
{
    const bool all = !method && !filter;
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "version", crv_version());
    cJSON *list = cJSON_AddArrayToObject(root, "methods");
    for (int32_t i = 0; i < crv_method_count(); i++)
        if (all || crv_method_at(i) == method)
            add_method(list, crv_method_at(i));
    list = cJSON_AddArrayToObject(root, "filters");
    for (int32_t i = 0; i < crv_filter_count(); i++)
        if (all || crv_filter_at(i) == filter)
            add_filter(list, crv_filter_at(i));
    return json_print(root, r);
}

static int unknown_name(const char *name, report *r)
{
    const char *names[64];
    int32_t count = 0;
    for (int32_t i = 0; i < crv_method_count() && count < 64; i++)
        names[count++] = crv_method_at(i)->name;
    for (int32_t i = 0; i < crv_filter_count() && count < 64; i++)
        names[count++] = crv_filter_at(i)->name;
    const char *nearest = nearest_name(name, names, count);
    if (nearest)
        report_error(r, "%s: no such method or filter; did you mean %s?", name, nearest);
    else
        report_error(r, "%s: no such method or filter; see `crevice methods`", name);
    return EXIT_USAGE;
}

static int run(const void *settings, report *r)
{
    const methods_settings *s = settings;
    const crv_method *method = s->name ? crv_method_find(s->name) : NULL;
    const crv_filter *filter = s->name ? crv_filter_find(s->name) : NULL;
    if (s->name && !method && !filter)
        return unknown_name(s->name, r);
    if (s->json)
        return print_json(method, filter, r);
    if (method)
        print_method(method, true);
    if (filter)
        print_filter(filter, true);
    if (!s->name)
        print_all();
    return EXIT_DONE;
}

const command command_methods = {
    .name = "methods",
    .summary = "list methods and filters with their papers, options and presets",
    .synopsis = "[NAME] [--json]",
    .tables = tables,
    .examples = examples,
    .settings_size = sizeof(methods_settings),
    .run = run,
};

/* SPDX-License-Identifier: MIT */
#include "args.h"

#include "nearest.h"
#include "options_file.h"

#include <stdio.h>
#include <string.h>

static const arg output_line_rows[] = {
    {.name = "--quiet",
     .short_name = 'q',
     ARG_INTO(ARG_FLAG, common_settings, quiet),
     .help = "write nothing but errors and warnings to stderr"},
    {.name = "--verbose",
     .short_name = 'v',
     ARG_INTO(ARG_FLAG, common_settings, verbose),
     .help = "write more about what is done"},
};
const arg_table args_output_lines = ARG_TABLE("Messages", output_line_rows);

static const arg thread_rows[] = {
    {.name = "--threads",
     .value = "N",
     ARG_RANGE(0, 1024),
     ARG_INTO(ARG_INT, common_settings, threads),
     .initial = "0",
     .help = "threads that work; 0: all processors. The result is the same bit by bit"},
};
const arg_table args_threads = ARG_TABLE("Work", thread_rows);

const char *const args_png_bits[] = {"8", "16", NULL};

enum { FLAGS_MAX = 128, CHOICES_MAX = 64 };

static bool is_library_option(const char *key)
{
    return strcmp(key, "method") == 0 || strcmp(key, "preset") == 0
           || strcmp(key, "options") == 0 || strcmp(key, "filter") == 0
           || crv_option_find(key);
}

/* The row of this flag ("--size" or "-o"), its first `length` bytes counting. */
static const arg *find_flag(const command *c, const char *flag, size_t length)
{
    for (size_t t = 0; c->tables[t]; t++) {
        for (size_t i = 0; i < c->tables[t]->count; i++) {
            const arg *row = &c->tables[t]->rows[i];
            if (strlen(row->name) == length && row->name[0] == '-'
                && memcmp(row->name, flag, length) == 0)
                return row;
            if (length == 2 && row->short_name != 0 && flag[1] == row->short_name)
                return row;
        }
    }
    return NULL;
}

static const arg *find_positional(const command *c, size_t index)
{
    for (size_t t = 0; c->tables[t]; t++) {
        for (size_t i = 0; i < c->tables[t]->count; i++) {
            const arg *row = &c->tables[t]->rows[i];
            if (row->name[0] != '-' && (index-- == 0 || row->type == ARG_TEXTS))
                return row;
        }
    }
    return NULL;
}

/* Names are compared without their dashes, so that these don't count as letters met. */
static int unknown_flag(const command *c, const char *flag, report *r)
{
    const char *names[FLAGS_MAX] = {"method", "preset", "filter", "options"};
    char keys[FLAGS_MAX][64];
    int32_t count = c->library_options ? 4 : 0;
    for (size_t t = 0; c->tables[t]; t++)
        for (size_t i = 0; i < c->tables[t]->count && count < FLAGS_MAX; i++)
            if (c->tables[t]->rows[i].name[0] == '-')
                names[count++] = c->tables[t]->rows[i].name + 2;
    for (int32_t i = 0; c->library_options && i < crv_option_count(); i++) {
        if (count == FLAGS_MAX)
            break;
        snprintf(keys[count], sizeof keys[count], "%s", crv_option_at(i)->key);
        for (char *p = keys[count]; *p != '\0'; p++)
            *p = *p == '_' ? '-' : *p;
        names[count] = keys[count];
        count++;
    }
    const char *nearest = nearest_name(flag + strspn(flag, "-"), names, count);
    if (nearest)
        report_error(r, "%s: no such option; did you mean --%s?", flag, nearest);
    else
        report_error(r, "%s: no such option; see `crevice help %s`", flag, c->name);
    return EXIT_USAGE;
}

static int wrong_value(const arg *row, const char *text, report *r)
{
    char values[256];
    const char *choices[CHOICES_MAX], *nearest = NULL;
    int32_t count = 0;
    args_describe_values(row, values, sizeof values);
    while (row->type == ARG_CHOICE && count < CHOICES_MAX && arg_choice(row, count)) {
        choices[count] = arg_choice(row, count);
        count++;
    }
    nearest = nearest_name(text, choices, count);
    if (nearest)
        report_error(r, "%s: \"%s\" is not one of %s; did you mean %s?", row->name, text,
                     values, nearest);
    else
        report_error(r, "%s: \"%s\" is not valid; give %s", row->name, text,
                     values[0] != '\0' ? values : row->value);
    return EXIT_USAGE;
}

/* `given` is the first member of every type that has it. */
static void mark_given(const arg *row, void *settings)
{
    if (row->type != ARG_FLAG && row->type != ARG_TEXT && row->type != ARG_TEXTS)
        *(bool *)((char *)settings + row->offset) = true;
}

static void set_defaults(const command *c, void *settings)
{
    for (size_t t = 0; c->tables[t]; t++)
        for (size_t i = 0; i < c->tables[t]->count; i++)
            if (c->tables[t]->rows[i].initial)
                args_set_value(&c->tables[t]->rows[i], c->tables[t]->rows[i].initial,
                               settings);
}

/* The value of the last `flag` among the arguments; NULL if there is none. */
static const char *last_value(const char *flag, int argc, char **argv)
{
    const size_t length = strlen(flag);
    const char *value = NULL;
    for (int i = 0; i < argc && strcmp(argv[i], "--") != 0; i++) {
        if (strncmp(argv[i], flag, length) != 0)
            continue;
        if (argv[i][length] == '=')
            value = argv[i] + length + 1;
        else if (argv[i][length] == '\0' && i + 1 < argc)
            value = argv[i + 1];
    }
    return value;
}

static const char *method_name(const command *c, int argc, char **argv)
{
    const char *name = last_value("--method", argc, argv);
    if (!name && c->method_flag && last_value(c->method_flag, argc, argv))
        name = c->method_of_flag;
    return name;
}

const crv_method *args_method(const command *c, int argc, char **argv)
{
    const char *name = method_name(c, argc, argv);
    const crv_method *method = name ? crv_method_find(name) : NULL;
    crv_options options;
    if (!method && crv_options_init(&options, sizeof options, NULL) == CRV_OK)
        method = options.method;
    return method;
}

/* A method brings its own defaults, so it comes before all other options. */
static int set_method(const command *c, int argc, char **argv, const options_file *file,
                      common_settings *common, report *r)
{
    const char *flag = last_value("--method", argc, argv);
    const char *name = flag ? flag : options_file_find(file, "method");
    if (!name)
        name = method_name(c, argc, argv);
    if (!report_ok(r, crv_options_init(&common->options, sizeof common->options, NULL),
                   "options"))
        return EXIT_USAGE;
    if (!name)
        return EXIT_DONE;
    if (crv_options_set(&common->options, "method", name, &r->logger) == CRV_OK
        && crv_options_init(&common->options, sizeof common->options, name) == CRV_OK)
        return EXIT_DONE;
    if (r->errors == 0)
        report_error(r, "--method: no method \"%s\"; see `crevice methods`", name);
    return EXIT_USAGE;
}

/* A preset is the method's, so it comes after that; single options change it. */
static int set_preset(int argc, char **argv, const options_file *file,
                      common_settings *common, report *r)
{
    const char *flag = last_value("--preset", argc, argv);
    const char *name = flag ? flag : options_file_find(file, "preset");
    const char *names[CRV_PRESET_COUNT];
    for (int i = 0; name && i < CRV_PRESET_COUNT; i++) {
        names[i] = crv_preset_name((crv_preset)i);
        if (strcmp(names[i], name) == 0)
            return report_ok(r, crv_options_preset(&common->options, (crv_preset)i),
                             "preset")
                       ? EXIT_DONE
                       : EXIT_USAGE;
    }
    if (!name)
        return EXIT_DONE;
    const char *nearest = nearest_name(name, names, CRV_PRESET_COUNT);
    if (nearest)
        report_error(r, "--preset: no preset \"%s\"; did you mean %s?", name, nearest);
    else
        report_error(r, "--preset: no preset \"%s\"; see `crevice methods`", name);
    return EXIT_USAGE;
}

static int set_library_option(const char *flag, size_t length, const char *text,
                              common_settings *common, report *r)
{
    char key[64];
    memcpy(key, flag + 2, length - 2);
    key[length - 2] = '\0';
    if (strcmp(key, "method") == 0 || strcmp(key, "preset") == 0
        || strcmp(key, "options") == 0)
        return EXIT_DONE; /* set_library() has seen to it */
    const crv_option *option = crv_option_find(key);
    if (strcmp(key, "radius") == 0)
        common->radius_given = true;
    if (crv_options_set(&common->options, option ? option->key : key, text, &r->logger)
        == CRV_OK)
        return EXIT_DONE;
    if (r->errors == 0)
        report_error(r, "%s: \"%s\" is not valid; see `crevice methods`", key, text);
    return EXIT_USAGE;
}

/* One flag at argv[*i], which moves on to the flag's value if that is the next word. */
static int parse_flag(const command *c, int argc, char **argv, int *i, void *settings,
                      report *r)
{
    const char *flag = argv[*i];
    const char *equals = strncmp(flag, "--", 2) == 0 ? strchr(flag, '=') : NULL;
    const size_t length = equals ? (size_t)(equals - flag) : strlen(flag);
    const arg *row = find_flag(c, flag, length);
    const char *text = equals ? equals + 1 : NULL;
    char key[64] = "";
    if (!row && c->library_options && length > 2 && length < sizeof key
        && flag[1] == '-') {
        memcpy(key, flag + 2, length - 2);
        if (!is_library_option(key))
            key[0] = '\0';
    }
    if (!row && key[0] == '\0')
        return unknown_flag(c, flag, r);
    if (row && row->type == ARG_FLAG) {
        if (!text)
            return args_set_value(row, "", settings) ? EXIT_DONE : EXIT_USAGE;
        report_error(r, "%s: takes no value; leave out \"=%s\"", row->name, text);
        return EXIT_USAGE;
    }
    if (!text) {
        /* A following option is a forgotten value, not a file of that name. */
        if (*i + 1 >= argc || strncmp(argv[*i + 1], "--", 2) == 0) {
            report_error(r, "%s: its value is missing; see `crevice help %s`", flag,
                         c->name);
            return EXIT_USAGE;
        }
        text = argv[++*i];
    }
    if (!row)
        return set_library_option(flag, length, text, settings, r);
    if (!args_set_value(row, text, settings))
        return wrong_value(row, text, r);
    mark_given(row, settings);
    return EXIT_DONE;
}

static int parse_positional(const command *c, const char *text, size_t *index,
                            void *settings, report *r)
{
    const arg *row = find_positional(c, *index);
    if (!row) {
        report_error(r, "\"%s\": one argument too many; see `crevice help %s`", text,
                     c->name);
        return EXIT_USAGE;
    }
    if (strcmp(text, "-") == 0) {
        report_error(r, "%s: standard input is not read; name a file", row->name);
        return EXIT_USAGE;
    }
    ++*index;
    if (!args_set_value(row, text, settings)) {
        if (text[0] == '\0')
            report_error(r, "%s: is empty; name a file", row->name);
        else
            report_error(r, "%s: is given more than %d times; leave some out", row->name,
                         ARG_TEXTS_MAX);
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}

static bool has_text(const arg *row, const void *member)
{
    if (row->type == ARG_TEXTS)
        return ((const arg_texts *)member)->count > 0;
    return *(const char *const *)member;
}

static int check_required(const command *c, const void *settings, report *r)
{
    for (size_t t = 0; c->tables[t]; t++) {
        for (size_t i = 0; i < c->tables[t]->count; i++) {
            const arg *row = &c->tables[t]->rows[i];
            const void *member = (const char *)settings + row->offset;
            if (!row->required || has_text(row, member))
                continue;
            report_error(r, "%s is missing; see `crevice help %s`",
                         row->short_name == 'o' ? "-o OUT" : row->name, c->name);
            return EXIT_USAGE;
        }
    }
    return EXIT_DONE;
}

/* What comes before single options: method, preset, and the file of --options, which
 * options of the command line change. */
static int set_library(const command *c, int argc, char **argv, common_settings *common,
                       report *r)
{
    options_file file;
    int result = options_file_read(last_value("--options", argc, argv), &file, r);
    if (result == EXIT_DONE)
        result = set_method(c, argc, argv, &file, common, r);
    if (result == EXIT_DONE)
        result = set_preset(argc, argv, &file, common, r);
    if (result == EXIT_DONE)
        result = options_file_apply(&file, &common->options, r);
    if (options_file_find(&file, "radius"))
        common->radius_given = true;
    options_file_free(&file);
    return result;
}

int args_parse(const command *c, int argc, char **argv, void *settings, report *r)
{
    common_settings *common = settings;
    bool options_end = false;
    size_t positionals = 0;
    int result = EXIT_DONE;
    set_defaults(c, settings);
    if (c->library_options)
        result = set_library(c, argc, argv, common, r);
    for (int i = 0; i < argc && result == EXIT_DONE; i++) {
        if (!options_end && strcmp(argv[i], "--") == 0)
            options_end = true;
        else if (!options_end && argv[i][0] == '-' && argv[i][1] != '\0')
            result = parse_flag(c, argc, argv, &i, settings, r);
        else
            result = parse_positional(c, argv[i], &positionals, settings, r);
    }
    if (result == EXIT_DONE)
        result = check_required(c, settings, r);
    if (result == EXIT_DONE && c->library_options) {
        /* The plan warns of options without effect; here only what is wrong counts. */
        crv_logger errors = report_errors_only(r);
        if (!report_ok(r, crv_options_check(&common->options, &errors), "options"))
            result = EXIT_USAGE;
    }
    r->quiet = common->quiet;
    r->verbose = common->verbose;
    return result;
}

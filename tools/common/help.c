/* SPDX-License-Identifier: MIT */
#include "help.h"

#include <string.h>

enum { WIDTH = 90, COLUMN = 27, ENTRY_SIZE = 1024 };

static void open_plain(FILE *out, const command *c);
static void write_paragraph(FILE *out, const char *text);
static void write_heading(FILE *out, const char *text);
static void write_entry(FILE *out, const char *head, const char *text);
static void write_item(FILE *out, const char *head, const char *text);
static void close_plain(FILE *out, const command *c);

static const help_style plain = {.opening = open_plain,
                                 .paragraph = write_paragraph,
                                 .heading = write_heading,
                                 .entry = write_entry,
                                 .item = write_item,
                                 .closing = close_plain};

/* Words of text from column `column` on, indented by `indent` if a line breaks: at
 * spaces, or after a '|'. */
static void write_wrapped(FILE *out, const char *text, int column, int indent)
{
    bool first = true, space = false;
    while (*text != '\0') {
        const size_t part = strcspn(text, " |");
        const int length = (int)part + (text[part] == '|');

        if (!first && column + space + length > WIDTH) {
            fprintf(out, "\n%*s", indent, "");
            column = indent;
            space = false;
        }
        fprintf(out, "%s%.*s", space ? " " : "", length, text);
        column += length + space;
        first = false;
        text += length;
        space = *text == ' ';
        text += strspn(text, " ");
    }
    fputc('\n', out);
}

static void write_entry(FILE *out, const char *head, const char *text)
{
    const int used = fprintf(out, "  %s", head);
    if (used < COLUMN - 1)
        fprintf(out, "%*s", COLUMN - used, "");
    else
        fprintf(out, "\n%*s", COLUMN, "");
    write_wrapped(out, text, COLUMN, COLUMN);
}

/* What stands before a row's help: "-o, --output FILE". */
static void row_head(const arg *row, char *out, size_t size)
{
    char shorthand[8] = "";
    if (row->short_name != 0)
        snprintf(shorthand, sizeof shorthand, "-%c, ", row->short_name);
    snprintf(out, size, "%s%s%s%s", shorthand, row->name, row->value ? " " : "",
             row->value ? row->value : "");
}

/* The help with values and default behind it. */
static void row_text(const arg *row, char *out, size_t size)
{
    const char *initial = row->computed ? row->computed : row->initial;
    char values[256];
    args_describe_values(row, values, sizeof values);
    const bool has_values = values[0] != '\0';
    snprintf(out, size, "%s%s%s%s%s%s%s", row->help, has_values || initial ? " [" : "",
             values, has_values && initial ? "; " : "", initial ? "default " : "",
             initial ? initial : "", has_values || initial ? "]" : "");
}

void help_option_flag(const crv_option *option, char *out, size_t size)
{
    snprintf(out, size, "--%s", option->key);
    for (char *p = out; *p != '\0'; p++)
        *p = *p == '_' ? '-' : *p;
}

void help_option_values(const crv_option *option, char *out, size_t size)
{
    const char *space = option->unit[0] != '\0' ? " " : "";
    size_t used = 0;
    if (option->type == CRV_OPTION_BOOL) {
        snprintf(out, size, "on|off");
    } else if (option->type == CRV_OPTION_CHOICE) {
        out[0] = '\0';
        for (int32_t i = 0; option->choices[i] && used < size; i++)
            used += (size_t)snprintf(out + used, size - used, "%s%s", i == 0 ? "" : "|",
                                     option->choices[i]);
    } else {
        snprintf(out, size, "%.10g to %.10g%s%s", option->min, option->max, space,
                 option->unit);
    }
}

double help_default_value(const crv_option *option, const crv_method *method)
{
    crv_options options;
    if (crv_options_init(&options, sizeof options, method ? method->name : NULL)
        != CRV_OK)
        return option->default_value;
    return crv_options_get(&options, option);
}

void help_option_default(const crv_option *option, const crv_method *method, char *out,
                         size_t size)
{
    const double value = help_default_value(option, method);
    if (option->type == CRV_OPTION_BOOL)
        snprintf(out, size, "%s", value > 0.0 ? "on" : "off");
    else if (option->type == CRV_OPTION_CHOICE)
        snprintf(out, size, "%s", option->choices[(int32_t)value]);
    else
        snprintf(out, size, "%.6g", value);
}

static void write_option(FILE *out, const help_style *style, const crv_option *option,
                         const crv_method *method)
{
    static const char *const value_names[] = {"X", "N", "on|off", "NAME"};
    char flag[80], head[96], values[256], initial[64], text[ENTRY_SIZE];
    help_option_flag(option, flag, sizeof flag);
    help_option_values(option, values, sizeof values);
    help_option_default(option, method, initial, sizeof initial);
    snprintf(head, sizeof head, "%s %s", flag, value_names[option->type]);
    if (strcmp(option->key, "radius") == 0)
        snprintf(initial, sizeof initial, "chosen to suit the input");
    snprintf(text, sizeof text, "%s [%s; default %s]", option->help, values, initial);
    style->entry(out, head, text);
}

void help_library_option(FILE *out, const crv_option *option, const crv_method *method)
{
    write_option(out, &plain, option, method);
}

void help_presets(FILE *out, const crv_method *method, int indent)
{
    for (int i = 0; i < CRV_PRESET_COUNT; i++) {
        const int column =
            fprintf(out, "%*s%-8s", indent, "", crv_preset_name((crv_preset)i));
        write_wrapped(out, crv_preset_text(method, (crv_preset)i), column, column);
    }
}

static void write_presets(FILE *out, const help_style *style, const crv_method *method)
{
    char text[ENTRY_SIZE];
    size_t used = (size_t)snprintf(text, sizeof text, "what to spend: ");
    for (int i = 0; i < CRV_PRESET_COUNT && used < sizeof text; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s",
                                 i == 0 ? "" : "|", crv_preset_name((crv_preset)i));
    if (used < sizeof text)
        snprintf(text + used, sizeof text - used,
                 ". Options that are given themselves win over it [default %s]. For "
                 "--method %s:",
                 crv_preset_name(CRV_PRESET_MEDIUM), method->name);
    style->entry(out, "--preset NAME", text);
    for (int i = 0; i < CRV_PRESET_COUNT; i++)
        style->item(out, crv_preset_name((crv_preset)i),
                    crv_preset_text(method, (crv_preset)i));
}

static void write_library_options(FILE *out, const help_style *style, const command *c,
                                  const crv_method *method)
{
    char text[ENTRY_SIZE];
    style->heading(out, "Ambient occlusion");
    snprintf(text, sizeof text,
             "`crevice methods` says which method reads what. Defaults here are those of "
             "%s; `crevice %s --method NAME --help` has another's.",
             method->name, c->name);
    style->paragraph(out, text);
    size_t used = (size_t)snprintf(text, sizeof text, "how to estimate: ");
    for (int32_t i = 0; i < crv_method_count() && used < sizeof text; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s",
                                 i == 0 ? "" : "|", crv_method_at(i)->name);
    style->entry(out, "--method NAME", text);
    write_presets(out, style, method);
    used = (size_t)snprintf(text, sizeof text, "how to smooth the result: none");
    for (int32_t i = 0; i < crv_filter_count() && used < sizeof text; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "|%s",
                                 crv_filter_at(i)->name);
    style->entry(out, "--filter NAME", text);
    style->entry(out, "--options FILE",
                 "read key=value lines, as `crevice view` copies them (method, preset, "
                 "filter and all options); what the command line says wins");
    for (int32_t i = 0; i < crv_option_count(); i++)
        write_option(out, style, crv_option_at(i), method);
}

void help_write(FILE *out, const help_style *style, const command *c,
                const crv_method *method)
{
    style->opening(out, c);
    if (c->details)
        style->paragraph(out, c->details);
    for (size_t t = 0; c->tables[t]; t++) {
        style->heading(out, c->tables[t]->title);
        for (size_t i = 0; i < c->tables[t]->count; i++) {
            char head[128], text[ENTRY_SIZE];
            row_head(&c->tables[t]->rows[i], head, sizeof head);
            row_text(&c->tables[t]->rows[i], text, sizeof text);
            style->entry(out, head, text);
        }
    }
    if (c->library_options)
        write_library_options(out, style, c, method);
    style->closing(out, c);
}

static void open_plain(FILE *out, const command *c)
{
    fprintf(out, "usage: crevice %s %s\n\n", c->name, c->synopsis);
    write_wrapped(out, c->summary, 0, 0);
}

static void write_paragraph(FILE *out, const char *text)
{
    fputc('\n', out);
    write_wrapped(out, text, 0, 0);
}

static void write_heading(FILE *out, const char *text)
{
    fprintf(out, "\n%s:\n", text);
}

static void write_item(FILE *out, const char *head, const char *text)
{
    const int column = fprintf(out, "%*s%-8s", COLUMN + 2, "", head);
    write_wrapped(out, text, column, column);
}

static void close_plain(FILE *out, const command *c)
{
    write_heading(out, "Examples");
    for (size_t i = 0; c->examples[i]; i += 2)
        fprintf(out, "  # %s\n  %s\n", c->examples[i], c->examples[i + 1]);
}

void help_command(FILE *out, const command *c, const crv_method *method)
{
    help_write(out, &plain, c, method);
}

void help_overview(FILE *out, const command *const *commands, const help_topic *topics)
{
    fprintf(out, "usage: crevice COMMAND ...\n\n"
                 "Ambient occlusion from meshes, and from depth and normal passes.\n\n");
    for (size_t i = 0; commands[i]; i++) {
        char head[32];
        snprintf(head, sizeof head, "%-10s", commands[i]->name);
        fprintf(out, "  %s %s\n", head, commands[i]->summary);
    }
    fputc('\n', out);
    for (size_t i = 0; topics[i].name; i++)
        fprintf(out, "  help %-8s %s\n", topics[i].name, topics[i].summary);
    fprintf(out, "\n`crevice help COMMAND` says more; `crevice --version` the version.\n"
                 "Exit code: 0 done, 1 failed, 2 wrong usage.\n");
}

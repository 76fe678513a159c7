/* SPDX-License-Identifier: MIT */
/* help.h: help, written from the tables that the arguments are parsed with. */
#ifndef TOOL_HELP_H
#define TOOL_HELP_H

#include <stdio.h>

#include "args.h"

/* How a command's help is set: as text, or as a manual page. The words are the same. */
typedef struct help_style {
    void (*opening)(FILE *out, const command *c); /* name, synopsis, summary */
    void (*paragraph)(FILE *out, const char *text);
    void (*heading)(FILE *out, const char *text);
    void (*entry)(FILE *out, const char *head, const char *text); /* an option */
    void (*item)(FILE *out, const char *head, const char *text);  /* below an entry */
    void (*closing)(FILE *out, const command *c);                 /* examples */
} help_style;

void help_write(FILE *out, const help_style *style, const command *c,
                const crv_method *method);

/* All about one command; presets and defaults are those of the method. */
void help_command(FILE *out, const command *c, const crv_method *method);

/* A page of help that is not about one command. */
typedef struct help_topic {
    const char *name;
    const char *summary; /* one line */
    void (*write)(FILE *out);
} help_topic;

/* What there is; commands NULL-terminated, topics ending with a name that is NULL. */
void help_overview(FILE *out, const command *const *commands, const help_topic *topics);

/* A line of the library's option table: flag, help, unit, range, and the default that the
 * method has for it (NULL: the default method). */
void help_library_option(FILE *out, const crv_option *option, const crv_method *method);

/* What each preset of a method sets, a line each, indented. */
void help_presets(FILE *out, const crv_method *method, int indent);

/* "--max-radius-px" for "max_radius_px". */
void help_option_flag(const crv_option *option, char *out, size_t size);

/* The range or choices as the user would write them. */
void help_option_values(const crv_option *option, char *out, size_t size);

/* What a method has an option at by default: as a number, and as the user would write it.
 */
double help_default_value(const crv_option *option, const crv_method *method);
void help_option_default(const crv_option *option, const crv_method *method, char *out,
                         size_t size);

#endif

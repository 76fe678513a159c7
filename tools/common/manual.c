/* SPDX-License-Identifier: MIT */
/* manual.c: help as manual pages, in roff's man macros (man(7)). */
#include "manual.h"

#include <errno.h>
#include <string.h>

#include "help.h"

enum { PATH_SIZE = 4096, BREAK_COLUMN = 60 };

/* What roff would take for a request, an escape or a hyphen. Text within backquotes is
 * bold. Long lines are broken: only roff's own breaks count. */
static void put_text(FILE *out, const char *text)
{
    bool bold = false, begins = true;
    int column = 0;
    for (; *text != '\0'; text++, column++) {
        if (*text == ' ' && column > BREAK_COLUMN) {
            fputc('\n', out);
            column = -1;
            begins = true;
            continue;
        }
        if (*text == '`') {
            bold = !bold;
            fputs(bold ? "\\fB" : "\\fR", out);
        } else if (*text == '\\') {
            fputs("\\e", out);
        } else if (*text == '-') {
            fputs("\\-", out);
        } else if (*text == '|') {
            fputs("|\\:", out); /* may break here */
        } else {
            fprintf(out, begins && (*text == '.' || *text == '\'') ? "\\&%c" : "%c",
                    *text);
        }
        begins = false;
    }
}

static void put_line(FILE *out, const char *text)
{
    put_text(out, text);
    fputc('\n', out);
}

static void put_title(FILE *out, const char *name)
{
    fputs(".TH ", out);
    for (const char *p = name; *p != '\0'; p++)
        fputc(*p >= 'a' && *p <= 'z' ? *p - 'a' + 'A' : *p, out);
    fprintf(out, " 1 \"\" \"Crevice %s\" \"User Commands\"\n.ad l\n.SH NAME\n",
            crv_version());
    put_line(out, name);
}

static void open_page(FILE *out, const command *c)
{
    char name[64];
    snprintf(name, sizeof name, "crevice-%s", c->name);
    put_title(out, name);
    fputs("\\- ", out);
    put_line(out, c->summary);
    fprintf(out, ".SH SYNOPSIS\n.B crevice %s\n", c->name);
    put_line(out, c->synopsis);
    if (c->details)
        fputs(".SH DESCRIPTION\n", out);
}

static void put_paragraph(FILE *out, const char *text)
{
    put_line(out, text);
}

static void put_heading(FILE *out, const char *text)
{
    fputs(".SH \"", out);
    for (const char *p = text; *p != '\0'; p++)
        fputc(*p >= 'a' && *p <= 'z' ? *p - 'a' + 'A' : *p, out);
    fputs("\"\n", out);
}

static void put_entry(FILE *out, const char *head, const char *text)
{
    fputs(".TP\n\\fB", out);
    put_text(out, head);
    fputs("\\fR\n", out);
    put_line(out, text);
}

static void put_item(FILE *out, const char *head, const char *text)
{
    fputs(".RS\n.TP\n", out);
    put_line(out, head);
    put_line(out, text);
    fputs(".RE\n", out);
}

static void close_page(FILE *out, const command *c)
{
    fputs(".SH EXAMPLES\n", out);
    for (size_t i = 0; c->examples[i]; i += 2) {
        fputs(".TP\n", out);
        put_line(out, c->examples[i]);
        fputs("\\fB", out);
        put_text(out, c->examples[i + 1]);
        fputs("\\fR\n", out);
    }
    fputs(".SH \"EXIT STATUS\"\n0 if done, 1 if it failed, 2 for wrong usage.\n"
          ".SH \"SEE ALSO\"\n.BR crevice (1)\n",
          out);
}

static const help_style roff = {.opening = open_page,
                                .paragraph = put_paragraph,
                                .heading = put_heading,
                                .entry = put_entry,
                                .item = put_item,
                                .closing = close_page};

void manual_command(FILE *out, const command *c)
{
    char method[] = "--method";
    char *none[] = {method};
    help_write(out, &roff, c, args_method(c, 0, none));
}

void manual_overview(FILE *out, const command *const *commands)
{
    put_title(out, "crevice");
    fputs("\\- ambient occlusion from meshes, and from depth and normal passes\n"
          ".SH SYNOPSIS\n.B crevice\n.I COMMAND\n\\&...\n.SH COMMANDS\n",
          out);
    for (size_t i = 0; commands[i]; i++) {
        fprintf(out, ".TP\n.BR crevice\\-%s (1)\n", commands[i]->name);
        put_line(out, commands[i]->summary);
    }
    fputs(".TP\n.B crevice help COMMAND\nhelp of a command, with the defaults of a "
          "method behind \\fB\\-\\-method\\fR\n"
          ".TP\n.B crevice \\-\\-version\nthe version\n"
          ".SH \"EXIT STATUS\"\n0 if done, 1 if it failed, 2 for wrong usage.\n",
          out);
}

static FILE *open_file(const char *folder, const char *name, report *r)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *out = fopen(path, "w");
    if (!out)
        report_error(r, "%s: cannot be written (%s); name a folder that is there", path,
                     strerror(errno));
    return out;
}

static int close_file(FILE *out, const char *name, report *r)
{
    const bool written = ferror(out) == 0;
    if (fclose(out) == 0 && written)
        return EXIT_DONE;
    report_error(r, "%s: cannot be written; is the disk full?", name);
    return EXIT_FAILED;
}

int manual_write_all(const char *folder, const command *const *commands, report *r)
{
    static const struct {
        const char *shell, *name;
    } shells[] = {
        {"bash", "crevice.bash"}, {"zsh", "_crevice"}, {"fish", "crevice.fish"}};
    FILE *out = open_file(folder, "crevice.1", r);

    if (!out)
        return EXIT_FAILED;
    manual_overview(out, commands);
    int result = close_file(out, "crevice.1", r);
    for (size_t i = 0; commands[i] && result == EXIT_DONE; i++) {
        char name[64];
        snprintf(name, sizeof name, "crevice-%s.1", commands[i]->name);
        out = open_file(folder, name, r);
        if (!out)
            return EXIT_FAILED;
        manual_command(out, commands[i]);
        result = close_file(out, name, r);
    }
    for (size_t i = 0; i < sizeof shells / sizeof shells[0] && result == EXIT_DONE; i++) {
        out = open_file(folder, shells[i].name, r);
        if (!out)
            return EXIT_FAILED;
        completion_write(out, shells[i].shell, commands);
        result = close_file(out, shells[i].name, r);
    }
    return result;
}

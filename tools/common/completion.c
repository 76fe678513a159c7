/* SPDX-License-Identifier: MIT */
/* completion.c: what shells complete, from the tables of the arguments. */
#include <string.h>

#include "help.h"
#include "manual.h"
#include "scene.h"

enum { WORDS_MAX = 96 };

/* What an argument may be. Nothing of it: any text. */
typedef struct values {
    const char *at[WORDS_MAX];
    int32_t count;
    bool files, list; /* list: words with commas between */
} values;

/* One thing to complete: an option, or what goes without one. */
typedef struct item {
    const char *flag; /* "" without one */
    char short_name;
    bool takes_value;
    const char *help;
    values v;
} item;

static void add(values *v, const char *word)
{
    if (v->count < WORDS_MAX)
        v->at[v->count++] = word;
}

static void add_all(values *v, const char *const *words)
{
    for (size_t i = 0; words && words[i]; i++)
        add(v, words[i]);
}

static void add_methods(values *v)
{
    for (int32_t i = 0; i < crv_method_count(); i++)
        add(v, crv_method_at(i)->name);
}

static void add_filters(values *v)
{
    for (int32_t i = 0; i < crv_filter_count(); i++)
        add(v, crv_filter_at(i)->name);
}

static void add_presets(values *v)
{
    for (int i = 0; i < CRV_PRESET_COUNT; i++)
        add(v, crv_preset_name((crv_preset)i));
}

static void add_isas(values *v)
{
    for (int i = 0; crv_isa_name((crv_isa)i); i++)
        add(v, crv_isa_name((crv_isa)i));
}

/* Rows say by the name of their value what it is. */
static values values_of(const arg *row)
{
    static const char *const files[] = {"FILE", "DIR",   "SKY",   "IN", "A",
                                        "B",    "MODEL", "INPUT", NULL};
    const char *what = row->value ? row->value : row->name;
    values v = {.list = row->type == ARG_TEXTS && row->name[0] == '-'};
    if (row->type == ARG_CHOICE)
        for (int32_t i = 0; arg_choice(row, i); i++)
            add(&v, arg_choice(row, i));
    else if (strncmp(what, "METHOD", 6) == 0)
        add_methods(&v);
    else if (strncmp(what, "PRESET", 6) == 0)
        add_presets(&v);
    else if (strncmp(what, "FILTER", 6) == 0)
        add(&v, "none"), add_filters(&v);
    else if (strncmp(what, "ISA", 3) == 0)
        add_isas(&v);
    else if (strcmp(what, "DEVICE") == 0)
        add(&v, "cpu"), add(&v, "vulkan");
    else if (strcmp(row->name, "NAME") == 0)
        add_methods(&v), add_filters(&v);
    for (size_t i = 0; files[i]; i++)
        v.files = v.files || strcmp(what, files[i]) == 0;
    if (strcmp(what, "MODEL") == 0 || strcmp(what, "INPUT") == 0)
        add(&v, "builtin:courtyard");
    return v;
}

/* Calls write for every option and positional argument of the command. */
static void each_item(FILE *out, const command *c,
                      void (*write)(FILE *out, const command *c, const item *i))
{
    for (size_t t = 0; c->tables[t]; t++)
        for (size_t i = 0; i < c->tables[t]->count; i++) {
            const arg *row = &c->tables[t]->rows[i];
            write(out, c,
                  &(item){.flag = row->name[0] == '-' ? row->name : "",
                          .short_name = row->short_name,
                          .takes_value = row->type != ARG_FLAG,
                          .help = row->help,
                          .v = values_of(row)});
        }
    if (!c->library_options)
        return;
    item method = {.flag = "--method", .takes_value = true, .help = "how to estimate"};
    item preset = {.flag = "--preset", .takes_value = true, .help = "what to spend"};
    item filter = {.flag = "--filter", .takes_value = true, .help = "how to smooth"};
    const item file = {
        .flag = "--options", .takes_value = true, .help = "file of options"};
    add_methods(&method.v);
    add_presets(&preset.v);
    add(&filter.v, "none");
    add_filters(&filter.v);
    write(out, c, &method);
    write(out, c, &preset);
    write(out, c, &filter);
    write(out, c, &file);
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        char flag[80];
        item of = {.flag = flag, .takes_value = true, .help = option->help};
        help_option_flag(option, flag, sizeof flag);
        if (option->type == CRV_OPTION_CHOICE)
            add_all(&of.v, option->choices);
        else if (option->type == CRV_OPTION_BOOL)
            add(&of.v, "on"), add(&of.v, "off");
        write(out, c, &of);
    }
}

static void put_words(FILE *out, const values *v)
{
    for (int32_t i = 0; i < v->count; i++)
        fprintf(out, "%s%s", i == 0 ? "" : " ", v->at[i]);
}

static void put_names(FILE *out, const command *const *commands)
{
    for (size_t i = 0; commands[i]; i++)
        fprintf(out, "%s ", commands[i]->name);
    fputs("help", out);
}

/* A branch of a case over "COMMAND OPTION". */
static void put_bash_item(FILE *out, const command *c, const item *i)
{
    if (!i->takes_value)
        return;
    fprintf(out, "    '%s %s'", c->name, i->flag);
    if (i->short_name != 0)
        fprintf(out, "|'%s -%c'", c->name, i->short_name);
    fprintf(out, ")\n        files=%s list=%s words='", i->v.files ? "yes" : "no",
            i->v.list ? "yes" : "no");
    put_words(out, &i->v);
    fputs("' ;;\n", out);
}

static void put_flag(FILE *out, const command *c, const item *i)
{
    (void)c;
    if (i->flag[0] != '\0')
        fprintf(out, "%s ", i->flag);
}

static void put_bash(FILE *out, const command *const *commands)
{
    fputs("# bash completion of crevice, made by it\n"
          "_crevice()\n{\n"
          "    local word=$2 before=$3 command=${COMP_WORDS[1]} files=no list=no words=\n"
          "    COMPREPLY=()\n"
          "    if [ \"$COMP_CWORD\" -eq 1 ] || [ \"$command\" = help ]; then\n"
          "        COMPREPLY=($(compgen -W '",
          out);
    put_names(out, commands);
    fputs(" --help --version' -- \"$word\"))\n        return\n    fi\n"
          "    # --option=value comes as three words.\n"
          "    [ \"$word\" = = ] && word=\n"
          "    [ \"$before\" = = ] && before=${COMP_WORDS[COMP_CWORD - 2]}\n"
          "    case $word in\n    -*) before= ;;\n    esac\n"
          "    case $before in\n    -*) ;;\n    *) before= ;;\n    esac\n"
          "    case \"$command $before\" in\n",
          out);
    for (size_t i = 0; commands[i]; i++)
        each_item(out, commands[i], put_bash_item);
    fputs("    *) before= ;; # takes no value\n    esac\n"
          "    case $word in\n    -*)\n        files=no list=no words=\n"
          "        case $command in\n",
          out);
    for (size_t i = 0; commands[i]; i++) {
        fprintf(out, "        %s) words='", commands[i]->name);
        each_item(out, commands[i], put_flag);
        fputs("--help' ;;\n", out);
    }
    fputs("        esac ;;\n    esac\n"
          "    if [ $list = yes ] && [ \"$word\" != \"${word%,*}\" ]; then\n"
          "        local done=${word%,*},\n"
          "        COMPREPLY=($(compgen -P \"$done\" -W \"$words\" -- \"${word##*,}\"))\n"
          "    else\n"
          "        COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
          "    fi\n"
          "    if [ $files = yes ]; then\n"
          "        compopt -o filenames 2>/dev/null\n"
          "        COMPREPLY+=($(compgen -f -- \"$word\"))\n"
          "    fi\n"
          "}\ncomplete -F _crevice crevice\n",
          out);
}

/* Within single quotes; zsh takes brackets and colons for its own. */
static void put_quoted(FILE *out, const char *text, const char *escaped)
{
    for (; *text != '\0'; text++) {
        if (*text == '\'')
            fputs("'\\'", out);
        else if (strchr(escaped, *text))
            fputc('\\', out);
        fputc(*text, out);
    }
}

static void put_zsh_item(FILE *out, const command *c, const item *i)
{
    (void)c;
    fputs(" \\\n            '", out);
    if (i->flag[0] != '\0') {
        if (i->short_name != 0)
            fprintf(out, "(-%c %s)'{-%c,%s}'", i->short_name, i->flag, i->short_name,
                    i->flag);
        else
            fprintf(out, "%s%s", i->v.list ? "*" : "", i->flag);
        fputc('[', out);
        put_quoted(out, i->help, "[]:\\");
        fputc(']', out);
    } else {
        fputc('*', out);
    }
    if (i->takes_value) {
        fputs(": :", out);
        if (i->v.count > 0 && i->v.list)
            fputs("_values -s , value ", out);
        else if (i->v.count > 0 && !i->v.files)
            fputc('(', out);
        if (i->v.files)
            fputs("_files", out);
        else
            put_words(out, &i->v);
        if (i->v.count > 0 && !i->v.list && !i->v.files)
            fputc(')', out);
    }
    fputc('\'', out);
}

static void put_zsh(FILE *out, const command *const *commands)
{
    fputs("#compdef crevice\n# zsh completion of crevice, made by it\n"
          "_crevice() {\n    if (( CURRENT == 2 )); then\n        compadd ",
          out);
    put_names(out, commands);
    fputs(" -- --help --version\n        return\n    fi\n"
          "    local of=$words[2]\n    shift words\n    (( CURRENT-- ))\n"
          "    case $of in\n    help) compadd ",
          out);
    put_names(out, commands);
    fputs(" ;;\n", out);
    for (size_t i = 0; commands[i]; i++) {
        fprintf(out, "    %s)\n        _arguments '--help[help]'", commands[i]->name);
        each_item(out, commands[i], put_zsh_item);
        fputs(" ;;\n", out);
    }
    fputs("    esac\n}\n_crevice \"$@\"\n", out);
}

static void put_fish_item(FILE *out, const command *c, const item *i)
{
    fprintf(out, "complete -c crevice -n '__fish_seen_subcommand_from %s'", c->name);
    if (i->flag[0] != '\0')
        fprintf(out, " -l %s", i->flag + 2);
    if (i->short_name != 0)
        fprintf(out, " -s %c", i->short_name);
    if (i->v.files)
        fputs(i->flag[0] != '\0' ? " -r -F" : " -F", out);
    else if (i->takes_value && i->flag[0] != '\0')
        fputs(" -x", out);
    if (i->v.count > 0) {
        fputs(i->v.list ? " -a '(__fish_append , " : " -a '", out);
        put_words(out, &i->v);
        fputs(i->v.list ? ")'" : "'", out);
    }
    fputs(" -d '", out);
    for (const char *p = i->help; *p != '\0'; p++)
        fprintf(out, *p == '\'' || *p == '\\' ? "\\%c" : "%c", *p);
    fputs("'\n", out);
}

static void put_fish(FILE *out, const command *const *commands)
{
    fputs("# fish completion of crevice, made by it\ncomplete -c crevice -f\n", out);
    for (size_t i = 0; commands[i]; i++) {
        fprintf(out, "complete -c crevice -n __fish_use_subcommand -a %s -d '",
                commands[i]->name);
        put_quoted(out, commands[i]->summary, "\\");
        fputs("'\n", out);
    }
    for (size_t i = 0; commands[i]; i++)
        each_item(out, commands[i], put_fish_item);
}

bool completion_write(FILE *out, const char *shell, const command *const *commands)
{
    if (strcmp(shell, "bash") == 0)
        put_bash(out, commands);
    else if (strcmp(shell, "zsh") == 0)
        put_zsh(out, commands);
    else if (strcmp(shell, "fish") == 0)
        put_fish(out, commands);
    else
        return false;
    return true;
}

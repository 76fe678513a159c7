/* SPDX-License-Identifier: MIT */
/*
 * args.h: arguments as rows of tables. A row says what the argument is called, which
 * values it takes, what it is by default and where its value goes; parsing, checks and
 * help all come from it. A command's settings are a struct that begins with struct
 * common_settings; rows address its members by offset.
 */
#ifndef TOOL_ARGS_H
#define TOOL_ARGS_H

#include "report.h"

typedef enum arg_type {
    ARG_FLAG,   /* bool; takes no value */
    ARG_TEXT,   /* const char *; NULL unless given */
    ARG_TEXTS,  /* arg_texts; may be given again, also as the last one without a flag */
    ARG_INT,    /* arg_int */
    ARG_NUMBER, /* arg_number; infinite only if max is */
    ARG_VECTOR, /* arg_vector: X,Y,Z */
    ARG_SIZE,   /* arg_size: WxH */
    ARG_CHOICE  /* arg_int: the index of one of the choices */
} arg_type;

/* given: by the user. Where the row has a default, the value is set anyway. */
typedef struct arg_int {
    bool given;
    int32_t value;
} arg_int;

typedef struct arg_number {
    bool given;
    double value;
} arg_number;

typedef struct arg_vector {
    bool given;
    double value[3];
} arg_vector;

typedef struct arg_size {
    bool given;
    int32_t width, height;
} arg_size;

#define ARG_TEXTS_MAX 64

typedef struct arg_texts {
    int32_t count;
    const char *value[ARG_TEXTS_MAX];
} arg_texts;

typedef struct arg {
    const char *name;  /* "--size", or "MODEL" for what goes without a flag */
    char short_name;   /* 'o' for -o; 0 for none */
    const char *value; /* what help calls the value */
    arg_type type;
    bool required;   /* texts only */
    size_t offset;   /* of the member in the settings */
    double min, max; /* int and number; inclusive */
    /* NULL-terminated. Of a number: the one word that may stand for it, read as NAN. */
    const char *const *choices;
    /* The choices, if the library has their names: NULL behind the last. */
    const char *(*choice_name)(int32_t index);
    const char *unit;
    const char *initial;  /* the default as the user would write it; parsed like it */
    const char *computed; /* in help, if the default depends on the input */
    const char *help;
} arg;

/* A row's choice of this index; NULL behind the last. */
const char *arg_choice(const arg *row, int32_t index);

/* In a row: what its value is and where it goes; the range of a number. */
#define ARG_INTO(type_, settings_, member_)                                              \
    .type = type_, .offset = offsetof(settings_, member_)
#define ARG_RANGE(min_, max_) .min = min_, .max = max_

/* The row of the file that a command writes. */
#define ARG_OUTPUT_ROW(settings_, member_, help_)                                        \
    {                                                                                    \
        .name = "--output", .short_name = 'o', .value = "FILE", .required = true,        \
        ARG_INTO(ARG_TEXT, settings_, member_), .help = help_                            \
    }

typedef struct arg_table {
    const char *title;
    const arg *rows;
    size_t count;
} arg_table;

#define ARG_TABLE(title_, rows_)                                                         \
    {                                                                                    \
        title_, rows_, sizeof(rows_) / sizeof((rows_)[0])                                \
    }

/* What all commands have. */
typedef struct common_settings {
    bool quiet, verbose;
    arg_int threads;
    const char *device; /* as written; NULL: the CPU */
    const char *isa;    /* as written; NULL: the fastest */
    bool exact;
    /* Of plans on a GPU: what `crevice bench` compares. */
    int32_t depth_layout; /* crv_vulkan_depth_layout */
    bool half_filters;
    crv_options options; /* commands with library_options only */
    bool radius_given;
} common_settings;

extern const arg_table args_output_lines; /* --quiet, --verbose */
extern const arg_table args_threads;      /* --threads */
extern const arg_table args_device;       /* --device, --isa, --exact; see device.h */
extern const char *const args_png_bits[]; /* choices: 8, 16 */

typedef struct command {
    const char *name;
    const char *summary;            /* one line */
    const char *synopsis;           /* what follows the name, without options */
    const char *details;            /* a paragraph of help, or NULL */
    const arg_table *const *tables; /* NULL-terminated */
    /* Takes --method, --preset, --filter and the option table. */
    bool library_options;
    /* With this flag and without --method, that method is the default. NULL: none. */
    const char *method_flag, *method_of_flag;
    const char *const *examples; /* NULL-terminated: comment, line, comment, line ... */
    size_t settings_size;
    int (*run)(const void *settings, report *r); /* returns an exit code */
    const char *program; /* instead of run: a program beside this one that is run with the
                            same arguments; NULL: none */
} command;

/* Fills zeroed settings from argv (what follows the command's name). Returns EXIT_DONE
 * or, after an error line, EXIT_USAGE. */
int args_parse(const command *c, int argc, char **argv, void *settings, report *r);

/* The method that these arguments choose, the default one if they name none that
 * there is. For help; args_parse() finds it by itself. */
const crv_method *args_method(const command *c, int argc, char **argv);

/* Reads one value into the row's member; false if it is not valid. */
bool args_set_value(const arg *row, const char *text, void *settings);

/* What values a row takes ("0.1 to 179 degrees"), "" if any text is fine. */
void args_describe_values(const arg *row, char *out, size_t size);

/* A whole finite or infinite number, nothing before or after it. */
bool args_number(const char *text, double *out);

/* "1,2,3": at most max finite numbers. Returns how many there are, or -1. */
int args_numbers(const char *text, double *out, int max);

#endif

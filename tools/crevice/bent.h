/* SPDX-License-Identifier: MIT */
/*
 * bent.h: bent normals, which stand beside accessibility in a result: channel 0 is AO,
 * channels 1 to 3 are x, y and z, in view space as estimate_run() gives them.
 */
#ifndef TOOL_BENT_H
#define TOOL_BENT_H

#include "common/args.h"
#include "io.h"

typedef enum bent_space { BENT_VIEW = 0, BENT_WORLD = 1 } bent_space;
extern const char *const bent_spaces[]; /* in this order */

typedef struct bent_settings {
    arg_int space;
    const char *output; /* NULL: none of their own */
} bent_settings;

/* The rows, for a table of settings that have them as `member_`. computed_: the default
 * space. */
#define BENT_ROWS(settings_, member_, computed_)                                         \
    {.name = "--bent-space",                                                             \
     .value = "SPACE",                                                                   \
     .choices = bent_spaces,                                                             \
     .computed = computed_,                                                              \
     ARG_INTO(ARG_CHOICE, settings_, member_.space),                                     \
     .help = "for --bent-normal: the space of bent.X bent.Y bent.Z"},                    \
    {                                                                                    \
        .name = "--bent-output", .value = "FILE",                                        \
        ARG_INTO(ARG_TEXT, settings_, member_.output),                                   \
        .help = "for --bent-normal: also write them as a picture of their own; .png "    \
                "for the eye (n / 2 + 1/2), .exr or .pfm as they are"                    \
    }

/* Whether a result has them. */
bool bent_is_there(const io_image *result);

/* The name of component k, 1 to 3, of their layer. */
void bent_name(const char *layer, int32_t k, char out[IO_NAME_SIZE]);

/* Checks the settings, and that the method gives bent normals if they are wanted. output:
 * the command's. Returns an exit code. */
int bent_check(const bent_settings *s, const crv_options *options, const char *output,
               report *r);

/* Turns view space to another: to_view says how that is turned to view space. */
void bent_turn(io_image *result, const double to_view[9]);

/* The result without them: a view, not to be freed. */
io_image bent_left_out(const io_image *result);

/* Writes them alone. Returns an exit code. */
int bent_write(const char *path, const io_image *result, const io_write_options *options,
               report *r);

#endif

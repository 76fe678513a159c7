/* SPDX-License-Identifier: MIT */
/* test_io_support.h: a folder to write to, a logger that remembers, EXR files made with
 * OpenEXRCore alone. */
#ifndef TESTS_TEST_IO_SUPPORT_H
#define TESTS_TEST_IO_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <openexr.h>

#include "io.h"

/* Group setup and teardown: makes and removes the folder that support_path() is in. */
int support_setup(void **state);
int support_teardown(void **state);

/* "FOLDER/name"; the last eight results stay valid. */
const char *support_path(const char *name);

/* Number of files in the folder, and whether one begins with a dot (a leftover). */
int support_file_count(bool *leftovers);

void support_write_file(const char *path, const void *data, size_t size);
/* The caller frees the result. */
unsigned char *support_read_file(const char *path, size_t *size);

/* Remembers lines; support_forget() empties it. */
typedef struct support_log {
    int errors, warnings, infos;
    char error[4096]; /* the last error */
    char text[32768]; /* all lines, each with a newline */
} support_log;
extern support_log support_lines;
const crv_logger *support_logger(void);
void support_forget(void);

/* Asserts that exactly one error line was logged, that it begins with "path: ", has a
 * remedy after a semicolon and contains `part`; then forgets it. */
void support_expect_error(const char *path, const char *part);

typedef struct support_part {
    const char *name; /* NULL in single-part files */
    exr_storage_t storage;
    exr_compression_t compression;
    int32_t min_x, min_y, width, height; /* data window */
    int32_t tile_width, tile_height;
    int32_t sampling; /* of the last channel; 0 is 1 */
    int channel_count;
    const char *channels[8]; /* sorted by name */
    exr_pixel_type_t types[8];
    const float *world_to_ndc; /* of this part alone; NULL for none */
    const char *view;          /* the attribute; NULL for none */
} support_part;

/* The value that channel c of part p holds at pixel (x, y) of the data window: a number
 * that half floats hold exactly. */
float support_value(int p, int c, int32_t x, int32_t y);

/* Writes such a file. display: NULL for the data window of the first part. matrices: NULL
 * or worldToCamera and worldToNDC, each of which may be NULL. */
void support_make_exr(const char *path, const support_part *parts, int count,
                      const int32_t display[4], const float *world_to_camera,
                      const float *world_to_ndc);

/* Turns a scanline file into one with decreasing y: chunks stored from the bottom to the
 * top. By hand, because OpenEXRCore cannot write them (seen in 3.1.5). */
void support_turn_upside_down(const char *path, int chunks);

/* Writes depth 1 with up to two float attributes; a name that is NULL is none. */
void support_make_lens_exr(const char *path, int32_t width, int32_t height,
                           const char *const names[2], const float values[2]);

/* Writes a plain float file with these pixels: planes[c][y * width + x]. */
void support_make_plain_exr(const char *path, const char *const *names, int count,
                            int32_t width, int32_t height, const float *const *planes);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * internal.h: what the files of this room share: messages, files being read and written,
 * and the row that each format fills in the table of format.c.
 */
#ifndef CREVICE_IO_INTERNAL_H
#define CREVICE_IO_INTERNAL_H

#include <stdarg.h>
#include <stdio.h>

#include "io.h"
#include "system/file.h"
#include "system/new_file.h"
#include "system/text.h"

#if defined(__GNUC__)
#define IO__PRINTF(f, a) __attribute__((format(printf, f, a)))
#else
#define IO__PRINTF(f, a)
#endif

/* One line "path: message" to the logger. io__fail() returns -1. */
int io__fail(const crv_logger *log, const char *path, const char *format, ...)
    IO__PRINTF(3, 4);
void io__warn(const crv_logger *log, const char *path, const char *format, ...)
    IO__PRINTF(3, 4);
void io__info(const crv_logger *log, const char *path, const char *format, ...)
    IO__PRINTF(3, 4);

/* Fails with the list of the channels that `image` has and the nearest of them. */
int io__fail_channel(const crv_logger *log, const char *path, const char *wanted,
                     const io_image *image);

/* The channel whose name is nearest, or NULL if none is near. */
const char *io__nearest_channel(const io_image *image, const char *wanted);

/* Writes "A, B, C" into out, cut short with "... (N in all)" if it does not fit. */
void io__list_channels(const io_image *image, char *out, size_t size);

/* Checks 1 <= width, height <= CRV_MAX_SIZE. 64 bits, so that no sum overflowed. */
int io__check_size(const crv_logger *log, const char *path, int64_t width,
                   int64_t height);

/* A regular file, open for reading. */
typedef struct io__file {
    const char *path; /* as the caller wrote it, for messages */
    FILE *stream;
    int64_t size;
    const crv_logger *log;
    const io_watch *watch; /* of the reading; NULL: nobody */
} io__file;

/* fread() and fwrite() that go on after EINTR: fewer bytes than `size` are the end of the
 * file or, with errno set, an error. */
size_t io__read(FILE *stream, void *bytes, size_t size);
size_t io__write(FILE *stream, const void *bytes, size_t size);

/* Half floats by their 16 bits. Rounded to the nearest, ties to even. */
float io__float_of_half(uint32_t half);
uint32_t io__half_of_float(float value);

/* A picture being written. */
typedef struct io__output {
    const char *path; /* as the caller wrote it, for messages */
    new_file file;    /* its target has links followed */
    const crv_logger *log;
    bool (*stop)(void);    /* io_write_options.stop */
    const io_watch *watch; /* io_write_options.watch */
} io__output;

/* Opens the temporary file, and removes those that killed processes left beside it. After
 * success, one of commit or discard must follow. */
int io__output_open(io__output *output, const char *path, const crv_logger *log);
/* Brings the data to disk and puts the file in place of the target. */
int io__output_commit(io__output *output);
void io__output_discard(io__output *output);
/* Logs the failed write with errno's reason; returns -1. */
int io__output_fail(const io__output *output);
/* Tells the watch, which may be NULL, that so many of all rows or chunks are done. Other
 * threads than the one that began the work are not heard. */
void io__tell(const io_watch *watch, int64_t done, int64_t count);
/* Whether the caller wants no more of it, from any thread; then io__output_stopped() logs
 * that and returns -1. */
bool io__output_stops(const io__output *output);
int io__output_stopped(const io__output *output);
/* The file that a path names, links followed, if it can be written; NULL after an error
 * line. The caller frees it. */
char *io__writable_target(const char *path, const crv_logger *log);

/* Opens a regular file for reading; the caller closes its stream. Logs the error. */
int io__file_open(const char *path, const crv_logger *log, io__file *file);

/* A row of the format table. The functions log their own errors and return 0 or -1. */
typedef struct io__format {
    const char *name;
    const char *extension;
    /* Whether a file that begins with these bytes is of this format. */
    bool (*recognises)(const unsigned char *head, size_t size);
    int (*probe)(const io__file *file, io_image *out);
    /* names as in io_read(). */
    int (*read)(const io__file *file, const char *const *names, int32_t count,
                io_image *out);
    int (*write)(io__output *output, const io_image *image,
                 const io_write_options *options);
} io__format;

extern const io__format io__format_exr, io__format_png, io__format_pfm;

/* Reduces `all`, which it takes over, to the named channels; for formats that cannot read
 * single channels. */
int io__select_channels(const io__file *file, io_image *all, const char *const *names,
                        int32_t count, io_image *out);

/* The channels of a grey or colour picture: "Y", "R", "G", "B" and "A". */
int io__image_init_colour(io_image *image, int32_t width, int32_t height,
                          int32_t channels, const io__file *file);

/* The same channels without pixels, for probing. */
int io__probe_colour(const io__file *file, int32_t width, int32_t height,
                     int32_t channels, io_image *out);

/* Which channels make up a picture of one or three components: indices, or -1 after an
 * error line. Returns their count. */
int io__colour_channels(const io_image *image, int32_t index[3], const char *path,
                        const char *format, const crv_logger *log);

/* A line of OpenMP, if it is built with that. */
#ifdef _OPENMP
#define IO__OMP_TEXT(...) _Pragma(#__VA_ARGS__)
#define IO__OMP(...)      IO__OMP_TEXT(omp __VA_ARGS__)
#define IO__OMP_FOR(...)  IO__OMP_TEXT(omp for __VA_ARGS__)
#else
#define IO__OMP(...)
#define IO__OMP_FOR(...)
#endif

#endif

/* SPDX-License-Identifier: MIT */
/*
 * append.h: a copy of an EXR file with further channels beside its own, or with pictures
 * multiplied into its own. Everything else stays as it is, bit for bit: parts, channels
 * and their types, attributes, deep pixels, mip-maps.
 */
#ifndef CREVICE_IO_APPEND_H
#define CREVICE_IO_APPEND_H

#include "io.h"

/* A picture and what becomes of it. */
typedef struct io_addition {
    const io_image *picture; /* lies where its data window says. NULL in
                                io_append_check() */
    int32_t channel;         /* of the picture */
    const char *beside;      /* a channel of the file, as io_probe() names it. The picture
                                belongs to the same part and eye */
    const char *name;        /* of the new channel. The attribute "crevice.NAME" holds: */
    const char *made;        /* what made the picture; NULL: there is no attribute */
    bool is_added;           /* false: only multiplied */
    bool zero_outside;       /* pixels that the picture does not cover get 0, not 1 */
    /* In a file of several parts: the name of the new part, which several additions may
     * share. NULL: that of the channel. */
    const char *part;
    /* Channels of the file to multiply, as io_probe() names them. */
    int32_t multiplied_count;
    const char *const *multiplied;
    /* What red, green and blue are multiplied by: three channels, others get their mean.
     * NULL: the picture's channel multiplies all. Unused in io_append_check(). */
    const io_image *factors;
} io_addition;

typedef struct io_append_options {
    bool half;    /* new channels hold half floats instead of floats */
    bool replace; /* a channel of the new name is replaced; otherwise an error */
    float
        tint[3]; /* multiplied channels get c * (tint + (1 - tint) * picture); red, green
                      and blue ones their own tint, others the mean of the three */
    bool (*stop)(void);    /* as io_write_options.stop */
    const io_watch *watch; /* as io_write_options.watch */
} io_append_options;

/*
 * Writes the copy, as io_write() writes. A file of one part gets further channels in that
 * part; a file of several gets further parts. A part whose channels are added to or
 * multiplied keeps its compression if that is lossless; what lossy compression left of
 * its pixels is written with ZIP. Other parts are copied as they are packed. Errors: deep
 * and mip-mapped parts cannot be added to or multiplied, nor can channels of integers.
 */
int io_append(const char *input, const char *output, const io_addition *additions,
              int32_t count, const io_append_options *options, const crv_logger *log);

/* The errors that io_append() would find before it writes, from the header alone. */
int io_append_check(const char *input, const io_addition *additions, int32_t count,
                    const io_append_options *options, const crv_logger *log);

/* What made the channel that io_append() added or multiplied: "" if the file is not
 * whole, or does not say. Nothing is logged. */
void io_append_made(const char *path, const char *name, char made[IO_MADE_SIZE]);

#endif

/* SPDX-License-Identifier: MIT */
/* exr.h: an open EXR file, shared by exr_file.c, exr_chunks.c and exr_read.c. */
#ifndef CREVICE_IO_EXR_H
#define CREVICE_IO_EXR_H

#include <openexr.h>

#include "internal.h"

typedef struct io__exr_channel {
    int part;
    int32_t index; /* in the part's channel list */
    bool subsampled, is_half;
    char name[IO_NAME_SIZE]; /* as io_channel.name */
} io__exr_channel;

typedef struct io__exr {
    const io__file *file;
    exr_context_t context;
    int io_error; /* errno of a failed read */
    int part_count;
    bool has_deep_parts;
    int32_t channel_count;
    int32_t channel_capacity;  /* no part has more channels, left out ones included */
    io__exr_channel *channels; /* of all flat parts; owned */
} io__exr;

/* Opens the file and lists its channels. */
int io__exr_open(const io__file *file, io__exr *exr);
void io__exr_close(io__exr *exr);

/* An error handler for OpenEXR's contexts. */
void io__exr_say_nothing(exr_const_context_t context, exr_result_t code,
                         const char *text);

/* Logs `what` with what the code means, or why the disk could not be read; returns -1. */
int io__exr_fail(const io__exr *exr, exr_result_t code, const char *what);

/* The field of view in the attributes of a part, as renderers name them (lens.c). */
void io__exr_find_lens(const io__exr *exr, int part, io_lens *lens);

/* Windows, pixel aspect and camera; the data window is that of `part`. The channels are
 * left alone. */
int io__exr_metadata(const io__exr *exr, int part, io_image *image);

/*
 * Whether all of a part's pixels are in the file, before memory is taken for them: finds
 * a file that was cut off or whose header claims more than it holds. Logs the error.
 */
int io__exr_check_part(io__exr *exr, int part);

/* Reads a part. targets: for each channel of the part, in its order, the place for the
 * data window's pixels, or NULL if it is not wanted. */
int io__exr_read_part(io__exr *exr, int part, float *const *targets);

/* The writer of exr_write.c. */
int io__exr_write(io__output *output, const io_image *image,
                  const io_write_options *options);

/* The channel list as an image without pixels; io_image_free() frees it. */
int io__exr_list(const io__exr *exr, io_image *image);

#endif

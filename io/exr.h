/* SPDX-License-Identifier: MIT */
/* exr.h: an open EXR file, shared by the files that read, write and copy them. */
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
/* The channel of this name, or NULL. */
const io__exr_channel *io__exr_find_channel(const io__exr *exr, const char *name);
/* Fails with the list of channels. */
int io__exr_fail_channel(const io__exr *exr, const char *name);
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
int io__exr_check_chunks(io__exr *exr, int part);
/* The same, and whether OpenEXR reads its compression as it should. */
int io__exr_check_part(io__exr *exr, int part);

/* Reads a part. targets: for each channel of the part, in its order, the place for the
 * data window's pixels, or NULL if it is not wanted. */
int io__exr_read_part(io__exr *exr, int part, float *const *targets);

/* A chunk of a part: a tile, or some scanlines. */
typedef struct io__exr_chunk {
    int32_t x, y;             /* of a tile; x is 0 and y the first line of scanlines */
    int32_t level_x, level_y; /* of mip-maps */
} io__exr_chunk;

/* Where a chunk lies, checked against the size of the file. */
exr_result_t io__exr_find_chunk(const io__exr *exr, int part, const io__exr_chunk *chunk,
                                exr_chunk_info_t *info);

/* An EXR file that is being written. */
typedef struct io__exr_sink {
    io__output *output;
    exr_context_t context;
    int io_error; /* errno of a failed write */
} io__exr_sink;

exr_result_t io__exr_sink_open(io__exr_sink *sink, io__output *output);
exr_result_t io__exr_set_level(const io__exr_sink *sink, int part);
/* Finishes the file, of which `code` is the result so far. Returns 0, or -1 after an
 * error line with this remedy. */
int io__exr_sink_close(io__exr_sink *sink, exr_result_t code, const char *remedy);

/* A chunk that has been packed, to the file. */
exr_result_t io__exr_write_packed(const io__exr_sink *sink, int part,
                                  const io__exr_chunk *chunk,
                                  const exr_encode_pipeline_t *encode);

/* The writer of exr_write.c. */
int io__exr_write(io__output *output, const io_image *image,
                  const io_write_options *options);

/* The channel list as an image without pixels; io_image_free() frees it. */
int io__exr_list(const io__exr *exr, io_image *image);

#endif

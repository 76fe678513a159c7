/* SPDX-License-Identifier: MIT */
/*
 * io.h: pictures on disk. Formats are rows of one table (format.c), chosen by the file's
 * extension when writing and by its first bytes when reading.
 *
 * Every function that can fail returns 0 when done and -1 after it has logged one error
 * line "FILE: what is wrong; what to do". Nothing is global; all functions are
 * thread-safe for different images.
 */
#ifndef CREVICE_IO_H
#define CREVICE_IO_H

#include <stdbool.h>

#include "crevice/crevice.h"

#define IO_NAME_SIZE 256
#define IO_VIEW_SIZE 32

typedef struct io_channel {
    char name[IO_NAME_SIZE]; /* full name; in multi-part files "part.channel" unless the
                                channel's name already begins with the part's */
    float *data;  /* width * height floats, packed, top row first; NULL in an image
                     from io_probe() */
    bool is_half; /* of io_probe(): the file stores half floats */
    char view[IO_VIEW_SIZE]; /* of io_probe(): the eye that its part says it is of, or ""
                              */
} io_channel;

/* Row-vector matrices as OpenEXR stores them: p' = (x, y, z, 1) * M, row-major. */
typedef struct io_camera_metadata {
    bool has_world_to_camera, has_world_to_ndc;
    float world_to_camera[16];
    float world_to_ndc[16]; /* x, y in [0, 1] over the display window, y down, after
                               dividing by w */
} io_camera_metadata;

/* The field of view that other attributes than matrices tell; 0: none. */
typedef struct io_lens {
    float hfov_rad, vfov_rad; /* one of them */
    char source[64];          /* the attribute, for messages */
} io_lens;

#define IO_MADE_SIZE 1024

typedef struct io_image {
    int32_t width, height; /* of the data window: what the channels hold */
    /* Where the data window's top left pixel lies inside the display window (negative
     * with overscan), and the size of the display window. Formats without windows: 0, 0,
     * width, height. */
    int32_t data_x, data_y, display_width, display_height;
    float pixel_aspect;
    io_camera_metadata camera;
    io_lens lens; /* read only */
    /* What made the picture: the string attribute or text "crevice" of EXR and PNG files,
     * "" if there is none. */
    char made[IO_MADE_SIZE];
    int32_t channel_count;
    /* Owned. The pixels of all channels lie in one block, in order, so that three
     * channels in a row make one crv_image. */
    io_channel *channels;
} io_image;

/* Makes an image with zeroed channels of these names, display window = data window. */
int io_image_init(io_image *image, int32_t width, int32_t height,
                  const char *const *names, int32_t count, const crv_logger *log);

/* Frees what the image owns and zeroes it. Zeroed images and NULL are fine. */
void io_image_free(io_image *image);

/* The channel of exactly this name, or NULL. */
io_channel *io_image_find(const io_image *image, const char *name);

/* A view of so many channels in a row, from this one on. */
crv_image io_image_view(const io_image *image, int32_t first, int32_t channels);

/* Reads everything but the pixels: sizes, metadata, channel names of all parts. */
int io_probe(const char *path, io_image *out, const crv_logger *log);

/*
 * Reads the named channels (names NULL: all; all requested parts must share one data
 * window), converted to float: half and float as they are, EXR uint as numbers, PNG to
 * [0, 1]. An unknown name is an error that lists the names there are. Truncated and
 * damaged files are errors, never a partial picture. Deep EXR parts are refused.
 */
int io_read(const char *path, const char *const *names, int32_t count, io_image *out,
            const crv_logger *log);

/* Who is told, now and then and in the calling thread, which share of the pixels is read
 * or written, from 0 to 1; of EXR files each part by itself. */
typedef struct io_watch {
    void (*tell)(void *user, double share);
    void *user;
} io_watch;

/* The same; watch NULL: nobody is told. */
int io_read_watched(const char *path, const char *const *names, int32_t count,
                    const io_watch *watch, io_image *out, const crv_logger *log);

typedef struct io_write_options {
    bool half;    /* EXR: half floats instead of floats. AO loses at most 5e-4 */
    int32_t bits; /* PNG: 8 (default, also for 0) or 16 */
    bool
        srgb; /* PNG: encode with the sRGB curve (lit pictures); AO is written linearly */
    bool (*stop)(void);    /* asked now and then by any thread: true gives the writing up,
                           after an error line. NULL: never */
    const io_watch *watch; /* NULL: nobody is told */
} io_write_options;

/*
 * Writes the picture in the format that the extension names (.exr, .png, .pfm): EXR any
 * channels, ZIP, scanlines, windows and camera metadata; PNG one channel (grey) or three
 * (R, G, B), clamped to [0, 1], NaN as 0; PFM one or three channels. Through a temporary
 * file in the same folder and a rename: on failure a former file of that name is
 * untouched and nothing is left behind. Links are followed, devices such as /dev/stdout
 * refused. options NULL: defaults.
 */
int io_write(const char *path, const io_image *image, const io_write_options *options,
             const crv_logger *log);

/* The whole number of 0 to `largest` that a PNG gets for a value; srgb as above. */
unsigned io_quantise(float value, bool srgb, unsigned largest);

/* Whether the format that the extension names keeps io_image.made. */
bool io_keeps_made(const char *path);

/* Whether the format that the extension names keeps data and display window. */
bool io_keeps_windows(const char *path);

/* Copies the part of a channel that the data windows of both images cover. */
void io_copy_window(const io_image *from, const float *source, const io_image *to,
                    float *target);

/* Whether io_write() could write there: known extension, folder exists and is writable,
 * path is not a folder. For finding out before a long computation. */
int io_check_writable(const char *path, const crv_logger *log);

/* Whether both paths name one file, links followed; neither need be there yet. For
 * outputs that would replace each other, or an input. */
bool io_is_same_file(const char *a, const char *b);

/* Whether the disk holds `room` more bytes where `path` will be: writes them beside it
 * and removes them again. */
int io_check_room(const char *path, size_t room, const crv_logger *log);

#endif

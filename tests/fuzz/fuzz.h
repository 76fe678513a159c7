/* SPDX-License-Identifier: MIT */
/*
 * fuzz.h: targets for fuzzers. Each takes any bytes and ends the process if something
 * that must hold does not. libfuzzer.c makes a libFuzzer program of one; replay.c runs
 * files through any of them without clang. Files are written to the current folder.
 */
#ifndef TESTS_FUZZ_FUZZ_H
#define TESTS_FUZZ_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "crevice/crevice.h"

/* A picture file: whatever is read can be probed; memory in proportion to the file. */
void fuzz_image(const uint8_t *data, size_t size);
/* A picture file and, in its last four bytes, what its user says of it: the result of
 * every method lies in [0, 1]. */
void fuzz_frame(const uint8_t *data, size_t size);
/* Descriptions, strides, options and pixels of the public interface, with an allocator
 * that may fail. */
void fuzz_api(const uint8_t *data, size_t size);
/* Its conversions: texels, depth, matrices, cameras, options; a picture in one call. */
void fuzz_convert(const uint8_t *data, size_t size);
/* A letter for the extension, then a model file, through the import's child process. */
void fuzz_mesh(const uint8_t *data, size_t size);
/* The extensions in the order of their letters, from 'a'; NULL-terminated. */
extern const char *const fuzz_mesh_extensions[];
const char *fuzz_mesh_extension(uint8_t letter);
/* glTF, as the child process reads it. */
void fuzz_gltf(const uint8_t *data, size_t size);
/* What a child process whose reader was taken over may send. */
void fuzz_pipe(const uint8_t *data, size_t size);
/* Arguments of the commands, options of the library, lists of frames: one a line. */
void fuzz_text(const uint8_t *data, size_t size);
/* A checkpoint of the reference; by the first byte, its checksum is mended. */
void fuzz_checkpoint(const uint8_t *data, size_t size);
/* --sky and --key-light as text, or a picture as sky and height map. */
void fuzz_sky(const uint8_t *data, size_t size);
/* A file of cameras, JSON or .chan, behind a byte for the order of angles. */
void fuzz_cameras(const uint8_t *data, size_t size);
/* An EXR file to copy with a further channel, and its Cryptomattes. */
void fuzz_append(const uint8_t *data, size_t size);

/* support.c */

/* Ends the process with a line unless `truth` holds. */
#define FUZZ_CHECK(truth, ...)                                                           \
    do {                                                                                 \
        if (!(truth)) {                                                                  \
            fprintf(stderr, "%s:%d: not so: %s: ", __FILE__, __LINE__, #truth);          \
            fprintf(stderr, __VA_ARGS__);                                                \
            fputc('\n', stderr);                                                         \
            abort();                                                                     \
        }                                                                                \
    } while (0)

/* Writes the file and returns its name. */
const char *fuzz_file(const char *name, const uint8_t *data, size_t size);

/* Ends the process if a line holds control characters. */
extern const crv_logger fuzz_logger;
/* The error lines since the process began. */
extern int fuzz_errors;

/* requests.c: the largest block that was asked for since fuzz_forget_requests(). */
size_t fuzz_largest_request(void);
void fuzz_forget_requests(void);

/* edges.c: from the first call on, children count their edges where fuzz_add_edges() adds
 * them to libFuzzer's. */
void fuzz_share_edges(void);
void fuzz_add_edges(void);

/* Values made of the input's bytes; zeros once they are used up. */
typedef struct fuzz_bytes {
    const uint8_t *at;
    size_t left;
} fuzz_bytes;

uint32_t fuzz_byte(fuzz_bytes *in);
uint32_t fuzz_word(fuzz_bytes *in);
/* One time in `times`. */
bool fuzz_seldom(fuzz_bytes *in, uint32_t times);
/* 0 to most; seldom an extreme value. */
int32_t fuzz_int(fuzz_bytes *in, int32_t most);
/* Near the usual value; one time in two something extreme. */
float fuzz_float(fuzz_bytes *in, float usual);

/* pixels.c */

/* An image in a block that ends with its last pixel, so that reading beyond is seen; of
 * any strides. The block is to be freed. */
typedef struct fuzz_pixels {
    char *block;
    crv_image image;
} fuzz_pixels;

fuzz_pixels fuzz_make_pixels(fuzz_bytes *in, int32_t width, int32_t height,
                             int32_t channels);
/* The same with values as fuzz_float() gives them. */
fuzz_pixels fuzz_fill_pixels(fuzz_bytes *in, int32_t width, int32_t height,
                             int32_t channels, float usual);
/* Breaks one member of the image, one time in four. */
void fuzz_spoil(fuzz_bytes *in, crv_image *image);
/* Ends the process unless every value lies between the two. */
void fuzz_check_pixels(const crv_image *image, float least, float most, const char *what);

/* The same for texels of any type, any bytes in them; seldom with a broken member. */
typedef struct fuzz_texels {
    char *block;
    crv_texels texels;
} fuzz_texels;

fuzz_texels fuzz_make_texels(fuzz_bytes *in, int32_t width, int32_t height,
                             int32_t channels);

#endif

/* SPDX-License-Identifier: MIT */
/* mattes.h: parts of a frame that the user names. */
#ifndef CREVICE_IO_PASSES_MATTES_H
#define CREVICE_IO_PASSES_MATTES_H

#include "io.h"

/*
 * Reads how much of each pixel is meant, 0 to 1, for the data window of `window`: width *
 * height floats; 0 where the file has nothing. text is one of
 *     CHANNEL          a matte: its values, held between 0 and 1
 *     CHANNEL=ID,ID    an object id, or several of them
 *     crypto:NAME,NAME objects of a Cryptomatte, see io_cryptomatte_read()
 * and "not:" before it means everything else.
 */
int io_matte_read(const char *path, const char *text, const io_image *window,
                  float *coverage, const crv_logger *log);

#endif

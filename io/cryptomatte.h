/* SPDX-License-Identifier: MIT */
/*
 * cryptomatte.h: objects of an EXR frame by their names (Friedman and Jones,
 * "Cryptomatte specification" 1.2.0, 2018): ranked pairs of an id and its coverage in
 * each pixel, and names of the ids in the metadata.
 */
#ifndef CREVICE_IO_CRYPTOMATTE_H
#define CREVICE_IO_CRYPTOMATTE_H

#include "io.h"

/*
 * Reads how much of each pixel the named objects cover, 0 to 1, into one channel of *out,
 * which io_image_free() frees. names: separated by commas, with * and ? as in a shell;
 * "LAYER=" before them chooses one of several Cryptomattes of the file by its name
 * ("View Layer.CryptoObject"). A name that the manifest lacks is an error, a pattern that
 * fits none of its names a warning. Without a manifest, names are hashed.
 */
int io_cryptomatte_read(const char *path, const char *names, io_image *out,
                        const crv_logger *log);

/* The id of a name: MurmurHash3 (x86, 32 bits), with the exponent of a normal float. */
uint32_t io_cryptomatte_id(const char *name);

#endif

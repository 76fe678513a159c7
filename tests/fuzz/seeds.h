/* SPDX-License-Identifier: MIT */
/* seeds.h: the files of fuzz_seeds. */
#ifndef TESTS_FUZZ_SEEDS_H
#define TESTS_FUZZ_SEEDS_H

#include <stddef.h>

/* Writes FOLDER/target/name. */
void seeds_write(const char *target, const char *name, const void *data, size_t size);

/* The same with a file's bytes between two texts. */
void seeds_take(const char *target, const char *name, const char *path,
                const char *before, const char *after);

/* A model, by the extension of its name. */
void seeds_write_model(const char *name, const void *data, size_t size);

/* seeds_readers.c: models in formats that assimp only reads. */
void seeds_write_for_readers(void);

/* seeds_pictures.c */
void seeds_write_pictures(void);

/* seeds_models.c: models of every format that can be written; leaves model.obj. */
void seeds_write_models(void);

#endif

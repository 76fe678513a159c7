/* SPDX-License-Identifier: MIT */
/* png_io.h: what png_read.c and png_write.c share. */
#ifndef CREVICE_IO_PNG_IO_H
#define CREVICE_IO_PNG_IO_H

#include <png.h>

#include "internal.h"

/* libpng's last words; the error pointer of its structs. */
typedef struct io__png_message {
    char text[160];
} io__png_message;

PNG_NORETURN void io__png_error(png_structp png, png_const_charp text);
void io__png_warning(png_structp png, png_const_charp text);

int io__png_write(io__output *output, const io_image *image,
                  const io_write_options *options);

#endif

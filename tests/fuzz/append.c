/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include <string.h>

#include "append.h"
#include "cryptomatte.h"

/* Chunks are copied one at a time, and unpacked to 2048 times their size at most. */
#define LARGEST_RATIO 4096
#define LARGEST_SLACK ((size_t)64 << 20)

/* One of the channels, chosen by the file itself. */
static const char *choose(const io_image *probed, const uint8_t *data, size_t size,
                          size_t back)
{
    const size_t byte = size > back ? data[size - 1 - back] : 0;
    return probed->channels[byte % (size_t)probed->channel_count].name;
}

static void copy(const char *path, const io_image *probed, const uint8_t *data,
                 size_t size)
{
    static const char *const names[] = {"AO"};
    io_image picture, copied = {0};
    FUZZ_CHECK(!io_image_init(&picture, 5, 3, names, 1, NULL), "no image");
    const char *const multiplied[] = {choose(probed, data, size, 1)};
    const io_addition addition = {.picture = &picture,
                                  .beside = choose(probed, data, size, 0),
                                  .name = "AO",
                                  .made = "fuzz",
                                  .is_added = size % 2 == 0,
                                  .multiplied_count = size % 3 == 0,
                                  .multiplied = multiplied};
    const io_append_options options = {.replace = true};
    const int before = fuzz_errors;
    const int result =
        io_append(path, "output.exr", &addition, 1, &options, &fuzz_logger);
    FUZZ_CHECK(fuzz_errors == before + (result ? 1 : 0), "%d lines",
               fuzz_errors - before);
    if (!result) {
        char made[IO_MADE_SIZE];
        FUZZ_CHECK(!io_probe("output.exr", &copied, &fuzz_logger), "a copy like this");
        FUZZ_CHECK(!addition.is_added || io_image_find(&copied, "AO"), "no channel");
        io_append_made("output.exr", "AO", made);
        FUZZ_CHECK(!strcmp(made, "fuzz"), "%s", made);
        io_image_free(&copied);
        remove("output.exr");
    }
    io_image_free(&picture);
}

void fuzz_append(const uint8_t *data, size_t size)
{
    io_image probed = {0}, coverage = {0};
    const char *path = fuzz_file("input.exr", data, size);
    fuzz_forget_requests();
    if (io_probe(path, &probed, &fuzz_logger))
        return;
    copy(path, &probed, data, size);
    const int before = fuzz_errors;
    const int result = io_cryptomatte_read(path, "hero,*", &coverage, &fuzz_logger);
    FUZZ_CHECK(fuzz_errors == before + (result ? 1 : 0), "%d lines",
               fuzz_errors - before);
    FUZZ_CHECK(fuzz_largest_request() <= LARGEST_RATIO * size + LARGEST_SLACK,
               "%zu bytes for a file of %zu", fuzz_largest_request(), size);
    io_image_free(&coverage);
    io_image_free(&probed);
}

/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include "io.h"

/* Compressed pixels unpack to 2048 times their size at most, and halves to twice that;
 * rows and chunks that are unpacked one at a time take the rest. */
#define LARGEST_RATIO 4096
#define LARGEST_SLACK ((size_t)64 << 20)

static void check_pixels(const io_image *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    volatile float sum = 0.0f; /* reads every pixel under the sanitizer's eyes */
    for (int32_t c = 0; c < image->channel_count; c++)
        for (size_t i = 0; i < count; i++)
            sum = image->channels[c].data[i];
    (void)sum;
}

void fuzz_image(const uint8_t *data, size_t size)
{
    io_image probed = {0}, all = {0}, one = {0};
    const char *path = fuzz_file("input", data, size);
    const int before = fuzz_errors;
    fuzz_forget_requests();
    const int probe = io_probe(path, &probed, &fuzz_logger);
    FUZZ_CHECK(fuzz_errors == before + (probe ? 1 : 0), "%d lines", fuzz_errors - before);
    const int read = io_read(path, NULL, 0, &all, &fuzz_logger);
    FUZZ_CHECK(read || !probe, "what is read can be probed");
    FUZZ_CHECK(fuzz_errors == before + (probe ? 1 : 0) + (read ? 1 : 0), "%d lines",
               fuzz_errors - before);
    FUZZ_CHECK(fuzz_largest_request() <= LARGEST_RATIO * size + LARGEST_SLACK,
               "%zu bytes for a file of %zu", fuzz_largest_request(), size);
    if (!read) {
        FUZZ_CHECK(all.width == probed.width && all.height == probed.height
                       && all.channel_count == probed.channel_count,
                   "%d x %d, %d channels", all.width, all.height, all.channel_count);
        check_pixels(&all);
    }
    if (!probe && probed.channel_count > 0) {
        const char *name = probed.channels[size % (size_t)probed.channel_count].name;
        if (!io_read(path, &name, 1, &one, &fuzz_logger))
            check_pixels(&one);
        io_image_free(&one);
    }
    io_image_free(&probed);
    io_image_free(&all);
}

/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include <string.h>

#include "reference_internal.h"

enum { SIDE = 4, PIXELS = SIDE * SIDE, HEAD = 48 };
enum { WHOLE = HEAD + REFERENCE_FLOATS * 4 * PIXELS + 8 };
enum { MEND_FINGERPRINT = 1, MEND_CHECKSUM = 2 };

static scene *model;
static scene_gbuffer gbuffer;
static uint8_t sound[WHOLE]; /* a checkpoint of this reference */

static reference *make(void)
{
    static const reference_options options = {.weighting = CRV_WEIGHTING_COSINE,
                                              .falloff = CRV_FALLOFF_LINEAR,
                                              .radius = 1.0f,
                                              .rays = 4,
                                              .tau = 3.0f,
                                              .u = 0.1f};
    reference *r = NULL;
    FUZZ_CHECK(!reference_create(model, &gbuffer, &options, &r, &fuzz_logger), "none");
    return r;
}

static void prepare(void)
{
    scene_gbuffer_request q = {.width = SIDE, .height = SIDE, .layers = 1, .threads = 1};
    FUZZ_CHECK(!scene_builtin("corner", &model, &fuzz_logger), "no scene");
    scene_frame(model, 1.0f, 1.0f, &q.view);
    FUZZ_CHECK(!scene_render_gbuffer(model, &q, &gbuffer, &fuzz_logger), "no G-buffer");
    reference *r = make();
    FUZZ_CHECK(!reference_save(r, "sound", &fuzz_logger), "not saved");
    FILE *file = fopen("sound", "rb");
    FUZZ_CHECK(file && fread(sound, 1, WHOLE, file) == WHOLE && getc(file) == EOF,
               "a checkpoint of another size");
    fclose(file);
    remove("sound");
    reference_free(r);
}

void fuzz_checkpoint(const uint8_t *data, size_t size)
{
    if (size < 1 || size > 4096)
        return;
    if (!model)
        prepare();
    const int mend = data[0];
    const size_t length = size - 1;
    uint8_t *copy = malloc(size);
    memcpy(copy, data + 1, length);
    if ((mend & MEND_FINGERPRINT) && length >= 32)
        memcpy(copy, sound, 32);
    if ((mend & MEND_CHECKSUM) && length == WHOLE) {
        const uint64_t sum = reference_hash(REFERENCE_HASH, copy, WHOLE - 8);
        memcpy(copy + WHOLE - 8, &sum, 8);
    }
    const char *path = fuzz_file("input", copy, length);
    free(copy);
    reference *r = make();
    const int before = fuzz_errors;
    const int result = reference_load(r, path, &fuzz_logger);
    FUZZ_CHECK(fuzz_errors == before + (result ? 1 : 0), "%d lines",
               fuzz_errors - before);
    const int64_t done = reference_done(r);
    FUZZ_CHECK(done >= 0 && done <= PIXELS && (!result || !done), "%d pixels done",
               (int)done);
    reference_advance(r, PIXELS, 1);
    FUZZ_CHECK(reference_done(r) == PIXELS, "%d pixels", (int)reference_done(r));
    /* The loaded pixels are believed: their checksum was right. */
    for (int64_t i = done; i < PIXELS; i++)
        FUZZ_CHECK(reference_accessibility(r)[i] >= 0.0f
                       && reference_accessibility(r)[i] <= 1.0f,
                   "%g", (double)reference_accessibility(r)[i]);
    reference_free(r);
}

/* SPDX-License-Identifier: MIT */
#include "masks.h"

#include <math.h>
#include <stdlib.h>

#include "passes/mattes.h"

/* The coverage over the frame's data window; the caller frees it. */
static int read_matte(const char *flag, const char *text, const char *input,
                      const io_frame *frame, float **out, report *r)
{
    const size_t count = (size_t)frame->image.width * (size_t)frame->image.height;
    float *coverage = malloc(count * sizeof *coverage);
    if (!coverage)
        return report_no_memory(r);
    if (io_matte_read(input, text, &frame->image, coverage, &r->logger) != 0) {
        free(coverage);
        return EXIT_FAILED;
    }
    size_t covered = 0;
    for (size_t i = 0; i < count; i++)
        covered += coverage[i] > 0.0f;
    if (!covered)
        report_warning(r, "%s: %s covers nothing of %s", flag, text, input);
    *out = coverage;
    return EXIT_DONE;
}

int masks_take_out(const ao_settings *s, const char *input, io_frame *frame, report *r)
{
    float *coverage = NULL;
    if (!s->occlude)
        return EXIT_DONE;
    const int result = read_matte("--occlude", s->occlude, input, frame, &coverage, r);
    if (result != EXIT_DONE)
        return result;
    const size_t count = (size_t)frame->image.width * (size_t)frame->image.height;
    for (int32_t layer = 0; layer < frame->desc.layers; layer++) {
        float *depth = frame->depth[layer].data;
        for (size_t i = 0; i < count; i++)
            if (coverage[i] < 0.5f)
                depth[i] = INFINITY;
    }
    free(coverage);
    return EXIT_DONE;
}

int masks_open(const ao_settings *s, const char *input, const io_frame *frame,
               io_image *ao, report *r)
{
    float *coverage = NULL;
    if (!s->receive)
        return EXIT_DONE;
    const int result = read_matte("--receive", s->receive, input, frame, &coverage, r);
    if (result != EXIT_DONE)
        return result;
    for (int32_t y = 0; y < ao->height; y++) {
        const float *from =
            coverage + (size_t)(y + frame->desc.guard_top) * (size_t)frame->image.width
            + frame->desc.guard_left;
        float *to = ao->channels[0].data + (size_t)y * (size_t)ao->width;
        for (int32_t x = 0; x < ao->width; x++)
            to[x] = 1.0f - from[x] * (1.0f - to[x]);
    }
    free(coverage);
    return EXIT_DONE;
}

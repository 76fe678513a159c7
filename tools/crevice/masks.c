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

/* Bent normals of what does not receive. */
static int straighten(const io_frame *frame, const float *coverage, crv_gbuffer *gbuffer,
                      io_image *ao, report *r)
{
    const size_t width = (size_t)frame->image.width;
    float *normals = malloc(3 * width * (size_t)frame->image.height * sizeof *normals);
    if (!normals)
        return report_no_memory(r);
    const crv_image view =
        crv_image_packed(normals, frame->image.width, frame->image.height, 3);
    if (!report_ok(r, crv_gbuffer_get_normals(gbuffer, &view), "normals")) {
        free(normals);
        return EXIT_FAILED;
    }
    for (int32_t y = 0; y < ao->height; y++)
        for (int32_t x = 0; x < ao->width; x++) {
            const size_t from = (size_t)(y + frame->desc.guard_top) * width
                                + (size_t)(x + frame->desc.guard_left);
            const size_t to = (size_t)y * (size_t)ao->width + (size_t)x;
            const double share = (double)coverage[from];
            double v[3], length = 0.0;
            for (size_t k = 0; k < 3; k++) {
                v[k] = share * (double)ao->channels[1 + k].data[to]
                       + (1.0 - share) * (double)normals[3 * from + k];
                length += v[k] * v[k];
            }
            for (int k = 0; k < 3; k++)
                ao->channels[1 + k].data[to] =
                    length > 0.0 ? (float)(v[k] / sqrt(length)) : 0.0f;
        }
    free(normals);
    return EXIT_DONE;
}

int masks_open(const ao_settings *s, const char *input, const io_frame *frame,
               crv_gbuffer *gbuffer, io_image *ao, report *r)
{
    float *coverage = NULL;
    if (!s->receive)
        return EXIT_DONE;
    int result = read_matte("--receive", s->receive, input, frame, &coverage, r);
    if (result == EXIT_DONE && bent_is_there(ao))
        result = straighten(frame, coverage, gbuffer, ao, r);
    if (result != EXIT_DONE) {
        free(coverage);
        return result;
    }
    for (int32_t y = 0; y < ao->height; y++) {
        const float *from =
            coverage + (size_t)(y + frame->desc.guard_top) * (size_t)frame->image.width
            + frame->desc.guard_left;
        float *to = ao->channels[0].data + (size_t)y * (size_t)ao->width;
        for (int32_t x = 0; x < ao->width; x++)
            to[x] += (1.0f - from[x]) * (1.0f - to[x]);
    }
    free(coverage);
    return EXIT_DONE;
}

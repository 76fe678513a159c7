/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include <math.h>

#include "passes/passes.h"

enum { KNOBS = 4, MAX_PIXELS = 4096 };

static crv_context *context;

static void make_context(void)
{
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = fuzz_logger;
    desc.threads = 1;
    FUZZ_CHECK(crv_context_create(&desc, &context) == CRV_OK, "no context");
}

static io_passes_request request_of(const uint8_t knobs[KNOBS])
{
    io_passes_request q = {.depth_format = crv_depth_format_planar()};
    crv_depth_format *f = &q.depth_format;
    f->encoding = (crv_depth_encoding)(knobs[0] % (CRV_DEPTH_LOGARITHMIC + 1));
    q.encoding_given = (knobs[0] & 64) != 0;
    q.keep_overscan = (knobs[0] & 128) != 0;
    if (f->encoding != CRV_DEPTH_PLANAR && f->encoding != CRV_DEPTH_RADIAL) {
        f->z_near = 0.1f;
        f->z_far =
            (knobs[1] & 1) && f->encoding <= CRV_DEPTH_REVERSED ? INFINITY : 100.0f;
    }
    if ((knobs[1] & 6) == 2)
        q.vfov_rad = 1.0f;
    if ((knobs[1] & 6) == 4)
        q.view_height = 2.0f;
    if ((knobs[1] & 6) == 6)
        q.hfov_rad = 2.0f;
    q.normal_space = (io_normal_space)(knobs[2] % 3);
    for (int i = 0; i < 3; i++)
        q.flip_normals[i] = (knobs[2] >> (2 + i) & 1) != 0;
    if (knobs[2] & 64)
        q.normal = "none";
    q.is_later = (knobs[2] & 128) != 0;
    return q;
}

static void estimate(const io_frame *f, crv_gbuffer *gbuffer, uint8_t knob)
{
    const crv_gbuffer_desc *d = &f->desc;
    crv_plan *plan = NULL;
    crv_options o;
    crv_options_init(&o, sizeof o, crv_method_at(knob % crv_method_count())->name);
    o.radius = knob & 128 ? 50.0f : 0.5f;
    o.directions = o.steps = o.samples = 3; /* what was read is the point */
    o.bent_normal = (knob & 64) && o.method->bent_normal;
    if (crv_plan_create(context, &o, d, &plan) == CRV_OK) {
        const int32_t width = d->width - d->guard_left - d->guard_right;
        const int32_t height = d->height - d->guard_top - d->guard_bottom;
        const size_t count = (size_t)width * (size_t)height;
        float *result = malloc(count * sizeof *result);
        const crv_image image = crv_image_packed(result, width, height, 1);
        if (crv_plan_run(plan, gbuffer, &image) == CRV_OK)
            for (size_t i = 0; i < count; i++)
                FUZZ_CHECK(result[i] >= 0.0f && result[i] <= 1.0f, "%g of %s",
                           (double)result[i], o.method->name);
        free(result);
    }
    crv_plan_destroy(plan);
}

void fuzz_frame(const uint8_t *data, size_t size)
{
    if (size < 2 * KNOBS)
        return;
    if (!context)
        make_context();
    const uint8_t *knobs = data + size - KNOBS;
    const io_passes_request request = request_of(knobs);
    const char *path = fuzz_file("input", data, size - KNOBS);
    const int before = fuzz_errors;
    io_frame f = {0};
    const int result = io_frame_load(path, &request, &f, &fuzz_logger);
    FUZZ_CHECK(fuzz_errors == before + (result ? 1 : 0), "%d lines",
               fuzz_errors - before);
    if (result)
        return;
    crv_gbuffer *gbuffer = NULL;
    if ((int64_t)f.desc.width * f.desc.height <= MAX_PIXELS
        && io_frame_to_gbuffer(&f, context, &gbuffer) == CRV_OK)
        estimate(&f, gbuffer, knobs[3]);
    crv_gbuffer_destroy(gbuffer);
    io_frame_free(&f);
}

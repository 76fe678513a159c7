/* SPDX-License-Identifier: MIT */
/* How long a GPU is going to compute: loops on the CPU tell how far they are, a device
 * does not. */
#include "estimate.h"

#include <math.h>
#include <stdlib.h>

#include "progress.h"

/* The part that is tried at first, of pictures of many pixels. A device that is done with
 * it at once was not busy, and gets more. */
enum { PART_WIDTH = 512, PART_HEIGHT = 16, MORE = 4, MANY_PIXELS = 200000 };
#define BUSY_SECONDS 0.3

typedef struct part {
    crv_gbuffer_desc desc;
    crv_gbuffer *gbuffer;
    crv_plan *plan;
    int32_t x, y; /* its first pixel in the whole */
} part;

/* The part of one plane of the whole; pixels: of the whole's size, packed. */
static crv_const_image part_of(const estimator *e, const part *s, const float *pixels,
                               int32_t channels)
{
    crv_const_image image =
        crv_const_image_packed(pixels, e->desc.width, e->desc.height, channels);
    image.data = crv_const_image_at(&image, s->x, s->y, 0);
    image.width = s->desc.width;
    image.height = s->desc.height;
    return image;
}

/* A part without a surface says nothing, and a G-buffer would warn of it. */
static bool shows_something(const crv_const_image *depth)
{
    for (int32_t y = 0; y < depth->height; y++)
        for (int32_t x = 0; x < depth->width; x++)
            if (isfinite(*crv_const_image_at(depth, x, y, 0)))
                return true;
    return false;
}

static bool fill(const estimator *e, const crv_camera *camera, float *pixels, part *s)
{
    const crv_camera cropped = crv_camera_crop(camera, s->x, s->y);
    if (crv_gbuffer_set_camera(s->gbuffer, &cropped))
        return false;
    for (int32_t layer = 0; layer < e->desc.layers; layer++) {
        const crv_image all = crv_image_packed(pixels, e->desc.width, e->desc.height, 1);
        const crv_const_image some = part_of(e, s, pixels, 1);
        if (crv_gbuffer_get_depth(e->gbuffer, layer, &all)
            || (layer == 0 && !shows_something(&some))
            || crv_gbuffer_set_depth(s->gbuffer, layer, &some, NULL))
            return false;
    }
    const crv_image all = crv_image_packed(pixels, e->desc.width, e->desc.height, 3);
    const crv_const_image some = part_of(e, s, pixels, 3);
    return !crv_gbuffer_get_normals(e->gbuffer, &all)
           && !crv_gbuffer_set_normals(s->gbuffer, &some, CRV_NORMAL_VIEW);
}

/* Seconds that the part takes; 0 if it cannot be computed. */
static double try_part(const estimator *e, const crv_camera *camera, part *s)
{
    const size_t count = (size_t)e->desc.width * (size_t)e->desc.height;
    float *pixels = malloc(3 * count * sizeof *pixels);
    double seconds = 0.0;
    if (pixels && crv_gbuffer_create(e->context, &s->desc, &s->gbuffer) == CRV_OK
        && crv_plan_create(e->context, &e->options, &s->desc, &s->plan) == CRV_OK
        && fill(e, camera, pixels, s)) {
        const crv_image result =
            crv_image_packed(pixels, s->desc.width, s->desc.height, 1);
        const double start = report_seconds();
        if (crv_plan_run(s->plan, s->gbuffer, &result) == CRV_OK)
            seconds = report_seconds() - start;
    }
    crv_plan_destroy(s->plan);
    crv_gbuffer_destroy(s->gbuffer);
    free(pixels);
    return seconds;
}

void estimate_announce(estimator *e, const crv_camera *camera, report *r)
{
    const crv_gbuffer_desc *d = &e->desc;
    const double all = (double)d->width * (double)d->height;
    if (!e->on_gpu || e->is_announced || r->quiet || all < MANY_PIXELS)
        return;
    e->is_announced = true;
    double seconds = 0.0, spent = 0.0;
    for (int32_t rows = PART_HEIGHT; spent < BUSY_SECONDS && rows < d->height / MORE;
         rows *= MORE) {
        part s = {.y = (d->height - rows) / 2};
        const int32_t width = d->width < PART_WIDTH ? d->width : PART_WIDTH;
        s.x = (d->width - width) / 2;
        crv_gbuffer_desc_init(&s.desc, sizeof s.desc, width, rows);
        s.desc.layers = d->layers;
        s.desc.layer_kind = d->layer_kind;
        spent = try_part(e, camera, &s);
        seconds = spent * all / ((double)width * (double)rows);
        if (!progress_is_long(seconds))
            return;
    }
    progress_announce(r, "estimation", seconds);
}

/* SPDX-License-Identifier: MIT */
#include "frame_facts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void facts_compare(frame_facts *first, const io_frame *frame, const char *path, report *r)
{
    const frame_facts now = {true, frame->has_normals, frame->desc,
                             frame->image.display_width, frame->image.display_height};
    if (!first->known) {
        *first = now;
        return;
    }
    if (now.has_normals != first->has_normals)
        report_warning(r, "%s: its normals are %s, unlike those of the first frame", path,
                       now.has_normals ? "in the file" : "taken from depth");
    if (now.display_width != first->display_width
        || now.display_height != first->display_height)
        report_warning(r, "%s: is %dx%d, the first frame %dx%d", path, now.display_width,
                       now.display_height, first->display_width, first->display_height);
    else if (!crv_gbuffer_desc_equal(&now.desc, &first->desc))
        report_warning(r,
                       "%s: has another data window, other layers or layers of another "
                       "kind than the first frame",
                       path);
}

static bool is_open(const io_image *ao)
{
    const size_t count = (size_t)ao->width * (size_t)ao->height;
    const float *values = ao->channels[0].data;
    for (size_t i = 0; i < count; i++)
        if (values[i] < 1.0f)
            return false;
    return true;
}

int facts_check_surface(estimator *e, const io_image *ao, const char *path, report *r)
{
    const size_t count = (size_t)e->desc.width * (size_t)e->desc.height;
    if (!is_open(ao))
        return EXIT_DONE;
    bool surface = false;
    float *depth = NULL;
    const int result = estimate_depth(e, &depth, r);
    for (size_t i = 0; i < count && result == EXIT_DONE && !surface; i++)
        surface = isfinite(depth[i]);
    free(depth);
    if (result == EXIT_DONE && !surface)
        report_warning(r,
                       "%s: shows nothing: every depth is negative, 0, not a number, or "
                       "background; check --depth, --depth-encoding and --background",
                       path);
    return result;
}

int facts_fill_display(io_image *ao, report *r)
{
    const int32_t width = ao->display_width, height = ao->display_height;
    io_image whole = {0};
    const char *names[] = {ao->channels[0].name};
    if (ao->data_x == 0 && ao->data_y == 0 && ao->width == width && ao->height == height)
        return EXIT_DONE;
    if (io_image_init(&whole, width, height, names, 1, &r->logger) != 0)
        return EXIT_FAILED;
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        whole.channels[0].data[i] = 1.0f;
    io_copy_window(ao, ao->channels[0].data, &whole, whole.channels[0].data);
    whole.pixel_aspect = ao->pixel_aspect;
    whole.camera = ao->camera;
    memcpy(whole.made, ao->made, sizeof whole.made);
    io_image_free(ao);
    *ao = whole;
    return EXIT_DONE;
}

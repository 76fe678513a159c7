/* SPDX-License-Identifier: MIT */
#include "results.h"

#include <stdio.h>
#include <string.h>

#include "common/output.h"
#include "frame_facts.h"
#include "shrink.h"
#include "views.h"

/* The result lies where the frame does, without its guard band. */
static void place(ao_result *result, const char *made, const made_state *state)
{
    const io_frame *frame = &result->frame;
    io_image *ao = &result->ao;
    ao->data_x = frame->image.data_x + frame->desc.guard_left;
    ao->data_y = frame->image.data_y + frame->desc.guard_top;
    ao->display_width = frame->image.display_width;
    ao->display_height = frame->image.display_height;
    ao->pixel_aspect = frame->image.pixel_aspect;
    ao->camera = frame->image.camera;
    snprintf(ao->made, sizeof ao->made, "%s", made);
    made_add_state(ao->made, state);
}

static bool same_windows(const io_image *a, const io_image *b)
{
    return a->width == b->width && a->height == b->height && a->data_x == b->data_x
           && a->data_y == b->data_y && a->display_width == b->display_width
           && a->display_height == b->display_height;
}

/* One picture with a channel for each view. */
static int write_views(const char *output, const ao_result *results, int32_t count,
                       const io_write_options *options, report *r)
{
    const char *names[MAX_VIEWS] = {0};
    io_image all = {0};
    const io_image *first = &results[0].ao;
    for (int32_t i = 0; i < count; i++) {
        names[i] = results[i].channel;
        if (!same_windows(first, &results[i].ao)) {
            report_error(r,
                         "%s: its views have different windows; write a file for each, "
                         "named with %%V",
                         output);
            return EXIT_FAILED;
        }
    }
    if (io_image_init(&all, first->width, first->height, names, count, &r->logger) != 0)
        return EXIT_FAILED;
    io_image described = *first;
    described.channels = all.channels;
    described.channel_count = count;
    described.camera = (io_camera_metadata){0}; /* each view has its own */
    for (int32_t i = 0; i < count; i++)
        memcpy(all.channels[i].data, results[i].ao.channels[0].data,
               (size_t)first->width * (size_t)first->height * sizeof(float));
    const int result = output_write(output, &described, options, r);
    io_image_free(&all);
    return result;
}

int results_write(const ao_settings *s, const char *input, const char *output,
                  ao_result *results, int32_t count, const char *made,
                  const made_state *state, report *r)
{
    const io_write_options options = {.half = s->half,
                                      .bits = s->bits.value == 0 ? 8 : 16};
    for (int32_t i = 0; i < count; i++) {
        place(&results[i], made, state);
        if (s->aa.value > 1
            && shrink(&results[i].frame, s->aa.value, &results[i].ao, r) != EXIT_DONE)
            return EXIT_FAILED;
    }
    if (append_is_wanted(s))
        return append_write(s, input, output, results, count, r);
    if (count > 1)
        return write_views(output, results, count, &options, r);
    /* Formats without windows get the whole picture. */
    if (!io_keeps_windows(output) && facts_fill_display(&results->ao, r) != EXIT_DONE)
        return EXIT_FAILED;
    return output_write(output, &results->ao, &options, r);
}

void results_free(ao_result *results, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        io_image_free(&results[i].ao);
        io_frame_free(&results[i].frame);
    }
}

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
    made_state own = *state;
    if (bent_is_there(ao))
        own.bent_space = bent_spaces[result->bent_space];
    snprintf(ao->made, sizeof ao->made, "%s", made);
    made_add_state(ao->made, &own);
}

static bool same_windows(const io_image *a, const io_image *b)
{
    return a->width == b->width && a->height == b->height && a->data_x == b->data_x
           && a->data_y == b->data_y && a->display_width == b->display_width
           && a->display_height == b->display_height;
}

/* The channels of all views, with bent normals if there are any. Returns how many. */
static int32_t name_channels(const ao_result *results, int32_t count,
                             char texts[MAX_VIEWS * 4][IO_NAME_SIZE],
                             const char *names[MAX_VIEWS * 4])
{
    int32_t total = 0;
    for (int32_t i = 0; i < count; i++)
        for (int32_t k = 0; k < results[i].ao.channel_count; k++, total++) {
            if (k)
                bent_name(results[i].bent_layer, k, texts[total]);
            else
                snprintf(texts[total], IO_NAME_SIZE, "%s", results[i].channel);
            names[total] = texts[total];
        }
    return total;
}

/* One picture with the channels of each view. */
static int write_views(const char *output, const ao_result *results, int32_t count,
                       const io_write_options *options, report *r)
{
    char texts[MAX_VIEWS * 4][IO_NAME_SIZE];
    const char *names[MAX_VIEWS * 4];
    io_image all = {0};
    const io_image *first = &results[0].ao;
    for (int32_t i = 0; i < count; i++) {
        if (!same_windows(first, &results[i].ao)) {
            report_error(r,
                         "%s: its views have different windows; write a file for each, "
                         "named with %%V",
                         output);
            return EXIT_FAILED;
        }
    }
    const int32_t total = name_channels(results, count, texts, names);
    if (io_image_init(&all, first->width, first->height, names, total, &r->logger) != 0)
        return EXIT_FAILED;
    io_image described = *first;
    described.channels = all.channels;
    described.channel_count = total;
    described.camera = (io_camera_metadata){0}; /* each view has its own */
    const int32_t each = first->channel_count;
    for (int32_t i = 0; i < total; i++)
        memcpy(all.channels[i].data, results[i / each].ao.channels[i % each].data,
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
        if (results[i].bent_output[0]
            && bent_write(results[i].bent_output, &results[i].ao, &options, r)
                   != EXIT_DONE)
            return EXIT_FAILED;
    }
    if (append_is_wanted(s))
        return append_write(s, input, output, results, count, r);
    if (count > 1)
        return write_views(output, results, count, &options, r);
    if (io_keeps_windows(output))
        return output_write(output, &results->ao, &options, r);
    /* Formats without windows get the whole picture, of one channel. */
    if (facts_fill_display(&results->ao, r) != EXIT_DONE)
        return EXIT_FAILED;
    const io_image alone = bent_left_out(&results->ao);
    return output_write(output, &alone, &options, r);
}

void results_free(ao_result *results, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        io_image_free(&results[i].ao);
        io_frame_free(&results[i].frame);
    }
}

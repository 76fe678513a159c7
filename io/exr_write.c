/* SPDX-License-Identifier: MIT */
/* exr_write.c: one part of scanlines, ZIP, half or float. */
#include <string.h>

#include "exr.h"
#include "ndc.h"

typedef struct writer {
    io__exr_sink sink;
    const io_image *image;
    exr_pixel_type_t type;
    int part;
} writer;

static exr_result_t set_windows(const writer *w)
{
    const io_image *image = w->image;
    io__ndc_camera found[2];
    exr_attr_v2f_t centre = {.x = 0.0f, .y = 0.0f};
    float width = 1.0f;
    const exr_attr_box2i_t display = {
        .max = {.x = image->display_width - 1, .y = image->display_height - 1}};
    const exr_attr_box2i_t data = {.min = {.x = image->data_x, .y = image->data_y},
                                   .max = {.x = image->data_x + image->width - 1,
                                           .y = image->data_y + image->height - 1}};
    if (io__cameras_from_ndc(&image->camera, image->display_width, image->display_height,
                             found)) {
        const crv_camera camera = found[0].camera;
        width = (float)image->display_width / camera.fx_px;
        centre.x = (0.5f * (float)image->display_width - camera.cx_px) / camera.fx_px;
        centre.y = (camera.cy_px - 0.5f * (float)image->display_height) / camera.fy_px;
    }
    return exr_initialize_required_attr(
        w->sink.context, w->part, &display, &data,
        image->pixel_aspect > 0.0f ? image->pixel_aspect : 1.0f, &centre, width,
        EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_ZIP);
}

static exr_result_t set_matrix(const writer *w, const char *name, const float m[16])
{
    exr_attr_m44f_t matrix;
    memcpy(matrix.m, m, sizeof matrix.m);
    return exr_attr_set_m44f(w->sink.context, w->part, name, &matrix);
}

static exr_result_t write_header(writer *w)
{
    const io_image *image = w->image;
    const io_camera_metadata *camera = &image->camera;
    exr_result_t code =
        exr_add_part(w->sink.context, "main", EXR_STORAGE_SCANLINE, &w->part);
    if (!code)
        code = set_windows(w);
    if (!code)
        code = io__exr_set_level(&w->sink, w->part);
    for (int32_t i = 0; !code && i < image->channel_count; i++) {
        const char *name = image->channels[i].name;
        if (strlen(name) > 31)
            exr_set_longname_support(w->sink.context, 1);
        code = exr_add_channel(w->sink.context, w->part, name, w->type,
                               EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    }
    if (!code && image->made[0])
        code = exr_attr_set_string(w->sink.context, w->part, "crevice", image->made);
    if (!code && camera->has_world_to_camera)
        code = set_matrix(w, "worldToCamera", camera->world_to_camera);
    if (!code && camera->has_world_to_ndc)
        code = set_matrix(w, "worldToNDC", camera->world_to_ndc);
    return code ? code : exr_write_header(w->sink.context);
}

static void aim(const writer *w, exr_encode_pipeline_t *encode, int32_t y)
{
    for (int16_t i = 0; i < encode->channel_count; i++) {
        exr_coding_channel_info_t *from = &encode->channels[i];
        const io_channel *channel = io_image_find(w->image, from->channel_name);
        from->encode_from_ptr =
            (const uint8_t *)(channel->data + (size_t)y * (size_t)w->image->width);
        from->user_bytes_per_element = sizeof(float);
        from->user_data_type = EXR_PIXEL_FLOAT;
        from->user_pixel_stride = sizeof(float);
        from->user_line_stride = w->image->width * (int32_t)sizeof(float);
    }
}

/* Packs the chunk that begins at row y of the picture. */
static exr_result_t pack_chunk(const writer *w, int32_t y, exr_encode_pipeline_t *encode)
{
    exr_chunk_info_t info;
    if (io__output_stops(w->sink.output))
        return EXR_ERR_UNKNOWN;
    exr_result_t code = exr_write_scanline_chunk_info(w->sink.context, w->part,
                                                      w->image->data_y + y, &info);
    const bool first = !encode->channels;
    if (!code)
        code = first ? exr_encoding_initialize(w->sink.context, w->part, &info, encode)
                     : exr_encoding_update(w->sink.context, w->part, &info, encode);
    if (code)
        return code;
    aim(w, encode, y);
    if (first)
        code = exr_encoding_choose_default_routines(w->sink.context, w->part, encode);
    /* Writing waits for its turn: see write_pixels(). */
    encode->yield_until_ready_fn = NULL;
    encode->write_fn = NULL;
    return code ? code : exr_encoding_run(w->sink.context, w->part, encode);
}

/* Chunks are packed by all threads and written in their order. */
static exr_result_t write_pixels(const writer *w)
{
    int32_t lines = 1;
    const exr_result_t known =
        exr_get_scanlines_per_chunk(w->sink.context, w->part, &lines);
    exr_result_t result = known;
    if (known)
        return known;
    IO__OMP(parallel)
    {
        exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
        IO__OMP_FOR(ordered schedule(dynamic))
        for (int32_t y = 0; y < w->image->height; y += lines) {
            const io__exr_chunk chunk = {.y = w->image->data_y + y};
            const exr_result_t code = pack_chunk(w, y, &encode);
            IO__OMP(ordered)
            if (!result)
                result = code ? code
                              : io__exr_write_packed(&w->sink, w->part, &chunk, &encode);
            io__tell(w->sink.output->watch, y, w->image->height);
        }
        exr_encoding_destroy(w->sink.context, &encode);
    }
    io__tell(w->sink.output->watch, 1, 1);
    return result;
}

static int check_names(const io__output *output, const io_image *image)
{
    for (int32_t i = 0; i < image->channel_count; i++)
        if (!image->channels[i].name[0]
            || io_image_find(image, image->channels[i].name) != &image->channels[i])
            return io__fail(output->log, output->path,
                            "the channel name \"%s\" is empty or occurs twice; change it",
                            image->channels[i].name);
    if (image->data_x > INT32_MAX / 2 || image->data_x < INT32_MIN / 2
        || image->data_y > INT32_MAX / 2 || image->data_y < INT32_MIN / 2)
        return io__fail(output->log, output->path,
                        "its data window lies too far from its display window; crop it");
    return 0;
}

int io__exr_write(io__output *output, const io_image *image,
                  const io_write_options *options)
{
    writer w = {.image = image, .type = options->half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT};
    if (check_names(output, image))
        return -1;
    exr_result_t code = io__exr_sink_open(&w.sink, output);
    if (!code)
        code = write_header(&w);
    if (!code)
        code = write_pixels(&w);
    return io__exr_sink_close(&w.sink, code, "try .pfm");
}

/* SPDX-License-Identifier: MIT */
/* Pictures of every kind that io writes, and EXR files of other programs' kinds. */
#include "fuzz.h"

#include "seeds.h"
#include "test_io_support.h"

/* A slanted floor with a step, and its camera. */
static void fill(io_image *image)
{
    for (int i = 0; i < image->width * image->height; i++) {
        const int x = i % image->width, y = i / image->width;
        image->channels[0].data[i] = (x > 3 ? 2.0f : 3.0f) + 0.125f * (float)y;
        for (int c = 1; c < image->channel_count; c++)
            image->channels[c].data[i] = c == 3 ? 1.0f : 0.0f;
    }
    for (int i = 0; i < 16; i += 5)
        image->camera.world_to_camera[i] = image->camera.world_to_ndc[i] = 1.0f;
    image->camera.world_to_ndc[11] = -1.0f;
    image->camera.has_world_to_camera = image->camera.has_world_to_ndc = true;
}

static void write_plain(void)
{
    static const char *const passes[] = {"Z", "N.X", "N.Y", "N.Z"};
    static const char *const colours[] = {"R", "G", "B"};
    static const struct {
        const char *name;
        const char *const *channels;
        int count;
        io_write_options options;
    } files[] = {
        {"frame.exr", passes, 4, {0}},         {"half.exr", passes, 4, {.half = true}},
        {"grey.png", passes, 1, {.bits = 16}}, {"colour.png", colours, 3, {0}},
        {"depth.pfm", passes, 1, {0}},         {"colour.pfm", colours, 3, {0}},
        {"colour.exr", colours, 3, {0}},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        io_image image;
        FUZZ_CHECK(!io_image_init(&image, 8, 6, files[i].channels, files[i].count, NULL),
                   "no image");
        fill(&image);
        snprintf(image.made, sizeof image.made, "crevice seeds");
        FUZZ_CHECK(!io_write(files[i].name, &image, &files[i].options, &fuzz_logger),
                   "%s", files[i].name);
        io_image_free(&image);
        seeds_take("image", files[i].name, files[i].name, "", "");
        /* Planar, 1 rad; then hardware depth between planes. */
        seeds_take("frame", files[i].name, files[i].name, "", "a\x02\x01\x03");
        char other[64];
        snprintf(other, sizeof other, "planes-%s", files[i].name);
        seeds_take("frame", other, files[i].name, "", "b\x04\x41\x07");
        seeds_take("sky", files[i].name, files[i].name, "f", "");
        remove(files[i].name);
    }
}

/* Every compression that io cannot write, in lines and in tiles. */
static void write_compressed(void)
{
    for (int c = EXR_COMPRESSION_NONE; c <= EXR_COMPRESSION_B44A; c++)
        for (int tiled = 0; tiled < 2; tiled++) {
            const support_part part = {
                .storage = tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE,
                .compression = (exr_compression_t)c,
                .width = 7,
                .height = 5,
                .tile_width = 4,
                .tile_height = 4,
                .channel_count = 2,
                .channels = {"N.X", "Z"},
                .types = {EXR_PIXEL_HALF,
                          c < EXR_COMPRESSION_B44 ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF}};
            char name[64];
            snprintf(name, sizeof name, "%s-%d.exr", tiled ? "tiles" : "lines", c);
            support_make_exr(name, &part, 1, NULL, NULL, NULL);
            seeds_take("image_packed", name, name, "", "");
            seeds_take("frame_packed", name, name, "", "a\x02\x01\x03");
            seeds_take("append", name, name, "", "");
            remove(name);
        }
}

/* Objects by their names, and an eye, in two parts; no pixel is packed. */
static void write_parts(void)
{
    const exr_attr_v2f_t centre = {.x = 0.0f, .y = 0.0f};
    const exr_attr_box2i_t window = {.max = {.x = 1, .y = 1}};
    const float line[8] = {1.0f, 2.0f};
    exr_context_t context = NULL;
    int failed = exr_start_write(&context, "parts.exr", EXR_WRITE_FILE_DIRECTLY, NULL);
    for (int part = 0; part < 2; part++) {
        int index;
        failed |= exr_add_part(context, part ? "c" : "z", EXR_STORAGE_SCANLINE, &index);
        failed |= exr_initialize_required_attr(context, part, &window, &window, 1.0f,
                                               &centre, 1.0f, EXR_LINEORDER_INCREASING_Y,
                                               EXR_COMPRESSION_NONE);
        for (int c = 0; c < (part ? 4 : 1); c++) {
            char name[16] = "Z";
            if (part)
                snprintf(name, sizeof name, "o00.%c", "ABGR"[c]);
            failed |= exr_add_channel(context, part, name, EXR_PIXEL_FLOAT,
                                      EXR_PERCEPTUALLY_LINEAR, 1, 1);
        }
    }
    failed |= exr_attr_set_string(context, 0, "view", "left");
    failed |= exr_attr_set_string(context, 1, "cryptomatte/1/name", "o");
    failed |= exr_attr_set_string(context, 1, "cryptomatte/1/hash", "MurmurHash3_32");
    failed |= exr_attr_set_string(context, 1, "cryptomatte/1/manifest",
                                  "{\"hero\":\"3f800000\"}");
    failed |= exr_write_header(context);
    for (int part = 0; part < 2; part++)
        for (int y = 0; y < 2; y++)
            failed |= exr_write_scanline_chunk(context, part, y, line,
                                               (part ? 8 : 2) * sizeof *line);
    FUZZ_CHECK(!failed && !exr_finish(&context), "parts.exr");
    seeds_take("append", "parts.exr", "parts.exr", "", "");
    remove("parts.exr");
}

void seeds_write_pictures(void)
{
    write_parts();
    write_plain();
    write_compressed();
}

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
            remove(name);
        }
}

void seeds_write_pictures(void)
{
    write_plain();
    write_compressed();
}

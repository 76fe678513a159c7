/* SPDX-License-Identifier: MIT */
/*
 * Copies of EXR files with a further channel: everything else must have the same bits.
 * Headers are taken apart here by the rules of the format, not by the library that
 * copies them.
 */
#include <math.h>

#include "append.h"
#include "test_io_support.h"

#define COUNT(a) (sizeof(a) / sizeof(a)[0])

static const io_append_options no_options;

static void ok(exr_result_t code)
{
    if (code != EXR_ERR_SUCCESS)
        fail_msg("OpenEXR: %s", exr_get_default_error_message(code));
}

/* Accessibility 0, 1/4, 1/2, 3/4, 0 ... along rows, at (x, y) of the display window. */
static io_image make_picture(int32_t x, int32_t y, int32_t width, int32_t height)
{
    static const char *const names[] = {"AO"};
    io_image picture;
    assert_int_equal(io_image_init(&picture, width, height, names, 1, NULL), 0);
    picture.data_x = x;
    picture.data_y = y;
    for (int32_t i = 0; i < width * height; i++)
        picture.channels[0].data[i] = (float)(i % width % 4) / 4.0f;
    return picture;
}

static int append(const char *input, const char *output, const char *beside,
                  const char *name, const io_image *picture,
                  const io_append_options *options)
{
    const io_addition addition = {.picture = picture,
                                  .beside = beside,
                                  .name = name,
                                  .made = "by hand",
                                  .is_added = true};
    return io_append(input, output, &addition, 1, options, support_logger());
}

/* A header's attribute: its bytes in the file. */
typedef struct attribute {
    const char *name, *type;
    uint32_t size;
    const unsigned char *data;
} attribute;

/* Reads the next attribute and goes on behind it; false at the end of a header. */
static bool next_attribute(const unsigned char **at, attribute *a)
{
    if (!**at) {
        ++*at;
        return false;
    }
    a->name = (const char *)*at;
    a->type = a->name + strlen(a->name) + 1;
    const unsigned char *size = (const unsigned char *)a->type + strlen(a->type) + 1;
    a->size = (uint32_t)size[0] | (uint32_t)size[1] << 8 | (uint32_t)size[2] << 16
              | (uint32_t)size[3] << 24;
    a->data = size + 4;
    *at = a->data + a->size;
    return true;
}

static const unsigned char *header_of(const unsigned char *file, int part)
{
    const unsigned char *at = file + 8;
    attribute a;
    for (int i = 0; i < part; i++)
        while (next_attribute(&at, &a)) {
        }
    return at;
}

static bool find_attribute(const unsigned char *file, int part, const char *name,
                           attribute *a)
{
    const unsigned char *at = header_of(file, part);
    while (next_attribute(&at, a))
        if (!strcmp(a->name, name))
            return true;
    return false;
}

/* How the chunks are packed may change, and channels may come in between. */
static bool may_differ(const char *name)
{
    static const char *const names[] = {"channels", "compression", "lineOrder",
                                        "chunkCount"};
    for (size_t i = 0; i < COUNT(names); i++)
        if (!strcmp(name, names[i]))
            return true;
    return false;
}

static void expect_same_attributes(const char *input, const char *output, int parts)
{
    size_t size;
    unsigned char *before = support_read_file(input, &size);
    unsigned char *after = support_read_file(output, &size);
    for (int part = 0; part < parts; part++) {
        const unsigned char *at = header_of(before, part);
        attribute a, b;
        int count = 0;
        for (; next_attribute(&at, &a); count++) {
            if (may_differ(a.name))
                continue;
            if (!find_attribute(after, part, a.name, &b) || strcmp(a.type, b.type)
                || a.size != b.size || memcmp(a.data, b.data, a.size))
                fail_msg("attribute %s of part %d is missing or differs", a.name, part);
        }
        assert_true(count > 5);
    }
    free(before);
    free(after);
}

/* Each channel of the input is in the output, of the same type and with the same bits. */
static void expect_same_pixels(const char *input, const char *output)
{
    io_image before, after;
    assert_int_equal(io_probe(input, &before, support_logger()), 0);
    for (int32_t i = 0; i < before.channel_count; i++) {
        io_image a, b;
        const char *const name[] = {before.channels[i].name};
        assert_int_equal(io_read(input, name, 1, &a, support_logger()), 0);
        assert_int_equal(io_read(output, name, 1, &b, support_logger()), 0);
        assert_int_equal(a.width, b.width);
        assert_int_equal(a.height, b.height);
        assert_int_equal(a.data_x, b.data_x);
        assert_memory_equal(a.channels[0].data, b.channels[0].data,
                            (size_t)a.width * (size_t)a.height * sizeof(float));
        io_image_free(&a);
        io_image_free(&b);
    }
    assert_int_equal(io_probe(output, &after, support_logger()), 0);
    assert_int_equal(after.channel_count, before.channel_count + 1);
    for (int32_t i = 0; i < before.channel_count; i++) {
        const io_channel *same = io_image_find(&after, before.channels[i].name);
        assert_int_equal(same->is_half, before.channels[i].is_half);
    }
    io_image_free(&before);
    io_image_free(&after);
}

static void expect_picture(const char *output, const char *name, const io_image *picture)
{
    io_image read;
    const char *const names[] = {name};
    assert_int_equal(io_read(output, names, 1, &read, support_logger()), 0);
    for (int32_t y = 0; y < read.height; y++)
        for (int32_t x = 0; x < read.width; x++) {
            const int32_t px = x + read.data_x - picture->data_x;
            const int32_t py = y + read.data_y - picture->data_y;
            const bool inside =
                px >= 0 && py >= 0 && px < picture->width && py < picture->height;
            const float expected =
                inside ? picture->channels[0].data[py * picture->width + px] : 1.0f;
            const float value = read.channels[0].data[y * read.width + x];
            if (value < expected || value > expected)
                fail_msg("(%d, %d) is %g, not %g", x, y, (double)value, (double)expected);
        }
    io_image_free(&read);
}

static support_part some_part(exr_compression_t compression)
{
    return (support_part){
        .storage = EXR_STORAGE_SCANLINE,
        .compression = compression,
        .min_x = -3,
        .min_y = 5,
        .width = 37,
        .height = 71,
        .channel_count = 4,
        .channels = {"B", "N.X", "Z", "id"},
        .types = {EXR_PIXEL_HALF, EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, EXR_PIXEL_UINT}};
}

/* More lines than one chunk has, windows that begin anywhere, all types. Lossy ones are
 * compared with what the library reads from the input. */
static void test_compressions(void **state)
{
    static const exr_compression_t all[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,
                                            EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                                            EXR_COMPRESSION_PIZ,  EXR_COMPRESSION_PXR24,
                                            EXR_COMPRESSION_B44,  EXR_COMPRESSION_B44A};
    const char *input = support_path("in.exr"), *output = support_path("copy.exr");
    const int32_t display[4] = {-3, 5, 60, 80};
    (void)state;
    for (size_t i = 0; i < COUNT(all); i++)
        for (int tiled = 0; tiled < 2; tiled++) {
            support_part part = some_part(all[i]);
            const bool lossy = all[i] >= EXR_COMPRESSION_PXR24;
            size_t size;
            attribute a = {0};
            part.channel_count -= lossy; /* several channels of 32 bits are misread */
            part.storage = tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE;
            part.tile_width = 16;
            part.tile_height = 20;
            support_make_exr(input, &part, 1, display, NULL, NULL);
            io_image picture = make_picture(0, 0, part.width, part.height);
            assert_int_equal(append(input, output, "Z", "AO", &picture, &no_options), 0);
            expect_same_pixels(input, output);
            expect_same_attributes(input, output, 1);
            expect_picture(output, "AO", &picture);
            unsigned char *file = support_read_file(output, &size);
            assert_true(find_attribute(file, 0, "compression", &a));
            assert_int_equal(a.data[0], lossy ? EXR_COMPRESSION_ZIP : all[i]);
            free(file);
            io_image_free(&picture);
        }
    assert_int_equal(support_lines.errors, 0);
    support_forget();
}

/* Brightness in full resolution and colours in half of it lie in one chunk. */
static void test_subsampled_neighbours(void **state)
{
    const char *input = support_path("chroma.exr"), *output = support_path("copy.exr");
    support_part part = some_part(EXR_COMPRESSION_ZIP);
    io_image picture = make_picture(0, 0, 36, 70);
    (void)state;
    part.min_x = part.min_y = 0;
    part.width = 36;
    part.height = 70;
    part.sampling = 2;
    part.channels[3] = "chroma";
    part.types[3] = EXR_PIXEL_FLOAT;
    support_make_exr(input, &part, 1, NULL, NULL, NULL);
    assert_int_equal(append(input, output, "Z", "AO", &picture, &no_options), 0);
    expect_picture(output, "AO", &picture);
    const char *const name[] = {"Z"};
    io_image a, b;
    assert_int_equal(io_read(input, name, 1, &a, NULL), 0);
    assert_int_equal(io_read(output, name, 1, &b, NULL), 0);
    assert_memory_equal(a.channels[0].data, b.channels[0].data, 36 * 70 * sizeof(float));
    io_image_free(&a);
    io_image_free(&b);
    io_image_free(&picture);
    support_forget();
}

static void test_upside_down(void **state)
{
    const char *input = support_path("down.exr"), *output = support_path("copy.exr");
    support_part part = some_part(EXR_COMPRESSION_ZIP);
    io_image picture = make_picture(0, 0, part.width, part.height);
    (void)state;
    support_make_exr(input, &part, 1, NULL, NULL, NULL);
    support_turn_upside_down(input, 5);
    assert_int_equal(append(input, output, "Z", "AO", &picture, &no_options), 0);
    expect_same_pixels(input, output);
    expect_picture(output, "AO", &picture);
    io_image_free(&picture);
    support_forget();
}

enum { SIZE = 4 };

static void declare(exr_context_t context, int part, const char *name,
                    exr_storage_t storage)
{
    const exr_attr_v2f_t centre = {.x = 0.0f, .y = 0.0f};
    const exr_attr_box2i_t window = {.max = {.x = SIZE - 1, .y = SIZE - 1}};
    int index;
    ok(exr_add_part(context, name, storage, &index));
    assert_int_equal(index, part);
    ok(exr_initialize_required_attr(context, part, &window, &window, 1.0f, &centre, 1.0f,
                                    EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_NONE));
}

/* What productions keep in headers, and a type that nobody knows. */
static void describe(exr_context_t context, int part)
{
    static const char manifest[] = "{\"hero\":\"3c2a\",\"floor \\u00e4\":\"00ff\"}";
    const exr_attr_timecode_t time = {.time_and_flags = 0x12345678u,
                                      .user_data = 0x9abcdef0u};
    const exr_attr_chromaticities_t colours = {.red_x = 0.7f, .white_y = 0.33f};
    static const unsigned char unknown[] = {1, 0, 2, 0, 3};
    const char *views[] = {"left", "right"};
    ok(exr_attr_set_timecode(context, part, "timeCode", &time));
    ok(exr_attr_set_chromaticities(context, part, "chromaticities", &colours));
    ok(exr_attr_set_string(context, part, "cryptomatte/abc1234/manifest", manifest));
    ok(exr_attr_set_string(context, part, "empty", ""));
    ok(exr_attr_set_string_vector(context, part, "multiView", 2, views));
    ok(exr_attr_set_double(context, part, "exposure", 0.1));
    ok(exr_attr_set_string(context, part, "an attribute's name of more than 31 bytes",
                           "x"));
    ok(exr_attr_set_user(context, part, "private", "studioType", sizeof unknown,
                         unknown));
}

/* Lines of one float channel, not packed. The bits are those of a quiet and of a
 * signalling NaN, an infinity and a denormal, which nothing may convert. */
static void write_lines(exr_context_t context, int part)
{
    const uint32_t bits[SIZE] = {0x7fc12345u, 0x7f812345u, 0xff800000u, 0x00000001u};
    for (int y = 0; y < SIZE; y++)
        ok(exr_write_scanline_chunk(context, part, y, bits, sizeof bits));
}

/* One sample a pixel. */
static void write_deep(exr_context_t context, int part)
{
    const int32_t samples[SIZE] = {1, 2, 3, 4};
    for (int y = 0; y < SIZE; y++) {
        const float depth[SIZE] = {1.0f, 2.0f, 3.0f, (float)y};
        ok(exr_write_deep_scanline_chunk(context, part, y, depth, sizeof depth,
                                         sizeof depth, samples, sizeof samples));
    }
}

static void make_studio_file(const char *path, bool with_parts)
{
    exr_context_t context = NULL;
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    ok(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &initializer));
    ok(exr_set_longname_support(context, 1));
    declare(context, 0, with_parts ? "depth" : NULL, EXR_STORAGE_SCANLINE);
    ok(exr_add_channel(context, 0, "Z", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1));
    describe(context, 0);
    if (with_parts) {
        ok(exr_set_version(context, 0, 1));
        declare(context, 1, "deep", EXR_STORAGE_DEEP_SCANLINE);
        ok(exr_add_channel(context, 1, "Z", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC,
                           1, 1));
    }
    ok(exr_write_header(context));
    write_lines(context, 0);
    if (with_parts)
        write_deep(context, 1);
    ok(exr_finish(&context));
}

static void test_attributes(void **state)
{
    const char *input = support_path("studio.exr"), *output = support_path("copy.exr");
    io_image picture = make_picture(0, 0, SIZE, SIZE);
    char made[IO_MADE_SIZE];
    (void)state;
    make_studio_file(input, false);
    assert_int_equal(append(input, output, "Z", "View Layer.AO2", &picture, &no_options),
                     0);
    expect_same_attributes(input, output, 1);
    expect_same_pixels(input, output);
    expect_picture(output, "View Layer.AO2", &picture);
    io_append_made(output, "View Layer.AO2", made);
    assert_string_equal(made, "by hand");
    io_append_made(output, "AO", made);
    assert_string_equal(made, "");
    io_image_free(&picture);
    assert_int_equal(support_lines.errors, 0);
    support_forget();
}

/* Parts stay, deep ones too, and the channel gets a part of its own. */
static void test_parts(void **state)
{
    const char *input = support_path("parts.exr"), *output = support_path("copy.exr");
    io_image picture = make_picture(1, 0, 2, 3), twice = {0};
    const io_append_options half = {.half = true, .replace = true};
    size_t size;
    attribute a = {0}, b = {0};
    (void)state;
    make_studio_file(input, true);
    assert_int_equal(append(input, output, "depth.Z", "AO", &picture, &no_options), 0);
    expect_same_attributes(input, output, 2);
    expect_picture(output, "AO", &picture);
    unsigned char *before = support_read_file(input, &size);
    unsigned char *after = support_read_file(output, &size);
    /* What all parts must agree on. */
    assert_true(find_attribute(before, 0, "timeCode", &a));
    assert_true(find_attribute(after, 2, "timeCode", &b));
    assert_memory_equal(a.data, b.data, a.size);
    assert_true(find_attribute(after, 2, "name", &b));
    assert_memory_equal(b.data, "AO", 2);
    assert_false(find_attribute(after, 2, "cryptomatte/abc1234/manifest", &b));
    free(before);
    free(after);
    /* Pixels that are deep, one by one. */
    for (int y = 0; y < SIZE; y++) {
        exr_context_t files[2];
        float depth[2][SIZE];
        int32_t samples[2][SIZE];
        for (int i = 0; i < 2; i++) {
            exr_chunk_info_t info;
            ok(exr_start_read(&files[i], i ? output : input, NULL));
            ok(exr_read_scanline_chunk_info(files[i], 1, y, &info));
            ok(exr_read_deep_chunk(files[i], 1, &info, depth[i], samples[i]));
            ok(exr_finish(&files[i]));
        }
        assert_memory_equal(depth[0], depth[1], sizeof depth[0]);
        assert_memory_equal(samples[0], samples[1], sizeof samples[0]);
    }
    /* A second one, into the copy, and again in place of the first. */
    const char *second = support_path("second.exr"), *third = support_path("third.exr");
    assert_int_equal(append(output, second, "depth.Z", "AO", &picture, &no_options), -1);
    support_expect_error(output, "has a channel \"AO\" already");
    assert_int_equal(append(output, second, "depth.Z", "deep", &picture, &no_options),
                     -1);
    support_expect_error(output, "has a part \"deep\" already");
    assert_int_equal(append(output, second, "depth.Z", "AO2", &picture, &no_options), 0);
    for (int32_t i = 0; i < 6; i++)
        picture.channels[0].data[i] = 0.5f;
    assert_int_equal(append(second, third, "depth.Z", "AO", &picture, &half), 0);
    expect_picture(third, "AO", &picture);
    assert_int_equal(io_probe(third, &twice, support_logger()), 0);
    assert_int_equal(twice.channel_count, 3);
    assert_true(io_image_find(&twice, "AO")->is_half);
    assert_false(io_image_find(&twice, "AO2")->is_half);
    io_image_free(&twice);
    io_image_free(&picture);
    support_forget();
}

static void test_clashes(void **state)
{
    const char *input = support_path("in.exr"), *output = support_path("clash.exr");
    support_part part = some_part(EXR_COMPRESSION_ZIP);
    io_image picture = make_picture(0, 0, part.width, part.height);
    const io_append_options replace = {.replace = true};
    bool leftovers;
    (void)state;
    support_make_exr(input, &part, 1, NULL, NULL, NULL);
    const int files = support_file_count(&leftovers);
    assert_int_equal(append(input, output, "Z", "N.X", &picture, &no_options), -1);
    support_expect_error(input, "has a channel \"N.X\" already");
    const io_addition two[2] = {
        {.picture = &picture, .beside = "Z", .name = "AO", .is_added = true},
        {.picture = &picture, .beside = "Z", .name = "AO", .is_added = true}};
    assert_int_equal(io_append_check(input, two, 2, &no_options, support_logger()), -1);
    support_expect_error(input, "would be added twice");
    assert_int_equal(support_file_count(&leftovers), files);
    assert_int_equal(append(input, output, "Z", "N.X", &picture, &replace), 0);
    expect_picture(output, "N.X", &picture);
    io_image_free(&picture);
    support_forget();
}

static void test_levels(void **state)
{
    const char *input = support_path("levels.exr"), *output = support_path("no.exr");
    const exr_attr_v2f_t centre = {.x = 0.0f, .y = 0.0f};
    const exr_attr_box2i_t window = {.max = {.x = SIZE - 1, .y = SIZE - 1}};
    io_image picture = make_picture(0, 0, SIZE, SIZE);
    exr_context_t context = NULL;
    const float pixels[SIZE * SIZE] = {1.0f};
    (void)state;
    ok(exr_start_write(&context, input, EXR_WRITE_FILE_DIRECTLY, NULL));
    for (int part = 0; part < 2; part++) {
        int index;
        ok(exr_add_part(context, part ? "b" : "a", EXR_STORAGE_TILED, &index));
        ok(exr_initialize_required_attr(context, part, &window, &window, 1.0f, &centre,
                                        1.0f, EXR_LINEORDER_INCREASING_Y,
                                        EXR_COMPRESSION_NONE));
        ok(exr_set_tile_descriptor(context, part, SIZE, SIZE, EXR_TILE_MIPMAP_LEVELS,
                                   EXR_TILE_ROUND_DOWN));
        ok(exr_add_channel(context, part, "Z", EXR_PIXEL_FLOAT,
                           EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
    }
    ok(exr_write_header(context));
    for (int part = 0; part < 2; part++)
        for (int level = 0, size = SIZE; size; level++, size /= 2)
            ok(exr_write_tile_chunk(context, part, 0, 0, level, level, pixels,
                                    (uint64_t)(size * size) * sizeof(float)));
    ok(exr_finish(&context));
    /* As a part of its own it needs no levels; in their part it does. */
    const io_append_options replace = {.replace = true};
    assert_int_equal(append(input, output, "a.Z", "a.Z", &picture, &replace), -1);
    support_expect_error(input, "mip-map levels");
    assert_int_equal(append(input, output, "a.Z", "AO", &picture, &no_options), 0);
    expect_same_pixels(input, output);
    expect_same_attributes(input, output, 2);
    io_image_free(&picture);
    support_forget();
}

/* A frame of Blender with the passes of a compositor's day: 39 channels with spaces in
 * their names, whose bits are any, as those of Cryptomattes are. */
static void test_many_channels(void **state)
{
    static const char *const layers[] = {"AO.RGB",
                                         "Combined.RGBA",
                                         "CryptoObject00.rgba",
                                         "CryptoObject01.rgba",
                                         "Crypto02.rgba",
                                         "Albedo.RGB",
                                         "Denoising Depth.Z",
                                         "Denoising Normal.XYZ",
                                         "Depth.Z",
                                         "IndexOB.X",
                                         "Mist.Z",
                                         "Normal.XYZ",
                                         "Position.XYZ",
                                         "Vector.XYZW"};
    enum { CHANNELS = 39, WIDE = 20, HIGH = 33 };
    static char names[CHANNELS][64];
    static uint32_t bits[CHANNELS][WIDE * HIGH];
    const char *list[CHANNELS];
    const float *planes[CHANNELS];
    const char *input = support_path("blender.exr"), *output = support_path("copy.exr");
    uint32_t random = 12345;
    int count = 0;
    (void)state;
    for (size_t i = 0; i < COUNT(layers); i++) {
        const char *dot = strchr(layers[i], '.');
        for (const char *letter = dot + 1; *letter; letter++, count++) {
            assert_true(count < CHANNELS);
            snprintf(names[count], sizeof names[0], "View Layer.%.*s.%c",
                     (int)(dot - layers[i]), layers[i], *letter);
            for (int k = 0; k < WIDE * HIGH; k++) /* Numerical Recipes' generator */
                bits[count][k] = random = random * 1664525u + 1013904223u;
            list[count] = names[count];
            planes[count] = (const float *)(const void *)bits[count];
        }
    }
    assert_int_equal(count, CHANNELS);
    support_make_plain_exr(input, list, CHANNELS, WIDE, HIGH, planes);
    io_image picture = make_picture(0, 0, WIDE, HIGH);
    assert_int_equal(append(input, output, "View Layer.Depth.Z", "View Layer.AO2",
                            &picture, &no_options),
                     0);
    expect_same_pixels(input, output);
    expect_same_attributes(input, output, 1);
    expect_picture(output, "View Layer.AO2", &picture);
    io_image_free(&picture);
    support_forget();
}

/* What is multiplied, by hand. */
static void test_multiplied(void **state)
{
    const char *input = support_path("colour.exr"), *output = support_path("copy.exr");
    const float big = 1e30f, infinite = INFINITY;
    const float r[4] = {8.0f, 8.0f, 8.0f, 8.0f};
    const float g[4] = {infinite, 8.0f, -8.0f, big};
    const float other[4] = {3.0f, 3.0f, 3.0f, 3.0f};
    static const char *const names[] = {"a.R", "a.G", "Z"};
    const float *const planes[] = {r, g, other};
    static const char *const multiplied[] = {"a.R", "a.G"};
    io_image picture = make_picture(0, 0, 4, 1), read; /* 0, 1/4, 1/2, 3/4 */
    const io_append_options tinted = {.tint = {0.5f, 0.0f, 1.0f}};
    io_addition addition = {.picture = &picture,
                            .beside = "Z",
                            .name = "AO",
                            .multiplied_count = 2,
                            .multiplied = multiplied};
    (void)state;
    support_make_plain_exr(input, names, 3, 4, 1, planes);
    assert_int_equal(io_append(input, output, &addition, 1, &tinted, support_logger()),
                     0);
    assert_int_equal(io_read(output, NULL, 0, &read, support_logger()), 0);
    assert_int_equal(read.channel_count, 3);
    /* 8 (1/2 + 1/2 AO), and -8 AO; an infinite colour in the dark is dark. */
    const float red[4] = {4.0f, 5.0f, 6.0f, 7.0f};
    const float green[4] = {0.0f, 2.0f, -4.0f, big * 0.75f};
    assert_memory_equal(io_image_find(&read, "a.R")->data, red, sizeof red);
    assert_memory_equal(io_image_find(&read, "a.G")->data, green, sizeof green);
    assert_memory_equal(io_image_find(&read, "Z")->data, other, sizeof other);
    io_image_free(&read);
    static const char *const missing[] = {"a.Q"};
    addition.multiplied_count = 1;
    addition.multiplied = missing;
    assert_int_equal(io_append_check(input, &addition, 1, &tinted, support_logger()), -1);
    support_expect_error(input, "a.Q");
    io_image_free(&picture);
    support_forget();
}

/* Each colour by its own factor, other channels by the mean of the three, tints on top;
 * pixels without a factor stay. */
static void test_factors(void **state)
{
    const char *input = support_path("colour.exr"), *output = support_path("copy.exr");
    static const char *const names[] = {"a.B", "a.G", "a.R", "y"};
    static const char *const colours[] = {"R", "G", "B"};
    const float eight[3] = {8.0f, 8.0f, 8.0f};
    const float *const planes[] = {eight, eight, eight, eight};
    io_image picture = make_picture(0, 0, 3, 1), factors, read;
    const io_append_options tinted = {.tint = {0.5f, 0.0f, 0.0f}};
    (void)state;
    assert_int_equal(io_image_init(&factors, 2, 1, colours, 3, NULL), 0);
    for (int32_t i = 0; i < 2; i++) {
        factors.channels[0].data[i] = 0.5f;
        factors.channels[1].data[i] = 0.25f;
        factors.channels[2].data[i] = i ? 1.0f : 0.75f;
    }
    factors.data_x = 1;
    const io_addition addition = {.picture = &picture,
                                  .beside = "y",
                                  .name = "AO",
                                  .is_added = true,
                                  .multiplied_count = 4,
                                  .multiplied = names,
                                  .factors = &factors};
    support_make_plain_exr(input, names, 4, 3, 1, planes);
    assert_int_equal(io_append(input, output, &addition, 1, &tinted, support_logger()),
                     0);
    assert_int_equal(io_read(output, NULL, 0, &read, support_logger()), 0);
    const float red[3] = {8.0f, 6.0f, 6.0f}, green[3] = {8.0f, 2.0f, 2.0f};
    const float blue[3] = {8.0f, 6.0f, 8.0f};
    assert_memory_equal(io_image_find(&read, "a.R")->data, red, sizeof red);
    assert_memory_equal(io_image_find(&read, "a.G")->data, green, sizeof green);
    assert_memory_equal(io_image_find(&read, "a.B")->data, blue, sizeof blue);
    /* The mean is 1/2, then 7/12; the tint's is 1/6. */
    const float *other = io_image_find(&read, "y")->data;
    assert_float_equal(other[0], 8.0f, 0.0f);
    assert_float_equal(other[1], 8.0f * (1.0f + 5.0f / 2.0f) / 6.0f, 1e-6f);
    assert_float_equal(other[2], 8.0f * (1.0f + 35.0f / 12.0f) / 6.0f, 1e-6f);
    /* What is added is the picture itself. */
    assert_memory_equal(io_image_find(&read, "AO")->data, picture.channels[0].data,
                        3 * sizeof(float));
    io_image_free(&read);
    io_image_free(&factors);
    io_image_free(&picture);
    support_forget();
}

/* Three channels of one picture, 0 where it does not reach; in a file of several parts
 * they share one. */
static void test_vectors(void **state)
{
    static const char *const names[] = {"bent.X", "bent.Y", "bent.Z"};
    const char *output = support_path("copy.exr");
    io_image picture;
    (void)state;
    assert_int_equal(io_image_init(&picture, 2, 3, names, 3, NULL), 0);
    picture.data_x = 1;
    for (int32_t i = 0; i < 18; i++) /* channels lie in a row */
        picture.channels[0].data[i] = (float)(i + 1) / 32.0f;
    for (int parts = 0; parts < 2; parts++) {
        const char *input = support_path("in.exr");
        io_image probed, read;
        io_addition additions[3];
        size_t size;
        attribute a;
        make_studio_file(input, parts);
        assert_int_equal(io_probe(input, &probed, support_logger()), 0);
        for (int32_t i = 0; i < 3; i++)
            additions[i] = (io_addition){.picture = &picture,
                                         .channel = i,
                                         .beside = parts ? "depth.Z" : "Z",
                                         .name = names[i],
                                         .is_added = true,
                                         .zero_outside = true,
                                         .part = "bent"};
        const int32_t before = probed.channel_count;
        io_image_free(&probed);
        assert_int_equal(
            io_append(input, output, additions, 3, &no_options, support_logger()), 0);
        assert_int_equal(io_probe(output, &probed, support_logger()), 0);
        assert_int_equal(probed.channel_count, before + 3);
        io_image_free(&probed);
        assert_int_equal(io_read(output, names, 3, &read, support_logger()), 0);
        for (int32_t c = 0; c < 3; c++)
            for (int32_t y = 0; y < read.height; y++)
                for (int32_t x = 0; x < read.width; x++) {
                    const int32_t column = x + read.data_x - picture.data_x;
                    const int32_t row = y + read.data_y - picture.data_y;
                    const bool inside = column >= 0 && column < 2 && row >= 0 && row < 3;
                    const float expected =
                        inside ? picture.channels[c].data[2 * row + column] : 0.0f;
                    assert_float_equal(read.channels[c].data[y * read.width + x],
                                       expected, 0.0f);
                }
        io_image_free(&read);
        unsigned char *file = support_read_file(output, &size);
        if (parts) {
            assert_true(find_attribute(file, 2, "name", &a));
            assert_int_equal(a.size, 4);
            assert_memory_equal(a.data, "bent", 4);
        }
        /* Nobody said how they were made. */
        assert_false(find_attribute(file, parts ? 2 : 0, "crevice.bent.X", &a));
        free(file);
    }
    io_image_free(&picture);
    support_forget();
}

/* Half floats are rounded to the nearest: 3 * 1/4 and 2047 * 3/4 = 1535.25, of which the
 * step is 1; integers are refused. */
static void test_multiplied_types(void **state)
{
    const char *input = support_path("in.exr"), *output = support_path("copy.exr");
    support_part part = some_part(EXR_COMPRESSION_PIZ);
    static const char *const half[] = {"B"}, *const whole[] = {"id"};
    io_image picture = make_picture(0, 0, part.width, part.height), before, after;
    io_addition addition = {.picture = &picture,
                            .beside = "Z",
                            .name = "AO",
                            .multiplied_count = 1,
                            .multiplied = half};
    (void)state;
    support_make_exr(input, &part, 1, NULL, NULL, NULL);
    assert_int_equal(
        io_append(input, output, &addition, 1, &no_options, support_logger()), 0);
    assert_int_equal(io_read(input, half, 1, &before, support_logger()), 0);
    assert_int_equal(io_read(output, half, 1, &after, support_logger()), 0);
    for (int32_t i = 0; i < part.width * part.height; i++) {
        const float exact = before.channels[0].data[i] * picture.channels[0].data[i];
        int exponent;
        frexpf(exact, &exponent);
        const float step = ldexpf(1.0f, exponent - 11);
        assert_true(fabsf(after.channels[0].data[i] - exact) <= 0.5f * step);
    }
    io_image_free(&before);
    io_image_free(&after);
    addition.multiplied = whole;
    assert_int_equal(
        io_append(input, output, &addition, 1, &no_options, support_logger()), -1);
    support_expect_error(input, "integers");
    io_image_free(&picture);
    support_forget();
}

/* A file that ends in the middle has no copy. */
static void test_cut_off(void **state)
{
    const char *input = support_path("in.exr"), *cut = support_path("cut.exr");
    const char *output = support_path("none.exr");
    support_part part = some_part(EXR_COMPRESSION_ZIP);
    io_image picture = make_picture(0, 0, part.width, part.height);
    char made[IO_MADE_SIZE];
    size_t size;
    bool leftovers = true;
    (void)state;
    support_make_exr(input, &part, 1, NULL, NULL, NULL);
    unsigned char *file = support_read_file(input, &size);
    support_write_file(cut, file, size - 10);
    free(file);
    assert_int_equal(append(cut, output, "Z", "AO", &picture, &no_options), -1);
    support_expect_error(cut, "is damaged or cut off");
    support_file_count(&leftovers);
    assert_false(leftovers);
    assert_null(fopen(output, "rb"));
    /* A result that is cut off says nothing of how it was made. */
    assert_int_equal(append(input, output, "Z", "AO", &picture, &no_options), 0);
    file = support_read_file(output, &size);
    support_write_file(cut, file, size - 10);
    free(file);
    io_append_made(cut, "AO", made);
    assert_string_equal(made, "");
    io_image_free(&picture);
    support_forget();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_compressions), cmocka_unit_test(test_subsampled_neighbours),
        cmocka_unit_test(test_upside_down),  cmocka_unit_test(test_attributes),
        cmocka_unit_test(test_parts),        cmocka_unit_test(test_clashes),
        cmocka_unit_test(test_levels),       cmocka_unit_test(test_many_channels),
        cmocka_unit_test(test_factors),      cmocka_unit_test(test_vectors),
        cmocka_unit_test(test_multiplied),   cmocka_unit_test(test_multiplied_types),
        cmocka_unit_test(test_cut_off)};
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}

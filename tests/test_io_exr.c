/* SPDX-License-Identifier: MIT */
/* EXR files that OpenEXRCore wrote, read by io/, and the other way round. */
#include "test_io_support.h"

static support_part three_types(void)
{
    return (support_part){.storage = EXR_STORAGE_SCANLINE,
                          .compression = EXR_COMPRESSION_ZIP,
                          .width = 37,
                          .height = 45,
                          .tile_width = 16,
                          .tile_height = 8,
                          .channel_count = 3,
                          .channels = {"N.X", "Z", "id"},
                          .types = {EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, EXR_PIXEL_UINT}};
}

/* Every pixel of part p's channel c must hold what was put there. */
static void expect_channel(const io_image *image, const char *name, int p, int c)
{
    const io_channel *channel = io_image_find(image, name);
    assert_non_null(channel);
    for (int32_t y = 0; y < image->height; y++)
        for (int32_t x = 0; x < image->width; x++) {
            const float got = channel->data[y * image->width + x];
            if (got != support_value(p, c, x, y))
                fail_msg("%s at (%d, %d): %g instead of %g", name, x, y, (double)got,
                         (double)support_value(p, c, x, y));
        }
}

static void read_and_expect(const char *path, const support_part *part)
{
    io_image image;
    support_forget();
    if (io_read(path, NULL, 0, &image, support_logger()))
        fail_msg("%s", support_lines.error);
    assert_int_equal(image.width, part->width);
    assert_int_equal(image.height, part->height);
    assert_int_equal(image.channel_count, part->channel_count);
    for (int c = 0; c < part->channel_count; c++)
        expect_channel(&image, part->channels[c], 0, c);
    io_image_free(&image);
}

static void test_storage_and_compression(void **state)
{
    (void)state;
    /* The lossless methods; B44 and DWA would change the values. */
    static const exr_compression_t methods[] = {
        EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE, EXR_COMPRESSION_ZIPS,
        EXR_COMPRESSION_ZIP,  EXR_COMPRESSION_PIZ, EXR_COMPRESSION_PXR24};
    const char *path = support_path("stored.exr");
    for (size_t m = 0; m < sizeof methods / sizeof methods[0]; m++)
        for (int tiled = 0; tiled < 2; tiled++) {
            support_part part = three_types();
            part.compression = methods[m];
            part.storage = tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE;
            support_make_exr(path, &part, 1, NULL, NULL, NULL);
            read_and_expect(path, &part);
        }
}

static void test_bottom_up(void **state)
{
    (void)state;
    const char *path = support_path("upwards.exr");
    support_part part = three_types();
    support_make_exr(path, &part, 1, NULL, NULL, NULL);
    support_turn_upside_down(path, 3); /* 45 lines in chunks of 16 */
    read_and_expect(path, &part);
}

static void test_single_channel_of_many(void **state)
{
    (void)state;
    const char *path = support_path("many.exr");
    static const char *const wanted[] = {"id", "N.X"};
    const support_part part = three_types();
    io_image image;
    support_make_exr(path, &part, 1, NULL, NULL, NULL);
    assert_int_equal(io_read(path, wanted, 2, &image, support_logger()), 0);
    assert_int_equal(image.channel_count, 2);
    assert_string_equal(image.channels[0].name, "id"); /* in the order asked for */
    expect_channel(&image, "id", 0, 2);
    expect_channel(&image, "N.X", 0, 0);
    io_image_free(&image);
}

static void test_windows_and_metadata(void **state)
{
    (void)state;
    const char *path = support_path("windows.exr");
    const int32_t display[4] = {10, 20, 10 + 31, 20 + 23};
    float camera[16], ndc[16];
    for (int i = 0; i < 16; i++) {
        camera[i] = (float)i;
        ndc[i] = (float)(100 - i);
    }
    support_part part = three_types();
    part.min_x = 6;
    part.min_y = -3;
    support_make_exr(path, &part, 1, display, camera, ndc);
    read_and_expect(path, &part);
    io_image image;
    assert_int_equal(io_probe(path, &image, support_logger()), 0);
    assert_int_equal(image.data_x, -4);
    assert_int_equal(image.data_y, -23);
    assert_int_equal(image.display_width, 32);
    assert_int_equal(image.display_height, 24);
    assert_true(image.camera.has_world_to_camera && image.camera.has_world_to_ndc);
    assert_memory_equal(image.camera.world_to_camera, camera, sizeof camera);
    assert_memory_equal(image.camera.world_to_ndc, ndc, sizeof ndc);
    assert_int_equal(image.channel_count, 3);
    assert_null(image.channels[0].data);
    io_image_free(&image);
}

static void test_parts(void **state)
{
    (void)state;
    const char *path = support_path("parts.exr");
    static const char *const wanted[] = {"depth.Z", "normal.N.X"};
    static const char *const both[] = {"depth.Z", "small.Z"};
    support_part parts[3] = {three_types(), three_types(), three_types()};
    io_image image;
    parts[0].name = "normal";
    parts[1].name = "depth";
    parts[1].storage = EXR_STORAGE_TILED;
    parts[1].channels[1] = "depth.Z"; /* says its part already */
    parts[1].channels[0] = "a";
    parts[2].name = "small";
    parts[2].width = 5;
    support_make_exr(path, parts, 3, NULL, NULL, NULL);
    assert_int_equal(io_probe(path, &image, support_logger()), 0);
    assert_int_equal(image.channel_count, 9);
    assert_non_null(io_image_find(&image, "normal.id"));
    assert_non_null(io_image_find(&image, "small.N.X"));
    io_image_free(&image);
    assert_int_equal(io_read(path, wanted, 2, &image, support_logger()), 0);
    expect_channel(&image, "depth.Z", 1, 1);
    expect_channel(&image, "normal.N.X", 0, 0);
    io_image_free(&image);
    support_forget();
    assert_int_equal(io_read(path, both, 2, &image, support_logger()), -1);
    support_expect_error(path, "different data windows");
}

static void test_subsampled_refused(void **state)
{
    (void)state;
    const char *path = support_path("chroma.exr");
    static const char *const full[] = {"Z"};
    support_part part = three_types();
    io_image image;
    part.width = 32;
    part.height = 32;
    part.sampling = 2;
    part.types[2] = EXR_PIXEL_FLOAT;
    support_make_exr(path, &part, 1, NULL, NULL, NULL);
    support_forget();
    assert_int_equal(io_read(path, NULL, 0, &image, support_logger()), -1);
    support_expect_error(path, "subsampling");
    assert_int_equal(io_read(path, full, 1, &image, support_logger()), 0);
    expect_channel(&image, "Z", 0, 1);
    io_image_free(&image);
}

/* The header alone: that is as far as a deep file is looked at. */
static void make_deep_header(const char *path)
{
    const exr_attr_box2i_t window = {.max = {.x = 3, .y = 3}};
    const exr_attr_v2f_t centre = {.x = 0.0f, .y = 0.0f};
    exr_context_t context = NULL;
    int part = 0;
    assert_int_equal(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, NULL), 0);
    assert_int_equal(exr_add_part(context, "deep", EXR_STORAGE_DEEP_SCANLINE, &part), 0);
    assert_int_equal(
        exr_initialize_required_attr(context, part, &window, &window, 1.0f, &centre, 1.0f,
                                     EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_ZIPS),
        0);
    assert_int_equal(exr_add_channel(context, part, "Z", EXR_PIXEL_FLOAT,
                                     EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1),
                     0);
    assert_int_equal(exr_write_header(context), 0);
    exr_finish(&context);
}

static void test_deep_refused(void **state)
{
    (void)state;
    const char *path = support_path("deep.exr");
    io_image image;
    make_deep_header(path);
    support_forget();
    assert_int_equal(io_read(path, NULL, 0, &image, support_logger()), -1);
    support_expect_error(path, "deep");
}

/* Decodes a channel with OpenEXRCore alone, in the file's own type. */
static void decode_natively(const char *path, const char *name, exr_pixel_type_t type,
                            int32_t min_y, int32_t width, int32_t height, void *out)
{
    exr_context_t context = NULL;
    exr_chunk_info_t info;
    int32_t lines = 0;
    const int32_t bytes = type == EXR_PIXEL_HALF ? 2 : 4;
    bool found = false;
    assert_int_equal(exr_start_read(&context, path, NULL), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_scanlines_per_chunk(context, 0, &lines), EXR_ERR_SUCCESS);
    for (int32_t y = 0; y < height; y += lines) {
        exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
        assert_int_equal(exr_read_scanline_chunk_info(context, 0, min_y + y, &info), 0);
        assert_int_equal(exr_decoding_initialize(context, 0, &info, &decode), 0);
        for (int16_t c = 0; c < decode.channel_count; c++) {
            exr_coding_channel_info_t *channel = &decode.channels[c];
            if (strcmp(channel->channel_name, name))
                continue;
            found = true;
            assert_int_equal(channel->data_type, type);
            channel->decode_to_ptr = (uint8_t *)out + y * width * bytes;
            channel->user_pixel_stride = bytes;
            channel->user_line_stride = width * bytes;
        }
        assert_int_equal(exr_decoding_choose_default_routines(context, 0, &decode), 0);
        assert_int_equal(exr_decoding_run(context, 0, &decode), 0);
        exr_decoding_destroy(context, &decode);
    }
    assert_true(found);
    exr_finish(&context);
}

static void make_image(io_image *image, int32_t width, int32_t height)
{
    static const char *const names[] = {"Z", "AO",
                                        "a channel with a name beyond 31 bytes"};
    assert_int_equal(io_image_init(image, width, height, names, 3, NULL), 0);
    for (int c = 0; c < 3; c++)
        for (int32_t i = 0; i < width * height; i++)
            image->channels[c].data[i] = support_value(0, c, i % width, i / width);
}

static void test_written_floats(void **state)
{
    (void)state;
    enum { W = 33, H = 35 };
    const char *path = support_path("floats.exr");
    static float got[W * H];
    io_image image;
    make_image(&image, W, H);
    image.data_x = -3;
    image.data_y = 4;
    image.display_width = 40;
    image.display_height = 50;
    support_forget();
    if (io_write(path, &image, NULL, support_logger()))
        fail_msg("%s", support_lines.error);
    for (int c = 0; c < 3; c++) {
        decode_natively(path, image.channels[c].name, EXR_PIXEL_FLOAT, 4, W, H, got);
        assert_memory_equal(got, image.channels[c].data, sizeof got);
    }
    io_image back;
    assert_int_equal(io_probe(path, &back, support_logger()), 0);
    assert_int_equal(back.data_x, -3);
    assert_int_equal(back.data_y, 4);
    assert_int_equal(back.display_width, 40);
    assert_int_equal(back.display_height, 50);
    io_image_free(&back);
    io_image_free(&image);
}

static void test_written_halves(void **state)
{
    (void)state;
    const char *path = support_path("halves.exr");
    static const char *const names[] = {"AO"};
    const io_write_options options = {.half = true};
    /* IEEE 754 half precision by hand: sign, 5 exponent bits (bias 15), 10 bits. */
    const float values[4] = {0.0f, 1.0f, 0.5f, 0.333251953125f};
    const uint16_t expected[4] = {0x0000, 0x3c00, 0x3800, 0x3555};
    uint16_t got[4] = {0};
    io_image image;
    assert_int_equal(io_image_init(&image, 4, 1, names, 1, NULL), 0);
    memcpy(image.channels[0].data, values, sizeof values);
    assert_int_equal(io_write(path, &image, &options, support_logger()), 0);
    decode_natively(path, "AO", EXR_PIXEL_HALF, 0, 4, 1, got);
    assert_memory_equal(got, expected, sizeof got);
    io_image_free(&image);
}

static void test_written_camera(void **state)
{
    (void)state;
    const char *path = support_path("camera.exr");
    static const char *const names[] = {"AO"};
    /* A camera at the origin that looks along -Z, 90 degrees high, on 8 x 4 pixels whose
     * principal point is one pixel right of the middle: x_ndc = (4 x / w + 10 / 2) / 8
     * ... so w = -z, u = (fx x + cx w) / 8 with fx = 2, cx = 5, v = (-2 y + 2 w) / 4. */
    const float ndc[16] = {0.25f,   0,     0, 0,  0, -0.5f, 0, 0,
                           -0.625f, -0.5f, 0, -1, 0, 0,     1, 0};
    io_image image;
    exr_context_t context = NULL;
    exr_attr_v2f_t centre;
    exr_attr_m44f_t matrix;
    float width = 0.0f;
    assert_int_equal(io_image_init(&image, 8, 4, names, 1, NULL), 0);
    image.camera.has_world_to_ndc = true;
    memcpy(image.camera.world_to_ndc, ndc, sizeof ndc);
    assert_int_equal(io_write(path, &image, NULL, support_logger()), 0);
    assert_int_equal(exr_start_read(&context, path, NULL), 0);
    assert_int_equal(exr_get_screen_window_width(context, 0, &width), 0);
    assert_int_equal(exr_get_screen_window_center(context, 0, &centre), 0);
    assert_int_equal(exr_attr_get_m44f(context, 0, "worldToNDC", &matrix), 0);
    /* At distance 1 the window is 8 / 2 = 4 wide, and its middle lies half a unit left of
     * the axis. Exact in binary, so a few ulp are ample. */
    assert_true(width > 3.99999f && width < 4.00001f);
    assert_true(centre.x > -0.50001f && centre.x < -0.49999f);
    assert_true(centre.y > -0.00001f && centre.y < 0.00001f);
    assert_memory_equal(matrix.m, ndc, sizeof ndc);
    exr_finish(&context);
    io_image_free(&image);
}

/* Every small size, so that among them are chunks which pack to exactly their own size:
 * such a chunk must be stored as it is, or readers take it for one that is not packed. */
static void test_chunks_of_equal_size(void **state)
{
    (void)state;
    static const char *const names[] = {"AO"};
    const char *path = support_path("equal.exr");
    uint32_t seed = 1;
    for (int32_t height = 1; height <= 16; height++)
        for (int32_t width = 1; width <= 19; width++) {
            io_image image, again;
            assert_int_equal(io_image_init(&image, width, height, names, 1, NULL), 0);
            /* Some pixels open, the rest not: packs to about as much. */
            for (int32_t i = 0; i < width * height; i++) {
                seed = seed * 1664525u + 1013904223u;
                image.channels[0].data[i] =
                    seed >> 29 < 3 ? 1.0f : (float)(seed >> 8) / 16777216.0f;
            }
            assert_int_equal(io_write(path, &image, NULL, NULL), 0);
            assert_int_equal(io_read(path, NULL, 0, &again, support_logger()), 0);
            assert_memory_equal(again.channels[0].data, image.channels[0].data,
                                (size_t)(width * height) * sizeof(float));
            io_image_free(&again);
            io_image_free(&image);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chunks_of_equal_size),
        cmocka_unit_test(test_storage_and_compression),
        cmocka_unit_test(test_bottom_up),
        cmocka_unit_test(test_single_channel_of_many),
        cmocka_unit_test(test_windows_and_metadata),
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_subsampled_refused),
        cmocka_unit_test(test_deep_refused),
        cmocka_unit_test(test_written_floats),
        cmocka_unit_test(test_written_halves),
        cmocka_unit_test(test_written_camera),
    };
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}

/* SPDX-License-Identifier: MIT */
/* PNG against libpng's simplified interface, PFM against bytes written by hand. */
#include <math.h>
#include <png.h>
#include <sys/stat.h>
#include <unistd.h>

#include "append.h"
#include "test_io_support.h"

static const char *const one[] = {"AO"};
static const char *const rgb[] = {"R", "G", "B"};

static void make(io_image *image, int32_t width, int32_t height, const char *const *names,
                 int32_t count)
{
    assert_int_equal(io_image_init(image, width, height, names, count, NULL), 0);
    support_forget();
}

static void write_ok(const char *path, const io_image *image,
                     const io_write_options *options)
{
    if (io_write(path, image, options, support_logger()))
        fail_msg("%s", support_lines.error);
}

static void read_ok(const char *path, io_image *image)
{
    support_forget();
    if (io_read(path, NULL, 0, image, support_logger()))
        fail_msg("%s", support_lines.error);
}

/* The bytes that a plain PNG reader sees, eight bits, no conversion. */
static void decode_png(const char *path, png_uint_32 format, unsigned char *out,
                       size_t size)
{
    png_image png;
    memset(&png, 0, sizeof png);
    png.version = PNG_IMAGE_VERSION;
    assert_int_not_equal(png_image_begin_read_from_file(&png, path), 0);
    png.format = format;
    assert_int_equal(PNG_IMAGE_SIZE(png), size);
    assert_int_not_equal(png_image_finish_read(&png, NULL, out, 0, NULL), 0);
}

static void test_png_quantises(void **state)
{
    (void)state;
    const char *path = support_path("grey.png");
    /* round(255 v), by hand; out of range is clamped, NaN is 0. */
    const float values[8] = {0.0f, 1.0f, 0.5f, 0.1f, -3.0f, 7.0f, NAN, INFINITY};
    const unsigned char expected[8] = {0, 255, 128, 26, 0, 255, 0, 255};
    unsigned char got[8];
    io_image image;
    make(&image, 4, 2, one, 1);
    memcpy(image.channels[0].data, values, sizeof values);
    write_ok(path, &image, NULL);
    decode_png(path, PNG_FORMAT_GRAY, got, sizeof got);
    assert_memory_equal(got, expected, sizeof got);
    io_image_free(&image);
}

static void test_png_srgb(void **state)
{
    (void)state;
    const char *path = support_path("colour.png");
    const io_write_options options = {.srgb = true};
    /* IEC 61966-2-1: 0.002 -> 12.92 v = 0.02584 -> 6.6; 0.214041 -> 0.5 -> 127.5 (a hair
     * above); 0.5 -> 0.735357 -> 187.5 (a hair above); 0.1 -> 0.349190 -> 89.04. */
    const float red[2] = {0.002f, 0.2141f}, green[2] = {0.5f, 0.1f}, blue[2] = {1, 0};
    const unsigned char expected[6] = {7, 188, 255, 128, 89, 0};
    unsigned char got[6];
    io_image image;
    make(&image, 2, 1, rgb, 3);
    memcpy(image.channels[0].data, red, sizeof red);
    memcpy(image.channels[1].data, green, sizeof green);
    memcpy(image.channels[2].data, blue, sizeof blue);
    write_ok(path, &image, &options);
    decode_png(path, PNG_FORMAT_RGB, got, sizeof got);
    assert_memory_equal(got, expected, sizeof got);
    io_image_free(&image);
}

static void round_trip(const char *path, const char *const *names, int32_t count,
                       const io_write_options *options, float tolerance)
{
    io_image image, back;
    make(&image, 67, 31, names, count);
    for (int32_t c = 0; c < count; c++)
        for (int32_t i = 0; i < 67 * 31; i++)
            image.channels[c].data[i] = support_value(0, c, i % 67, i / 67) / 2047.0f;
    write_ok(path, &image, options);
    read_ok(path, &back);
    assert_int_equal(back.width, 67);
    assert_int_equal(back.height, 31);
    assert_int_equal(back.channel_count, count);
    for (int32_t c = 0; c < count; c++)
        for (int32_t i = 0; i < 67 * 31; i++)
            if (fabsf(back.channels[c].data[i] - image.channels[c].data[i]) > tolerance)
                fail_msg("%s: channel %d, pixel %d: %g instead of %g", path, (int)c,
                         (int)i, (double)back.channels[c].data[i],
                         (double)image.channels[c].data[i]);
    io_image_free(&back);
    io_image_free(&image);
}

static void test_round_trips(void **state)
{
    (void)state;
    const io_write_options eight = {.bits = 8}, sixteen = {.bits = 16};
    const io_write_options half = {.half = true};
    /* Half a step of the format, and a little for the division. */
    round_trip(support_path("a.png"), one, 1, &eight, 0.5001f / 255.0f);
    round_trip(support_path("b.png"), one, 1, &sixteen, 0.51f / 65535.0f);
    round_trip(support_path("c.png"), rgb, 3, &eight, 0.5001f / 255.0f);
    round_trip(support_path("d.png"), rgb, 3, &sixteen, 0.51f / 65535.0f);
    round_trip(support_path("e.pfm"), one, 1, NULL, 0.0f);
    round_trip(support_path("f.PFM"), rgb, 3, NULL, 0.0f);
    round_trip(support_path("g.exr"), one, 1, NULL, 0.0f);
    /* Halves have 11 significant bits: at most 2^-12 below 1. */
    round_trip(support_path("h.exr"), one, 1, &half, 0x1p-12f);
}

/* Writes a PNG with libpng, row by row, of any kind. */
static void encode_png(const char *path, int width, int height, int bits, int type,
                       int interlace, const unsigned char *rows, size_t row_bytes)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_color palette[2] = {{255, 0, 51}, {0, 102, 255}};
    png_bytep pointers[16];
    png_init_io(png, stream);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, bits, type,
                 interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (type == PNG_COLOR_TYPE_PALETTE)
        png_set_PLTE(png, info, palette, 2);
    png_write_info(png, info);
    for (int y = 0; y < height; y++)
        pointers[y] = (png_bytep)(uintptr_t)(rows + (size_t)y * row_bytes);
    png_write_image(png, pointers);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    fclose(stream);
}

static void expect_pixels(const char *path, const char *name, const float *expected,
                          size_t count)
{
    io_image image;
    read_ok(path, &image);
    const io_channel *channel = io_image_find(&image, name);
    assert_non_null(channel);
    for (size_t i = 0; i < count; i++)
        assert_true(fabsf(channel->data[i] - expected[i]) < 1e-6f); /* a few ulp */
    io_image_free(&image);
}

static void test_png_kinds(void **state)
{
    (void)state;
    const char *path = support_path("kind.png");
    const unsigned char packed[2] = {0x80, 0x40}; /* 1 0 / 0 1 */
    const unsigned char wide[4] = {0x80, 0x00, 0xff, 0xff};
    const unsigned char with_alpha[4] = {51, 255, 102, 0};
    const float red[4] = {0.0f, 1.0f, 1.0f, 0.0f};
    const float blue[4] = {1.0f, 0.2f, 0.2f, 1.0f};
    const float bits[4] = {1.0f, 0.0f, 0.0f, 1.0f};
    const float grey16[2] = {32768.0f / 65535.0f, 1.0f};
    const float grey[2] = {0.2f, 0.4f}, alpha[2] = {1.0f, 0.0f};
    encode_png(path, 2, 2, 1, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE, packed, 1);
    expect_pixels(path, "R", red, 4);
    expect_pixels(path, "B", blue, 4);
    encode_png(path, 2, 2, 1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_ADAM7, packed, 1);
    expect_pixels(path, "Y", bits, 4);
    encode_png(path, 2, 1, 16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, wide, 4);
    expect_pixels(path, "Y", grey16, 2);
    encode_png(path, 2, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_INTERLACE_NONE, with_alpha,
               4);
    expect_pixels(path, "Y", grey, 2);
    expect_pixels(path, "A", alpha, 2);
}

static void test_pfm_bytes(void **state)
{
    (void)state;
    /* 1 x 2: the lower row (2.0f) comes first. 1.0f is 3f800000, 2.0f is 40000000. */
    static const char little[] = "Pf\n1 2\n-1.0\n\x00\x00\x00\x40\x00\x00\x80\x3f";
    static const char big[] = "Pf\n1 2\n1.0\n\x40\x00\x00\x00\x3f\x80\x00\x00";
    static const float expected[2] = {1.0f, 2.0f};
    const char *path = support_path("hand.pfm");
    io_image image;
    support_write_file(path, little, sizeof little - 1);
    expect_pixels(path, "Y", expected, 2);
    support_write_file(path, big, sizeof big - 1);
    expect_pixels(path, "Y", expected, 2);
    make(&image, 1, 2, one, 1);
    memcpy(image.channels[0].data, expected, sizeof expected);
    write_ok(path, &image, NULL);
    size_t size = 0;
    unsigned char *data = support_read_file(path, &size);
    assert_int_equal(size, sizeof little - 1);
    assert_memory_equal(data, little, size);
    free(data);
    io_image_free(&image);
}

static void test_format_is_found_by_content(void **state)
{
    (void)state;
    static const char bytes[] = "Pf\n1 1\n-1.0\n\x00\x00\x80\x3f";
    const char *path = support_path("really_pfm.exr");
    const float expected[1] = {1.0f};
    support_write_file(path, bytes, sizeof bytes - 1);
    expect_pixels(path, "Y", expected, 1);
}

static void test_permissions_and_links(void **state)
{
    (void)state;
    char target[256], link_path[256], dangling[256];
    struct stat status;
    io_image image;
    snprintf(target, sizeof target, "%s", support_path("target.pfm"));
    snprintf(link_path, sizeof link_path, "%s", support_path("link.pfm"));
    snprintf(dangling, sizeof dangling, "%s", support_path("dangling.pfm"));
    make(&image, 3, 2, one, 1);
    const mode_t before = umask(027);
    write_ok(target, &image, NULL);
    umask(before);
    assert_int_equal(stat(target, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640); /* 0666 less 0027 */
    assert_int_equal(symlink("target.pfm", link_path), 0);
    image.channels[0].data[0] = 5.0f;
    write_ok(link_path, &image, NULL);
    assert_int_equal(lstat(link_path, &status), 0);
    assert_true(S_ISLNK(status.st_mode));
    io_image back;
    read_ok(target, &back);
    assert_true(back.channels[0].data[0] == 5.0f);
    io_image_free(&back);
    assert_int_equal(symlink("new.pfm", dangling), 0);
    write_ok(dangling, &image, NULL);
    read_ok(support_path("new.pfm"), &back);
    io_image_free(&back);
    io_image_free(&image);
    bool leftovers = true;
    support_file_count(&leftovers);
    assert_false(leftovers);
}

typedef struct shares {
    int count;
    double last;
} shares;

static void note_share(void *user, double share)
{
    shares *s = user;
    /* Each part begins anew. */
    assert_true((share >= s->last || s->last >= 1.0) && share >= 0.0 && share <= 1.0);
    s->last = share;
    s->count++;
}

/* Every row, or every chunk of the calling thread, and in the end of each part. */
static void check_told(shares *told)
{
    assert_in_range(told->count, 1, 3 * 401);
    assert_float_equal(told->last, 1.0, 0.0);
    *told = (shares){0};
}

static void test_long_files_are_told(void **state)
{
    static const char *const files[] = {"told.exr", "told.png", "told.pfm"};
    static const char *const names[] = {"Z"};
    io_image image, again;
    shares told = {0};
    const io_watch watch = {note_share, &told};
    const io_write_options options = {.watch = &watch};
    (void)state;
    assert_int_equal(io_image_init(&image, 8, 400, names, 1, NULL), 0);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        const char *path = support_path(files[i]);
        assert_int_equal(io_write(path, &image, &options, support_logger()), 0);
        check_told(&told);
        assert_int_equal(io_read_watched(path, NULL, 0, &watch, &again, support_logger()),
                         0);
        check_told(&told);
        io_image_free(&again);
    }
    io_image_free(&image);
}

/* One part with a channel more, packed anew; then two that are copied, and a third. */
static void test_long_copies_are_told(void **state)
{
    static const char *const names[] = {"AO"};
    const support_part plain = {
        .width = 8, .height = 400, .channel_count = 1, .channels = {"Z"}};
    support_part parts[2] = {plain, plain};
    parts[1].channels[0] = "R";
    io_image picture;
    shares told = {0};
    const io_watch watch = {note_share, &told};
    const io_append_options options = {.watch = &watch};
    io_addition addition = {.picture = &picture, .name = "AO", .is_added = true};
    (void)state;
    assert_int_equal(io_image_init(&picture, 8, 400, names, 1, NULL), 0);
    for (int count = 1; count <= 2; count++) {
        parts[0].name = count > 1 ? "first" : NULL;
        parts[1].name = "second";
        addition.beside = count > 1 ? "first.Z" : "Z";
        support_make_exr(support_path("two.exr"), parts, count, NULL, NULL, NULL);
        assert_int_equal(io_append(support_path("two.exr"), support_path("more.exr"),
                                   &addition, 1, &options, support_logger()),
                         0);
        check_told(&told);
    }
    io_image_free(&picture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_png_quantises),
        cmocka_unit_test(test_png_srgb),
        cmocka_unit_test(test_round_trips),
        cmocka_unit_test(test_png_kinds),
        cmocka_unit_test(test_pfm_bytes),
        cmocka_unit_test(test_format_is_found_by_content),
        cmocka_unit_test(test_permissions_and_links),
        cmocka_unit_test(test_long_files_are_told),
        cmocka_unit_test(test_long_copies_are_told),
    };
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}

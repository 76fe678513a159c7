/* SPDX-License-Identifier: MIT */
/* Bad input and full disks: one clear line, no picture, nothing left behind. */
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "test_io_support.h"

static const char *const one[] = {"AO"};

static void read_fails(const char *path, const char *part)
{
    io_image image = {.width = 77};
    support_forget();
    assert_int_equal(io_read(path, NULL, 0, &image, support_logger()), -1);
    support_expect_error(path, part);
    assert_int_equal(image.width, 77); /* outputs are untouched */
    assert_int_equal(io_probe(path, &image, NULL) == 0 && !image.channels, 0);
    if (image.width != 77)
        io_image_free(&image);
}

/* What no method compresses. */
static void make_random(io_image *image, int32_t width, int32_t height)
{
    uint32_t seed = 1;
    assert_int_equal(io_image_init(image, width, height, one, 1, NULL), 0);
    for (int32_t i = 0; i < width * height; i++) {
        seed = seed * 1664525u + 1013904223u;
        image->channels[0].data[i] = (float)(seed >> 8) / 16777216.0f;
    }
}

static void write_random(const char *path)
{
    io_image image;
    make_random(&image, 61, 53);
    assert_int_equal(io_write(path, &image, NULL, support_logger()), 0);
    io_image_free(&image);
}

/* Cuts the file at many lengths; each must be refused. */
static void refuse_cuts(const char *path)
{
    size_t size = 0;
    unsigned char *data = support_read_file(path, &size);
    for (size_t i = 1; i < 60; i++) {
        io_image image;
        const size_t length = i < 20 ? size - i : size * (i - 19) / 41;
        support_write_file(path, data, length);
        support_forget();
        if (!io_read(path, NULL, 0, &image, support_logger()))
            fail_msg("%s: cut to %zu of %zu bytes and still read", path, length, size);
        support_expect_error(path, "");
    }
    free(data);
}

static void test_truncated(void **state)
{
    (void)state;
    static const char *const names[] = {"cut.png", "cut.pfm", "cut.exr"};
    for (int i = 0; i < 3; i++) {
        write_random(support_path(names[i]));
        refuse_cuts(support_path(names[i]));
    }
    for (int c = EXR_COMPRESSION_NONE; c <= EXR_COMPRESSION_B44A; c++)
        for (int tiled = 0; tiled < 2; tiled++) {
            const support_part part = {.storage = tiled ? EXR_STORAGE_TILED
                                                        : EXR_STORAGE_SCANLINE,
                                       .compression = (exr_compression_t)c,
                                       .width = 64,
                                       .height = 70,
                                       .tile_width = 32,
                                       .tile_height = 32,
                                       .channel_count = 2,
                                       .channels = {"N.X", "Z"},
                                       .types = {EXR_PIXEL_HALF, EXR_PIXEL_FLOAT}};
            support_make_exr(support_path("cut2.exr"), &part, 1, NULL, NULL, NULL);
            refuse_cuts(support_path("cut2.exr"));
        }
}

/* B44 leaves 32-bit numbers as they are; the C interface finds but the first channel of
 * them. What cannot be read must be refused, and one such channel can be read. */
static void test_b44(void **state)
{
    (void)state;
    for (int floats = 1; floats <= 2; floats++) {
        support_part part = {
            .storage = EXR_STORAGE_SCANLINE,
            .compression = EXR_COMPRESSION_B44,
            .width = 64,
            .height = 70,
            .channel_count = 2,
            .channels = {"N.X", "Z"},
            .types = {floats == 2 ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF, EXR_PIXEL_FLOAT}};
        io_image image = {0};
        support_make_exr(support_path("b44.exr"), &part, 1, NULL, NULL, NULL);
        support_forget();
        const int code =
            io_read(support_path("b44.exr"), NULL, 0, &image, support_logger());
        assert_int_equal(code, floats == 2 ? -1 : 0);
        if (floats == 2)
            support_expect_error(support_path("b44.exr"), "ZIP");
        io_image_free(&image);
    }
}

/* Damage may go unnoticed, since the formats have no checksums everywhere, but must not
 * crash or write outside (for the sanitizers to see). */
static void test_flipped_bytes(void **state)
{
    (void)state;
    static const char *const names[] = {"flip.exr", "flip.png", "flip.pfm"};
    for (int i = 0; i < 3; i++) {
        const char *path = support_path(names[i]);
        size_t size = 0;
        uint32_t seed = 7;
        write_random(path);
        unsigned char *data = support_read_file(path, &size);
        for (int round = 0; round < 400; round++) {
            io_image image;
            seed = seed * 1664525u + 1013904223u;
            /* Most of the trouble is in headers. */
            const size_t range = round % 2 ? size : 450;
            const size_t at = (seed >> 4) % range;
            const unsigned char before = data[at];
            data[at] = (unsigned char)(before ^ (1u << (seed >> 29)));
            support_write_file(path, data, size);
            data[at] = before;
            support_forget();
            if (!io_read(path, NULL, 0, &image, support_logger()))
                io_image_free(&image);
            else
                assert_int_equal(support_lines.errors, 1);
        }
        free(data);
    }
}

static void test_not_a_picture(void **state)
{
    (void)state;
    static const char text[] = "This is a letter and not a picture.\n";
    const char *path = support_path("letter.exr");
    support_write_file(path, text, sizeof text);
    read_fails(path, "not an OpenEXR file in spite of its name");
    path = support_path("letter.txt");
    support_write_file(path, text, sizeof text);
    read_fails(path, "not a picture");
    path = support_path("empty.exr");
    support_write_file(path, text, 0);
    read_fails(path, "empty");
    read_fails(support_path("missing.exr"), "No such file");
    path = support_path("folder.exr");
    assert_int_equal(mkdir(path, 0777), 0);
    read_fails(path, "folder");
    read_fails("/dev/null", "not a regular file");
}

static void test_unreadable(void **state)
{
    (void)state;
    const char *path = support_path("secret.pfm");
    if (geteuid() == 0) {
        print_message("root may read everything; skipped\n");
        skip();
    }
    write_random(path);
    assert_int_equal(chmod(path, 0), 0);
    read_fails(path, "Permission denied");
}

static void test_unknown_channel(void **state)
{
    (void)state;
    const char *path = support_path("channels.exr");
    static const char *const names[] = {"ViewLayer.Depth.Z", "ViewLayer.Normal.X", "AO"};
    static const char *const wanted[] = {"ViewLayer.Depth.V"};
    io_image image;
    assert_int_equal(io_image_init(&image, 2, 2, names, 3, NULL), 0);
    assert_int_equal(io_write(path, &image, NULL, support_logger()), 0);
    io_image_free(&image);
    support_forget();
    assert_int_equal(io_read(path, wanted, 1, &image, support_logger()), -1);
    assert_non_null(
        strstr(support_lines.error, "AO, ViewLayer.Depth.Z, ViewLayer.Normal.X"));
    support_expect_error(path, "did you mean \"ViewLayer.Depth.Z\"?");
}

static void test_forged_sizes(void **state)
{
    (void)state;
    const char *path = support_path("forged.exr");
    const support_part part = {.storage = EXR_STORAGE_SCANLINE,
                               .compression = EXR_COMPRESSION_ZIP,
                               .width = 32,
                               .height = 32,
                               .channel_count = 1,
                               .channels = {"Z"},
                               .types = {EXR_PIXEL_FLOAT}};
    static const char attribute[] = "dataWindow\0box2i\0\x10\0\0";
    size_t size = 0, at = 0;
    support_make_exr(path, &part, 1, NULL, NULL, NULL);
    unsigned char *data = support_read_file(path, &size);
    while (memcmp(data + at, attribute, sizeof attribute))
        at++;
    unsigned char *box = data + at + sizeof attribute; /* min x, min y, max x, max y */
    box[8] = 0xff;
    box[9] = 0x7f; /* 32768 wide */
    support_write_file(path, data, size);
    read_fails(path, "");
    box[10] = 0x01; /* 98304 wide */
    support_write_file(path, data, size);
    read_fails(path, "");
    memset(box, 0, 16);
    box[0] = 5; /* empty */
    support_write_file(path, data, size);
    read_fails(path, "");
    free(data);
    static const char huge[] = "Pf\n32768 32768\n-1.0\n1234";
    static const char larger[] = "Pf\n32769 1\n-1.0\n1234";
    static const char nothing[] = "Pf\n0 0\n-1.0\n1234";
    static const char no_scale[] = "Pf\n1 1\n0\n1234";
    path = support_path("forged.pfm");
    support_write_file(path, huge, sizeof huge - 1);
    read_fails(path, "cut off");
    support_write_file(path, larger, sizeof larger - 1);
    read_fails(path, "largest");
    support_write_file(path, nothing, sizeof nothing - 1);
    read_fails(path, "at least one pixel");
    support_write_file(path, no_scale, sizeof no_scale - 1);
    read_fails(path, "scale");
}

static void write_fails(const char *path, const io_image *image, const char *part)
{
    support_forget();
    assert_int_equal(io_write(path, image, NULL, support_logger()), -1);
    support_expect_error(path, part);
}

static void test_unwritable(void **state)
{
    (void)state;
    io_image image;
    const char *folder = support_path("output.png");
    static const char *const four[] = {"R", "G", "B", "A"};
    assert_int_equal(io_image_init(&image, 4, 4, one, 1, NULL), 0);
    assert_int_equal(mkdir(folder, 0777), 0);
    write_fails(folder, &image, "folder");
    write_fails(support_path("no/such/place.exr"), &image, "folder");
    write_fails(support_path("picture.jpg"), &image, "unknown picture format \".jpg\"");
    write_fails(support_path("picture"), &image, "no extension");
    support_forget();
    assert_int_equal(io_check_writable(support_path("x.tiff"), support_logger()), -1);
    support_expect_error(support_path("x.tiff"), "use .exr, .png or .pfm");
    assert_int_equal(io_check_writable(folder, support_logger()), -1);
    support_expect_error(folder, "folder");
    assert_int_equal(io_check_writable(support_path("fine.exr"), support_logger()), 0);
    assert_int_equal(support_lines.errors, 0);
    io_image_free(&image);
    assert_int_equal(io_image_init(&image, 4, 4, four, 4, NULL), 0);
    write_fails(support_path("rgba.png"), &image, "one channel");
    write_fails(support_path("rgba.pfm"), &image, "one channel");
    io_image_free(&image);
    bool leftovers = true;
    support_file_count(&leftovers);
    assert_false(leftovers);
    assert_int_not_equal(access(support_path("fine.exr"), F_OK), 0);
}

/* A limit on the size of files looks to a program like a full disk. */
static void test_full_disk(void **state)
{
    (void)state;
    static const char *const names[] = {"full.exr", "full.png", "full.pfm"};
    struct rlimit before, small;
    io_image image;
    make_random(&image, 300, 200);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = 4096;
    for (int i = 0; i < 3; i++) {
        const char *path = support_path(names[i]);
        support_write_file(path, "former", 6);
        signal(SIGXFSZ, SIG_IGN);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
        support_forget();
        const int result = io_write(path, &image, NULL, support_logger());
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
        signal(SIGXFSZ, SIG_DFL);
        assert_int_equal(result, -1);
        support_expect_error(path, "raise the limit on the size of files");
        size_t size = 0;
        unsigned char *data = support_read_file(path, &size);
        assert_int_equal(size, 6);
        assert_memory_equal(data, "former", 6);
        free(data);
    }
    io_image_free(&image);
    bool leftovers = true;
    support_file_count(&leftovers);
    assert_false(leftovers);
}

static void test_bad_images(void **state)
{
    (void)state;
    static const char *const empty[] = {""};
    static const char *const twice[] = {"Z", "Z"};
    io_image image;
    support_forget();
    assert_int_equal(io_image_init(&image, 0, 5, one, 1, support_logger()), -1);
    support_expect_error("new picture", "at least one pixel");
    assert_int_equal(io_image_init(&image, 100000, 100000, one, 1, support_logger()), -1);
    support_expect_error("new picture", "largest");
    assert_int_equal(io_image_init(&image, 5, 5, empty, 1, support_logger()), -1);
    support_expect_error("new picture", "empty");
    assert_int_equal(io_image_init(&image, 5, 5, twice, 2, support_logger()), 0);
    write_fails(support_path("twice.exr"), &image, "occurs twice");
    io_image_free(&image);
    io_image_free(&image);
    io_image_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_truncated),     cmocka_unit_test(test_b44),
        cmocka_unit_test(test_flipped_bytes), cmocka_unit_test(test_not_a_picture),
        cmocka_unit_test(test_unreadable),    cmocka_unit_test(test_unknown_channel),
        cmocka_unit_test(test_forged_sizes),  cmocka_unit_test(test_unwritable),
        cmocka_unit_test(test_full_disk),     cmocka_unit_test(test_bad_images),
    };
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}

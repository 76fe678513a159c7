/* SPDX-License-Identifier: MIT */
/* Parts of frames by matte channels, object ids and Cryptomattes. */
#include <math.h>

#include "cryptomatte.h"
#include "passes/mattes.h"
#include "test_io_support.h"

enum { WIDTH = 4 };

static void ok(exr_result_t code)
{
    if (code != EXR_ERR_SUCCESS)
        fail_msg("OpenEXR: %s", exr_get_default_error_message(code));
}

/* Published values of MurmurHash3_x86_32 with seed 0; the empty text hashes to 0, whose
 * exponent would be that of a denormal. Those of names are Blender's. */
static void test_ids(void **state)
{
    (void)state;
    assert_int_equal(io_cryptomatte_id(""), 0x00800000u);
    assert_int_equal(io_cryptomatte_id("hello"), 0x248bfa47u);
    assert_int_equal(io_cryptomatte_id("hello, world"), 0x149bbb7fu);
    assert_int_equal(io_cryptomatte_id("The quick brown fox jumps over the lazy dog"),
                     0x2e4ff723u);
    assert_int_equal(io_cryptomatte_id("Wall"), 0x2c388f97u);
    assert_int_equal(io_cryptomatte_id("Crate.002"), 0x3a5c6171u);
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* One row. "floor" covers the pixels whole, by 3/4, 1/4 and not at all; "hero" by 1/4 in
 * the second; "tree" by 3/4 in the third, of which 1/2 in the second level. */
static void make_file(const char *path, const char *key, const char *value,
                      exr_pixel_type_t type)
{
    static const char *const names[] = {
        "Z",          "id",         "vl.obj00.a", "vl.obj00.b", "vl.obj00.g",
        "vl.obj00.r", "vl.obj01.A", "vl.obj01.B", "vl.obj01.G", "vl.obj01.R"};
    const uint32_t floor_id = io_cryptomatte_id("floor");
    const uint32_t hero = io_cryptomatte_id("hero"), tree = io_cryptomatte_id("tree");
    const uint32_t pixels[10][WIDTH] = {
        {bits_of(1.0f), bits_of(1.0f), bits_of(1.0f), bits_of(1.0f)},
        {0, 7, 16777217u, 8},
        {0, bits_of(0.25f), bits_of(0.25f), 0},             /* coverage 2 */
        {0, hero, floor_id, 0},                             /* id 2 */
        {bits_of(1.0f), bits_of(0.75f), bits_of(0.25f), 0}, /* coverage 1 */
        {floor_id, floor_id, tree, 0},                      /* id 1 */
        {0, 0, 0, 0},
        {0, 0, 0, 0},
        {0, 0, bits_of(0.5f), 0}, /* coverage 3 */
        {0, 0, tree, 0}};
    const exr_attr_v2f_t centre = {.x = 0.0f, .y = 0.0f};
    const exr_attr_box2i_t window = {.max = {.x = WIDTH - 1}};
    exr_context_t context = NULL;
    char attribute[64];
    int index;
    ok(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, NULL));
    ok(exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, &index));
    ok(exr_initialize_required_attr(context, 0, &window, &window, 1.0f, &centre, 1.0f,
                                    EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_NONE));
    for (int c = 0; c < 10; c++)
        ok(exr_add_channel(context, 0, names[c], c == 1 ? EXR_PIXEL_UINT : type,
                           EXR_PERCEPTUALLY_LINEAR, 1, 1));
    ok(exr_set_longname_support(context, 1));
    ok(exr_attr_set_string(context, 0, "cryptomatte/1234567/name", "vl.obj"));
    ok(exr_attr_set_string(context, 0, "cryptomatte/1234567/hash", "MurmurHash3_32"));
    if (key) {
        snprintf(attribute, sizeof attribute, "cryptomatte/1234567/%s", key);
        ok(exr_attr_set_string(context, 0, attribute, value));
    }
    ok(exr_write_header(context));
    if (type == EXR_PIXEL_FLOAT)
        ok(exr_write_scanline_chunk(context, 0, 0, pixels, sizeof pixels));
    else /* nobody reads them */
        ok(exr_write_scanline_chunk(context, 0, 0, pixels,
                                    WIDTH * sizeof(float) + 9 * WIDTH * 2));
    ok(exr_finish(&context));
}

static char manifest[256];

static const char *make_manifest(void)
{
    snprintf(manifest, sizeof manifest,
             "{\"floor\":\"%08x\",\"hero\":\"%08x\",\"tree\":\"%08x\"}",
             (unsigned)io_cryptomatte_id("floor"), (unsigned)io_cryptomatte_id("hero"),
             (unsigned)io_cryptomatte_id("tree"));
    return manifest;
}

/* Coverages are sums of powers of two, so that they are exact. */
static void expect(const char *path, const char *text, float a, float b, float c, float d)
{
    const float expected[WIDTH] = {a, b, c, d};
    float coverage[WIDTH];
    const io_image window = {
        .width = WIDTH, .height = 1, .display_width = WIDTH, .display_height = 1};
    if (io_matte_read(path, text, &window, coverage, support_logger()))
        fail_msg("%s: %s", text, support_lines.error);
    for (int i = 0; i < WIDTH; i++)
        if (coverage[i] < expected[i] || coverage[i] > expected[i])
            fail_msg("%s: %g at %d, not %g", text, (double)coverage[i], i,
                     (double)expected[i]);
}

static void expect_failure(const char *path, const char *text, const char *part)
{
    float coverage[WIDTH];
    const io_image window = {
        .width = WIDTH, .height = 1, .display_width = WIDTH, .display_height = 1};
    assert_int_equal(io_matte_read(path, text, &window, coverage, support_logger()), -1);
    support_expect_error(path, part);
}

static void test_cryptomatte(void **state)
{
    const char *path = support_path("crypto.exr");
    (void)state;
    make_file(path, "manifest", make_manifest(), EXR_PIXEL_FLOAT);
    expect(path, "crypto:floor", 1.0f, 0.75f, 0.25f, 0.0f);
    expect(path, "crypto:tree", 0.0f, 0.0f, 0.75f, 0.0f);
    expect(path, "crypto:hero,tree", 0.0f, 0.25f, 0.75f, 0.0f);
    expect(path, "not:crypto:floor", 0.0f, 0.25f, 0.75f, 1.0f);
    expect(path, "crypto:*r*", 1.0f, 1.0f, 1.0f, 0.0f);
    expect(path, "crypto:vl.obj=h?ro", 0.0f, 0.25f, 0.0f, 0.0f);
    assert_int_equal(support_lines.warnings, 0);
    expect(path, "crypto:car*", 0.0f, 0.0f, 0.0f, 0.0f);
    assert_int_equal(support_lines.warnings, 1);
    support_forget();
    expect_failure(path, "crypto:hera", "did you mean \"hero\"?");
    expect_failure(path, "crypto:hero,,tree", "single commas");
}

/* Without names whole ones are hashed; the list may lie beside the frame. */
static void test_manifests(void **state)
{
    const char *path = support_path("plain.exr");
    (void)state;
    make_file(path, NULL, NULL, EXR_PIXEL_FLOAT);
    expect(path, "crypto:floor", 1.0f, 0.75f, 0.25f, 0.0f);
    expect_failure(path, "crypto:fl*", "no list of names");
    make_manifest();
    support_write_file(support_path("names.json"), manifest, strlen(manifest));
    make_file(path, "manif_file", "names.json", EXR_PIXEL_FLOAT);
    expect(path, "crypto:fl*", 1.0f, 0.75f, 0.25f, 0.0f);
    expect_failure(path, "crypto:her", "did you mean \"hero\"?");
    make_file(path, "manifest", "{\"floor\":", EXR_PIXEL_FLOAT);
    expect(path, "crypto:floor", 1.0f, 0.75f, 0.25f, 0.0f);
    assert_int_equal(support_lines.warnings, 1);
    support_forget();
}

static void test_unusable(void **state)
{
    const char *path = support_path("half.exr");
    static const char *const names[] = {"Z"};
    const float depth[1] = {1.0f};
    const float *const planes[] = {depth};
    (void)state;
    make_file(path, "manifest", make_manifest(), EXR_PIXEL_HALF);
    expect_failure(path, "crypto:hero", "in half floats");
    make_file(path, "hash", "SpookyHash", EXR_PIXEL_FLOAT);
    expect_failure(path, "crypto:hero", "SpookyHash");
    support_make_plain_exr(path, names, 1, 1, 1, planes);
    expect_failure(path, "crypto:hero", "has no Cryptomatte");
}

static void test_channels(void **state)
{
    const char *path = support_path("mask.exr");
    static const char *const names[] = {"m", "a=1"};
    const float matte[WIDTH] = {-1.0f, 0.25f, NAN, 2.0f};
    const float other[WIDTH] = {0.0f, 0.5f, 1.0f, 0.0f};
    const float *const planes[] = {matte, other};
    const char *ids = support_path("crypto.exr");
    (void)state;
    support_make_plain_exr(path, names, 2, WIDTH, 1, planes);
    expect(path, "m", 0.0f, 0.25f, 0.0f, 1.0f);
    expect(path, "not:m", 1.0f, 0.75f, 1.0f, 0.0f);
    expect(path, "m=2,-1", 1.0f, 0.0f, 0.0f, 1.0f);
    expect(path, "a=1", 0.0f, 0.5f, 1.0f, 0.0f);
    make_file(ids, NULL, NULL, EXR_PIXEL_FLOAT);
    expect(ids, "id=7,8", 0.0f, 1.0f, 0.0f, 1.0f);
    expect_failure(path, "m=", "are no object ids");
    expect_failure(path, "m=1,,2", "are no object ids");
    expect_failure(path, "m=1-2", "are no object ids");
    expect_failure(path, "n", "has no channel \"n\"");
}

/* Where the file has no pixels, nothing is meant. */
static void test_windows(void **state)
{
    const char *path = support_path("window.exr");
    static const char *const names[] = {"m"};
    const float matte[2] = {1.0f, 1.0f};
    const float *const planes[] = {matte};
    const io_image window = {
        .width = 3, .height = 1, .data_x = -1, .display_width = 2, .display_height = 1};
    float coverage[3];
    (void)state;
    support_make_plain_exr(path, names, 1, 2, 1, planes);
    assert_int_equal(io_matte_read(path, "m", &window, coverage, support_logger()), 0);
    const float expected[3] = {0.0f, 1.0f, 1.0f};
    assert_memory_equal(coverage, expected, sizeof expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ids),       cmocka_unit_test(test_cryptomatte),
        cmocka_unit_test(test_manifests), cmocka_unit_test(test_unusable),
        cmocka_unit_test(test_channels),  cmocka_unit_test(test_windows)};
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}

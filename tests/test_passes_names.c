/* SPDX-License-Identifier: MIT */
/* Which channels of a file are depth and normals. */
#include <ctype.h>

#include "passes/conventions.h"
#include "passes/passes.h"
#include "test_io_support.h"

static io_passes_request default_request(void)
{
    return (io_passes_request){.depth_format = crv_depth_format_planar(),
                               .vfov_rad = 0.9f};
}

static void load(const char *path, const io_passes_request *request, io_frame *frame)
{
    if (io_frame_load(path, request, frame, support_logger()))
        fail_msg("%s", support_lines.error);
}

typedef struct name_case {
    const char *channels[9];
    const char *depth, *normal_x; /* expected; NULL: none */
} name_case;

static void test_names(void **state)
{
    (void)state;
    static const name_case cases[] = {
        {{"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z"}, "Z", "N.X"},
        {{"ViewLayer.Combined.R", "ViewLayer.Depth.Z", "ViewLayer.Mist.Z",
          "ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z"},
         "ViewLayer.Depth.Z",
         "ViewLayer.Normal.X"},
        {{"View Layer.001.Depth.V", "View Layer.001.Normal.X", "View Layer.001.Normal.Y",
          "View Layer.001.Normal.Z"},
         "View Layer.001.Depth.V",
         "View Layer.001.Normal.X"},
        {{"crypto_object00.R", "crypto_object00.Z", "depth.Z", "n.x", "n.y", "n.z"},
         "depth.Z",
         "n.x"},
        {{"P.X", "P.Y", "P.Z", "Pz", "N.x", "N.y", "N.z"}, "Pz", "N.x"},
        {{"VRayZDepth.R", "VRayZDepth.G", "VRayZDepth.B", "VRayNormals.R",
          "VRayNormals.G", "VRayNormals.B"},
         "VRayZDepth.R",
         "VRayNormals.R"},
        {{"DEPTH", "NX", "NY", "NZ", "AO"}, "DEPTH", "NX"},
        {{"beauty.Z", "R", "G", "B"}, "beauty.Z", NULL},
        {{"z", "Nworld.R", "Nworld.G", "Nworld.B", "Nn.R", "Nn.G", "Nn.B"}, "z", "Nn.R"},
        {{"shadow.Z", "camera_depth.R", "N.X", "N.Y", "N.Z"}, "camera_depth.R", "N.X"},
        {{"Px", "Py", "Pz", "depth.R"}, "depth.R", NULL},
        {{"FinalImageMovieRenderQueue_WorldDepth.R", "FinalImageWorldNormal.R",
          "FinalImageWorldNormal.G", "FinalImageWorldNormal.B"},
         "FinalImageMovieRenderQueue_WorldDepth.R",
         "FinalImageWorldNormal.R"},
        {{"V.Denoising Depth.left.Z", "V.Depth.left.Z", "V.Depth.right.Z",
          "V.Normal.left.X", "V.Normal.left.Y", "V.Normal.left.Z"},
         "V.Depth.left.Z",
         "V.Normal.left.X"},
        /* Nuke's parts of a stereo frame. */
        {{"rgba.left.N.X", "rgba.left.N.Y", "rgba.left.N.Z", "rgba.left.Z",
          "rgba.right.N.X", "rgba.right.N.Y", "rgba.right.N.Z", "rgba.right.Z"},
         "rgba.left.Z",
         "rgba.left.N.X"},
        {{"R", "G", "B"}, NULL, NULL},
        {{"AO"}, NULL, NULL},
        {{"Pref.X", "Pref.Y", "Pref.Z"}, NULL, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *path = support_path("names.exr");
        io_passes_request request = default_request();
        io_frame frame;
        io_image image;
        int32_t count = 0;
        while (count < 9 && cases[i].channels[count])
            count++;
        assert_int_equal(io_image_init(&image, 2, 2, cases[i].channels, count, NULL), 0);
        assert_int_equal(io_write(path, &image, NULL, NULL), 0);
        io_image_free(&image);
        support_forget();
        request.normal_space = IO_NORMALS_VIEW;
        const int result = io_frame_load(path, &request, &frame, support_logger());
        if (!cases[i].depth) {
            assert_int_equal(result, -1);
            support_expect_error(path, "no channel looks like depth");
            continue;
        }
        assert_int_equal(result, 0);
        assert_null(strstr(support_lines.text, "another layer"));
        assert_string_equal(frame.image.channels[0].name, cases[i].depth);
        if (cases[i].normal_x)
            assert_string_equal(frame.image.channels[1].name, cases[i].normal_x);
        assert_int_equal(frame.has_normals, cases[i].normal_x != NULL);
        io_frame_free(&frame);
    }
}

/* A single Y is luminance in an EXR, grey in other formats. */
static void test_only_channel(void **state)
{
    (void)state;
    static const char *const names[] = {"Y"};
    const float value = 1.0f, *planes[] = {&value};
    io_passes_request request = default_request();
    io_frame frame;
    const char *path = support_path("only.exr");
    support_make_plain_exr(path, names, 1, 1, 1, planes);
    support_forget();
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "luminance");
    request.depth = "Y";
    load(path, &request, &frame);
    io_frame_free(&frame);
    request.depth = NULL;
    path = support_path("only.pfm");
    support_make_plain_exr(path, names, 1, 1, 1, planes);
    load(path, &request, &frame);
    io_frame_free(&frame);
}

/* Every row of the table is found by its name, with a prefix and in another case. */
static void test_conventions(void **state)
{
    (void)state;
    for (size_t i = 0; i < io_convention_count; i++) {
        const io_convention *row = &io_conventions[i];
        const char *path = support_path("row.exr");
        io_passes_request request = default_request();
        char text[4][128];
        const char *names[4] = {text[0], text[1], text[2], text[3]};
        const float value[4] = {1, 1, 1, 1}, *planes[] = {value, value, value, value};
        io_frame frame;
        if (row->kind != IO_PASS_DEPTH && row->kind != IO_PASS_NORMAL)
            continue;
        if (row->kind == IO_PASS_NORMAL)
            snprintf(text[0], sizeof text[0], "Beauty.Z");
        else
            snprintf(text[0], sizeof text[0], "Beauty.%s.R", row->name);
        for (int c = 0; c < 3; c++)
            snprintf(text[1 + c], sizeof text[1], "Beauty.%s.%c",
                     row->kind == IO_PASS_NORMAL ? row->name : "N", "RGB"[c]);
        for (char *c = text[0]; *c; c++)
            *c = (char)tolower((unsigned char)*c);
        request.normal_space = IO_NORMALS_VIEW;
        support_make_plain_exr(path, names, 4, 2, 2, planes);
        support_forget();
        load(path, &request, &frame);
        assert_string_equal(frame.image.channels[0].name, text[0]);
        assert_string_equal(frame.image.channels[1].name, text[1]);
        io_frame_free(&frame);
    }
}

/* Passes that are found without reading a frame: every row, and names that look like it.
 */
static void test_find_pass(void **state)
{
    (void)state;
    const char *found[3];
    io_image image;
    for (size_t i = 0; i < io_convention_count; i++) {
        const io_convention *row = &io_conventions[i];
        const bool vector = row->kind != IO_PASS_DEPTH && row->kind != IO_PASS_AO;
        char text[5][128];
        const char *names[5] = {text[0], text[1], text[2], text[3], text[4]};
        for (int c = 0; c < 3; c++)
            snprintf(text[c], sizeof text[c], "Part.%s.%c", row->name, "RGB"[c]);
        snprintf(text[3], sizeof text[3], "B");
        snprintf(text[4], sizeof text[4], "%s", row->kind == IO_PASS_NORMAL ? "Z" : "C");
        assert_int_equal(io_image_init(&image, 1, 1, names, 5, NULL), 0);
        assert_int_equal(io_find_pass(&image, row->kind, found), vector ? 3 : 1);
        assert_string_equal(found[0], text[0]);
        io_image_free(&image);
    }
    static const char *const cases[][2] = {
        {"V.AO.R", "V.AO.R"},   {"ao", "ao"},
        {"rs_AO.R", "rs_AO.R"}, {"Chaos.R", NULL},
        {"Shadow.R", NULL},     {"my_occlusion", "my_occlusion"},
        {"AO.G", NULL},         {"ao_dirt.V", "ao_dirt.V"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *names[] = {cases[i][0], "R"};
        assert_int_equal(io_image_init(&image, 1, 1, names, 2, NULL), 0);
        assert_int_equal(io_find_pass(&image, IO_PASS_AO, found), cases[i][1] ? 1 : 0);
        if (cases[i][1])
            assert_string_equal(found[0], cases[i][1]);
        assert_int_equal(io_find_pass(&image, IO_PASS_DEPTH, found), 0);
        io_image_free(&image);
    }
}

/* The picture: rows before a lone R, G, B; a red alone is none. */
static void test_find_beauty(void **state)
{
    (void)state;
    static const char *const names[] = {
        "R", "G", "B", "V.Combined.R", "V.Combined.G", "V.Combined.B"};
    const char *found[3];
    io_image image;
    assert_int_equal(io_image_init(&image, 1, 1, names, 6, NULL), 0);
    assert_int_equal(io_find_pass(&image, IO_PASS_BEAUTY, found), 3);
    assert_string_equal(found[2], "V.Combined.B");
    io_image_free(&image);
    assert_int_equal(io_image_init(&image, 1, 1, names, 5, NULL), 0);
    assert_int_equal(io_find_pass(&image, IO_PASS_BEAUTY, found), 3);
    assert_string_equal(found[2], "B");
    io_image_free(&image);
    assert_int_equal(io_image_init(&image, 1, 1, names, 2, NULL), 0);
    assert_int_equal(io_find_pass(&image, IO_PASS_BEAUTY, found), 0);
    io_image_free(&image);
}

/* As for depth, the left eye stands for a frame of both. */
static void test_positions_of_eyes(void **state)
{
    (void)state;
    static const char *const names[] = {"V.Position.right.X", "V.Position.right.Y",
                                        "V.Position.right.Z", "V.Position.left.X",
                                        "V.Position.left.Y",  "V.Position.left.Z"};
    const char *found[3];
    io_image image;
    assert_int_equal(io_image_init(&image, 1, 1, names, 6, NULL), 0);
    assert_int_equal(io_find_pass(&image, IO_PASS_POSITION, found), 3);
    assert_string_equal(found[0], "V.Position.left.X");
    io_image_free(&image);
}

static void test_choice_by_name(void **state)
{
    (void)state;
    static const char *const names[] = {"A.Depth.Z",  "B.Depth.Z",  "A.Normal.X",
                                        "A.Normal.Y", "A.Normal.Z", "B.Normal.X",
                                        "B.Normal.Y", "B.Normal.Z"};
    const char *path = support_path("choice.exr");
    io_passes_request request = default_request();
    io_image image;
    io_frame frame;
    request.normal_space = IO_NORMALS_VIEW;
    assert_int_equal(io_image_init(&image, 2, 2, names, 8, NULL), 0);
    assert_int_equal(io_write(path, &image, NULL, NULL), 0);
    io_image_free(&image);
    support_forget();
    load(path, &request, &frame);
    assert_string_equal(frame.image.channels[0].name, "A.Depth.Z");
    assert_non_null(strstr(support_lines.text, "\"B.Depth.Z\" (name the depth channel)"));
    io_frame_free(&frame);
    request.depth = "B.Depth"; /* without its component; normals of the same layer */
    load(path, &request, &frame);
    assert_string_equal(frame.image.channels[0].name, "B.Depth.Z");
    assert_string_equal(frame.image.channels[1].name, "B.Normal.X");
    io_frame_free(&frame);
    request.normal = "A.Normal";
    load(path, &request, &frame);
    assert_string_equal(frame.image.channels[3].name, "A.Normal.Z");
    io_frame_free(&frame);
    support_forget();
    request.normal = "A.Normals";
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "did you mean \"A.Normal.X\"?");
    request.normal = NULL;
    request.depth = "C.Depth.Z";
    assert_int_equal(io_frame_load(path, &request, &frame, support_logger()), -1);
    support_expect_error(path, "has no channel \"C.Depth.Z\"");
}

/* A pixel of four channels, of which the first three are layers of this kind. */
static void layers_are(const char *file, const char *const names[4], crv_layers kind)
{
    const float values[4][1] = {{1}, {2}, {3}, {4}};
    const float *planes[] = {values[0], values[1], values[2], values[3]};
    const char *path = support_path(file);
    const io_passes_request request = default_request();
    io_frame frame;
    support_make_plain_exr(path, names, 4, 1, 1, planes);
    support_forget();
    load(path, &request, &frame);
    assert_int_equal(frame.desc.layers, 3);
    assert_int_equal(frame.desc.layer_kind, kind);
    for (int i = 0; i < 3; i++)
        assert_true(*crv_image_at(&frame.depth[i], 0, 0, 0) == (float)(i + 1));
    assert_int_equal(support_lines.warnings + support_lines.errors, 0);
    io_frame_free(&frame);
}

static void test_layers(void **state)
{
    (void)state;
    static const char *const names[] = {"Z", "layer2.Z", "layer3.Z", "AO"};
    layers_are("layers.exr", names, CRV_LAYERS_SURFACES);
}

/* The kind is in the names; layers of the other kind are left alone. */
static void test_layers_of_solids(void **state)
{
    (void)state;
    static const char *const names[] = {"Z", "solid2.Z", "solid3.Z", "layer4.Z"};
    layers_are("solids.exr", names, CRV_LAYERS_SOLID);
    assert_non_null(strstr(support_lines.text, "3 layers of solids"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_only_channel),
        cmocka_unit_test(test_conventions),
        cmocka_unit_test(test_find_pass),
        cmocka_unit_test(test_find_beauty),
        cmocka_unit_test(test_positions_of_eyes),
        cmocka_unit_test(test_choice_by_name),
        cmocka_unit_test(test_layers),
        cmocka_unit_test(test_layers_of_solids),
    };
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}

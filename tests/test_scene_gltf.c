/* SPDX-License-Identifier: MIT */
/*
 * One square, 2 units wide at height 0 around the origin of its mesh, told in the ways
 * that glTF 2.0 has: where it comes to lie is known from the specification.
 */
#define _POSIX_C_SOURCE 200809L
#include "reference.h"
#include "test_scene_support.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float square[12] = {-1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1};
static const float up[12] = {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0};
static const float uvs[8] = {0, 1, 1, 1, 1, 0, 0, 0};
static const uint16_t corners[6] = {0, 1, 2, 0, 2, 3};

/* The binary part of a file, and the JSON of its views and accessors. */
typedef struct file {
    unsigned char bytes[16384];
    size_t size;
    char views[4096], accessors[4096];
    int view_count, accessor_count;
} file;

static int add_view(file *f, const void *data, size_t size, int stride)
{
    char text[200], step[40] = "";
    if (stride > 0)
        snprintf(step, sizeof step, ",\"byteStride\":%d", stride);
    assert_true(f->size + size + 4 < sizeof f->bytes);
    snprintf(text, sizeof text,
             "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu%s}",
             f->view_count ? "," : "", f->size, size, step);
    strcat(f->views, text);
    memcpy(f->bytes + f->size, data, size);
    f->size = (f->size + size + 3) / 4 * 4;
    return f->view_count++;
}

/* more: further members, beginning with a comma. */
static int add_accessor(file *f, int view, int type, const char *shape, int count,
                        const char *more)
{
    char text[300];
    snprintf(text, sizeof text,
             "%s{\"bufferView\":%d,\"componentType\":%d,\"type\":\"%s\",\"count\":%d%s}",
             f->accessor_count ? "," : "", view, type, shape, count, more);
    strcat(f->accessors, text);
    return f->accessor_count++;
}

static int add_floats(file *f, const float *values, int count, int components)
{
    static const char *const shapes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const char *shape = components == 16 ? "MAT4" : shapes[components - 1];
    const int view =
        add_view(f, values, (size_t)count * (size_t)components * sizeof *values, 0);
    return add_accessor(f, view, 5126, shape, count, "");
}

/* The square: accessors 0 positions, 1 normals, 2 indices, 3 texture coordinates. */
static file square_file(void)
{
    file f = {.size = 0};
    add_floats(&f, square, 4, 3);
    add_floats(&f, up, 4, 3);
    const int view = add_view(&f, corners, sizeof corners, 0);
    add_accessor(&f, view, 5123, "SCALAR", 6, "");
    add_floats(&f, uvs, 4, 2);
    return f;
}

#define MESH                                                                             \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,"         \
    "\"TEXCOORD_0\":3},\"indices\":2,\"material\":0}]}]"
#define ONE_SCENE "\"scene\":0,\"scenes\":[{\"nodes\":[0]}]"

/* rest: the other members of the JSON, without braces. */
static char *make_json(const file *f, const char *uri, const char *rest)
{
    char *json = malloc(65536);
    assert_non_null(json);
    snprintf(json, 65536,
             "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu%s%s%s}],"
             "\"bufferViews\":[%s],\"accessors\":[%s],%s}",
             f->size, uri ? ",\"uri\":\"" : "", uri ? uri : "", uri ? "\"" : "", f->views,
             f->accessors, rest);
    while (strlen(json) % 4)
        strcat(json, " ");
    return json;
}

static const char *write_glb(const file *f, const char *rest)
{
    char *json = make_json(f, NULL, rest);
    const uint32_t json_size = (uint32_t)strlen(json), size = (uint32_t)f->size;
    const uint32_t head[5] = {0x46546c67, 2, 28 + json_size + size, json_size,
                              0x4e4f534a};
    const uint32_t chunk[2] = {size, 0x004e4942};
    unsigned char *all = malloc(head[2]);
    assert_non_null(all);
    memcpy(all, head, sizeof head);
    memcpy(all + 20, json, json_size);
    memcpy(all + 20 + json_size, chunk, sizeof chunk);
    memcpy(all + 28 + json_size, f->bytes, size);
    const char *path = write_file("square.glb", all, head[2]);
    free(all);
    free(json);
    return path;
}

static scene *load(const char *path, int warnings)
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    if (scene_load(path, &s, &log))
        fail_msg("%s", m.error);
    assert_int_equal(m.warnings, warnings);
    return s;
}

static void refuse(const char *path, const char *cause)
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    assert_int_equal(scene_load(path, &s, &log), -1);
    assert_error_line(&m, path);
    if (!strstr(m.error, cause))
        fail_msg("'%s' does not say '%s'", m.error, cause);
}

/* The height of what a ray straight down meets; -INFINITY: nothing. */
static double height_at(const scene *s, double x, double z)
{
    const double eye[3] = {x, 100, z}, target[3] = {x, 0, z};
    scene_view view = look(CRV_ORTHOGRAPHIC, eye, target, 1e-4);
    view.up[1] = 0.0;
    view.up[2] = -1.0;
    const scene_gbuffer_request request = request_of(&view, 1, 1);
    scene_gbuffer g = render(s, &request);
    const double depth = (double)g.depth[0][0];
    if (isfinite(depth))
        assert_true(fabs((double)g.normals[2] - 1.0) < 1e-3); /* it faces the viewer */
    scene_gbuffer_free(&g);
    return 100.0 - depth;
}

static void expect(const scene *s, double x, double z, double height)
{
    const double found = height_at(s, x, z);
    if (isfinite(height) ? !(fabs(found - height) < 1e-4) : isfinite(found))
        fail_msg("height %g at (%g, %g), not %g", found, x, z, height);
}

/* A square of this height around (x, z), and nothing beside it. */
static void expect_square(const char *path, double x, double z, double height)
{
    scene *s = load(path, 0);
    assert_int_equal(scene_triangle_count(s), 2);
    for (int i = 0; i < 4; i++) {
        const double sx = i & 1 ? 1.0 : -1.0, sz = i & 2 ? 1.0 : -1.0;
        expect(s, x + 0.97 * sx, z + 0.95 * sz, height);
        expect(s, x + 1.03 * sx, z, -INFINITY);
        expect(s, x, z + 1.03 * sz, -INFINITY);
    }
    scene_free(s);
}

static void test_nodes(void **state)
{
    const file f = square_file();
    (void)state;
    expect_square(write_glb(&f, MESH "," ONE_SCENE ",\"nodes\":[{\"mesh\":0}]"), 0, 0, 0);
    /* A quarter turn about Z after one about X, mirrored, at (3, 2, 1): each keeps a
     * square of that size but for where it looks, so turn it back in the parent. */
    expect_square(write_glb(&f,
                            MESH "," ONE_SCENE
                                 ",\"nodes\":[{\"translation\":[3,2,1],\"children\":[1],"
                                 "\"rotation\":[0.70710678,0,0,0.70710678]},"
                                 "{\"mesh\":0,\"scale\":[-1,1,1],"
                                 "\"rotation\":[-0.70710678,0,0,0.70710678]}]"),
                  3, 1, 2);
    expect_square(write_glb(&f, MESH "," ONE_SCENE ",\"nodes\":[{\"mesh\":0,\"matrix\":"
                                     "[0,0,-1,0, 0,1,0,0, 1,0,0,0, 5,6,7,1]}]"),
                  5, 7, 6);
    /* The default scene is the second; the first shows the square elsewhere. */
    expect_square(write_glb(&f, MESH ",\"scene\":1,\"scenes\":[{\"nodes\":[0]},"
                                     "{\"nodes\":[1]}],\"nodes\":[{\"mesh\":0,"
                                     "\"translation\":[0,9,0]},{\"mesh\":0}]"),
                  0, 0, 0);
    expect_square(write_glb(&f, MESH
                            "," ONE_SCENE
                            ",\"nodes\":[{\"children\":[1,2]},{\"mesh\":0},{\"mesh\":0,"
                            "\"translation\":[0,5,0],\"extensions\":"
                            "{\"KHR_node_visibility\":{\"visible\":false}}}]"),
                  0, 0, 0);
}

/* Integers as KHR_mesh_quantization has them: positions scaled by the node, or divided by
 * the type's largest value; normals as bytes. */
static void test_quantised(void **state)
{
    static const uint16_t large[16] = {0,     50, 65534, 0, 65534, 50, 65534, 0,
                                       65534, 50, 0,     0, 0,     50, 0,     0};
    static const int16_t part[16] = {-32767, 0, 32767,  0, 32767,  0, 32767,  0,
                                     32767,  0, -32767, 0, -32767, 0, -32767, 0};
    static const int8_t bytes[16] = {0, 127, 0, 0, 0, 127, 0, 0,
                                     0, 127, 0, 0, 0, 127, 0, 0};
    static const char *const nodes[2] = {
        "{\"mesh\":0,\"translation\":[-1,0,-1],"
        "\"scale\":[3.0518509476e-05,1,3.0518509476e-05]}",
        "{\"mesh\":0,\"translation\":[0,4,0]}"};
    (void)state;
    for (int k = 0; k < 2; k++) {
        char rest[1000];
        file f = {.size = 0};
        const int view =
            k ? add_view(&f, part, sizeof part, 8) : add_view(&f, large, sizeof large, 8);
        add_accessor(&f, view, k ? 5122 : 5123, "VEC3", 4,
                     k ? ",\"normalized\":true" : "");
        add_accessor(&f, add_view(&f, bytes, sizeof bytes, 4), 5120, "VEC3", 4,
                     ",\"normalized\":true");
        add_accessor(&f, add_view(&f, corners, sizeof corners, 0), 5123, "SCALAR", 6, "");
        add_floats(&f, uvs, 4, 2);
        snprintf(rest, sizeof rest,
                 MESH "," ONE_SCENE ",\"extensionsUsed\":[\"KHR_mesh_quantization\"],"
                      "\"extensionsRequired\":[\"KHR_mesh_quantization\"],\"nodes\":[%s]",
                 nodes[k]);
        expect_square(write_glb(&f, rest), 0, 0, k ? 4 : 50);
    }
}

static void test_instances(void **state)
{
    static const float moves[9] = {-3, 1, 0, 0, 2, 0, 3, 3, 0};
    static const float scales[9] = {1, 1, 1, 0.5f, 1, 0.5f, 1, 1, 1};
    char rest[1000];
    file f = square_file();
    const int move = add_floats(&f, moves, 3, 3), scale = add_floats(&f, scales, 3, 3);
    (void)state;
    snprintf(rest, sizeof rest,
             MESH "," ONE_SCENE ",\"extensionsRequired\":[\"EXT_mesh_gpu_instancing\"],"
                  "\"nodes\":[{\"mesh\":0,\"translation\":[0,10,0],\"extensions\":"
                  "{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":%d,"
                  "\"SCALE\":%d}}}}]",
             move, scale);
    scene *s = load(write_glb(&f, rest), 0);
    assert_int_equal(scene_triangle_count(s), 6);
    expect(s, -3.9, 0.9, 11);
    expect(s, 0.45, 0.4, 12);
    expect(s, 0.55, 0.4, -INFINITY);
    expect(s, 3.9, 0.9, 13);
    scene_free(s);
}

/* Two joints carry half of the square each: one up by 1, one by 3; what their matrices
 * undo is theirs, and the node's own transform does not count. */
static void test_skin(void **state)
{
    static const uint8_t joints[16] = {0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
    static const float weights[16] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    static const float inverse[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -4, 0, 1,
                                      1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2, 0, 1};
    char rest[2000];
    file f = square_file();
    const int joint =
        add_accessor(&f, add_view(&f, joints, sizeof joints, 0), 5121, "VEC4", 4, "");
    const int weight = add_floats(&f, weights, 4, 4);
    const int matrices = add_floats(&f, inverse, 2, 16);
    (void)state;
    snprintf(rest, sizeof rest,
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
             "\"JOINTS_0\":%d,\"WEIGHTS_0\":%d},\"indices\":2}]}],\"scenes\":[{\"nodes\":"
             "[0,1]}],\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":%d}],"
             "\"nodes\":[{\"mesh\":0,\"skin\":0,\"translation\":[0,50,0]},"
             "{\"translation\":[0,5,0],\"children\":[2]},{}]",
             joint, weight, matrices);
    scene *s = load(write_glb(&f, rest), 0);
    /* A ramp from 1 on the left to 3 on the right. */
    const double eye[3] = {0, 100, 0}, target[3] = {0, 0, 0};
    scene_view view = look(CRV_ORTHOGRAPHIC, eye, target, 2.0);
    view.up[1] = 0.0;
    view.up[2] = -1.0;
    const scene_gbuffer_request request = request_of(&view, 4, 4);
    scene_gbuffer g = render(s, &request);
    for (int x = 0; x < 4; x++)
        assert_true(fabs(100.0 - (double)g.depth[0][4 + x] - (1.25 + 0.5 * x)) < 1e-4);
    scene_gbuffer_free(&g);
    scene_free(s);
}

static void test_morph(void **state)
{
    static const float lift[12] = {0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2, 0};
    char rest[1000];
    file f = square_file();
    const int target = add_floats(&f, lift, 4, 3);
    (void)state;
    for (int own = 0; own < 2; own++) {
        snprintf(rest, sizeof rest,
                 "\"meshes\":[{\"weights\":[0.5],\"primitives\":[{\"attributes\":"
                 "{\"POSITION\":0,\"NORMAL\":1},\"indices\":2,"
                 "\"targets\":[{\"POSITION\":%d}]}]}]," ONE_SCENE
                 ",\"nodes\":[{\"mesh\":0%s}]",
                 target, own ? ",\"weights\":[-1.5]" : "");
        expect_square(write_glb(&f, rest), 0, 0, own ? -3 : 1);
    }
}

static void test_sparse_and_modes(void **state)
{
    static const float strip[12] = {-1, 0, 1, 1, 0, 1, -1, 0, -1, 1, 0, -1};
    static const uint16_t all[4] = {0, 1, 2, 3};
    char rest[1000], more[300];
    file f = {.size = 0};
    (void)state;
    const int indices = add_view(&f, all, sizeof all, 0);
    const int values = add_view(&f, square, sizeof square, 0);
    /* All of it is replaced: zeros, then the sparse values. */
    snprintf(more, sizeof more,
             "{\"componentType\":5126,\"type\":\"VEC3\",\"count\":4,\"sparse\":"
             "{\"count\":4,\"indices\":{\"bufferView\":%d,\"componentType\":5123},"
             "\"values\":{\"bufferView\":%d}}}",
             indices, values);
    strcat(f.accessors, more);
    f.accessor_count++;
    add_floats(&f, strip, 4, 3);
    for (int mode = 5; mode <= 6; mode++) {
        snprintf(rest, sizeof rest,
                 "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":%d},"
                 "\"mode\":%d}]}]," ONE_SCENE ",\"nodes\":[{\"mesh\":0}]",
                 mode == 5 ? 1 : 0, mode);
        expect_square(write_glb(&f, rest), 0, 0, 0);
    }
}

static void encode64(const unsigned char *data, size_t size, char *out)
{
    static const char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; k++)
            bits = bits << 8 | (i + k < size ? data[i + k] : 0);
        for (size_t k = 0; k < 4; k++)
            *out++ = i + k > size ? '=' : digits[bits >> (18 - 6 * k) & 63];
    }
    *out = '\0';
}

static void test_buffers(void **state)
{
    static const char *const types[] = {"data:application/octet-stream;base64,",
                                        "data:application/gltf-buffer;base64,",
                                        "data:;base64,"};
    static const char rest[] = MESH "," ONE_SCENE ",\"nodes\":[{\"mesh\":0}]";
    const file f = square_file();
    char uri[8192];
    (void)state;
    for (int i = 0; i < 3; i++) {
        strcpy(uri, types[i]);
        encode64(f.bytes, f.size, uri + strlen(uri));
        char *json = make_json(&f, uri, rest);
        expect_square(write_text("data.gltf", json), 0, 0, 0);
        free(json);
    }
    char *json = make_json(&f, "a%20b.bin", rest);
    write_file("a b.bin", f.bytes, f.size);
    expect_square(write_text("beside.gltf", json), 0, 0, 0);
    write_file("a b.bin", f.bytes, f.size - 40);
    refuse(write_text("beside.gltf", json), "shorter than it says");
    free(json);
    json = make_json(&f, "nowhere.bin", rest);
    refuse(write_text("beside.gltf", json), "needs the file nowhere.bin");
    free(json);
}

static void test_refusals(void **state)
{
    static const struct {
        const char *rest, *cause;
    } cases[] = {
        {"\"extensionsRequired\":[\"VENDOR_shape\"],\"nodes\":[]", "VENDOR_shape"},
        {"\"extensionsRequired\":[\"EXT_meshopt_compression\"]", "without compression"},
        {"\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]",
         "without compression"},
        {"\"nodes\":[{\"children\":[1]},{\"children\":[0]}]", "has no triangles"},
        {"\"nodes\":[{\"children\":[2]},{\"children\":[2]},{}]", "two parents"},
        {"\"nodes\":[{\"children\":[7]}]", "not there"},
        {ONE_SCENE
         ",\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":"
         "{\"POSITION\":3},\"indices\":2}]}]",
         "another type"},
        {ONE_SCENE
         ",\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":"
         "{\"POSITION\":9},\"indices\":2}]}]",
         "is missing"},
        {ONE_SCENE
         ",\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":"
         "{\"POSITION\":0},\"indices\":4}]}]",
         "faces lack their vertices"},
        {ONE_SCENE
         ",\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":"
         "{\"POSITION\":5},\"indices\":2}]}]",
         "beyond its buffer view"},
        {"\"nodes\":[]", "has no triangles"}};
    static const uint16_t wrong[3] = {0, 1, 4};
    file f = square_file();
    (void)state;
    add_accessor(&f, add_view(&f, wrong, sizeof wrong, 0), 5123, "SCALAR", 3, "");
    add_accessor(&f, 0, 5126, "VEC3", 5, "");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        refuse(write_glb(&f, cases[i].rest), cases[i].cause);
}

/* A square whose picture is opaque in its left half. */
static void test_masks(void **state)
{
    unsigned char pixels[4 * 4 * 4], png[1000];
    png_alloc_size_t size = sizeof png;
    png_image image = {
        .version = PNG_IMAGE_VERSION, .width = 4, .height = 4, .format = PNG_FORMAT_RGBA};
    char rest[2000];
    (void)state;
    for (int i = 0; i < 16; i++)
        memcpy(pixels + 4 * i, i % 4 < 2 ? "\xff\xff\xff\xff" : "\xff\xff\xff\0", 4);
    assert_int_equal(png_image_write_to_memory(&image, png, &size, 0, pixels, 0, NULL),
                     1);
    for (int blends = 0; blends < 2; blends++) {
        file f = square_file();
        const int view = add_view(&f, png, size, 0);
        snprintf(rest, sizeof rest,
                 MESH "," ONE_SCENE
                      ",\"nodes\":[{\"mesh\":0}],\"images\":[{\"bufferView\":%d}],"
                      "\"textures\":[{\"source\":0,\"sampler\":0}],"
                      "\"samplers\":[{\"wrapS\":33071,\"wrapT\":33071}],"
                      "\"materials\":[{\"alphaMode\":\"%s\",\"pbrMetallicRoughness\":"
                      "{\"baseColorTexture\":{\"index\":0}}}]",
                 view, blends ? "BLEND" : "MASK");
        scene *s = load(write_glb(&f, rest), blends);
        /* Half of the map is half of the square; the edge is where alpha is 1/2. */
        for (int k = -9; k <= 9; k += 2)
            expect(s, 0.1 * k, 0.05 * k, k < 0 ? 0.0 : -INFINITY);
        scene_free(s);
    }
    /* A pane without a picture: gone below one half, there above it. */
    for (int k = 0; k < 2; k++) {
        const file f = square_file();
        snprintf(rest, sizeof rest,
                 MESH "," ONE_SCENE
                      ",\"nodes\":[{\"mesh\":0}],\"materials\":[{\"alphaMode\":\"BLEND\","
                      "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,%s]}}]",
                 k ? "0.6" : "0.05");
        if (k) {
            scene *s = load(write_glb(&f, rest), 1);
            expect(s, 0.3, 0.2, 0);
            scene_free(s);
        } else {
            scene *s = NULL;
            assert_int_equal(scene_load(write_glb(&f, rest), &s, NULL), -1);
        }
    }
}

/* The accessibility of a floor's middle, half a unit below the square; radius 1. */
static double under_square(unsigned char alpha, crv_falloff falloff)
{
    unsigned char pixels[2 * 2 * 4], png[500];
    png_alloc_size_t size = sizeof png;
    png_image image = {
        .version = PNG_IMAGE_VERSION, .width = 2, .height = 2, .format = PNG_FORMAT_RGBA};
    char rest[2000];
    file f = square_file();
    memset(pixels, alpha, sizeof pixels);
    assert_int_equal(png_image_write_to_memory(&image, png, &size, 0, pixels, 0, NULL),
                     1);
    const int view = add_view(&f, png, size, 0);
    snprintf(rest, sizeof rest,
             "\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},"
             "{\"mesh\":1,\"translation\":[0,-0.5,0],\"scale\":[9,1,9]}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
             "\"TEXCOORD_0\":3},\"indices\":2,\"material\":0}]},"
             "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2}]}],"
             "\"images\":[{\"bufferView\":%d}],\"textures\":[{\"source\":0}],"
             "\"materials\":[{\"alphaMode\":\"MASK\",\"pbrMetallicRoughness\":"
             "{\"baseColorTexture\":{\"index\":0}}}]",
             view);
    scene *s = load(write_glb(&f, rest), 0);
    /* From between the two, so that the floor is what is seen. */
    const double eye[3] = {0, -0.1, 0}, target[3] = {0, -1, 0};
    scene_view look_at = look(CRV_ORTHOGRAPHIC, eye, target, 1e-3);
    look_at.up[1] = 0.0;
    look_at.up[2] = -1.0;
    const scene_gbuffer_request request = request_of(&look_at, 1, 1);
    scene_gbuffer g = render(s, &request);
    const reference_options o = {.weighting = CRV_WEIGHTING_COSINE,
                                 .falloff = falloff,
                                 .tau = 3.0f,
                                 .u = 0.1f,
                                 .radius = 1.0f,
                                 .rays = 1024};
    reference *r = NULL;
    assert_int_equal(reference_create(s, &g, &o, &r, NULL), 0);
    const double accessibility = (double)reference_pixel(r, 0, 0).accessibility;
    reference_free(r);
    scene_gbuffer_free(&g);
    scene_free(s);
    return accessibility;
}

/* Rays that are traced for occlusion pass holes, too. A ceiling at half the radius blocks
 * all within 60 degrees of the normal, 3/4 of the cosine-weighted directions; the square
 * is large enough to be that ceiling. */
static void test_masks_do_not_occlude(void **state)
{
    (void)state;
    assert_true(under_square(0, CRV_FALLOFF_NONE) >= 1.0);
    assert_true(under_square(0, CRV_FALLOFF_LINEAR) >= 1.0);
    assert_true(fabs(under_square(255, CRV_FALLOFF_NONE) - 0.25) < 0.01);
    assert_true(under_square(255, CRV_FALLOFF_LINEAR) > 0.4);
    assert_true(under_square(255, CRV_FALLOFF_LINEAR) < 1.0);
}

static void test_cameras(void **state)
{
    const file f = square_file();
    (void)state;
    scene *s = load(write_glb(&f, MESH
                              ",\"scenes\":[{\"nodes\":[0,1,2]}],\"nodes\":[{\"mesh\":0},"
                              "{\"name\":\"above\",\"camera\":0,\"translation\":[0,4,0],"
                              "\"rotation\":[-0.70710678,0,0,0.70710678]},"
                              "{\"camera\":1,\"translation\":[0,0.5,7]}],"
                              "\"cameras\":[{\"type\":\"perspective\",\"perspective\":"
                              "{\"yfov\":0.5,\"aspectRatio\":2,\"znear\":0.1}},"
                              "{\"name\":\"front\",\"type\":\"orthographic\","
                              "\"orthographic\":{\"xmag\":3,\"ymag\":1.5,\"znear\":0.1,"
                              "\"zfar\":9}}]"),
                    0);
    assert_int_equal(scene_camera_count(s), 2);
    assert_null(scene_camera_at(s, 2));
    const scene_camera *above = scene_camera_at(s, 0), *front = scene_camera_at(s, 1);
    assert_string_equal(above->name, "above");
    assert_string_equal(front->name, "front");
    assert_true(fabs((double)above->view.vfov_rad - 0.5) < 1e-6);
    assert_true(fabs((double)above->aspect - 2.0) < 1e-6);
    assert_int_equal(front->view.projection, CRV_ORTHOGRAPHIC);
    assert_true(fabs((double)front->view.view_height - 3.0) < 1e-6);
    /* Straight down from 4: the target is in the scene's middle, -Z is up. */
    const double down[3][3] = {{0, 4, 0}, {0, 0, 0}, {0, 0, -1}};
    const double along[3][3] = {{0, 0.5, 7}, {0, 0.5, 0}, {0, 1, 0}};
    for (int i = 0; i < 3; i++) {
        assert_true(fabs(above->view.eye[i] - down[0][i]) < 1e-6);
        assert_true(fabs(above->view.target[i] - down[1][i]) < 1e-6);
        assert_true(fabs(above->view.up[i] - down[2][i]) < 1e-6);
        assert_true(fabs(front->view.eye[i] - along[0][i]) < 1e-6);
        assert_true(fabs(front->view.target[i] - along[1][i]) < 1e-6);
        assert_true(fabs(front->view.up[i] - along[2][i]) < 1e-6);
    }
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nodes),     cmocka_unit_test(test_quantised),
        cmocka_unit_test(test_instances), cmocka_unit_test(test_skin),
        cmocka_unit_test(test_morph),     cmocka_unit_test(test_sparse_and_modes),
        cmocka_unit_test(test_buffers),   cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_masks),     cmocka_unit_test(test_masks_do_not_occlude),
        cmocka_unit_test(test_cameras),
    };
    return cmocka_run_group_tests(tests, NULL, remove_files);
}

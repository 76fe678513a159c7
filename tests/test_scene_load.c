/* SPDX-License-Identifier: MIT */
/*
 * Files of several formats, written here: what comes out, and what is refused.
 */
#include "test_scene_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const cube_obj =
    "v 0 0 0\nv 0 0 1\nv 0 1 0\nv 0 1 1\nv 1 0 0\nv 1 0 1\nv 1 1 0\nv 1 1 1\n"
    "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";

static void assert_bounds(const scene *s, const double lower[3], const double upper[3])
{
    double found[2][3];
    scene_bounds(s, found[0], found[1]);
    for (int i = 0; i < 3; i++) {
        assert_true(fabs(found[0][i] - lower[i]) < 1e-6);
        assert_true(fabs(found[1][i] - upper[i]) < 1e-6);
    }
}

/* What a vertical ray down at (x, z) meets: normal in world space, albedo, two depths. */
typedef struct probe {
    double normal[3], albedo[3], depth[2];
} probe;

static probe look_down(const scene *s, double x, double z, crv_layers kind)
{
    const double eye[3] = {x, 50, z}, target[3] = {x, 0, z};
    scene_view view = look(CRV_ORTHOGRAPHIC, eye, target, 1e-3);
    probe p;
    view.up[1] = 0.0f;
    view.up[2] = -1.0f;
    scene_gbuffer_request request = request_of(&view, 1, 1);
    request.layers = 2;
    request.layer_kind = kind;
    scene_gbuffer g = render(s, &request);
    to_world(&g, g.normals, p.normal);
    for (int i = 0; i < 3; i++)
        p.albedo[i] = (double)g.albedo[i];
    for (int i = 0; i < 2; i++)
        p.depth[i] = (double)g.depth[i][0];
    scene_gbuffer_free(&g);
    return p;
}

static void assert_normal(const probe *p, double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);
    assert_true(fabs(p->normal[0] - x / length) < 1e-5);
    assert_true(fabs(p->normal[1] - y / length) < 1e-5);
    assert_true(fabs(p->normal[2] - z / length) < 1e-5);
}

static void test_obj(void **state)
{
    static const double lower[3] = {0, 0, 0}, upper[3] = {1, 1, 1};
    scene *s = load_text("cube.obj", cube_obj);
    probe p = look_down(s, 0.3, 0.1, CRV_LAYERS_SURFACES);
    (void)state;
    assert_int_equal(scene_triangle_count(s), 12);
    assert_bounds(s, lower, upper);
    assert_normal(&p, 0, 1, 0);
    assert_true(fabs(p.depth[0] - 49.0) < 1e-5 && fabs(p.depth[1] - 50.0) < 1e-5);
    for (int i = 0; i < 3; i++)
        assert_true(fabs(p.albedo[i] - 0.8) < 1e-6);
    scene_free(s);
}

static void test_material(void **state)
{
    static const double expected[3] = {0.125, 0.5, 0.75};
    char text[1024];
    scene *s;
    (void)state;
    write_text("paint.mtl", "newmtl paint\nKd 0.125 0.5 0.75\n");
    snprintf(text, sizeof text, "mtllib paint.mtl\nusemtl paint\n%s", cube_obj);
    s = load_text("painted.obj", text);
    probe p = look_down(s, 0.3, 0.1, CRV_LAYERS_SURFACES);
    for (int i = 0; i < 3; i++)
        assert_true(fabs(p.albedo[i] - expected[i]) < 1e-6);
    scene_free(s);
}

static void test_stl(void **state)
{
    static const double lower[3] = {0, 0, 0}, upper[3] = {2, 3, 0.5};
    unsigned char binary[80 + 4 + 50] = {0};
    const float corner[12] = {0, 0, 0, 0, 0, 0.5f, 2, 0, 0, 0, 3, 0};
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = load_text("one.stl", "solid one\nfacet normal 0 0 0\nouter loop\n"
                                    "vertex 0 0 0.5\nvertex 2 0 0\nvertex 0 3 0\n"
                                    "endloop\nendfacet\nendsolid one\n");
    (void)state;
    assert_int_equal(scene_triangle_count(s), 1);
    assert_bounds(s, lower, upper);
    scene_free(s);
    binary[80] = 1;
    memcpy(binary + 84, corner, sizeof corner);
    assert_int_equal(scene_load(write_file("two.stl", binary, sizeof binary), &s, &log),
                     0);
    assert_int_equal(scene_triangle_count(s), 1);
    assert_bounds(s, lower, upper);
    scene_free(s);
}

/* One good triangle; a repeated corner; three corners in a row; one that is not a
 * number. */
static void test_bad_triangles_are_counted(void **state)
{
    static const char header[] =
        "ply\nformat binary_little_endian 1.0\nelement vertex 6\nproperty float x\n"
        "property float y\nproperty float z\nelement face 4\n"
        "property list uchar int vertex_indices\nend_header\n";
    const float positions[18] = {0, 0, 0, 1,   0, 0, 0, 0,        -1,
                                 2, 0, 0, NAN, 0, 0, 0, INFINITY, 0};
    static const int32_t faces[4][3] = {{0, 1, 2}, {0, 1, 1}, {0, 1, 3}, {0, 4, 5}};
    char file[512];
    size_t used = sizeof header - 1;
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    (void)state;
    memcpy(file, header, used);
    memcpy(file + used, positions, sizeof positions);
    used += sizeof positions;
    for (int f = 0; f < 4; f++) {
        file[used++] = 3;
        memcpy(file + used, faces[f], sizeof faces[f]);
        used += sizeof faces[f];
    }
    assert_int_equal(scene_load(write_file("bad.ply", file, used), &s, &log), 0);
    assert_int_equal(m.errors, 0);
    assert_int_equal(m.warnings, 1);
    assert_non_null(strstr(m.warning, "bad.ply: left out 3 "));
    assert_non_null(strstr(m.warning, " of 4;"));
    assert_int_equal(scene_triangle_count(s), 1);
    scene_free(s);
}

static void base64(const unsigned char *data, size_t size, char *out)
{
    static const char digit[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t bits = (uint32_t)data[i] << 16
                        | (i + 1 < size ? (uint32_t)data[i + 1] << 8 : 0)
                        | (i + 2 < size ? (uint32_t)data[i + 2] : 0);
        *out++ = digit[bits >> 18];
        *out++ = digit[bits >> 12 & 63];
        *out++ = i + 1 < size ? digit[bits >> 6 & 63] : '=';
        *out++ = i + 2 < size ? digit[bits & 63] : '=';
    }
    *out = 0;
}

/* A mesh of `triangles` triangles without indices, with normals unless NULL, and these
 * nodes, all of which are in the scene. */
static const char *write_gltf(const char *name, const float *positions,
                              const float *normals, int triangles, const char *nodes,
                              const char *roots)
{
    static unsigned char data[4096];
    static char encoded[6000], text[9000];
    int bytes = 36 * triangles, vertices = 3 * triangles;
    memcpy(data, positions, (size_t)bytes);
    if (normals)
        memcpy(data + bytes, normals, (size_t)bytes);
    base64(data, (size_t)(normals ? 2 * bytes : bytes), encoded);
    snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[%s]}],"
        "\"nodes\":[%s],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0%s"
        "}}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%d,"
        "\"type\":\"VEC3\",\"min\":[-9,-9,-9],\"max\":[9,9,9]}%s",
        roots, nodes, normals ? ",\"NORMAL\":1" : "", vertices, normals ? "," : "]");
    if (normals)
        snprintf(
            text + strlen(text), sizeof text - strlen(text),
            "{\"bufferView\":1,\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\"}]",
            vertices);
    snprintf(text + strlen(text), sizeof text - strlen(text),
             ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":%d}", bytes);
    if (normals)
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 ",{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":%d}", bytes, bytes);
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "],\"buffers\":[{\"byteLength\":%d,\"uri\":"
             "\"data:application/octet-stream;base64,%s\"}]}",
             normals ? 2 * bytes : bytes, encoded);
    return write_text(name, text);
}

static scene *load_clean(const char *path)
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    assert_int_equal(scene_load(path, &s, &log), 0);
    assert_int_equal(m.errors + m.warnings, 0);
    return s;
}

/* A tetrahedron with its base below and its tip at (0, 1, 0), wound outwards. */
static const float tetrahedron[36] = {0, 1, 0,  0,  0, 1,  1,  0, -1, 0,  1, 0,
                                      1, 0, -1, -1, 0, -1, 0,  1, 0,  -1, 0, -1,
                                      0, 0, 1,  0,  0, 1,  -1, 0, -1, 1,  0, -1};

/* One mesh three times: moved, mirrored, and scaled under a parent that moves. */
static void test_instances(void **state)
{
    static const double lower[3] = {-11, 0, -1}, upper[3] = {12, 2, 1};
    static const double x[3] = {0, -10, 10};
    scene *s =
        load_clean(write_gltf("instances.gltf", tetrahedron, NULL, 4,
                              "{\"mesh\":0},"
                              "{\"mesh\":0,\"translation\":[-10,0,0],\"scale\":[-1,1,1]},"
                              "{\"translation\":[10,0,0],\"children\":[3]},"
                              "{\"mesh\":0,\"scale\":[2,2,1]}",
                              "0,1,2"));
    (void)state;
    assert_int_equal(scene_triangle_count(s), 12);
    assert_bounds(s, lower, upper);
    /* Fronts face outwards, the mirrored one's too: below the side that is seen there is
     * one back face, the base. */
    for (int i = 0; i < 3; i++) {
        probe p = look_down(s, x[i] + 0.05, -0.2, CRV_LAYERS_SOLID);
        assert_true(p.depth[0] < 49.5);
        assert_true(fabs(p.depth[1] - 50.0) < 1e-5);
    }
    scene_free(s);
}

/* The plane x + y = 0 with its normals, under scales that tell the transpose of the
 * inverse from the matrix itself, and mirrors that must not turn normals round. */
static void test_normals_are_transformed(void **state)
{
    static const float slope[9] = {-1, 1, 1, 1, -1, 1, 0, 0, -3};
    static const float normals[9] = {1, 1, 0, 1, 1, 0, 1, 1, 0};
    static const struct {
        const char *scale;
        double normal[3];
    } cases[] = {{"1,1,1", {1, 1, 0}},
                 {"2,1,1", {0.5, 1, 0}},
                 {"-2,1,1", {-0.5, 1, 0}},
                 {"1,1,-1", {1, 1, 0}},
                 {"1,-3,1", {1, -1. / 3, 0}}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char node[100];
        scene *s;
        double sign = cases[i].normal[1] < 0.0 ? -1.0 : 1.0; /* turned to the viewer */
        snprintf(node, sizeof node, "{\"mesh\":0,\"scale\":[%s]}", cases[i].scale);
        s = load_clean(write_gltf("slope.gltf", slope, normals, 1, node, "0"));
        probe p = look_down(s, 0.01, 0.02, CRV_LAYERS_SURFACES);
        assert_normal(&p, sign * cases[i].normal[0], sign * cases[i].normal[1], 0);
        scene_free(s);
    }
}

static void test_useless_normals_become_the_face(void **state)
{
    static const float flat[9] = {-1, 0, 1, 1, 0, 1, 0, 0, -1};
    const float normals[2][9] = {{0}, {NAN, NAN, NAN, 0, 0, 0, INFINITY, 0, 0}};
    (void)state;
    for (int i = 0; i < 2; i++) {
        scene *s = load_clean(
            write_gltf("useless.gltf", flat, normals[i], 1, "{\"mesh\":0}", "0"));
        probe p = look_down(s, 0.01, 0.02, CRV_LAYERS_SURFACES);
        assert_normal(&p, 0, 1, 0);
        scene_free(s);
    }
}

static void refuse(const char *path, const char *cause)
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    assert_int_equal(scene_load(path, &s, &log), -1);
    assert_null(s);
    assert_error_line(&m, path);
    if (!strstr(m.error, cause))
        fail_msg("'%s' does not say '%s'", m.error, cause);
    assert_int_equal(scene_load(path, &s, NULL), -1);
}

static void refuse_text(const char *name, const char *text, const char *cause)
{
    refuse(write_text(name, text), cause);
}

static void test_refusals(void **state)
{
    static const unsigned char short_glb[20] = {'g', 'l', 'T', 'F', 2, 0, 0, 0, 0, 1};
    unsigned char noise[4000];
    uint32_t random = 1;
    (void)state;
    refuse("/nowhere/model.obj", "cannot be opened");
    refuse(test_folder(), "is a folder");
    refuse("/dev/null", "is not a file");
    refuse_text("empty.obj", "", "is empty");
    refuse_text("prose.gltf", "Once upon a time", "cannot be read as a mesh");
    refuse_text("prose.ply", "Once upon a time", "cannot be read as a mesh");
    refuse_text("prose.stl", "Once upon a time", "cannot be read as a mesh");
    refuse_text("prose.fbx", "Once upon a time", "cannot be read as a mesh");
    refuse_text("prose.txt", "Once upon a time", "cannot be read as a mesh");
    refuse_text("prose.obj", "Once upon a time", "has no triangles");
    refuse_text("points.obj", "v 0 0 0\nv 1 0 0\nv 1 1 1\np 1\np 2 3\n",
                "has no triangles");
    refuse_text("lines.obj", "v 0 0 0\nv 1 0 0\nv 1 1 1\nl 1 2 3\n", "has no triangles");
    refuse_text("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "degenerate");
    refuse_text("far.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n", "not finite");
    refuse_text("tiny.obj", "v 0 0 0\nv 1e-20 0 0\nv 0 1e-20 0\nf 1 2 3\n",
                "scale it up");
    refuse(write_file("short.glb", short_glb, sizeof short_glb), "is truncated");
    for (size_t i = 0; i < sizeof noise; i++)
        noise[i] = (unsigned char)((random = random * 1664525u + 1013904223u) >> 24);
    refuse(write_file("noise.glb", noise, sizeof noise), "cannot be read as a mesh");
    refuse(write_file("noise.ply", noise, sizeof noise), "cannot be read as a mesh");
    refuse(write_file("noise.stl", noise, sizeof noise), "cannot be read as a mesh");
}

/* A camera at 1, 2, 3 that is turned to look along -z, with this property of its lens. */
static scene *load_fbx(const char *lens)
{
    static const char format[] =
        "; FBX 7.4.0 project file\nFBXHeaderExtension: {\n FBXHeaderVersion: 1003\n "
        "FBXVersion: 7400\n}\nObjects: {\n Geometry: 100, \"Geometry::A\", \"Mesh\" {\n  "
        "Vertices: *9 {\n a: 0,0,0,1,0,0,0,1,0\n }\n  PolygonVertexIndex: *3 {\n a: "
        "0,1,-3\n }\n  GeometryVersion: 124\n }\n Model: 200, \"Model::A\", \"Mesh\" {\n "
        "Version: 232\n }\n NodeAttribute: 300, \"NodeAttribute::Cam\", \"Camera\" {\n "
        "Properties70: {\n  P: %s\n }\n TypeFlags: \"Camera\"\n }\n Model: 400, "
        "\"Model::Cam\", \"Camera\" {\n Version: 232\n Properties70: {\n  P: \"Lcl "
        "Translation\", \"Lcl Translation\", \"\", \"A\",1,2,3\n  P: \"Lcl Rotation\", "
        "\"Lcl "
        "Rotation\", \"\", \"A\",0,90,0\n }\n }\n}\nConnections: {\n C: \"OO\",200,0\n "
        "C: "
        "\"OO\",100,200\n C: \"OO\",400,0\n C: \"OO\",300,400\n}\n";
    char text[2000];
    scene *s = NULL;
    snprintf(text, sizeof text, format, lens);
    assert_int_equal(scene_load(write_text("camera.fbx", text), &s, NULL), 0);
    assert_int_equal(scene_camera_count(s), 1);
    return s;
}

/* FBX cameras look along their +x. A focal length alone does not reach us. */
static void test_fbx_camera(void **state)
{
    (void)state;
    scene *s = load_fbx("\"FieldOfView\", \"FieldOfView\", \"\", \"A\",60");
    const scene_camera *c = scene_camera_at(s, 0);
    assert_string_equal(c->name, "Cam");
    assert_true(fabs((double)c->hfov_rad - 3.14159265 / 3.0) < 1e-6);
    for (int i = 0; i < 3; i++) {
        const double ahead = c->view.target[i] - c->view.eye[i];
        assert_true(fabs(c->view.eye[i] - (1.0 + i)) < 1e-6);
        assert_true(i == 2 ? ahead < -0.1 : fabs(ahead) < 1e-6);
    }
    scene_free(s);
    s = load_fbx("\"FocalLength\", \"Number\", \"\", \"A\",35");
    c = scene_camera_at(s, 0);
    assert_true(c->hfov_rad <= 0.0f && c->view.vfov_rad <= 0.0f);
    scene_free(s);
}

static void count_morphs(void *user, crv_log_level level, const char *line)
{
    if (level == CRV_LOG_WARNING && strstr(line, "morph targets"))
        ++*(int *)user;
}

static void test_morph_targets_are_told(void **state)
{
    (void)state;
    static const char text[] =
        "; FBX 7.4.0 project file\nFBXHeaderExtension: {\n FBXHeaderVersion: 1003\n "
        "FBXVersion: 7400\n}\nObjects: {\n Geometry: 100, \"Geometry::A\", \"Mesh\" {\n  "
        "Vertices: *9 {\n a: 0,0,0,1,0,0,0,1,0\n }\n  PolygonVertexIndex: *3 {\n a: "
        "0,1,-3\n }\n  GeometryVersion: 124\n }\n Geometry: 101, \"Geometry::S\", "
        "\"Shape\" {\n Version: 100\n Indexes: *1 {\n a: 2\n }\n Vertices: *3 {\n a: "
        "0,0,1\n "
        "}\n Normals: *3 {\n a: 0,0,0\n }\n }\n Deformer: 500, \"Deformer::B\", "
        "\"BlendShape\" {\n Version: 101\n }\n Deformer: 501, \"SubDeformer::C\", "
        "\"BlendShapeChannel\" {\n Version: 100\n DeformPercent: 0\n FullWeights: *1 {\n "
        "a: "
        "100\n }\n }\n Model: 200, \"Model::A\", \"Mesh\" {\n Version: 232\n }\n}\n"
        "Connections: {\n C: \"OO\",200,0\n C: \"OO\",100,200\n C: \"OO\",500,100\n C: "
        "\"OO\",501,500\n C: \"OO\",101,501\n}\n";
    int told = 0;
    const crv_logger log = {count_morphs, &told};
    scene *s = NULL;
    assert_int_equal(scene_load(write_text("morph.fbx", text), &s, &log), 0);
    assert_int_equal(told, 1);
    scene_free(s);
}

/* Binary PLY cut in the middle of its faces. */
static void test_truncated_ply(void **state)
{
    static const char header[] =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\nelement face 9\n"
        "property list uchar int vertex_indices\nend_header\n";
    char file[512] = {0};
    (void)state;
    memcpy(file, header, sizeof header - 1);
    refuse(write_file("cut.ply", file, sizeof header - 1 + 36 + 20), "truncated");
}

static void test_builtin_names(void **state)
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    int32_t count = 0;
    (void)state;
    for (; scene_builtin_name(count); count++) {
        assert_int_equal(scene_builtin(scene_builtin_name(count), &s, &log), 0);
        assert_true(scene_triangle_count(s) >= 2);
        scene_free(s);
    }
    assert_int_equal(m.errors + m.warnings, 0);
    assert_true(count >= 5);
    assert_null(scene_builtin_name(-1));
    assert_string_equal(scene_builtin_name(0), "courtyard");
    s = NULL;
    assert_int_equal(scene_builtin("courtyards", &s, &log), -1);
    assert_null(s);
    assert_error_line(&m, "builtin:courtyards");
    assert_non_null(strstr(m.error, "groove"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_obj),
        cmocka_unit_test(test_material),
        cmocka_unit_test(test_stl),
        cmocka_unit_test(test_bad_triangles_are_counted),
        cmocka_unit_test(test_instances),
        cmocka_unit_test(test_normals_are_transformed),
        cmocka_unit_test(test_useless_normals_become_the_face),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_fbx_camera),
        cmocka_unit_test(test_morph_targets_are_told),
        cmocka_unit_test(test_truncated_ply),
        cmocka_unit_test(test_builtin_names)};
    return cmocka_run_group_tests(tests, NULL, remove_files);
}

/* SPDX-License-Identifier: MIT */
/* A square of two triangles in every format that assimp writes, and glTF by hand. */
#include "fuzz.h"

#include <string.h>

#include <assimp/cexport.h>
#include <assimp/cimport.h>
#include <assimp/scene.h>

#include "seeds.h"

static const char square[] = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 1 -1\n"
                             "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 1 0\n"
                             "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n";

static const struct {
    const char *id, *name;
} formats[] = {
    {"obj", "m.obj"},       {"ply", "m.ply"},     {"plyb", "mb.ply"},  {"stl", "m.stl"},
    {"stlb", "mb.stl"},     {"gltf2", "m.gltf"},  {"glb2", "m.glb"},   {"fbx", "m.fbx"},
    {"fbxa", "ma.fbx"},     {"collada", "m.dae"}, {"3ds", "m.3ds"},    {"x", "m.x"},
    {"assbin", "m.assbin"}, {"glb", "m1.glb"},    {"gltf", "m1.gltf"}, {"3mf", "m.3mf"},
    {"stp", "m.stp"},       {"x3d", "mx.x3d"},    {"m3d", "m.m3d"},    {"m3da", "ma.m3d"},
};

/* The byte before a model that tells the target its extension. */
static void find_letter(const char *name, char letter[2])
{
    const char *extension = strchr(name, '.') + 1;
    int i = 0;
    while (fuzz_mesh_extensions[i] && strcmp(fuzz_mesh_extensions[i], extension) != 0)
        i++;
    FUZZ_CHECK(fuzz_mesh_extensions[i], "%s is not in the table", extension);
    letter[0] = (char)('a' + i);
    letter[1] = '\0';
    FUZZ_CHECK(!strcmp(fuzz_mesh_extension((uint8_t)letter[0]), extension),
               "%s is read as another", name);
}

void seeds_write_model(const char *name, const void *data, size_t size)
{
    char seed[4096];
    find_letter(name, seed);
    FUZZ_CHECK(size < sizeof seed, "%s is large", name);
    memcpy(seed + 1, data, size);
    seeds_write("mesh", name, seed, size + 1);
}

static void export_models(void)
{
    fuzz_file("model.obj", (const uint8_t *)square, sizeof square - 1);
    const struct aiScene *scene = aiImportFile("model.obj", 0);
    FUZZ_CHECK(scene, "%s", aiGetErrorString());
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        char letter[2];
        find_letter(formats[i].name, letter);
        /* An assimp without this format does without its seed. */
        if (aiExportScene(scene, formats[i].id, formats[i].name, 0) == aiReturn_SUCCESS)
            seeds_take("mesh", formats[i].name, formats[i].name, letter, "");
        remove(formats[i].name);
    }
    aiReleaseImport(scene);
    remove("model.mtl");
    remove("m.mtl");
    remove("m.bin");
    remove("m1.bin");
}

/* Most of what the reader knows: a camera, two nodes, a skin, a morph target, a sparse
 * accessor, instances, a mask. The binary part follows. */
static const char json[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
    "\"nodes\":[{\"mesh\":0,\"skin\":0,\"weights\":[0.5],\"rotation\":[0,0,0,1],"
    "\"scale\":[1,2,1],\"children\":[2]},{\"camera\":0,\"name\":\"eye\",\"translation\":"
    "[0,1,5]},{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,3,0,0,1],\"extensions\":{"
    "\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":0}}}}],"
    "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"znear\":0.1,"
    "\"aspectRatio\":1.5}},{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":2,"
    "\"ymag\":1,\"znear\":0,\"zfar\":9}}],"
    "\"skins\":[{\"joints\":[1],\"skeleton\":1}],"
    "\"materials\":[{\"alphaMode\":\"MASK\",\"alphaCutoff\":0.4,\"pbrMetallicRoughness\":"
    "{\"baseColorFactor\":[0.5,0.5,0.5,1],\"baseColorTexture\":{\"index\":0,\"texCoord\":"
    "0}"
    "}}],\"textures\":[{\"source\":0,\"sampler\":0}],\"samplers\":[{\"wrapS\":33071}],"
    "\"images\":[{\"uri\":\"data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAQAAAC1"
    "HAwCAAAAC0lEQVR42mNkYAAAAAYAAjCB0C8AAAAASUVORK5CYII=\"}],"
    "\"meshes\":[{\"weights\":[0.25],\"primitives\":[{\"attributes\":{\"POSITION\":0,"
    "\"TEXCOORD_0\":2,\"JOINTS_0\":4,\"WEIGHTS_0\":5},\"indices\":1,\"material\":0,"
    "\"targets\":[{\"POSITION\":3}]}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":"
    "\"VEC3\"},"
    "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
    "{\"bufferView\":2,\"componentType\":5121,\"normalized\":true,\"count\":4,\"type\":"
    "\"VEC2\"},{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{"
    "\"count\":1,"
    "\"indices\":{\"bufferView\":1,\"componentType\":5123},\"values\":{\"bufferView\":0}}"
    "},"
    "{\"bufferView\":3,\"componentType\":5121,\"count\":4,\"type\":\"VEC4\"},"
    "{\"bufferView\":4,\"componentType\":5126,\"count\":4,\"type\":\"VEC4\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,"
    "\"byteLength\":12},{\"buffer\":0,\"byteOffset\":60,\"byteLength\":8},{\"buffer\":0,"
    "\"byteOffset\":68,\"byteLength\":16},{\"buffer\":0,\"byteOffset\":84,\"byteLength\":"
    "64}"
    "],\"buffers\":[{\"byteLength\":148";

/* Little-endian, as glTF has it; so are the machines that this runs on. */
static size_t binary(uint8_t out[148])
{
    static const float positions[12] = {-1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 1, -1};
    static const uint16_t corners[6] = {0, 1, 2, 0, 2, 3};
    static const uint8_t uvs[8] = {0, 255, 255, 255, 255, 0, 0, 0};
    memset(out, 0, 148);
    memcpy(out, positions, 48);
    memcpy(out + 48, corners, 12);
    memcpy(out + 60, uvs, 8);
    for (int i = 0; i < 4; i++) {
        const float one = 1.0f;
        memcpy(out + 84 + 16 * i, &one, 4);
    }
    return 148;
}

static uint8_t *put(uint8_t *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        *to++ = (uint8_t)(value >> (8 * i));
    return to;
}

static void write_glb(void)
{
    uint8_t file[8192], data[148];
    char text[4096];
    const size_t size = binary(data);
    int length = snprintf(text, sizeof text, "%s}]}", json);
    while (length % 4)
        text[length++] = ' ';
    const uint32_t whole = (uint32_t)(12 + 8 + length + 8) + (uint32_t)size;
    uint8_t *p = put(put(put(file, 0x46546c67u), 2), whole);
    p = put(put(p, (uint32_t)length), 0x4e4f534au);
    memcpy(p, text, (size_t)length);
    p = put(put(p + length, (uint32_t)size), 0x004e4942u);
    memcpy(p, data, size);
    seeds_write("gltf", "all.glb", file, whole);
}

static void write_gltf(void)
{
    static const char letters[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uint8_t data[150] = {0};
    char text[8192];
    binary(data);
    size_t length = (size_t)snprintf(
        text, sizeof text, "%s,\"uri\":\"data:application/octet-stream;base64,", json);
    for (int i = 0; i < 147; i += 3) {
        const uint32_t bits =
            (uint32_t)data[i] << 16 | (uint32_t)data[i + 1] << 8 | data[i + 2];
        for (int k = 18; k >= 0; k -= 6)
            text[length++] = letters[bits >> k & 63];
    }
    memcpy(text + length, "AA==\"}]}", 8); /* the last byte is 0 */
    seeds_write("gltf_text", "all.gltf", text, length + 8);
}

void seeds_write_models(void)
{
    export_models();
    seeds_write_for_readers();
    write_glb();
    write_gltf();
}

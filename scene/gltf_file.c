/* SPDX-License-Identifier: MIT */
#include "gltf.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check_file.h"
#include "internal.h"
#include "system/file.h"
#include "system/text.h"

enum { GLB_HEADER = 12, GLB_CHUNK = 8 };

void gltf_refuse(gltf *g, const char *what)
{
    if (!g->failed)
        scene_log(g->log, CRV_LOG_ERROR, g->path, "is no sound glTF: %s; export it again",
                  what);
    g->failed = true;
}

const cJSON *gltf_member(const cJSON *object, const char *key)
{
    return cJSON_GetObjectItemCaseSensitive(object, key);
}

int gltf_index(const cJSON *object, const char *key)
{
    const cJSON *item = gltf_member(object, key);
    return cJSON_IsNumber(item) && item->valuedouble >= 0.0 && item->valuedouble < 2e9
               ? (int)item->valuedouble
               : -1;
}

double gltf_number(const cJSON *object, const char *key, double initial)
{
    const cJSON *item = gltf_member(object, key);
    return cJSON_IsNumber(item) && isfinite(item->valuedouble) ? item->valuedouble
                                                               : initial;
}

const char *gltf_text(const cJSON *object, const char *key)
{
    return cJSON_GetStringValue(gltf_member(object, key));
}

const cJSON *gltf_extension(const cJSON *object, const char *name)
{
    return gltf_member(gltf_member(object, "extensions"), name);
}

bool gltf_numbers(const cJSON *object, const char *key, int count, double *out)
{
    const cJSON *array = gltf_member(object, key);
    const cJSON *item;
    int i = 0;
    if (!cJSON_IsArray(array) || cJSON_GetArraySize(array) != count)
        return false;
    cJSON_ArrayForEach(item, array)
    {
        if (!cJSON_IsNumber(item))
            return false;
        i++;
    }
    i = 0;
    cJSON_ArrayForEach(item, array)
    {
        out[i++] = item->valuedouble;
    }
    return true;
}

const cJSON *gltf_at(const gltf_list *list, int index)
{
    return index >= 0 && index < list->count ? list->item[index] : NULL;
}

static uint32_t word_at(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16
           | (uint32_t)p[3] << 24;
}

bool gltf_is(const char *path)
{
    unsigned char header[GLB_HEADER];
    FILE *file = fopen(path, "rb");
    const size_t got = file ? fread(header, 1, sizeof header, file) : 0;
    if (file)
        fclose(file);
    if (got >= 8 && memcmp(header, "glTF", 4) == 0)
        return word_at(header + 4) == 2;
    if (!text_ends_with(path, ".gltf"))
        return false;
    size_t size = 0;
    unsigned char *text = read_whole_file(path, &size);
    cJSON *root = text ? cJSON_ParseWithLength((const char *)text, size) : NULL;
    const char *version = gltf_text(gltf_member(root, "asset"), "version");
    /* What is no JSON is refused here rather than by assimp. */
    const bool is = !root || !version || version[0] == '2';
    cJSON_Delete(root);
    free(text);
    return is;
}

/* The JSON and the binary chunk of a .glb, or the whole of a .gltf. */
static cJSON *parse(gltf *g)
{
    const unsigned char *p = g->file;
    cJSON *root = NULL;
    if (g->file_size < GLB_HEADER || memcmp(p, "glTF", 4) != 0) {
        const bool has_mark = g->file_size >= 3 && memcmp(p, "\xef\xbb\xbf", 3) == 0;
        return cJSON_ParseWithLength((const char *)p + (has_mark ? 3 : 0),
                                     g->file_size - (has_mark ? 3 : 0));
    }
    for (size_t at = GLB_HEADER; at + GLB_CHUNK <= g->file_size;) {
        const uint32_t length = word_at(p + at), kind = word_at(p + at + 4);
        at += GLB_CHUNK;
        if (length > g->file_size - at)
            break;
        if (kind == 0x4e4f534a && !root)
            root = cJSON_ParseWithLength((const char *)p + at, length);
        if (kind == 0x004e4942 && !g->binary.data)
            g->binary = (gltf_bytes){.data = p + at, .size = length};
        at += ((size_t)length + 3) / 4 * 4;
    }
    return root;
}

static bool list_items(const cJSON *root, const char *key, gltf_list *out)
{
    const cJSON *array = gltf_member(root, key);
    const cJSON *item;
    const int count = cJSON_IsArray(array) ? cJSON_GetArraySize(array) : 0;
    out->item = calloc((size_t)count + 1, sizeof *out->item);
    if (!out->item)
        return false;
    cJSON_ArrayForEach(item, array)
    {
        if (out->count < count)
            out->item[out->count++] = item;
    }
    return true;
}

static int digit64(unsigned char c)
{
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26;
    if (c >= '0' && c <= '9')
        return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

/* "data:[TYPE][;base64],TEXT" */
static gltf_bytes decode_data(const char *uri)
{
    const char *comma = strchr(uri, ',');
    const size_t length = comma ? strlen(comma + 1) : 0;
    gltf_bytes bytes = {.owned = malloc(length + 1)};
    uint32_t bits = 0;
    int held = 0;
    if (!bytes.owned || !comma || comma - uri < 7
        || strncmp(comma - 7, ";base64", 7) != 0)
        return bytes;
    for (size_t i = 0; i < length && comma[1 + i] != '='; i++) {
        const int digit = digit64((unsigned char)comma[1 + i]);
        if (digit < 0)
            continue;
        bits = bits << 6 | (uint32_t)digit;
        held += 6;
        if (held >= 8) {
            held -= 8;
            bytes.owned[bytes.size++] = (unsigned char)(bits >> held);
        }
    }
    bytes.data = bytes.owned;
    return bytes;
}

static int digit16(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* The file beside the model that a URI names, its %20 and the like decoded. */
static char *path_beside(const gltf *g, const char *uri)
{
    const size_t folder = (size_t)(file_name(g->path) - g->path);
    char *path = malloc(folder + strlen(uri) + 1);
    if (!path)
        return NULL;
    char *out = path + folder;
    memcpy(path, g->path, folder);
    for (const char *in = uri; *in; in++) {
        const int high = in[0] == '%' ? digit16(in[1]) : -1;
        const int low = high >= 0 ? digit16(in[2]) : -1;
        *out++ = low >= 0 ? (char)(16 * high + low) : *in;
        in += low >= 0 ? 2 : 0;
    }
    *out = '\0';
    return path;
}

static gltf_bytes read_uri(const gltf *g, const char *uri)
{
    gltf_bytes bytes = {0};
    if (strncmp(uri, "data:", 5) == 0)
        return decode_data(uri);
    char *path = path_beside(g, uri);
    bytes.owned = path ? read_whole_file(path, &bytes.size) : NULL;
    bytes.data = bytes.owned;
    free(path);
    return bytes;
}

static bool read_buffer(gltf *g, const cJSON *buffer, int index)
{
    const char *uri = gltf_text(buffer, "uri");
    const double stated = gltf_number(buffer, "byteLength", 0.0);
    gltf_bytes *b = &g->buffers[index];
    if (uri)
        *b = read_uri(g, uri);
    else if (index == 0)
        *b = g->binary;
    if (uri && !b->data) {
        scene_log(g->log, CRV_LOG_ERROR, g->path,
                  "needs the file %.300s, which cannot be read; put it beside the model",
                  uri);
        g->failed = true;
    } else if (b->data && (double)b->size < stated) {
        gltf_refuse(g, "a buffer is shorter than it says; the file is truncated");
    }
    return !g->failed;
}

bool gltf_read_buffers(gltf *g)
{
    const cJSON *array = gltf_member(g->root, "buffers");
    const cJSON *buffer;
    if (!cJSON_IsArray(array)) /* the loop would take the members of an object */
        array = NULL;
    const int count = array ? cJSON_GetArraySize(array) : 0;
    g->buffers = calloc((size_t)count + 1, sizeof *g->buffers);
    if (!g->buffers)
        return false;
    cJSON_ArrayForEach(buffer, array)
    {
        if (!read_buffer(g, buffer, g->buffer_count++))
            return false;
    }
    return true;
}

gltf_bytes gltf_view(gltf *g, int view)
{
    const gltf_bytes none = {0};
    const cJSON *v = gltf_at(&g->views, view);
    const int buffer = gltf_index(v, "buffer");
    const double offset = gltf_number(v, "byteOffset", 0.0);
    const double length = gltf_number(v, "byteLength", -1.0);
    if (!v || buffer < 0 || buffer >= g->buffer_count || !g->buffers[buffer].data) {
        gltf_refuse(g, "a buffer view has no buffer");
        return none;
    }
    if (!(offset >= 0.0 && length >= 0.0
          && offset + length <= (double)g->buffers[buffer].size)) {
        gltf_refuse(g, "a buffer view ends beyond its buffer");
        return none;
    }
    return (gltf_bytes){.data = g->buffers[buffer].data + (size_t)offset,
                        .size = (size_t)length};
}

gltf_bytes gltf_image(gltf *g, const cJSON *image)
{
    const char *uri = gltf_text(image, "uri");
    if (uri)
        return read_uri(g, uri);
    return gltf_view(g, gltf_index(image, "bufferView"));
}

bool gltf_open(const char *path, const crv_logger *log, gltf *out)
{
    static const struct {
        const char *key;
        size_t offset;
    } lists[] = {{"accessors", offsetof(gltf, accessors)},
                 {"bufferViews", offsetof(gltf, views)},
                 {"meshes", offsetof(gltf, meshes)},
                 {"nodes", offsetof(gltf, nodes)},
                 {"skins", offsetof(gltf, skins)},
                 {"materials", offsetof(gltf, materials)},
                 {"textures", offsetof(gltf, textures)},
                 {"images", offsetof(gltf, images)},
                 {"samplers", offsetof(gltf, samplers)},
                 {"cameras", offsetof(gltf, cameras)}};
    *out = (gltf){.path = path, .log = log};
    out->file = read_whole_file(path, &out->file_size);
    out->root = out->file ? parse(out) : NULL;
    if (!cJSON_IsObject(out->root)) {
        scene_log(log, CRV_LOG_ERROR, path,
                  "cannot be read as a mesh (its glTF is no JSON); give a complete glTF, "
                  "OBJ, PLY, STL or FBX file");
        out->failed = true;
        return false;
    }
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        if (!list_items(out->root, lists[i].key,
                        (gltf_list *)(void *)((char *)out + lists[i].offset)))
            gltf_refuse(out, "there is no memory for it");
    return !out->failed;
}

void gltf_close(gltf *g)
{
    const gltf_list lists[] = {g->accessors, g->views,     g->meshes,   g->nodes,
                               g->skins,     g->materials, g->textures, g->images,
                               g->samplers,  g->cameras};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        free(lists[i].item);
    for (int i = 0; i < g->buffer_count; i++)
        free(g->buffers[i].owned);
    free(g->buffers);
    free(g->file);
    cJSON_Delete(g->root);
    *g = (gltf){0};
}

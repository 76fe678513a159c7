/* SPDX-License-Identifier: MIT */
#include "gltf.h"

#include <stdlib.h>
#include <string.h>

/* The specification's component types. */
enum {
    INT8 = 5120,
    UINT8 = 5121,
    INT16 = 5122,
    UINT16 = 5123,
    UINT32 = 5125,
    REAL = 5126
};

static size_t size_of(int type)
{
    switch (type) {
    case INT8:
    case UINT8:
        return 1;
    case INT16:
    case UINT16:
        return 2;
    case UINT32:
    case REAL:
        return 4;
    default:
        return 0;
    }
}

static int components_of(const char *type)
{
    static const struct {
        const char *name;
        int components;
    } types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                 {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    for (size_t i = 0; type && i < sizeof types / sizeof *types; i++)
        if (strcmp(type, types[i].name) == 0)
            return types[i].components;
    return 0;
}

/* One component, little-endian. */
static double component_at(const unsigned char *p, int type, bool normalised)
{
    const uint32_t low = (uint32_t)p[0] | (size_of(type) > 1 ? (uint32_t)p[1] << 8 : 0);
    const uint32_t word =
        size_of(type) > 2 ? low | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24 : low;
    float real;
    switch (type) {
    case INT8:
        return normalised ? fmax((double)(int8_t)word / 127.0, -1.0)
                          : (double)(int8_t)word;
    case UINT8:
        return normalised ? (double)word / 255.0 : (double)word;
    case INT16:
        return normalised ? fmax((double)(int16_t)word / 32767.0, -1.0)
                          : (double)(int16_t)word;
    case UINT16:
        return normalised ? (double)word / 65535.0 : (double)word;
    case UINT32:
        return (double)word;
    default:
        memcpy(&real, &word, sizeof real);
        return (double)real;
    }
}

/* Where the elements of an accessor, or of its sparse values, lie. */
typedef struct layout {
    const unsigned char *data; /* NULL: all zero */
    size_t stride, count;
    int type, components;
    bool normalised;
} layout;

static bool find_elements(gltf *g, int view, double offset, layout *l)
{
    const size_t element = size_of(l->type) * (size_t)l->components;
    const gltf_bytes bytes = gltf_view(g, view);
    const double stride = gltf_number(gltf_at(&g->views, view), "byteStride", 0.0);
    if (!bytes.data)
        return false;
    l->stride = stride > 0.0 && stride < 65536.0 ? (size_t)stride : element;
    if (l->count > 0
        && !(offset >= 0.0
             && offset + (double)(l->count - 1) * (double)l->stride + (double)element
                    <= (double)bytes.size)) {
        gltf_refuse(g, "an accessor ends beyond its buffer view");
        return false;
    }
    l->data = bytes.data + (size_t)offset;
    return true;
}

static bool describe(gltf *g, int accessor, int components, layout *out)
{
    const cJSON *a = gltf_at(&g->accessors, accessor);
    const double count = gltf_number(a, "count", -1.0);
    *out = (layout){.type = gltf_index(a, "componentType"),
                    .components = components_of(gltf_text(a, "type")),
                    .normalised = cJSON_IsTrue(gltf_member(a, "normalized"))};
    if (!a || size_of(out->type) == 0 || out->components != components
        || !(count >= 0.0 && count < 4294967295.0)) {
        gltf_refuse(g, "an accessor is missing or of another type than its use");
        return false;
    }
    out->count = (size_t)count;
    const int view = gltf_index(a, "bufferView");
    return view < 0 || find_elements(g, view, gltf_number(a, "byteOffset", 0.0), out);
}

/* The index of one element of a sparse accessor and its values. */
typedef struct sparse {
    layout indices, values;
} sparse;

static bool describe_sparse(gltf *g, const cJSON *s, const layout *whole, sparse *out)
{
    const cJSON *indices = gltf_member(s, "indices"), *values = gltf_member(s, "values");
    const double count = gltf_number(s, "count", -1.0);
    *out = (sparse){
        .indices = {.type = gltf_index(indices, "componentType"), .components = 1},
        .values = *whole};
    if (!(count >= 0.0 && count <= (double)whole->count)
        || size_of(out->indices.type) == 0) {
        gltf_refuse(g, "a sparse accessor has no sound count");
        return false;
    }
    out->indices.count = out->values.count = (size_t)count;
    return find_elements(g, gltf_index(indices, "bufferView"),
                         gltf_number(indices, "byteOffset", 0.0), &out->indices)
           && find_elements(g, gltf_index(values, "bufferView"),
                            gltf_number(values, "byteOffset", 0.0), &out->values);
}

static double element_at(const layout *l, size_t index, int component)
{
    if (!l->data)
        return 0.0;
    return component_at(l->data + index * l->stride
                            + (size_t)component * size_of(l->type),
                        l->type, l->normalised);
}

/* All elements, handed to `put` one component after the other. */
static bool read_all(gltf *g, int accessor, const layout *l,
                     void (*put)(void *out, size_t index, double value), void *out)
{
    const cJSON *s = gltf_member(gltf_at(&g->accessors, accessor), "sparse");
    const size_t components = (size_t)l->components;
    sparse few;
    for (size_t i = 0; i < l->count; i++)
        for (size_t k = 0; k < components; k++)
            put(out, i * components + k, element_at(l, i, (int)k));
    if (!s)
        return true;
    if (!describe_sparse(g, s, l, &few))
        return false;
    for (size_t i = 0; i < few.indices.count; i++) {
        const double index = element_at(&few.indices, i, 0);
        if (!(index >= 0.0 && index < (double)l->count)) {
            gltf_refuse(g, "a sparse accessor replaces what is not there");
            return false;
        }
        for (size_t k = 0; k < components; k++)
            put(out, (size_t)index * components + k, element_at(&few.values, i, (int)k));
    }
    return true;
}

static void put_float(void *out, size_t index, double value)
{
    ((float *)out)[index] = (float)value;
}

static void put_integer(void *out, size_t index, double value)
{
    ((uint32_t *)out)[index] = value > 0.0 && value < 4294967296.0 ? (uint32_t)value : 0;
}

static void *read_as(gltf *g, int accessor, int components, size_t *count,
                     void (*put)(void *out, size_t index, double value))
{
    layout l;
    if (!describe(g, accessor, components, &l))
        return NULL;
    void *out = malloc((l.count * (size_t)components + 1) * 4);
    if (!out)
        gltf_refuse(g, "there is no memory for it");
    else if (!read_all(g, accessor, &l, put, out)) {
        free(out);
        out = NULL;
    }
    *count = l.count;
    return out;
}

float *gltf_floats(gltf *g, int accessor, int components, size_t *count)
{
    return read_as(g, accessor, components, count, put_float);
}

uint32_t *gltf_integers(gltf *g, int accessor, int components, size_t *count)
{
    return read_as(g, accessor, components, count, put_integer);
}

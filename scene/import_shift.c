/* SPDX-License-Identifier: MIT */
#include "import_shift.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check_file.h"
#include "system/text.h"

/* Text that grows. */
typedef struct text {
    char *data;
    size_t size, capacity;
    bool failed;
} text;

static void append(text *t, const char *data, size_t size)
{
    if (t->failed)
        return;
    if (t->capacity - t->size < size) {
        const size_t capacity = 2 * t->capacity + size + 4096;
        char *grown = realloc(t->data, capacity);
        if (!grown) {
            t->failed = true;
            return;
        }
        t->data = grown;
        t->capacity = capacity;
    }
    memcpy(t->data + t->size, data, size);
    t->size += size;
}

/* Three numbers; *rest: what follows them. */
static bool read_point(const char *at, double p[3], const char **rest)
{
    for (int i = 0; i < 3; i++) {
        char *end;
        at += strspn(at, " \t");
        p[i] = strtod(at, &end);
        if (end == at)
            return false;
        at = end;
    }
    *rest = at;
    return true;
}

static const char *next_line(const char *at)
{
    const char *end = strchr(at, '\n');
    return end ? end + 1 : at + strlen(at);
}

static void append_point(text *out, const double p[3], const double origin[3])
{
    char line[96];
    const int length = snprintf(line, sizeof line, "%.9g %.9g %.9g", p[0] - origin[0],
                                p[1] - origin[1], p[2] - origin[2]);
    append(out, line, (size_t)length);
}

/* Lines "v X Y Z ...". out NULL: only their bounds. */
static void pass_obj(const char *data, const double origin[3], text *out, vec3 *lower,
                     vec3 *upper)
{
    for (const char *line = data, *next; *line; line = next) {
        const char *at = line + strspn(line, " \t"), *rest;
        double p[3];
        next = next_line(line);
        const bool is_vertex = at[0] == 'v' && (at[1] == ' ' || at[1] == '\t')
                               && read_point(at + 1, p, &rest) && rest <= next;
        if (is_vertex && !out)
            v3_bound(v3_from_double(p), lower, upper);
        if (is_vertex && out) {
            append(out, "v ", 2);
            append_point(out, p, origin);
            append(out, rest, (size_t)(next - rest));
        } else if (out) {
            append(out, line, (size_t)(next - line));
        }
    }
}

static char *shift_obj(char *data, mesh *m, size_t *size)
{
    vec3 lower = v3(INFINITY, INFINITY, INFINITY), upper = v3_scale(lower, -1.0);
    text out = {0};
    pass_obj(data, m->origin, NULL, &lower, &upper);
    mesh_choose_origin(m, lower, upper);
    if (v3_length(v3_from_double(m->origin)) > 0.0)
        pass_obj(data, m->origin, &out, &lower, &upper);
    if (out.failed) {
        free(out.data);
        out.data = NULL;
        m->failed = true;
    }
    *size = out.size;
    return out.data;
}

/* Of a PLY whose first element is its vertices. */
typedef struct ply {
    bool ascii, swapped; /* swapped: the other byte order than this machine's */
    size_t body;         /* where the vertices begin */
    size_t count, stride;
    size_t offset[3]; /* of x, y, z: bytes, or columns where ascii */
    size_t width[3];  /* of each: 4 or 8 bytes */
} ply;

static size_t ply_width(const char *type)
{
    static const struct {
        const char *name;
        size_t width;
    } types[] = {{"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},
                 {"short", 2}, {"ushort", 2},  {"int16", 2},  {"uint16", 2},
                 {"int", 4},   {"uint", 4},    {"int32", 4},  {"uint32", 4},
                 {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (strcmp(type, types[i].name) == 0)
            return types[i].width;
    return 0;
}

/* One property of the vertices; false: not one that can be stepped over. */
static bool add_property(ply *p, const char *type, const char *name, size_t *column)
{
    const size_t width = ply_width(type);
    const bool is_real = type[0] == 'f' || type[0] == 'd';
    for (int i = 0; i < 3; i++) {
        if (name[0] == "xyz"[i] && name[1] == '\0' && is_real) {
            p->offset[i] = p->ascii ? *column : p->stride;
            p->width[i] = width;
        }
    }
    p->stride += width;
    (*column)++;
    return width > 0;
}

static bool read_ply_header(const char *data, ply *out)
{
    const uint16_t one = 1;
    const bool little = *(const unsigned char *)&one == 1;
    size_t column = 0;
    bool in_vertices = false, is_first = true;
    for (const char *line = data; *line; line = next_line(line)) {
        char a[32] = "", b[32] = "", c[32] = "";
        sscanf(line, "%31s %31s %31s", a, b, c);
        if (strcmp(a, "format") == 0) {
            out->ascii = strcmp(b, "ascii") == 0;
            out->swapped = strcmp(b, "binary_little_endian") == 0 ? !little : little;
        } else if (strcmp(a, "element") == 0) {
            in_vertices = is_first && strcmp(b, "vertex") == 0;
            if (is_first)
                out->count = (size_t)strtoull(c, NULL, 10);
            if (is_first && !in_vertices)
                return false;
            is_first = false;
        } else if (strcmp(a, "property") == 0 && in_vertices) {
            if (!add_property(out, b, c, &column))
                return false;
        } else if (strcmp(a, "end_header") == 0) {
            out->body = (size_t)(next_line(line) - data);
            return out->width[0] && out->width[1] && out->width[2];
        }
    }
    return false;
}

static void swap_bytes(unsigned char *bytes, size_t count, bool swapped)
{
    for (size_t i = 0; swapped && i < count / 2; i++) {
        const unsigned char byte = bytes[i];
        bytes[i] = bytes[count - 1 - i];
        bytes[count - 1 - i] = byte;
    }
}

static double get_real(const char *at, size_t width, bool swapped)
{
    unsigned char bytes[8];
    float single;
    double value;
    memcpy(bytes, at, width);
    swap_bytes(bytes, width, swapped);
    memcpy(&single, bytes, sizeof single);
    memcpy(&value, bytes, sizeof value);
    return width == 4 ? (double)single : value;
}

static void put_real(char *at, size_t width, bool swapped, double value)
{
    unsigned char bytes[8];
    const float single = (float)value;
    memcpy(bytes, &value, sizeof value);
    if (width == 4)
        memcpy(bytes, &single, sizeof single);
    swap_bytes(bytes, width, swapped);
    memcpy(at, bytes, width);
}

static void bound_binary(const char *data, const ply *p, vec3 *lower, vec3 *upper)
{
    for (size_t v = 0; v < p->count; v++) {
        const char *at = data + p->body + v * p->stride;
        double value[3];
        for (int i = 0; i < 3; i++)
            value[i] = get_real(at + p->offset[i], p->width[i], p->swapped);
        v3_bound(v3_from_double(value), lower, upper);
    }
}

static void shift_binary(char *data, const ply *p, const double origin[3])
{
    for (size_t v = 0; v < p->count; v++) {
        for (int i = 0; i < 3; i++) {
            char *at = data + p->body + v * p->stride + p->offset[i];
            put_real(at, p->width[i], p->swapped,
                     get_real(at, p->width[i], p->swapped) - origin[i]);
        }
    }
}

/* out NULL: only the bounds. */
static void pass_ascii(const char *data, const ply *p, const double origin[3], text *out,
                       vec3 *lower, vec3 *upper)
{
    const char *at = data + p->body;
    for (size_t v = 0; v < p->count && *at; v++) {
        const char *end = next_line(at);
        double value[3] = {0.0, 0.0, 0.0};
        for (size_t column = 0; at < end; column++) {
            const size_t gap = strspn(at, " \t");
            const size_t length = strcspn(at + gap, " \t\r\n");
            char number[40];
            int axis = 0;
            while (axis < 3 && p->offset[axis] != column)
                axis++;
            if (length > 0 && axis < 3) {
                value[axis] = strtod(at + gap, NULL);
                snprintf(number, sizeof number, " %.9g", value[axis] - origin[axis]);
                if (out)
                    append(out, number, strlen(number));
            } else if (out) {
                append(out, at, gap + length);
            }
            at += gap + length;
            if (length == 0)
                break;
        }
        if (out)
            append(out, "\n", 1);
        v3_bound(v3_from_double(value), lower, upper);
        at = end;
    }
    if (out)
        append(out, at, strlen(at));
}

/* Returns the data itself if it is binary. */
static char *shift_ply(char *data, mesh *m, size_t *size)
{
    vec3 lower = v3(INFINITY, INFINITY, INFINITY), upper = v3_scale(lower, -1.0);
    ply p = {0};
    text out = {0};
    if (!read_ply_header(data, &p) || p.stride == 0 || p.body > *size
        || (!p.ascii && p.count > (*size - p.body) / p.stride))
        return NULL;
    if (p.ascii)
        pass_ascii(data, &p, m->origin, NULL, &lower, &upper);
    else
        bound_binary(data, &p, &lower, &upper);
    mesh_choose_origin(m, lower, upper);
    if (!(v3_length(v3_from_double(m->origin)) > 0.0))
        return NULL;
    if (!p.ascii) {
        shift_binary(data, &p, m->origin);
        return data;
    }
    append(&out, data, p.body);
    pass_ascii(data, &p, m->origin, &out, &lower, &upper);
    m->failed = out.failed;
    *size = out.size;
    return out.data;
}

char *import_shift(const char *path, mesh *m, size_t *size)
{
    const bool obj = text_ends_with(path, ".obj");
    if (!obj && !text_ends_with(path, ".ply"))
        return NULL;
    char *data = (char *)read_whole_file(path, size);
    if (!data)
        return NULL;
    char *moved = obj ? shift_obj(data, m, size) : shift_ply(data, m, size);
    if (moved != data)
        free(data);
    return moved;
}

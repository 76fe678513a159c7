/* SPDX-License-Identifier: MIT */
#include "builtin.h"

#include <stdio.h>
#include <string.h>

#include "internal.h"

enum { MAX_PARAMETERS = 1 };

typedef struct builtin {
    const char *name, *help;
    void (*build)(mesh *m, scene_view *view, const double *p);
    scene_parameter parameter[MAX_PARAMETERS]; /* key NULL: none */
} builtin;

#define SEED                                                                             \
    {                                                                                    \
        {                                                                                \
            .key = "seed", .initial = 1.0, .min = 0.0, .max = 1e6,                       \
            .help = "another draw of the same kind"                                      \
        }                                                                                \
    }

static const builtin builtins[] = {
    {.name = "courtyard",
     .help = "columns, steps, gears, spheres in contact and grass; the demo",
     .build = builtin_courtyard},
    {.name = "corner", .help = "floor and wall, perpendicular", .build = builtin_corner},
    {.name = "plane",
     .help = "a floor",
     .build = builtin_plane,
     .parameter = {{.key = "tilt",
                    .initial = -1.0,
                    .min = 0.0,
                    .max = 89.0,
                    .help = "degrees between the plane's normal and an orthographic view "
                            "that it fills; without it, perspective"}}},
    {.name = "sphere",
     .help = "a sphere of radius 1 on a floor",
     .build = builtin_sphere,
     .parameter = {{.key = "floor",
                    .initial = 1.0,
                    .min = 0.0,
                    .max = 1.0,
                    .help = "0: the sphere alone"}}},
    {.name = "groove",
     .help = "two walls that meet in an edge, seen down their bisector",
     .build = builtin_groove,
     .parameter = {{.key = "angle",
                    .initial = 90.0,
                    .min = 10.0,
                    .max = 170.0,
                    .help = "degrees between the two walls"}}},
    {.name = "relief",
     .help = "flats and a ball for height maps",
     .build = builtin_relief},
    {.name = "blades",
     .help = "a lawn with stones",
     .build = builtin_blades,
     .parameter = SEED},
    {.name = "leaves", .help = "small trees", .build = builtin_leaves, .parameter = SEED},
    {.name = "bars",
     .help = "fence, tables, slats, shelves and leaning poles",
     .build = builtin_bars,
     .parameter = SEED},
};

enum { BUILTIN_COUNT = sizeof builtins / sizeof *builtins };

const char *scene_builtin_name(int32_t index)
{
    return index >= 0 && index < (int32_t)BUILTIN_COUNT ? builtins[index].name : NULL;
}

const char *scene_builtin_help(int32_t index)
{
    return index >= 0 && index < (int32_t)BUILTIN_COUNT ? builtins[index].help : NULL;
}

const scene_parameter *scene_builtin_parameter(int32_t scene_index, int32_t index)
{
    if (scene_index < 0 || scene_index >= (int32_t)BUILTIN_COUNT || index < 0
        || index >= MAX_PARAMETERS || !builtins[scene_index].parameter[index].key)
        return NULL;
    return &builtins[scene_index].parameter[index];
}

double builtin_random(uint64_t *state)
{
    /* splitmix64 (Steele, Lea, Flood 2014). */
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53;
}

static void log_error(const char *name, const char *text, const crv_logger *log)
{
    char label[96];
    snprintf(label, sizeof label, "builtin:%s", name);
    scene_log(log, CRV_LOG_ERROR, label, "%s", text);
}

static void log_unknown(const char *name, const crv_logger *log)
{
    char names[192] = "", text[256];
    size_t used = 0;
    for (size_t i = 0; i < BUILTIN_COUNT; i++) {
        const int n = snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "",
                               builtins[i].name);
        used += n > 0 && (size_t)n < sizeof names - used ? (size_t)n : 0;
    }
    snprintf(text, sizeof text, "is no built-in scene; choose one of %s", names);
    log_error(name, text, log);
}

/* A plain decimal number, the same in every locale; *end: what follows it. */
static bool read_decimal(const char *text, const char **end, double *out)
{
    const bool negative = *text == '-';
    double value = 0.0, unit = 1.0;
    bool is_fraction = false, has_digits = false;
    text += negative;
    for (;; text++) {
        if (*text == '.' && !is_fraction) {
            is_fraction = true;
        } else if (*text >= '0' && *text <= '9') {
            value = value * 10.0 + (*text - '0');
            unit *= is_fraction ? 10.0 : 1.0;
            has_digits = true;
        } else {
            break;
        }
    }
    *end = text;
    *out = (negative ? -value : value) / unit;
    return has_digits;
}

static int refuse_parameter(const builtin *b, const char *name, const crv_logger *log)
{
    const scene_parameter *p = b->parameter;
    char text[256];
    if (p->key)
        snprintf(
            text, sizeof text,
            "has parameters that are not valid; give %s or %s,%s=X with X from %g to "
            "%g (%s)",
            b->name, b->name, p->key, p->min, p->max, p->help);
    else
        snprintf(text, sizeof text, "has no parameters; give %s alone", b->name);
    log_error(name, text, log);
    return -1;
}

/* ",key=value,key=value" */
static int read_parameters(const builtin *b, const char *name, const char *text,
                           double values[MAX_PARAMETERS], const crv_logger *log)
{
    for (int i = 0; i < MAX_PARAMETERS; i++)
        values[i] = b->parameter[i].initial;
    while (*text) {
        const char *key = text + 1;
        const char *equals = strchr(key, '=');
        int i = 0;
        for (; equals && i < MAX_PARAMETERS && b->parameter[i].key; i++)
            if (strlen(b->parameter[i].key) == (size_t)(equals - key)
                && strncmp(b->parameter[i].key, key, (size_t)(equals - key)) == 0)
                break;
        if (*text != ',' || !equals || i == MAX_PARAMETERS || !b->parameter[i].key
            || !read_decimal(equals + 1, &text, &values[i])
            || !(values[i] >= b->parameter[i].min && values[i] <= b->parameter[i].max)
            || (*text && *text != ','))
            return refuse_parameter(b, name, log);
    }
    return 0;
}

/* The scene that is named, and its parameters; NULL after an error line. */
static const builtin *find(const char *name, double values[MAX_PARAMETERS],
                           const crv_logger *log)
{
    const size_t length = strcspn(name, ",?:=");
    for (size_t i = 0; i < BUILTIN_COUNT; i++)
        if (strlen(builtins[i].name) == length
            && strncmp(builtins[i].name, name, length) == 0)
            return read_parameters(&builtins[i], name, name + length, values, log)
                       ? NULL
                       : &builtins[i];
    log_unknown(name, log);
    return NULL;
}

int scene_builtin_check(const char *name, const crv_logger *log)
{
    double values[MAX_PARAMETERS];
    return find(name, values, log) ? 0 : -1;
}

int scene_builtin(const char *name, scene **out, const crv_logger *log)
{
    double values[MAX_PARAMETERS];
    const builtin *b = find(name, values, log);
    mesh m = {0};
    scene_view view = {0};
    if (!b)
        return -1;
    b->build(&m, &view, values);
    if (scene_from_mesh(&m, name, out, log))
        return -1;
    (*out)->has_view = true;
    (*out)->view = view;
    (*out)->view_aspect = 16.0f / 9.0f;
    return 0;
}

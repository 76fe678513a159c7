/* SPDX-License-Identifier: MIT */
#include "builtin.h"

#include <stdio.h>
#include <string.h>

#include "internal.h"

typedef struct builtin {
    const char *name;
    void (*build)(mesh *m, scene_view *view);
} builtin;

static const builtin builtins[] = {
    {"courtyard", builtin_courtyard}, {"corner", builtin_corner},
    {"plane", builtin_plane},         {"sphere", builtin_sphere},
    {"groove", builtin_groove},       {"relief", builtin_relief}};

enum { BUILTIN_COUNT = sizeof builtins / sizeof *builtins };

const char *scene_builtin_name(int32_t index)
{
    return index >= 0 && index < (int32_t)BUILTIN_COUNT ? builtins[index].name : NULL;
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

static void log_unknown(const char *name, const crv_logger *log)
{
    char names[256] = "";
    size_t used = 0;
    for (size_t i = 0; i < BUILTIN_COUNT; i++) {
        int n = snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "",
                         builtins[i].name);
        used += n > 0 && (size_t)n < sizeof names - used ? (size_t)n : 0;
    }
    scene_log(log, CRV_LOG_ERROR, name, "is no built-in scene; choose one of %s", names);
}

int scene_builtin(const char *name, scene **out, const crv_logger *log)
{
    for (size_t i = 0; i < BUILTIN_COUNT; i++) {
        mesh m = {0};
        scene_view view = {0};
        if (strcmp(name, builtins[i].name) != 0)
            continue;
        builtins[i].build(&m, &view);
        if (scene_from_mesh(&m, name, out, log))
            return -1;
        (*out)->has_view = true;
        (*out)->view = view;
        (*out)->view_aspect = 16.0f / 9.0f;
        return 0;
    }
    log_unknown(name, log);
    return -1;
}

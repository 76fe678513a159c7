/* SPDX-License-Identifier: MIT */
#include "internal.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

/* Smaller scenes would underflow inside the ray caster. */
#define MIN_EXTENT 1e-12

void scene_log(const crv_logger *log, crv_log_level level, const char *name,
               const char *format, ...)
{
    char line[1024];
    va_list arguments;
    if (!log || !log->fn)
        return;
    const int used = snprintf(line, sizeof line, "%.600s: ", name);
    if (used < 0)
        return;
    va_start(arguments, format);
    vsnprintf(line + used, sizeof line - (size_t)used, format, arguments);
    va_end(arguments);
    for (char *c = line; *c; c++)
        if ((unsigned char)*c < 32)
            *c = ' ';
    log->fn(log->user, level, line);
}

int scene_thread_count(int32_t requested)
{
#ifdef _OPENMP
    return requested > 0 ? requested : omp_get_max_threads();
#else
    (void)requested;
    return 1;
#endif
}

static void set_bounds(scene *s)
{
    const mesh *m = &s->mesh;
    for (int axis = 0; axis < 3; axis++) {
        s->lower[axis] = INFINITY;
        s->upper[axis] = -INFINITY;
    }
    for (size_t i = 0; i < 3 * m->triangle_count; i++) {
        const float *p = m->positions + 3 * (size_t)m->indices[i];
        for (int axis = 0; axis < 3; axis++) {
            s->lower[axis] = fminf(s->lower[axis], p[axis]);
            s->upper[axis] = fmaxf(s->upper[axis], p[axis]);
        }
    }
}

static bool build_acceleration(scene *s)
{
    /* One thread builds: how parallel builds order the triangles, and with it which of
     * two coincident ones a ray meets, may change from run to run. */
    s->device = rtcNewDevice("threads=1");
    if (!s->device)
        return false;
    RTCGeometry geometry = rtcNewGeometry(s->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               s->mesh.positions, 0, 3 * sizeof(float),
                               s->mesh.vertex_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               s->mesh.indices, 0, 3 * sizeof(uint32_t),
                               s->mesh.triangle_count);
    rtcCommitGeometry(geometry);
    s->rtc = rtcNewScene(s->device);
    rtcSetSceneFlags(s->rtc, RTC_SCENE_FLAG_ROBUST | EMBREE_SCENE_FLAG_FILTER);
    rtcAttachGeometry(s->rtc, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(s->rtc);
    return rtcGetDeviceError(s->device) == RTC_ERROR_NONE;
}

static int prepare(scene *s, const char *name, const crv_logger *log)
{
    double extent = 0.0;
    if (s->mesh.failed) {
        scene_log(log, CRV_LOG_ERROR, name,
                  "no memory for its triangles; simplify the model");
        return -1;
    }
    set_bounds(s);
    for (int axis = 0; axis < 3; axis++)
        extent = fmax(extent, (double)s->upper[axis] - (double)s->lower[axis]);
    if (!(extent >= MIN_EXTENT)) {
        scene_log(log, CRV_LOG_ERROR, name,
                  "is only %g units large; scale it up to 1e-12 units or more", extent);
        return -1;
    }
    if (!build_acceleration(s)) {
        scene_log(
            log, CRV_LOG_ERROR, name,
            "no memory to prepare %zu triangles for ray casting; simplify the model",
            s->mesh.triangle_count);
        return -1;
    }
    return 0;
}

int scene_from_mesh(mesh *m, const char *name, scene **out, const crv_logger *log)
{
    scene *s = calloc(1, sizeof *s);
    if (!s) {
        mesh_free(m);
        scene_log(log, CRV_LOG_ERROR, name, "out of memory; close other programs");
        return -1;
    }
    s->mesh = *m;
    memset(m, 0, sizeof *m);
    if (prepare(s, name, log)) {
        scene_free(s);
        return -1;
    }
    *out = s;
    return 0;
}

void scene_free(scene *s)
{
    if (!s)
        return;
    if (s->rtc)
        rtcReleaseScene(s->rtc);
    if (s->device)
        rtcReleaseDevice(s->device);
    mesh_free(&s->mesh);
    free(s);
}

int64_t scene_triangle_count(const scene *s)
{
    return (int64_t)s->mesh.triangle_count;
}

void scene_bounds(const scene *s, double lower[3], double upper[3])
{
    for (int axis = 0; axis < 3; axis++) {
        lower[axis] = s->mesh.origin[axis] + (double)s->lower[axis];
        upper[axis] = s->mesh.origin[axis] + (double)s->upper[axis];
    }
}

/* SPDX-License-Identifier: MIT */
#include "internal.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "system/text.h"

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
    text_clean(line);
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

void scene_tell_row(void (*watch)(void *user, int32_t rows), void *user, int32_t *done)
{
    int32_t rows;
#ifdef _OPENMP
    const bool tells = omp_get_thread_num() == 0;
#pragma omp atomic capture
#else
    const bool tells = true;
#endif
    rows = ++*done;
    if (watch && tells)
        watch(user, rows);
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

/* Lets rays pass where a mask has a hole. Single rays only: N is 1. */
static void pass_holes(const struct RTCFilterFunctionNArguments *arguments)
{
    const mesh *m = arguments->geometryUserPtr;
    const struct RTCHit *hit = (const struct RTCHit *)(const void *)arguments->hit;
    const int32_t mask = m->palette[m->materials[hit->primID]].mask;
    if (mask < 0)
        return;
    const uint32_t *index = m->indices + 3 * (size_t)hit->primID;
    const double weight[3] = {1.0 - (double)hit->u - (double)hit->v, (double)hit->u,
                              (double)hit->v};
    double u = 0.0, v = 0.0;
    for (int i = 0; i < 3; i++) {
        u += weight[i] * (double)m->uvs[2 * (size_t)index[i]];
        v += weight[i] * (double)m->uvs[2 * (size_t)index[i] + 1];
    }
    if (!mesh_mask_covers(&m->masks[mask], u, v))
        arguments->valid[0] = 0;
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
    if (s->mesh.mask_count > 0) {
        rtcSetGeometryUserData(geometry, &s->mesh);
        rtcSetGeometryIntersectFilterFunction(geometry, pass_holes);
        rtcSetGeometryOccludedFilterFunction(geometry, pass_holes);
    }
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
    free(s->cameras);
    free(s);
}

int32_t scene_camera_count(const scene *s)
{
    return s->camera_count;
}

const scene_camera *scene_camera_at(const scene *s, int32_t index)
{
    return index >= 0 && index < s->camera_count ? &s->cameras[index] : NULL;
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

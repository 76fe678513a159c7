/* SPDX-License-Identifier: MIT */
/*
 * Both ends are the same program, so that structs travel as they are. Records: a head,
 * then its bytes. The receiver bounds every size and every index.
 */
#include "import.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"
#include "system/clock.h"
#include "system/process.h"
#include "system/text.h"

enum { RECORD_MESSAGE = 1, RECORD_RESULT = 2, MAX_LINE = 1023, MAX_MESSAGES = 100 };
enum { FIRST_BYTES = 1 << 20 };

typedef struct record {
    int32_t kind, level; /* level: of a message */
    uint64_t size;       /* of the text, or the head of the result */
} record;

typedef struct result_head {
    uint64_t vertex_count, triangle_count, palette_count, mask_count, camera_count;
    uint64_t dropped_triangles;
    double origin[3];
} result_head;

void import_free(import *found)
{
    mesh_free(&found->mesh);
    free(found->cameras);
    *found = (import){0};
}

bool import_add_camera(import *found, const char *name, const scene_camera *like,
                       vec3 eye, vec3 back, vec3 up)
{
    enum { MAX_CAMERAS = 4096 };
    if (found->camera_count == MAX_CAMERAS)
        return true;
    scene_camera *grown =
        realloc(found->cameras, (found->camera_count + 1) * sizeof *grown);
    if (!grown)
        return false;
    scene_camera *c = &grown[found->camera_count];
    *c = *like;
    memset(c->name, 0, sizeof c->name);
    for (size_t i = 0; name && name[i] && i + 1 < sizeof c->name; i++)
        c->name[i] = name[i];
    v3_store_double(eye, c->view.eye);
    v3_store_double(v3_sub(eye, v3_normalise(back)), c->view.target);
    v3_store_double(v3_normalise(up), c->view.up);
    found->cameras = grown;
    found->camera_count++;
    return true;
}

static void send_message(void *user, crv_log_level level, const char *line)
{
    const size_t length = strlen(line);
    const record head = {.kind = RECORD_MESSAGE,
                         .level = (int32_t)level,
                         .size = length < MAX_LINE ? length : MAX_LINE};
    if (pipe_write(*(int *)user, &head, sizeof head))
        pipe_write(*(int *)user, line, (size_t)head.size);
}

crv_logger import_pipe_logger(int *fd)
{
    return (crv_logger){send_message, fd};
}

/* One array of the result. */
typedef struct part {
    void **data;
    uint64_t count;
    size_t element_size;
    size_t spare; /* bytes behind it */
} part;

enum { PART_COUNT = 8 };

static void list_parts(import *i, const result_head *h, part parts[PART_COUNT])
{
    mesh *m = &i->mesh;
    const part list[PART_COUNT] = {
        {(void **)&m->positions, h->vertex_count, 3 * sizeof(float), sizeof(float)},
        {(void **)&m->normals, h->vertex_count, 3 * sizeof(float), 0},
        {(void **)&m->uvs, h->vertex_count, 2 * sizeof(float), 0},
        {(void **)&m->indices, h->triangle_count, 3 * sizeof(uint32_t), 0},
        {(void **)&m->materials, h->triangle_count, sizeof(uint32_t), 0},
        {(void **)&m->palette, h->palette_count, sizeof(mesh_material), 0},
        {(void **)&m->masks, h->mask_count, sizeof(mesh_mask), 0},
        {(void **)&i->cameras, h->camera_count, sizeof(scene_camera), 0}};
    memcpy(parts, list, sizeof list);
}

bool import_pipe_send(int fd, const import *found)
{
    const mesh *m = &found->mesh;
    const record head = {.kind = RECORD_RESULT, .size = sizeof(result_head)};
    const result_head counts = {
        .vertex_count = m->vertex_count,
        .triangle_count = m->triangle_count,
        .palette_count = m->palette_count,
        .mask_count = m->mask_count,
        .camera_count = found->camera_count,
        .dropped_triangles = m->dropped_triangles,
        .origin = {m->origin[0], m->origin[1], m->origin[2]},
    };
import copy = * found;
    part parts[PART_COUNT];
    list_parts(&copy, &counts, parts);
    if (!pipe_write(fd, &head, sizeof head) || !pipe_write(fd, &counts, sizeof counts))
        return false;
    for (int i = 0; i < PART_COUNT; i++)
        if (!pipe_write(fd, *parts[i].data,
                        (size_t)parts[i].count * parts[i].element_size))
            return false;
    for (size_t i = 0; i < m->mask_count; i++)
        if (!pipe_write(fd, m->masks[i].alpha,
                        (size_t)m->masks[i].width * (size_t)m->masks[i].height))
            return false;
    return true;
}

static import_end receive_bytes(int fd, const import_wait *wait, void *data, size_t size)
{
    char *bytes = data;
    while (size > 0) {
        const double left = wait->start + wait->timeout - clock_seconds();
        if (left <= 0.0)
            return IMPORT_TIMEOUT;
        const int found = pipe_wait(fd, left < 1.0 ? left + 1e-3 : 1.0);
        if (found == 0 && wait->limits && wait->limits->waits)
            wait->limits->waits(wait->limits->user, clock_seconds() - wait->start);
        if (found == 0 || (found < 0 && errno == EINTR))
            continue;
        const int64_t got = found < 0 ? -1 : pipe_read(fd, bytes, size);
        if (got <= 0)
            return IMPORT_NOTHING;
        bytes += got;
        size -= (size_t)got;
    }
    return IMPORT_DONE;
}

/* Memory is taken as the bytes come: what is only announced costs nothing. */
static import_end receive_block(int fd, const import_wait *wait, size_t size,
                                size_t spare, void **out)
{
    char *block = NULL;
    size_t got = 0;
    import_end end = IMPORT_DONE;
    do {
        const size_t left = size - got, most = got ? got : FIRST_BYTES;
        const size_t more = left < most ? left : most;
        char *grown = realloc(block, got + more + spare + 1);
        if (!grown) {
            end = IMPORT_NO_MEMORY;
            break;
        }
        block = grown;
        end = receive_bytes(fd, wait, block + got, more);
        got += more;
    } while (end == IMPORT_DONE && got < size);
    *out = block;
    return end;
}

static import_end receive_message(int fd, const import_wait *wait, const record *head,
                                  int *errors, const crv_logger *log)
{
    char line[MAX_LINE + 1];
    if (head->size < 1 || head->size > MAX_LINE || head->level < CRV_LOG_ERROR
        || head->level > CRV_LOG_INFO)
        return IMPORT_DAMAGED;
    const import_end end = receive_bytes(fd, wait, line, (size_t)head->size);
    if (end != IMPORT_DONE)
        return end;
    line[head->size] = '\0';
    for (size_t i = 0; i < head->size; i++)
        if (!line[i])
            line[i] = ' ';
    text_clean(line);
    *errors += head->level == CRV_LOG_ERROR;
    if (log && log->fn)
        log->fn(log->user, (crv_log_level)head->level, line);
    return IMPORT_DONE;
}

/* Whether triangles and materials are what mesh_add_triangle() makes of them. */
static bool is_sound(const mesh *m)
{
    if (!mesh_usable_position(v3_from_double(m->origin)))
        return false;
    for (size_t t = 0; t < m->triangle_count; t++) {
        if (m->materials[t] >= m->palette_count)
            return false;
        for (size_t k = 3 * t; k < 3 * t + 3; k++)
            if (m->indices[k] >= m->vertex_count
                || !mesh_usable_position(mesh_position(m, m->indices[k]))
                || !(v3_length(mesh_normal(m, m->indices[k])) < 2.0))
                return false;
    }
    for (size_t i = 0; i < m->palette_count; i++) {
        const mesh_material *p = &m->palette[i];
        for (int k = 0; k < 3; k++)
            if (!(p->albedo[k] >= 0.0f && p->albedo[k] <= 1.0f))
                return false;
        if (p->mask < -1 || (p->mask >= 0 && (uint64_t)p->mask >= m->mask_count))
            return false;
    }
    return true;
}

/* Names end, and numbers are finite: the rest of a view is checked where it is used. */
static bool are_sound_cameras(const scene_camera *cameras, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const scene_view *v = &cameras[i].view;
        if (!memchr(cameras[i].name, 0, sizeof cameras[i].name)
            || !isfinite(cameras[i].aspect) || !isfinite(cameras[i].hfov_rad)
            || !isfinite(v->vfov_rad) || !isfinite(v->view_height)
            || (v->projection != CRV_PERSPECTIVE && v->projection != CRV_ORTHOGRAPHIC))
            return false;
        for (int k = 0; k < 3; k++)
            if (!isfinite(v->eye[k] + v->target[k] + v->up[k]))
                return false;
    }
    return true;
}

/* The masks' pictures follow the arrays. */
static import_end receive_masks(int fd, const import_wait *wait, mesh *m)
{
    import_end end = IMPORT_DONE;
    for (size_t i = 0; i < m->mask_count; i++)
        m->masks[i].alpha = NULL;
    for (size_t i = 0; i < m->mask_count && end == IMPORT_DONE; i++) {
        mesh_mask *mask = &m->masks[i];
        if (mask->width < 1 || mask->width > MESH_MAX_MASK || mask->height < 1
            || mask->height > MESH_MAX_MASK)
            return IMPORT_DAMAGED;
        const size_t size = (size_t)mask->width * (size_t)mask->height;
        void *alpha = NULL;
        end = receive_block(fd, wait, size, 0, &alpha);
        mask->alpha = alpha;
    }
    return end;
}

static import_end receive_result(int fd, const import_wait *wait, const record *head,
                                 import *out)
{
    result_head counts;
    part parts[PART_COUNT];
    if (head->size != sizeof counts)
        return IMPORT_DAMAGED;
    import_end end = receive_bytes(fd, wait, &counts, sizeof counts);
    if (end != IMPORT_DONE)
        return end;
    if (counts.vertex_count > UINT32_MAX || counts.triangle_count > UINT32_MAX
        || counts.palette_count > UINT32_MAX || counts.mask_count > INT32_MAX
        || counts.camera_count > INT16_MAX)
        return IMPORT_DAMAGED;
    list_parts(out, &counts, parts);
    for (int i = 0; i < PART_COUNT && end == IMPORT_DONE; i++)
        end = receive_block(fd, wait, (size_t)parts[i].count * parts[i].element_size,
                            parts[i].spare, parts[i].data);
    out->mesh.vertex_count = out->mesh.vertex_capacity = (size_t)counts.vertex_count;
    out->mesh.triangle_count = out->mesh.triangle_capacity =
        (size_t)counts.triangle_count;
    out->mesh.palette_count = out->mesh.palette_capacity = (size_t)counts.palette_count;
    out->camera_count = (size_t)counts.camera_count;
    if (end != IMPORT_DONE)
        return end; /* the masks' pictures are not there yet, nor is their count */
    out->mesh.mask_count = out->mesh.mask_capacity = (size_t)counts.mask_count;
    end = receive_masks(fd, wait, &out->mesh);
    out->mesh.dropped_triangles = (size_t)counts.dropped_triangles;
    memcpy(out->mesh.origin, counts.origin, sizeof counts.origin);
    if (end == IMPORT_DONE
        && (!is_sound(&out->mesh) || !are_sound_cameras(out->cameras, out->camera_count)))
        end = IMPORT_DAMAGED;
    return end;
}

import_end import_pipe_receive(int fd, const import_wait *wait, import *out, int *errors,
                               const crv_logger *log)
{
    for (int messages = 0; messages < MAX_MESSAGES; messages++) {
        record head;
        import_end end = receive_bytes(fd, wait, &head, sizeof head);
        if (end == IMPORT_DONE && head.kind == RECORD_RESULT)
            return receive_result(fd, wait, &head, out);
        if (end == IMPORT_DONE)
            end = head.kind == RECORD_MESSAGE
                      ? receive_message(fd, wait, &head, errors, log)
                      : IMPORT_DAMAGED;
        if (end != IMPORT_DONE)
            return end;
    }
    return IMPORT_DAMAGED;
}

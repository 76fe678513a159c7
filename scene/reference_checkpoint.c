/* SPDX-License-Identifier: MIT */
/*
 * The state of a reference on disk: a header, accessibility, error, bent normals, and a
 * hash over all of it. In the machine's own byte order; one of another machine is refused
 * as damaged.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference_internal.h"
#include "system/file.h"
#include "system/new_file.h"

/* Changes with everything that changes results, so that two versions never share one
 * picture. */
#define FORMAT "crevice reference 2\n"

typedef struct checkpoint_header {
    char format[24];
    uint64_t fingerprint;
    int64_t total, done;
} checkpoint_header;

uint64_t reference_hash(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

static uint64_t hash_float(uint64_t hash, float value)
{
    return reference_hash(hash, &value, sizeof value);
}

static uint64_t hash_int(uint64_t hash, int64_t value)
{
    return reference_hash(hash, &value, sizeof value);
}

static uint64_t hash_mesh(uint64_t hash, const mesh *m)
{
    hash = reference_hash(hash, m->positions, 3 * m->vertex_count * sizeof(float));
    hash = reference_hash(hash, m->normals, 3 * m->vertex_count * sizeof(float));
    return reference_hash(hash, m->indices, 3 * m->triangle_count * sizeof(uint32_t));
}

/* Member by member: structs have padding, whose bytes mean nothing. */
static uint64_t fingerprint_of(reference *r)
{
    if (r->fingerprint)
        return r->fingerprint;
    const reference_options *o = &r->options;
    const crv_camera *c = &r->gbuffer->camera;
    const crv_gbuffer_desc *d = &r->gbuffer->desc;
    const scene_view *v = &r->gbuffer->view;
    const float numbers[] = {o->tau,   o->u,     o->radius, o->thickness, o->max_error,
                             c->fx_px, c->fy_px, c->cx_px,  c->cy_px};
    const int64_t choices[] = {o->definition, o->kind,       o->weighting, o->falloff,
                               o->rays,       o->normals,    o->seed,      d->width,
                               d->height,     d->guard_left, d->guard_top, d->layers,
                               r->width,      d->layer_kind, r->height,    c->projection,
                               v->projection};
    uint64_t hash = hash_mesh(REFERENCE_HASH, &r->scene->mesh);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        hash = hash_float(hash, numbers[i]);
    for (size_t i = 0; i < sizeof choices / sizeof *choices; i++)
        hash = hash_int(hash, choices[i]);
    hash = reference_hash(hash, v->eye, sizeof v->eye);
    hash = reference_hash(hash, v->target, sizeof v->target);
    hash = reference_hash(hash, v->up, sizeof v->up);
    r->fingerprint = hash ? hash : 1;
    return r->fingerprint;
}

static size_t value_bytes(const reference *r)
{
    return REFERENCE_FLOATS * sizeof(float) * (size_t)r->width * (size_t)r->height;
}

static uint64_t checksum(const checkpoint_header *header, const void *values, size_t size)
{
    return reference_hash(reference_hash(REFERENCE_HASH, header, sizeof *header), values,
                          size);
}

static bool write_all(reference *r, FILE *file)
{
    checkpoint_header header;
    size_t size = value_bytes(r);
    memset(&header, 0, sizeof header);
    memcpy(header.format, FORMAT, sizeof FORMAT);
    header.fingerprint = fingerprint_of(r);
    header.total = reference_total(r);
    header.done = r->done;
    uint64_t sum = checksum(&header, r->accessibility, size);
    return fwrite(&header, sizeof header, 1, file) == 1
           && fwrite(r->accessibility, size, 1, file) == 1
           && fwrite(&sum, sizeof sum, 1, file) == 1;
}

static int fail(const crv_logger *log, const char *path, int reason)
{
    scene_log(log, CRV_LOG_ERROR, path, "cannot be written (%s); %s",
              reason ? strerror(reason) : "unknown reason", new_file_cure(reason));
    return -1;
}

static int refuse(const crv_logger *log, const char *path, const char *text)
{
    scene_log(log, CRV_LOG_ERROR, path, "%s", text);
    return -1;
}

static const char no_checkpoint[] =
    "a reference of all falloffs has no checkpoint; make one of each";

int reference_save(reference *r, const char *path, const crv_logger *log)
{
    new_file file;
    if (r->falloffs)
        return refuse(log, path, no_checkpoint);
    errno = 0;
    if (!new_file_open(&file, path))
        return fail(log, path, errno);
    if (!write_all(r, file.stream)) {
        const int reason = errno;
        new_file_discard(&file);
        return fail(log, path, reason);
    }
    return new_file_commit(&file) ? 0 : fail(log, path, errno);
}

/* values: as many bytes as the reference holds. */
static int read_all(reference *r, FILE *file, const char *path, checkpoint_header *header,
                    float *values, const crv_logger *log)
{
    static const char damaged[] = "is damaged or no checkpoint; delete it and begin anew";
    uint64_t sum = 0;
    if (fread(header, sizeof *header, 1, file) != 1
        || memcmp(header->format, FORMAT, sizeof FORMAT) != 0)
        return refuse(log, path, damaged);
    if (header->fingerprint != fingerprint_of(r) || header->total != reference_total(r))
        return refuse(log, path,
                      "is of another scene, view or setting; give the same ones again, "
                      "or delete it and begin anew");
    if (fread(values, value_bytes(r), 1, file) != 1
        || fread(&sum, sizeof sum, 1, file) != 1 || getc(file) != EOF
        || sum != checksum(header, values, value_bytes(r)) || header->done < 0
        || header->done > header->total)
        return refuse(log, path, damaged);
    return 0;
}

int reference_load(reference *r, const char *path, const crv_logger *log)
{
    FILE *file = file_open(path); /* nobody may ever write to a pipe */
    float *values = malloc(value_bytes(r));
    checkpoint_header header;
    int result = -1;
    if (r->falloffs)
        refuse(log, path, no_checkpoint);
    else if (!file)
        refuse(log, path, "cannot be read as a file; delete it and begin anew");
    else if (!values)
        refuse(log, path, "no memory to read it; close other programs");
    else
        result = read_all(r, file, path, &header, values, log);
    if (result == 0) {
        memcpy(r->accessibility, values, value_bytes(r));
        r->done = header.done;
    }
    if (file)
        fclose(file);
    free(values);
    return result;
}

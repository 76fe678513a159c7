/* SPDX-License-Identifier: MIT */
/*
 * camera_json.c: cameras as JSON. A camera is an object: "eye", "target" and "up", or a
 * matrix "camera_to_world" or "world_to_camera", and "vfov" or "hfov" in degrees, "lens"
 * with "sensor" in mm, or "ortho", a height. A shot is a list of them, each with its
 * "frame", or an object whose keys are the frames' numbers, alone or in a member of an
 * object that holds what they share. A bare matrix is a camera_to_world.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "camera_parse.h"

static const double degree = 3.14159265358979323846 / 180.0;

/* What is read; `mistake` is NULL while all is well. */
typedef struct parser {
    camera_file *out;
    report *r;
    const char *mistake;
} parser;

static bool find_number(parser *p, const cJSON *object, const char *key, double largest,
                        double *out)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (!item || cJSON_IsNull(item))
        return false;
    if (!cJSON_IsNumber(item)
        || !(item->valuedouble > 0.0 && item->valuedouble < largest))
        p->mistake = "its field of view, lens, sensor or ortho is no number in its range";
    *out = item->valuedouble;
    return !p->mistake;
}

/* Leaves what the object does not say as it is. */
static void read_lens(parser *p, const cJSON *object, camera_entry *entry)
{
    double v = 0.0, h = 0.0, lens = 0.0, sensor = 36.0, ortho = 0.0;
    const bool has_v = find_number(p, object, "vfov", 180.0, &v)
                       || find_number(p, object, "vfov_degrees", 180.0, &v);
    const bool has_h = find_number(p, object, "hfov", 180.0, &h);
    const bool has_lens = find_number(p, object, "lens", 1e9, &lens);
    const bool has_ortho = find_number(p, object, "ortho", 1e30, &ortho);
    find_number(p, object, "sensor", 1e9, &sensor);
    if (has_v + has_h + has_lens + has_ortho > 1)
        p->mistake = "several of vfov, hfov, lens and ortho are given";
    if (!(has_v || has_h || has_lens || has_ortho) || p->mistake)
        return;
    if (has_lens)
        h = 2.0 * atan(0.5 * sensor / lens) / degree;
    entry->vfov_rad = v * degree;
    entry->hfov_rad = h * degree;
    entry->view_height = ortho;
}

static bool read_vector(const cJSON *item, double out[3])
{
    const cJSON *number;
    int i = 0;
    if (cJSON_GetArraySize(item) != 3)
        return false;
    cJSON_ArrayForEach(number, item)
    {
        if (!cJSON_IsNumber(number) || !isfinite(number->valuedouble))
            return false;
        out[i++] = number->valuedouble;
    }
    return true;
}

static void read_look_at(parser *p, const cJSON *object, camera_entry *entry)
{
    double eye[3], target[3], up[3] = {0, 1, 0};
    const cJSON *given_up = cJSON_GetObjectItemCaseSensitive(object, "up");
    if (!read_vector(cJSON_GetObjectItemCaseSensitive(object, "eye"), eye)
        || !read_vector(cJSON_GetObjectItemCaseSensitive(object, "target"), target)
        || (given_up && !read_vector(given_up, up)))
        p->mistake = "eye, target and up must be three numbers each";
    else
        p->mistake = camera_pose_look_at(eye, target, up, entry);
}

/* Four rows of four, or sixteen numbers, row by row. */
static bool read_matrix(const cJSON *item, double m[16])
{
    const cJSON *row, *number;
    int i = 0;
    cJSON_ArrayForEach(row, item)
    {
        const cJSON *numbers = cJSON_IsArray(row) ? row->child : row;
        for (number = numbers; number; number = number->next) {
            if (i == 16 || !cJSON_IsNumber(number) || !isfinite(number->valuedouble))
                return false;
            m[i++] = number->valuedouble;
            if (!cJSON_IsArray(row))
                break;
        }
    }
    return i == 16;
}

static void read_pose(parser *p, const cJSON *item, camera_entry *entry)
{
    const cJSON *to_world =
        cJSON_IsArray(item) ? item
                            : cJSON_GetObjectItemCaseSensitive(item, "camera_to_world");
    const cJSON *to_camera = cJSON_GetObjectItemCaseSensitive(item, "world_to_camera");
    const cJSON *matrix = to_world ? to_world : to_camera;
    double m[16];
    if (cJSON_GetObjectItemCaseSensitive(item, "eye")) {
        read_look_at(p, item, entry);
    } else if (matrix) {
        p->mistake = read_matrix(matrix, m)
                         ? camera_pose_matrix(m, to_world, entry)
                         : "its matrix is not four rows of four numbers";
    }
}

/* A camera beside what all of them share. frame: its key, or NULL. */
static int add(parser *p, const cJSON *item, const camera_entry *shared,
               const char *frame)
{
    camera_entry entry = *shared;
    const cJSON *number = cJSON_GetObjectItemCaseSensitive(item, "frame");
    const double value = frame ? strtod(frame, NULL) : number ? number->valuedouble : 0.0;
    if ((!frame && number && !cJSON_IsNumber(number)) || !camera_is_frame(value))
        p->mistake = "its frame is no whole number";
    entry.has_frame = frame || number;
    if (!p->mistake)
        read_pose(p, item, &entry);
    if (!p->mistake && cJSON_IsObject(item))
        read_lens(p, item, &entry);
    if (!p->mistake && !entry.has_pose
        && !(entry.vfov_rad > 0.0 || entry.hfov_rad > 0.0 || entry.view_height > 0.0))
        p->mistake = "it holds no camera";
    entry.frame = p->mistake ? 0 : (int32_t)value;
    if (!p->mistake)
        return camera_file_add(p->out, &entry, p->r);
    report_error(p->r, "%s: camera %d%s%s: %s; see `crevice help camera`", p->out->path,
                 (int)p->out->count + 1, frame ? ", frame " : "", frame ? frame : "",
                 p->mistake);
    return EXIT_FAILED;
}

/* Whether all keys of an object are frames' numbers. */
static bool is_map(const cJSON *item)
{
    const cJSON *child;
    if (!cJSON_IsObject(item) || !item->child)
        return false;
    cJSON_ArrayForEach(child, item)
    {
        char *end;
        const double number = strtod(child->string, &end);
        if (end == child->string || *end || !camera_is_frame(number))
            return false;
    }
    return true;
}

static bool is_list(const cJSON *item)
{
    return cJSON_IsArray(item) && cJSON_IsObject(item->child);
}

static int add_all(parser *p, const cJSON *cameras, const camera_entry *shared)
{
    const cJSON *child;
    int result = EXIT_DONE;
    cJSON_ArrayForEach(child, cameras)
    {
        if (result == EXIT_DONE)
            result = add(p, child, shared, cJSON_IsArray(cameras) ? NULL : child->string);
    }
    return result;
}

static int parse(parser *p, const cJSON *root)
{
    const camera_entry none = {0};
    camera_entry shared = {0};
    const cJSON *child;
    if (is_map(root) || is_list(root))
        return add_all(p, root, &none);
    cJSON_ArrayForEach(child, root)
    {
        if (!is_map(child) && !is_list(child))
            continue;
        read_lens(p, root, &shared);
        return add_all(p, child, &shared);
    }
    return add(p, root, &none, NULL);
}

static void add_vector(cJSON *object, const char *key, const double v[3])
{
    cJSON_AddItemToObject(object, key, cJSON_CreateDoubleArray(v, 3));
}

int camera_file_write(const char *path, const scene_view *view, report *r)
{
    cJSON *root = cJSON_CreateObject();
    add_vector(root, "eye", view->eye);
    add_vector(root, "target", view->target);
    add_vector(root, "up", view->up);
    if (view->projection == CRV_ORTHOGRAPHIC)
        cJSON_AddNumberToObject(root, "ortho", (double)view->view_height);
    else
        cJSON_AddNumberToObject(root, "vfov", (double)view->vfov_rad / degree);
    char *text = cJSON_Print(root);
    cJSON_Delete(root);
    if (!text)
        return report_no_memory(r);
    FILE *stream = fopen(path, "w");
    const bool written = stream && fprintf(stream, "%s\n", text) > 0;
    const bool closed = stream && !fclose(stream);
    cJSON_free(text);
    if (written && closed)
        return EXIT_DONE;
    report_error(r, "%s: cannot be written: %s; check its folder and the disk", path,
                 strerror(errno));
    return EXIT_FAILED;
}

int camera_parse_json(const char *text, size_t size, camera_file *out, report *r)
{
    parser p = {.out = out, .r = r};
    cJSON *root = cJSON_ParseWithLength(text, size + 1);
    if (!root) {
        report_error(r, "%s: is no valid JSON; write it again", out->path);
        return EXIT_FAILED;
    }
    const int result = parse(&p, root);
    cJSON_Delete(root);
    return result;
}

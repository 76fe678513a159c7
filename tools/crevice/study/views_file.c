/* SPDX-License-Identifier: MIT */
/* views_file.c: lists of views as JSON. */
#include <cjson/cJSON.h>
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/text.h"
#include "common/view.h"
#include "views.h"

enum { FILE_MAX = 1 << 22, NAME_MAX_LENGTH = 40 };

static const double degree = 3.14159265358979323846 / 180.0;

/* The whole file, ended by a zero; NULL after an error line. */
static char *read_whole(const char *file, report *r)
{
    struct stat status;
    FILE *stream = NULL;
    char *data = NULL;
    size_t size = 0;

    errno = 0;
    if (stat(file, &status) == 0 && S_ISDIR(status.st_mode)) {
        report_error(r, "%s: is a folder; name a JSON file", file);
        return NULL;
    }
    stream = fopen(file, "rb");
    if (stream == NULL) {
        report_error(r, "%s: cannot be read (%s); check its name", file, strerror(errno));
        return NULL;
    }
    data = malloc((size_t)FILE_MAX + 1);
    if (data == NULL) {
        report_no_memory(r);
    } else {
        size = fread(data, 1, (size_t)FILE_MAX + 1, stream);
        data[size <= FILE_MAX ? size : 0] = '\0';
    }
    if (data != NULL && (ferror(stream) || size > FILE_MAX)) {
        report_error(r, "%s: %s; name a list of views", file,
                     ferror(stream) ? "cannot be read" : "is larger than 4 MiB");
        free(data);
        data = NULL;
    } else if (data != NULL && strlen(data) != size) {
        report_error(r, "%s: holds a zero byte; name a JSON file", file);
        free(data);
        data = NULL;
    }
    fclose(stream);
    return data;
}

typedef struct place {
    const char *file;
    int32_t number; /* of the view in the list, from 1 */
    report *r;
} place;

static int refuse(const place *at, const char *key, const char *what)
{
    report_error(at->r, "%s: view %d: \"%s\" %s", at->file, at->number, key, what);
    return EXIT_FAILED;
}

/* Coordinates whose squares stay finite in single precision. */
static bool usable(const cJSON *number)
{
    return cJSON_IsNumber(number) && fabs(number->valuedouble) < 1e18;
}

static int read_vector(const place *at, const cJSON *view, const char *key, double out[3])
{
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(view, key);

    if (!cJSON_IsArray(list) || cJSON_GetArraySize(list) != 3)
        return refuse(at, key,
                      "is not there or no list of three numbers; give [x, y, z]");
    for (int i = 0; i < 3; i++) {
        const cJSON *number = cJSON_GetArrayItem(list, i);
        if (!usable(number))
            return refuse(at, key, "is no list of three numbers; give [x, y, z]");
        out[i] = number->valuedouble;
    }
    return EXIT_DONE;
}

static int read_name(const place *at, const views_list *list, const cJSON *view,
                     const char **out)
{
    const cJSON *name = cJSON_GetObjectItemCaseSensitive(view, "name");
    size_t length;

    if (!cJSON_IsString(name))
        return refuse(at, "name", "is not there or no text; give the view one");
    *out = name->valuestring;
    length = strlen(*out);
    if (length == 0 || length > NAME_MAX_LENGTH)
        return refuse(at, "name", "is empty or longer than 40 letters; change it");
    for (size_t i = 0; i < length; i++)
        if (!isalnum((unsigned char)(*out)[i]) && (*out)[i] != '-' && (*out)[i] != '_')
            return refuse(at, "name",
                          "is no word; use letters, digits, dashes and underscores");
    for (int32_t i = 0; i < list->entry_count; i++)
        if (strcmp(list->entries[i].name, *out) == 0)
            return refuse(at, "name", "is that of a view before it; change it");
    return EXIT_DONE;
}

static int read_lens(const place *at, const cJSON *view, views_entry *out)
{
    const cJSON *vfov = cJSON_GetObjectItemCaseSensitive(view, "vfov_degrees");
    const cJSON *radius = cJSON_GetObjectItemCaseSensitive(view, "radius");

    if (!cJSON_IsNumber(vfov)
        || !(vfov->valuedouble >= 0.1 && vfov->valuedouble <= 179.0))
        return refuse(at, "vfov_degrees", "is not there or no number from 0.1 to 179");
    out->camera.vfov_rad = (float)(vfov->valuedouble * degree);
    if (radius == NULL)
        return EXIT_DONE;
    if (!cJSON_IsNumber(radius)
        || !(radius->valuedouble >= 1e-9 && radius->valuedouble <= 1e9))
        return refuse(at, "radius",
                      "is no number from 1e-9 to 1e9; leave it out for one "
                      "that suits the view");
    out->radius = (float)radius->valuedouble;
    return EXIT_DONE;
}

/* Files are meant relative to the list's folder. */
static int read_path(const place *at, const cJSON *view, text *out)
{
    const cJSON *name = cJSON_GetObjectItemCaseSensitive(view, "file");
    const char *slash = strrchr(at->file, '/');

    if (!cJSON_IsString(name) || name->valuestring[0] == '\0')
        return refuse(at, "file", "is not there or no text; name a mesh");
    if (slash != NULL && name->valuestring[0] != '/'
        && strncmp(name->valuestring, "builtin:", 8) != 0)
        text_addf(out, "%.*s", (int)(slash - at->file) + 1, at->file);
    text_add(out, name->valuestring);
    return out->failed ? report_no_memory(at->r) : EXIT_DONE;
}

static int read_view(const place *at, views_list *list, const cJSON *view)
{
    views_entry entry = {
        .has_camera = true,
        .camera = {.projection = CRV_PERSPECTIVE, .up = {0.0f, 1.0f, 0.0f}}};
    const char *name = NULL;
    text path = {0};
    int result = read_name(at, list, view, &name);

    if (result == EXIT_DONE)
        result = read_path(at, view, &path);
    if (result == EXIT_DONE)
        result = read_vector(at, view, "eye", entry.camera.eye);
    if (result == EXIT_DONE)
        result = read_vector(at, view, "target", entry.camera.target);
    if (result == EXIT_DONE && cJSON_GetObjectItemCaseSensitive(view, "up") != NULL)
        result = read_vector(at, view, "up", entry.camera.up);
    if (result == EXIT_DONE)
        result = read_lens(at, view, &entry);
    if (result == EXIT_DONE && !(view_up_slant(&entry.camera) > 1e-10))
        result = refuse(at, "eye", "is the target, or up lies along the view; move it");
    if (result == EXIT_DONE)
        result = views_add(list, name, path.data, &entry, at->r);
    text_free(&path);
    return result;
}

static int32_t line_of(const char *data, const char *at)
{
    int32_t line = 1;

    for (; at != NULL && data < at && *data != '\0'; data++)
        line += *data == '\n';
    return line;
}

int views_read_file(views_list *list, const char *file, report *r)
{
    char *data = read_whole(file, r);
    const char *end = NULL;
    cJSON *root, *views;
    const cJSON *view;
    place at = {file, 0, r};
    int result = EXIT_DONE;

    if (data == NULL)
        return EXIT_FAILED;
    root = cJSON_ParseWithOpts(data, &end, 1);
    if (root == NULL) {
        report_error(r, "%s: line %d is no valid JSON; see `crevice help report`", file,
                     line_of(data, end));
        free(data);
        return EXIT_FAILED;
    }
    views = cJSON_GetObjectItemCaseSensitive(root, "views");
    if (!cJSON_IsArray(views) || cJSON_GetArraySize(views) == 0) {
        report_error(r, "%s: %s; see `crevice help report`", file,
                     cJSON_IsArray(views) ? "its list \"views\" is empty"
                                          : "has no list \"views\"");
        result = EXIT_FAILED;
    }
    for (view = cJSON_IsArray(views) ? views->child : NULL;
         view != NULL && result == EXIT_DONE; view = view->next) {
        at.number++;
        result = read_view(&at, list, view);
    }
    cJSON_Delete(root);
    free(data);
    return result;
}

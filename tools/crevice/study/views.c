/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L

#include "views.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/text.h"
#include "common/view.h"
#include "common/nearest.h"

static const double degree = 3.14159265358979323846 / 180.0;

enum { VIEWS_MAX = 64, NAME_MAX_LENGTH = 40 };

/* Looks closer at what the courtyard's own view shows small: gears, and grass. */
static const struct {
    const char *name;
    bool has_camera;
    double eye[3], target[3];
    double vfov_deg;
} courtyard_views[] = {
    {"courtyard", false, {0}, {0}, 0.0},
    {"courtyard-machine", true, {1.75, 1.35, 3.6}, {2.68, 0.92, 0.7}, 40.0},
    {"courtyard-grass", true, {-1.75, 0.85, 3.35}, {-3.7, 0.18, 0.3}, 40.0},
};

static int model_index(views_list *list, const char *path, report *r)
{
    views_model *models;

    for (int32_t i = 0; i < list->model_count; i++)
        if (strcmp(list->models[i].path, path) == 0)
            return i;
    models = realloc(list->models, ((size_t)list->model_count + 1) * sizeof *models);
    if (models == NULL) {
        report_no_memory(r);
        return -1;
    }
    list->models = models;
    models[list->model_count] = (views_model){strdup(path), NULL};
    if (models[list->model_count].path == NULL) {
        report_no_memory(r);
        return -1;
    }
    return list->model_count++;
}

static bool name_is_taken(const views_list *list, const char *name)
{
    for (int32_t i = 0; i < list->entry_count; i++)
        if (strcmp(list->entries[i].name, name) == 0)
            return true;
    return false;
}

int views_add(views_list *list, const char *name, const char *model,
              const views_entry *like, report *r)
{
    int32_t index;
    views_entry *entries;

    if (list->entry_count == VIEWS_MAX) {
        report_error(r, "%s: is view number %d; give %d at most", name, VIEWS_MAX + 1,
                     VIEWS_MAX);
        return EXIT_USAGE;
    }
    index = model_index(list, model, r);
    entries = index < 0 ? NULL
                        : realloc(list->entries,
                                  ((size_t)list->entry_count + 1) * sizeof *entries);
    if (entries == NULL)
        return index < 0 ? EXIT_FAILED : report_no_memory(r);
    list->entries = entries;
    entries[list->entry_count] = *like;
    entries[list->entry_count].model = index;
    entries[list->entry_count].name = strdup(name);
    if (entries[list->entry_count].name == NULL)
        return report_no_memory(r);
    list->entry_count++;
    return EXIT_DONE;
}

/* "models/Old hall.glb" is the view "Old-hall"; a second one of that name "Old-hall-2".
 */
static int add_model(views_list *list, const char *path, report *r)
{
    const char *base = strrchr(path, '/');
    char name[NAME_MAX_LENGTH + 1], unique[NAME_MAX_LENGTH + 16];
    int length = 0;

    base = base != NULL ? base + 1 : path;
    if (strncmp(base, "builtin:", 8) == 0)
        base += 8;
    for (; base[length] != '\0' && length < NAME_MAX_LENGTH; length++)
        name[length] = isalnum((unsigned char)base[length]) || base[length] == '.'
                           ? base[length]
                           : '-';
    name[length] = '\0';
    if (strrchr(name, '.') != NULL && strrchr(name, '.') != name)
        *strrchr(name, '.') = '\0';
    for (char *c = name; *c != '\0'; c++)
        *c = *c == '.' ? '-' : *c;
    snprintf(unique, sizeof unique, "%s", name);
    for (int i = 2; name_is_taken(list, unique); i++)
        snprintf(unique, sizeof unique, "%s-%d", name, i);
    return views_add(list, unique, path, &(views_entry){0}, r);
}

static int add_builtin(views_list *list, report *r)
{
    int result = EXIT_DONE;

    for (size_t i = 0; i < sizeof courtyard_views / sizeof courtyard_views[0]; i++) {
        views_entry entry = {
            .has_camera = courtyard_views[i].has_camera,
            .camera = {.projection = CRV_PERSPECTIVE,
                       .up = {0.0f, 1.0f, 0.0f},
                       .vfov_rad = (float)(courtyard_views[i].vfov_deg * degree)}};
        memcpy(entry.camera.eye, courtyard_views[i].eye, sizeof entry.camera.eye);
        memcpy(entry.camera.target, courtyard_views[i].target,
               sizeof entry.camera.target);
        if (result == EXIT_DONE)
            result =
                views_add(list, courtyard_views[i].name, "builtin:courtyard", &entry, r);
    }
    return result;
}

int views_collect(views_list *list, const arg_texts *models, const char *file, report *r)
{
    int result = EXIT_DONE;

    *list = (views_list){0};
    for (int32_t i = 0; i < models->count && result == EXIT_DONE; i++)
        result = add_model(list, models->value[i], r);
    if (file != NULL && result == EXIT_DONE)
        result = views_read_file(list, file, r);
    if (models->count == 0 && file == NULL)
        result = add_builtin(list, r);
    return result;
}

int views_check_name(const views_list *list, const char *name, report *r)
{
    const char *names[VIEWS_MAX], *nearest;
    text all = {0};

    for (int32_t i = 0; i < list->entry_count; i++) {
        names[i] = list->entries[i].name;
        if (strcmp(names[i], name) == 0)
            return EXIT_DONE;
    }
    nearest = nearest_name(name, names, list->entry_count);
    if (nearest != NULL) {
        report_error(r, "--main: no view \"%s\"; did you mean %s?", name, nearest);
        return EXIT_USAGE;
    }
    for (int32_t i = 0; i < list->entry_count; i++)
        text_addf(&all, "%s%s", i == 0 ? "" : ", ", names[i]);
    report_error(r, "--main: no view \"%s\"; choose one of %s", name,
                 all.data != NULL && !all.failed ? all.data : "those given");
    text_free(&all);
    return EXIT_USAGE;
}

static int load_models(views_list *list, int32_t width, int32_t height, report *r)
{
    int result = EXIT_DONE;

    for (int32_t i = 0; i < list->model_count && result == EXIT_DONE; i++) {
        view_settings settings = {.model = list->models[i].path,
                                  .size = {true, width, height}};
        result = view_check(&settings, r);
        if (result == EXIT_DONE)
            result = view_load(&settings, &list->models[i].model, r);
    }
    return result;
}

static int make_view(const views_list *list, const views_entry *entry, study *s,
                     int32_t width, int32_t height)
{
    scene *model = list->models[entry->model].model;
    study_view *v = &s->views[s->view_count];
    scene_view camera = entry->camera;
    float radius = entry->radius;
    int result;

    if (!entry->has_camera)
        scene_frame(model, (float)(45.0 * degree), (float)width / (float)height, &camera);
    if (!(radius > 0.0f))
        radius = scene_suggest_radius(model, &camera);
    result = study_view_make(s, entry->name, model, &camera, radius, width, height, v);
    if (result != EXIT_DONE)
        return result;
    s->view_count++;
    if (v->pixels > 0)
        return EXIT_DONE;
    report_error(s->r, "%s: the camera sees no surface; turn it to the model", v->name);
    return EXIT_FAILED;
}

int views_make(views_list *list, study *s, const char *main_name, int32_t width,
               int32_t height)
{
    int result = load_models(list, width, height, s->r);

    if (result != EXIT_DONE)
        return result;
    s->views = calloc((size_t)list->entry_count, sizeof *s->views);
    if (s->views == NULL)
        return report_no_memory(s->r);
    for (int32_t i = 0; i < list->entry_count && result == EXIT_DONE; i++)
        result = make_view(list, &list->entries[i], s, width, height);
    s->main = &s->views[0];
    for (int32_t i = 0; i < s->view_count && main_name != NULL; i++)
        if (strcmp(s->views[i].name, main_name) == 0)
            s->main = &s->views[i];
    return result;
}

void views_free(views_list *list, study *s)
{
    for (int32_t i = 0; i < s->view_count; i++)
        study_view_free(&s->views[i]);
    free(s->views);
    s->views = NULL;
    s->view_count = 0;
    for (int32_t i = 0; i < list->model_count; i++) {
        scene_free(list->models[i].model);
        free(list->models[i].path);
    }
    for (int32_t i = 0; i < list->entry_count; i++)
        free(list->entries[i].name);
    free(list->models);
    free(list->entries);
    *list = (views_list){0};
}

/* SPDX-License-Identifier: MIT */
/* views.h: which views `crevice report` measures: built-in ones, models that are framed
 * by themselves, or those of a list. */
#ifndef TOOL_STUDY_VIEWS_H
#define TOOL_STUDY_VIEWS_H

#include "common/args.h"
#include "study.h"

typedef struct views_model {
    char *path; /* or builtin:NAME */
    scene *model;
} views_model;

/* A view that is yet to be made. */
typedef struct views_entry {
    char *name;
    int32_t model; /* index */
    bool has_camera;
    scene_view camera;
    float radius; /* 0: one that suits */
} views_entry;

typedef struct views_list {
    views_model *models;
    int32_t model_count;
    views_entry *entries;
    int32_t entry_count;
} views_list;

/* Collects the views of these models and of this file (NULL: none); of neither: the
 * built-in ones. Nothing is loaded yet. Returns an exit code; free the list also after an
 * error. */
int views_collect(views_list *list, const arg_texts *models, const char *file, report *r);

/* Loads the models and makes the study's views, `main_name` (NULL: the first) their main
 * one. The study's views are freed by views_free(). */
int views_make(views_list *list, study *s, const char *main_name, int32_t width,
               int32_t height);

/* Whether there is a view of that name; writes the error line where not. */
int views_check_name(const views_list *list, const char *name, report *r);

void views_free(views_list *list, study *s);

/* For views_file.c and tests. name: copied. */
int views_add(views_list *list, const char *name, const char *model,
              const views_entry *like, report *r);
int views_read_file(views_list *list, const char *file, report *r);

#endif

/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "common/device.h"
#include "common/machine.h"
#include "study/sections.h"
#include "common/text.h"
#include "common/output.h"
#include "study/views.h"
#include "common/nearest.h"

typedef struct report_settings {
    common_settings common;
    arg_texts models, only;
    const char *output, *views, *main;
    arg_size size;
    arg_int rays;
} report_settings;

/* Those that are `is_small` run many variants of everything; a picture of
 * SMALL_PIXELS tells as much of those as a larger one. */
static const struct {
    const char *name;
    int (*run)(study *s);
    bool is_small;
} sections[] = {
    {"methods", study_methods, false},     {"missing", study_missing, false},
    {"structure", study_structure, false}, {"hsao", study_claims_hsao, true},
    {"hbao", study_claims_hbao, true},     {"alchemy", study_claims_alchemy, true},
    {"vao", study_claims_vao, true},       {"closed-forms", study_closed_forms, true},
    {"stability", study_stability, true},
};
enum { SECTION_COUNT = sizeof sections / sizeof sections[0] };
enum { SMALL_PIXELS = 640 * 360 };

static const arg file_rows[] = {
    {.name = "MODEL",
     .type = ARG_TEXTS,
     .offset = offsetof(report_settings, models),
     .help =
         "mesh files or builtin:NAME, each framed by itself; without any, three views "
         "of the built-in courtyard"},
    {.name = "--output",
     .short_name = 'o',
     .value = "DIR",
     .type = ARG_TEXT,
     .required = true,
     .offset = offsetof(report_settings, output),
     .help = "folder for index.html, report.json and pictures; is made where it is "
             "missing"},
    {.name = "--views",
     .value = "FILE.json",
     .type = ARG_TEXT,
     .offset = offsetof(report_settings, views),
     .help = "views of models; see above"},
};
static const arg_table file_table = ARG_TABLE("Files", file_rows);

static const arg study_rows[] = {
    {.name = "--main",
     .value = "NAME",
     .type = ARG_TEXT,
     .offset = offsetof(report_settings, main),
     .computed = "the first",
     .help = "the view that the papers' statements are measured on, at 640x360 or so "
             "where it is larger; that of a model has its file's name without the "
             "extension"},
    {.name = "--only",
     .value = "SECTION",
     .type = ARG_TEXTS,
     .offset = offsetof(report_settings, only),
     .computed = "all",
     .help = "methods, missing, structure, hsao, hbao, alchemy, vao, closed-forms or "
             "stability; may be given again"},
    {.name = "--size",
     .value = "WxH",
     .type = ARG_SIZE,
     .initial = "640x360",
     .offset = offsetof(report_settings, size),
     .help = "size of the pictures, 64x36 at least"},
    {.name = "--rays",
     .value = "N",
     .type = ARG_INT,
     .min = 16,
     .max = REFERENCE_MAX_RAYS,
     .initial = "128",
     .offset = offsetof(report_settings, rays),
     .help = "rays of the references for each pixel, at most"},
};
static const arg_table study_table = ARG_TABLE("What is measured", study_rows);

static const arg_table *const tables[] = {&file_table,  &study_table,       &args_threads,
                                          &args_device, &args_output_lines, NULL};

static const char *const examples[] = {
    "the built-in views",
    "crevice report -o study",
    "your own meshes",
    "crevice report -o study hall.glb engine.glb --size 1280x720",
    "chosen views; one section, measured on one of them",
    "crevice report -o study --views views.json --main hall --only missing",
    NULL,
};

static int check_sections(const report_settings *s, report *r)
{
    const char *names[SECTION_COUNT], *nearest;

    for (int i = 0; i < SECTION_COUNT; i++)
        names[i] = sections[i].name;
    for (int32_t k = 0; k < s->only.count; k++) {
        bool found = false;
        for (int i = 0; i < SECTION_COUNT; i++)
            found = found || strcmp(names[i], s->only.value[k]) == 0;
        if (found)
            continue;
        nearest = nearest_name(s->only.value[k], names, SECTION_COUNT);
        if (nearest != NULL)
            report_error(r, "--only: no section \"%s\"; did you mean %s?",
                         s->only.value[k], nearest);
        else
            report_error(r, "--only: no section \"%s\"; see `crevice help report`",
                         s->only.value[k]);
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}

static int check(const report_settings *s, report *r)
{
    if (s->size.width < 64 || s->size.height < 36) {
        report_error(r, "--size: %dx%d is too small to measure on; give 64x36 or more",
                     s->size.width, s->size.height);
        return EXIT_USAGE;
    }
    return check_sections(s, r);
}

static bool is_wanted(const report_settings *s, const char *section)
{
    for (int32_t i = 0; i < s->only.count; i++)
        if (strcmp(s->only.value[i], section) == 0)
            return true;
    return s->only.count == 0;
}

/* What would make this page again. */
static void describe_command(const report_settings *s, text *out)
{
    text_add(out, "crevice report -o DIR");
    for (int32_t i = 0; i < s->models.count; i++)
        text_addf(out, " %s", s->models.value[i]);
    if (s->views != NULL)
        text_addf(out, " --views %s", s->views);
    if (s->main != NULL)
        text_addf(out, " --main %s", s->main);
    for (int32_t i = 0; i < s->only.count; i++)
        text_addf(out, " --only %s", s->only.value[i]);
    text_addf(out, " --size %dx%d --rays %d", s->size.width, s->size.height,
              s->rays.value);
    if (s->common.threads.value > 0)
        text_addf(out, " --threads %d", s->common.threads.value);
    device_describe(&s->common, out);
}

static int write_introduction(const report_settings *settings, study *s)
{
    machine m = machine_look(s->threads);
    text line = {0};

    describe_command(settings, &line);
    if (line.failed) {
        text_free(&line);
        return report_no_memory(s->r);
    }
    page_text(
        s->page,
        "How far the ambient occlusion of each method is from the ray-traced truth, "
        "what it costs, and what of the statements of the papers it comes from can "
        "be found again. Accessibility goes from 0, occluded, to 1, open; errors "
        "are differences of accessibility over the pixels that show a surface. All "
        "numbers are also in `report.json`.");
    page_text(s->page, "Made by `%s`, crevice %s, %s, on: %s, %d thread%s.", line.data,
              crv_version(), m.compiler, m.processor, m.threads,
              m.threads == 1 ? "" : "s");
    cJSON_AddStringToObject(s->results, "command", line.data);
    cJSON_AddStringToObject(s->results, "version", crv_version());
    cJSON_AddStringToObject(s->results, "compiler", m.compiler);
    cJSON_AddStringToObject(s->results, "processor", m.processor);
    cJSON_AddNumberToObject(s->results, "threads", m.threads);
    cJSON_AddNumberToObject(s->results, "width", settings->size.width);
    cJSON_AddNumberToObject(s->results, "height", settings->size.height);
    cJSON_AddNumberToObject(s->results, "rays", s->rays);
    cJSON_AddStringToObject(s->results, "main", s->main->name);
    text_free(&line);
    return EXIT_DONE;
}

/* The main view, made smaller where it is larger than SMALL_PIXELS: *copy, to be freed.
 */
static int shrink_main(study *s, study_view *copy)
{
    double pixels = (double)s->main->width * (double)s->main->height;
    double scale = sqrt(SMALL_PIXELS / pixels);
    int result;

    if (scale >= 1.0)
        return EXIT_DONE;
    result = study_view_resized(s, s->main, (int32_t)(scale * s->main->width),
                                (int32_t)(scale * s->main->height), copy);
    if (result == EXIT_DONE)
        s->main = copy;
    return result;
}

static int run_one_kind(const report_settings *settings, study *s, bool is_small)
{
    int result = EXIT_DONE;

    for (int i = 0; i < SECTION_COUNT && result == EXIT_DONE; i++) {
        if (sections[i].is_small != is_small || !is_wanted(settings, sections[i].name))
            continue;
        study_progress(s, "section %s", sections[i].name);
        result = sections[i].run(s);
        if (page_failed(s->page))
            result = EXIT_FAILED;
    }
    return result;
}

static int run_sections(const report_settings *settings, study *s)
{
    study_view *main_view = s->main, copy = {0};
    int result = write_introduction(settings, s);

    if (result == EXIT_DONE)
        result = study_views_section(s);
    if (result == EXIT_DONE)
        result = run_one_kind(settings, s, false);
    if (result == EXIT_DONE)
        result = shrink_main(s, &copy);
    if (result == EXIT_DONE)
        result = run_one_kind(settings, s, true);
    s->main = main_view;
    study_view_free(&copy);
    if (result == EXIT_DONE)
        study_references_section(s);
    return result;
}

static int write_results(study *s)
{
    char *words = cJSON_Print(s->results);
    text line = {0};
    int result;

    if (words == NULL)
        return report_no_memory(s->r);
    text_addf(&line, "%s\n", words);
    cJSON_free(words);
    result = line.failed ? report_no_memory(s->r)
                         : page_attach(s->page, "report.json", line.data);
    text_free(&line);
    return result;
}

/* Bytes that the pictures take at least; a disk without that room is told of before the
 * work. */
static size_t room_wanted(const report_settings *s)
{
    return (size_t)16 * (size_t)s->size.width * (size_t)s->size.height;
}

/* Views and models may lie in the folder, but not under the page's names. */
static int spare_inputs(const report_settings *s, report *r)
{
    static const char *const written[] = {"index.html", "report.json"};
    char path[4096];
    int result = EXIT_DONE;

    for (int i = 0; i < 2 && result == EXIT_DONE; i++) {
        snprintf(path, sizeof path, "%s/%s", s->output, written[i]);
        result = output_spare(path, s->views, r);
        if (result == EXIT_DONE)
            result = output_spare_all(path, &s->models, r);
    }
    return result;
}

static int run(const void *settings_, report *r)
{
    const report_settings *settings = settings_;
    study s = {.r = r,
               .common = &settings->common,
               .threads = settings->common.threads.value,
               .rays = settings->rays.value};
    views_list views = {0};
    int result = check(settings, r);

    if (result == EXIT_DONE)
        result = spare_inputs(settings, r);
    if (result == EXIT_DONE)
        result = views_collect(&views, &settings->models, settings->views, r);
    if (result == EXIT_DONE && settings->main != NULL)
        result = views_check_name(&views, settings->main, r);
    if (result == EXIT_DONE)
        result = page_open(settings->output, "Crevice: methods measured",
                           room_wanted(settings), r, &s.page);
    if (result == EXIT_DONE)
        result = study_open(&s);
    if (result == EXIT_DONE)
        result = views_make(&views, &s, settings->main, settings->size.width,
                            settings->size.height);
    if (result == EXIT_DONE)
        result = run_sections(settings, &s);
    if (result == EXIT_DONE)
        result = write_results(&s);
    if (result == EXIT_DONE) {
        result = page_close(s.page);
        report_info(r, "%.0f s in all", report_seconds() - s.started);
    } else {
        page_abandon(s.page);
    }
    views_free(&views, &s);
    study_close(&s);
    return result;
}

const command command_report = {
    .name = "report",
    .summary = "a page that measures all methods against ray-traced references",
    .synopsis = "-o DIR [MODEL...] [options]",
    .details =
        "Writes DIR/index.html, which any browser shows: errors, times and pictures of "
        "every method and preset, what keeps them from the truth, and what of the "
        "papers' statements holds. Files of a former report are overwritten. A list of "
        "views is {\"views\": [{\"name\": \"hall\", \"file\": \"hall.glb\", \"eye\": "
        "[-8, 1, 0], \"target\": [0, 3, 0], \"up\": [0, 1, 0], \"vfov_degrees\": 60, "
        "\"radius\": 1}, ...]}: the name a word, the file relative to the list, radius "
        "in "
        "scene units; up and radius may be left out, other members are ignored.",
    .tables = tables,
    .examples = examples,
    .settings_size = sizeof(report_settings),
    .run = run,
};

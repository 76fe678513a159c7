/* SPDX-License-Identifier: MIT */
/* section_whole.c: whole runs of `crevice ao` as a process of its own, from an EXR file
 * to an EXR file, and what reading and writing take of it. */
#define _XOPEN_SOURCE 700

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/bench.h"
#include "common/device.h"
#include "gbuffer_image.h"
#include "common/output.h"
#include "study/study.h"

extern char **environ;

enum { PATH_SIZE = 2048, WORDS_MAX = 24 };

typedef struct whole_run {
    bench *b;
    const bench_frame *frame;
    char folder[PATH_SIZE], input[PATH_SIZE + 16], output[PATH_SIZE + 16];
    char program[PATH_SIZE], radius[32], threads[16], vfov[32];
    const char *method, *preset, *isa;
    bool exact;
    io_image picture; /* what was written */
} whole_run;

static int list_words(const whole_run *w, const char *words[WORDS_MAX])
{
    const char *fixed[] = {w->program,
                           "ao",
                           w->input,
                           "-o",
                           w->output,
                           "--quiet",
                           "--method",
                           w->method,
                           "--preset",
                           w->preset,
                           "--radius",
                           w->radius,
                           device_is_cpu(&w->b->settings->common) ? "--isa" : "--device",
                           w->isa,
                           "--threads",
                           w->threads};
    int count = sizeof fixed / sizeof fixed[0];

    memcpy(words, fixed, sizeof fixed);
    if (w->exact && device_is_cpu(&w->b->settings->common))
        words[count++] = "--exact";
    if (w->vfov[0] != '\0') {
        words[count++] = "--vfov";
        words[count++] = w->vfov;
    }
    words[count] = NULL;
    return count;
}

static bool spawn_once(void *data)
{
    const whole_run *w = data;
    const char *words[WORDS_MAX];
    char *arguments[WORDS_MAX]; /* not written to, whatever their type says */
    int status = 0, failure;
    pid_t child;

    if (output_interrupted())
        return false;
    list_words(w, words);
    memcpy(arguments, words, sizeof words);
    failure = posix_spawn(&child, w->program, NULL, NULL, arguments, environ);
    if (failure != 0) {
        report_error(w->b->r, "%s: cannot be started (%s)", w->program,
                     strerror(failure));
        return false;
    }
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        continue;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return true;
    w->b->r->errors++; /* the other process has told of it */
    return false;
}

static bool read_once(void *data)
{
    const whole_run *w = data;
    io_passes_request request = {.depth_format = crv_depth_format_planar(),
                                 .vfov_rad = w->frame->source->vfov_rad};
    io_frame frame;

    if (output_interrupted())
        return false;
    if (io_frame_load(w->input, &request, &frame, &w->b->quiet_logger) != 0)
        return false;
    io_frame_free(&frame);
    return true;
}

static bool write_once(void *data)
{
    const whole_run *w = data;

    return !output_interrupted()
           && io_write(w->output, &w->picture, NULL, &w->b->quiet_logger) == 0;
}

static int measure(whole_run *w)
{
    const struct {
        const char *what;
        bool (*run)(void *data);
    } parts[] = {{"crevice ao", spawn_once},
                 {"reading the frame", read_once},
                 {"writing the result", write_once}};
    double pixels = (double)w->frame->width * (double)w->frame->height;

    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        bench_time t;
        cJSON *row;

        bench_progress(w->b, "%s, %dx%d", parts[i].what, w->frame->width,
                       w->frame->height);
        if (parts[i].run == write_once
            && io_read(w->output, NULL, 0, &w->picture, &w->b->quiet_logger) != 0)
            return EXIT_FAILED;
        if (!bench_time_runs(&w->b->clock, parts[i].run, w, &t))
            return EXIT_FAILED;
        row = cJSON_CreateObject();
        cJSON_AddStringToObject(row, "what", parts[i].what);
        cJSON_AddStringToObject(row, "frame", w->frame->source->name);
        cJSON_AddNumberToObject(row, "width", w->frame->width);
        cJSON_AddNumberToObject(row, "height", w->frame->height);
        cJSON_AddStringToObject(row, "method", w->method);
        cJSON_AddStringToObject(row, "preset", w->preset);
        cJSON_AddStringToObject(row, "isa", w->isa);
        cJSON_AddNumberToObject(row, "threads", w->b->choices->threads[0]);
        bench_add_time(w->b, row, &t, pixels);
        bench_append(w->b, "whole", row);
    }
    return EXIT_DONE;
}

/* hbao where it was chosen: it is what the tool takes by default. */
static const char *choose_method(const bench_choices *c)
{
    for (int32_t i = 0; i < c->method_count; i++)
        if (strcmp(c->methods[i]->name, "hbao") == 0)
            return "hbao";
    return c->methods[0]->name;
}

static bool find_program(char *out, size_t size)
{
    ssize_t length = readlink("/proc/self/exe", out, size - 1);

    out[length > 0 ? length : 0] = '\0';
    return length > 0;
}

static int make_folder(whole_run *w)
{
    const char *where = getenv("TMPDIR");

    snprintf(w->folder, sizeof w->folder, "%s/crevice-bench-XXXXXX",
             where != NULL && where[0] != '\0' ? where : "/tmp");
    if (mkdtemp(w->folder) != NULL)
        return EXIT_DONE;
    report_error(w->b->r, "%s: the folder cannot be made (%s); set TMPDIR to another one",
                 w->folder, strerror(errno));
    w->folder[0] = '\0';
    return EXIT_FAILED;
}

/* A scene's frame is written here; a renderer's is where it is. */
static int make_input(whole_run *w)
{
    io_image image = {0};
    int result;

    snprintf(w->output, sizeof w->output, "%s/ao.exr", w->folder);
    if (w->frame->source->path != NULL) {
        snprintf(w->input, sizeof w->input, "%s", w->frame->source->path);
        return EXIT_DONE;
    }
    snprintf(w->input, sizeof w->input, "%s/frame.exr", w->folder);
    result = gbuffer_make_image(&w->frame->cast, &image, &w->b->quiet_logger) == 0
                     && io_write(w->input, &image, NULL, &w->b->quiet_logger) == 0
                 ? EXIT_DONE
                 : EXIT_FAILED;
    io_image_free(&image);
    return result;
}

/* Signals wait until the folder is removed. */
static int run_guarded(void *data)
{
    whole_run *w = data;
    int result = make_folder(w);

    if (result != EXIT_DONE)
        return result;
    result = make_input(w);
    if (result == EXIT_DONE)
        result = measure(w);
    io_image_free(&w->picture);
    unlink(w->output);
    if (w->frame->source->path == NULL)
        unlink(w->input);
    rmdir(w->folder);
    return result;
}

static void print(const bench *b)
{
    static const bench_column columns[] = {
        {"", "what", -1, 0},         {"frame", "frame", -1, 0}, {"width", "width", 0, 0},
        {"method", "method", -1, 0}, {"isa", "isa", -1, 0},     {"thr", "threads", 0, 0},
        {"ms", "ms", 1, 0},          {"+-", "ms_spread", 1, 0}, {"runs", "runs", 0, 0},
    };

    bench_print_list(b, "Whole runs of the tool, EXR to EXR", "whole", columns,
                     sizeof columns / sizeof columns[0]);
}

int bench_whole_section(bench *b)
{
    const bench_choices *c = b->choices;
    arg_size size =
        b->settings->sizes.count > 0 ? c->sizes[0] : (arg_size){true, 1920, 1080};
    bench_frame frame = {0};
    whole_run w = {.b = b,
                   .frame = &frame,
                   .method = choose_method(c),
                   .preset = crv_preset_name(c->presets[0]),
                   .isa = bench_isa_name(b, c->isas[0]),
                   .exact = c->exact[0]};
    int result;

    if (!find_program(w.program, sizeof w.program)) {
        report_info(b->r, "whole runs: this system does not tell where the tool lies");
        return EXIT_DONE;
    }
    result = bench_frame_make(&b->sources[0], size.width, size.height,
                              b->settings->common.threads.value, &b->quiet_logger, b->r,
                              &frame);
    snprintf(w.radius, sizeof w.radius, "%.9g", (double)frame.radius);
    snprintf(w.threads, sizeof w.threads, "%d", c->threads[0]);
    if (b->settings->vfov_deg.given)
        snprintf(w.vfov, sizeof w.vfov, "%.9g", b->settings->vfov_deg.value);
    if (result == EXIT_DONE)
        result = output_guarded(run_guarded, &w);
    bench_frame_free(&frame);
    if (result == EXIT_DONE)
        print(b);
    return result;
}

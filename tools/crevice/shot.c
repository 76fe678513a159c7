/* SPDX-License-Identifier: MIT */
#include "shot.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/progress.h"
#include "made.h"
#include "shot_state.h"

/* One line with all failures. */
static void tell_failures(const int32_t *failed, int32_t count, int32_t total, report *r)
{
    char text[1024] = "";
    for (int32_t i = 0; i < count; i++) {
        const size_t used = strlen(text);
        if (used + 40 > sizeof text) {
            snprintf(text + used, sizeof text - used, " ...");
            break;
        }
        snprintf(text + used, sizeof text - used, "%s%d", i ? "," : "", (int)failed[i]);
    }
    report_error(r, "%d of %d frames failed; mend them and give --frames %s", (int)count,
                 (int)total, text);
}

/* The frames of t->part. */
static int process_part(shot *t, job_failures *failures, report *r)
{
    const int32_t total = frames_count(t->list);
    int result = EXIT_DONE;
    progress p = progress_begin(r, "frames", 0, total);
    for (int32_t i = t->part.slice; i < total && result != EXIT_USAGE;
         i += t->part.count) {
        const int32_t number = frames_at(t->list, i);
        t->is_before_radius = i < t->radius_from;
        result = shot_process(t, &number, r);
        if (result == EXIT_FAILED) {
            failures->frames[failures->count++] = number;
            r->errors = 0; /* each failure has its line */
            if (t->part.count > 1)
                jobs_tell(&t->part, number);
        }
        r->brief = true;
        if (total > 1 && t->part.slice == 0)
            progress_show(&p, i + 1);
    }
    progress_end(&p);
    return failures->count ? EXIT_FAILED : result;
}

/* What is decided before the frames, then the frames. */
static int process_frames(shot *t, job_failures *failures, report *r)
{
    int result = t->request.fit_vfov && t->list ? shot_find_lens(t, r) : EXIT_DONE;
    if (result != EXIT_DONE)
        return result;
    made_describe(t->settings, &t->options, t->request.vfov_rad, t->cameras.checksum,
                  t->made);
    common_settings common = t->settings->common;
    if (t->part.count > 1)
        common.threads.value = jobs_threads(common.threads.value, t->part.count);
    result = estimate_open(&t->estimator, &common, r);
    if (result == EXIT_DONE)
        result = shot_find_radius(t, r);
    if (result == EXIT_DONE && t->part.count > 1)
        shot_decide(t, r);
    if (result == EXIT_DONE)
        result = t->list ? process_part(t, failures, r) : shot_process(t, NULL, r);
    estimate_close(&t->estimator);
    return result;
}

typedef struct job_work {
    shot *t;
    job_failures *failures;
    report *r;
} job_work;

static int process_job(void *user, const job *part)
{
    job_work *work = user;
    work->t->part = *part;
    work->r->brief = part->slice > 0; /* the first tells what is found */
    return process_frames(work->t, work->failures, work->r);
}

static int process_all(shot *t, report *r)
{
    const int32_t total = t->list ? frames_count(t->list) : 1;
    const int32_t wanted = t->settings->jobs.value;
    const int32_t jobs = wanted < total ? wanted : total;
    job_failures failures = {.capacity = total};
    job_work work = {t, &failures, r};
    failures.frames = malloc((size_t)total * sizeof *failures.frames);
    if (!failures.frames)
        return report_no_memory(r);
    const int result = jobs > 1 ? jobs_run(jobs, process_job, &work, &failures, r)
                                : process_frames(t, &failures, r);
    if (failures.count && total > 1)
        tell_failures(failures.frames, failures.count, total, r);
    free(failures.frames);
    return result;
}

int shot_run(const ao_settings *settings, const io_passes_request *request,
             const frame_list *list, const view_list *views, report *r)
{
    shot t = {.settings = settings,
              .list = list,
              .views = *views,
              .request = *request,
              .options = settings->common.options,
              .has_radius = settings->common.radius_given,
              .part = {.count = 1}};
    int result = settings->camera.file ? camera_file_load(
                     settings->camera.file, settings->camera.order.value, &t.cameras, r)
                                       : EXIT_DONE;
    if (result != EXIT_DONE)
        return result;
    shot_use_view(&t, 0);
    result = process_all(&t, r);
    camera_file_free(&t.cameras);
    return result;
}

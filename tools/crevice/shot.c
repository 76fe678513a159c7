/* SPDX-License-Identifier: MIT */
#include "shot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "ao_camera.h"
#include "common/estimate.h"
#include "common/output.h"
#include "common/progress.h"
#include "common/radius.h"
#include "frame_facts.h"
#include "jobs.h"
#include "made.h"
#include "masks.h"
#include "results.h"
#include "shrink.h"
#include "views.h"

enum { PATH_SIZE = 4096, LOOKED_AT = 5 };

/* What lasts from frame to frame. */
typedef struct shot {
    const ao_settings *settings;
    const frame_list *list;
    view_list views;
    const char *view; /* at hand */
    io_passes_request request;
    camera_file cameras; /* of --camera */
    crv_options options;
    bool has_radius;   /* the user's, or that of the first frame that shows anything */
    frame_facts first; /* of the first frame */
    char made[IO_MADE_SIZE]; /* the settings, without the state */
    job part;                /* of the frames, with --jobs */
    int32_t radius_from;     /* place of the frame that decided the radius; 0: any */
    bool is_before_radius;   /* the frame at hand lies before that, and shows nothing */
    estimator estimator;
} shot;

typedef struct frame_paths {
    bool has_number;
    int32_t number;
    char input[PATH_SIZE], output[PATH_SIZE];
} frame_paths;

/* Fills the place of the view in a name, which is there or not. */
static bool name_view(const shot *t, char path[PATH_SIZE])
{
    char pattern[PATH_SIZE];
    memcpy(pattern, path, PATH_SIZE);
    return views_name(pattern, t->view, path, PATH_SIZE);
}

static int name_frame(const shot *t, int32_t frame, frame_paths *paths, report *r)
{
    const ao_settings *s = t->settings;
    paths->has_number = true;
    paths->number = frame;
    if (frames_name(s->input, frame, paths->input, sizeof paths->input)
        && frames_name(s->output, frame, paths->output, sizeof paths->output)
        && name_view(t, paths->input) && name_view(t, paths->output))
        return EXIT_DONE;
    report_error(r, "--frames: the names of frame %d are too long", (int)frame);
    return EXIT_USAGE;
}

static int name_single(const shot *t, frame_paths *paths, report *r)
{
    const ao_settings *s = t->settings;
    const bool fits = views_name(s->input, t->view, paths->input, sizeof paths->input);
    if (fits && views_name(s->output, t->view, paths->output, sizeof paths->output)) {
        paths->has_number = ao_camera_number(paths->input, &paths->number);
        return EXIT_DONE;
    }
    report_error(r, "%s: the name is too long; shorten it", fits ? "-o" : "IN");
    return EXIT_USAGE;
}

/* From here on the passes of this view are read. */
static void use_view(shot *t, int32_t index)
{
    t->view = t->views.name[index];
    t->request.views = t->settings->views;
    t->request.view =
        t->settings->views && !views_have_place(t->settings->input) ? t->view : NULL;
}

/* Whether all views of a frame share a file. */
static bool views_are_together(const shot *t)
{
    return t->views.count > 1 && !views_have_place(t->settings->output);
}

/* The name of the view's channel. */
static void name_channel(const shot *t, char channel[IO_NAME_SIZE])
{
    views_channel(append_channel(t->settings), views_are_together(t) ? t->view : "",
                  channel);
}

/* What the frame of a result has left to those after it. */
static void take_up(shot *t, const made_state *state)
{
    if (state->has_radius) {
        t->options.radius = state->radius;
        t->has_radius = true;
    }
    t->request.usual_reading = state->reading;
    t->request.depth_format.encoding = state->encoding;
    t->request.is_later = true;
}

static bool is_same_radius(const shot *t, const made_state *state)
{
    return !t->has_radius || !state->has_radius
           || fabsf(state->radius - t->options.radius) <= 1e-6f * t->options.radius;
}

/* Whether a result is there, whole, and made with these settings. */
static bool is_done(shot *t, const char *output, report *r)
{
    struct stat info;
    char made[IO_MADE_SIZE], channel[IO_NAME_SIZE];
    made_state state;
    if (stat(output, &info) != 0)
        return false;
    name_channel(t, channel);
    const bool whole =
        made_read(output, append_is_wanted(t->settings) ? channel : NULL, made);
    const bool same =
        whole && made_matches(t->made, made, &state) && is_same_radius(t, &state);
    if (!same) {
        report_info(r, "%s: is %s; it is made again", output,
                    whole ? "made with other settings" : "not whole");
        return false;
    }
    take_up(t, &state);
    report_info(r, "%s: is there, and made with these settings", output);
    return true;
}

/* The first result that is there gives the radius and the rest, so that frames before it,
 * which failed or were lost, do not choose another. */
static int find_made_state(shot *t, report *r)
{
    frame_paths paths;
    char made[IO_MADE_SIZE], channel[IO_NAME_SIZE];
    made_state state;
    if (!t->settings->skip_existing || !t->list)
        return EXIT_DONE;
    for (int32_t i = 0; i < frames_count(t->list); i++) {
        const int result = name_frame(t, frames_at(t->list, i), &paths, r);
        if (result != EXIT_DONE)
            return result;
        name_channel(t, channel);
        made_glance(paths.output, append_is_wanted(t->settings) ? channel : NULL, made);
        if (!made_matches(t->made, made, &state) || !state.has_radius
            || !is_same_radius(t, &state))
            continue;
        if (!t->has_radius)
            report_info(r, "radius: %g, of %s", (double)state.radius, paths.output);
        take_up(t, &state);
        break;
    }
    return EXIT_DONE;
}

static int upload(estimator *e, const io_frame *frame, report *r)
{
    estimate_fit(e, &frame->desc);
    return report_ok(r, io_frame_to_gbuffer(frame, e->context, &e->gbuffer), "G-buffer")
               ? EXIT_DONE
               : EXIT_FAILED;
}

/* A part of a shot chooses its own radius, which another part would not. */
static void warn_of_part(const shot *t, report *r)
{
    frame_paths paths;
    if (!t->list)
        return;
    const int32_t first = frames_at(t->list, 0);
    const int32_t last = frames_at(t->list, frames_count(t->list) - 1);
    const int32_t outside[] = {first - 1, last + 1};
    for (int i = 0; i < 2; i++) {
        struct stat info;
        if (name_frame(t, outside[i], &paths, r) == EXIT_DONE
            && stat(paths.input, &info) == 0) {
            report_warning(r,
                           "--radius: these frames choose their own, and %s is not of "
                           "them; give --radius, or --radius-frame to all parts of a "
                           "shot",
                           paths.input);
            return;
        }
    }
}

static int fix_radius(shot *t, const io_frame *frame, report *r)
{
    float radius;
    const int result = radius_suggest(&t->estimator, frame, &radius, r);
    if (result != EXIT_DONE || !(radius > 0.0f))
        return result;
    t->options.radius = radius;
    t->has_radius = true;
    report_info(r, "radius: --radius %g, 5 %% of the view's height at the median depth",
                (double)radius);
    if (!t->settings->radius_frame.given)
        warn_of_part(t, r);
    return EXIT_DONE;
}

/* What is known of a frame before it is read. */
static int request_frame(const shot *t, const frame_paths *paths,
                         io_passes_request *request, report *r)
{
    const ao_frame frame = {paths->has_number, paths->number, paths->input};
    *request = t->request;
    return t->settings->camera
               ? ao_camera_set(t->settings, &t->cameras, &frame, request, r)
               : EXIT_DONE;
}

static int load(const shot *t, const frame_paths *paths, io_frame *frame, report *r)
{
    io_passes_request request;
    const int result = request_frame(t, paths, &request, r);
    if (result != EXIT_DONE)
        return result;
    if (io_frame_load(paths->input, &request, frame, &r->logger) != 0)
        return EXIT_FAILED;
    if (t->settings->layer_kind.given)
        frame->desc.layer_kind = (crv_layers)t->settings->layer_kind.value;
    return EXIT_DONE;
}

/* The i-th of some frames that are spread over the shot, the first included. */
static int32_t spread_frame(const shot *t, int32_t i)
{
    const int32_t last = frames_count(t->list) - 1;
    const int32_t parts = last < LOOKED_AT ? last : LOOKED_AT;
    return frames_at(t->list, i < parts ? (int32_t)((int64_t)i * last / parts) : last);
}

/* Lets other frames of the shot decide how normals are read, if the first cannot. */
static void ask_the_shot(shot *t, report *r)
{
    const int32_t count = t->list ? frames_count(t->list) : 0;
    frame_paths paths;
    for (int32_t i = 1; i <= LOOKED_AT && i < count; i++) {
        const int32_t number = spread_frame(t, i);
        io_frame frame = {0};
        io_passes_request request;
        if (name_frame(t, number, &paths, r) != EXIT_DONE
            || request_frame(t, &paths, &request, NULL) != EXIT_DONE
            || io_frame_load(paths.input, &request, &frame, NULL) != 0)
            continue;
        const int reading = frame.reading_decided ? frame.reading : 0;
        io_frame_free(&frame);
        if (!reading)
            continue;
        t->request.usual_reading = reading;
        report_info(r, "normals: %s decides how they are read, for the whole shot",
                    paths.input);
        return;
    }
}

/* Loads a frame, and again if the shot reads its normals otherwise. */
static int load_as_shot(shot *t, const frame_paths *paths, io_frame *frame, report *r)
{
    int result = load(t, paths, frame, r);
    if (result != EXIT_DONE)
        return result;
    if (frame->reading && frame->reading_decided && !t->request.is_later)
        t->request.usual_reading = frame->reading;
    if (frame->reading && !frame->reading_decided && !t->request.is_later
        && !t->request.usual_reading) {
        ask_the_shot(t, r);
        if (t->request.usual_reading && t->request.usual_reading != frame->reading) {
            io_frame_free(frame);
            result = load(t, paths, frame, r);
        }
    }
    if (result != EXIT_DONE)
        return result;
    if (!t->request.is_later)
        t->request.usual_deviation = frame->deviation;
    t->request.is_later = true;
    t->request.zoom_told |= frame->zooms;
    t->request.depth_format.encoding = frame->encoding;
    return masks_take_out(t->settings, paths->input, frame, r);
}

/* The result of the view at hand. so_far: those of the frame that will be written with
 * it, itself included. */
static int compute(shot *t, const frame_paths *paths, ao_result *result, int32_t so_far,
                   report *r)
{
    const char *input = paths->input;
    result->view = t->view;
    name_channel(t, result->channel);
    int code = load_as_shot(t, paths, &result->frame, r);
    if (code == EXIT_DONE)
        code = append_check(t->settings, input, result + 1 - so_far, so_far, r);
    if (code == EXIT_DONE)
        code = shrink_check(&result->frame, t->settings->aa.value, input, r);
    if (code == EXIT_DONE)
        facts_compare(&t->first, &result->frame, input, r);
    if (code == EXIT_DONE)
        code = upload(&t->estimator, &result->frame, r);
    if (code == EXIT_DONE && !t->has_radius)
        code = fix_radius(t, &result->frame, r);
    if (code == EXIT_DONE)
        code = estimate_plan(&t->estimator, &t->options, r);
    if (code == EXIT_DONE)
        estimate_announce(&t->estimator, &result->frame.camera, r);
    if (code == EXIT_DONE)
        code = estimate_run(&t->estimator, &result->ao, r);
    if (code == EXIT_DONE)
        code = facts_check_surface(&t->estimator, &result->ao, input, r);
    if (code == EXIT_DONE)
        code = masks_open(t->settings, input, &result->frame, &result->ao, r);
    return code;
}

static int write_results(const shot *t, const frame_paths *paths, ao_result *results,
                         report *r)
{
    const made_state state = {.has_radius = t->has_radius && !t->is_before_radius,
                              .radius = t->options.radius,
                              .reading = t->request.usual_reading,
                              .encoding = t->request.depth_format.encoding};
    const bool together = views_are_together(t);
    int code = EXIT_DONE;
    for (int32_t i = 0; i < (together ? 1 : t->views.count) && code == EXIT_DONE; i++)
        code = results_write(t->settings, paths[i].input, paths[i].output, &results[i],
                             together ? t->views.count : 1, t->made, &state, r);
    return code;
}

/* Whether all files of a frame are there; NULL for the number: a single frame. */
static int prepare(shot *t, const int32_t *number, frame_paths paths[MAX_VIEWS],
                   bool *is_there, report *r)
{
    const ao_settings *s = t->settings;
    *is_there = s->skip_existing;
    for (int32_t i = 0; i < t->views.count; i++) {
        use_view(t, i);
        int code =
            number ? name_frame(t, *number, &paths[i], r) : name_single(t, &paths[i], r);
        if (code == EXIT_DONE)
            code = output_check(paths[i].output, paths[i].input, r);
        if (code != EXIT_DONE)
            return code;
        if (i == 0 || !views_are_together(t))
            *is_there = *is_there && is_done(t, paths[i].output, r);
    }
    return EXIT_DONE;
}

static int process(shot *t, const int32_t *number, report *r)
{
    frame_paths paths[MAX_VIEWS];
    ao_result results[MAX_VIEWS];
    bool is_there;
    int code = prepare(t, number, paths, &is_there, r);
    if (code != EXIT_DONE || is_there)
        return code;
    memset(results, 0, sizeof results);
    for (int32_t i = 0; i < t->views.count && code == EXIT_DONE; i++) {
        use_view(t, i);
        code = compute(t, &paths[i], &results[i], views_are_together(t) ? i + 1 : 1, r);
    }
    if (code == EXIT_DONE)
        code = write_results(t, paths, results, r);
    results_free(results, t->views.count);
    return code;
}

/* --vfov fit: the first frame that decides it, for all. */
static int find_lens(shot *t, report *r)
{
    frame_paths paths;
    io_passes_request request;
    io_frame frame = {0};
    int result = EXIT_FAILED;
    for (int32_t i = 0; i <= LOOKED_AT + 1 && result == EXIT_FAILED; i++) {
        /* In the end the first again, for its error line. */
        const bool speak = i == LOOKED_AT + 1;
        result = name_frame(t, spread_frame(t, speak ? 0 : i), &paths, r);
        if (result == EXIT_DONE)
            result = request_frame(t, &paths, &request, speak ? r : NULL);
        if (result == EXIT_DONE
            && io_frame_load(paths.input, &request, &frame, speak ? &r->logger : NULL))
            result = EXIT_FAILED;
    }
    /* Positions tell the camera of each frame. */
    if (result == EXIT_DONE && frame.fitted_vfov_rad > 0.0f) {
        t->request.fit_vfov = false;
        t->request.vfov_rad = frame.fitted_vfov_rad;
        report_info(r, "field of view: --vfov %.4f, found from %s for the whole shot",
                    (double)frame.fitted_vfov_rad * 57.29577951308232, paths.input);
    }
    io_frame_free(&frame);
    return result;
}

/* The radius of the frame that the user names. */
static int find_radius(shot *t, report *r)
{
    frame_paths paths;
    io_frame frame = {0};
    if (!t->settings->radius_frame.given)
        return find_made_state(t, r);
    int result = name_frame(t, t->settings->radius_frame.value, &paths, r);
    if (result == EXIT_DONE)
        result = load_as_shot(t, &paths, &frame, r);
    if (result == EXIT_DONE)
        result = upload(&t->estimator, &frame, r);
    if (result == EXIT_DONE)
        result = fix_radius(t, &frame, r);
    io_frame_free(&frame);
    if (result == EXIT_DONE && !t->has_radius) {
        report_error(r, "--radius-frame: %s shows nothing; name another frame",
                     paths.input);
        result = EXIT_FAILED;
    }
    return result;
}

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

/* With --jobs each process finds out for itself what the first frames decide for all. */
static void decide(shot *t, report *r)
{
    report mute = *r;
    mute.quiet = mute.brief = true;
    mute.logger = (crv_logger){0};
    const int32_t total = frames_count(t->list);
    for (int32_t i = 0; i < total && !(t->has_radius && t->request.is_later); i++) {
        frame_paths paths;
        io_frame frame = {0};
        if (name_frame(t, frames_at(t->list, i), &paths, &mute) == EXIT_DONE
            && load_as_shot(t, &paths, &frame, &mute) == EXIT_DONE && !t->has_radius
            && upload(&t->estimator, &frame, &mute) == EXIT_DONE) {
            fix_radius(t, &frame, t->part.slice ? &mute : r);
            t->radius_from = i;
        }
        io_frame_free(&frame);
    }
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
        result = process(t, &number, r);
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
    int result = t->request.fit_vfov && t->list ? find_lens(t, r) : EXIT_DONE;
    if (result != EXIT_DONE)
        return result;
    made_describe(t->settings, &t->options, t->request.vfov_rad, t->cameras.checksum,
                  t->made);
    common_settings common = t->settings->common;
    if (t->part.count > 1)
        common.threads.value = jobs_threads(common.threads.value, t->part.count);
    result = estimate_open(&t->estimator, &common, r);
    if (result == EXIT_DONE)
        result = find_radius(t, r);
    if (result == EXIT_DONE && t->part.count > 1)
        decide(t, r);
    if (result == EXIT_DONE)
        result = t->list ? process_part(t, failures, r) : process(t, NULL, r);
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
    int result = settings->camera ? camera_file_load(
                     settings->camera, settings->camera_order.value, &t.cameras, r)
                                  : EXIT_DONE;
    if (result != EXIT_DONE)
        return result;
    use_view(&t, 0);
    result = process_all(&t, r);
    camera_file_free(&t.cameras);
    return result;
}

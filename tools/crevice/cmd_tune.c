/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "common/device.h"
#include "common/option_text.h"
#include "common/output.h"
#include "common/progress.h"
#include "common/target.h"
#include "system/interrupt.h"
#include "tune_work.h"

/* A run of the method, and the runs after it, take no longer after an interrupt. */
enum { GRACE_S = 10 };

/* The correlation of truth and result from which on one of them looks inverted: less may
 * be chance where hardly anything is occluded. */
#define OPPOSITE (-0.25)

static const arg file_rows[] = {
    {.name = "INPUT",
     .required = true,
     ARG_INTO(ARG_TEXT, tune_settings, in.view.model),
     .help = "mesh (glTF, OBJ, ...), scene made in code (builtin:courtyard, ...), or a "
             "frame with a depth pass (.exr, .png, .pfm)"},
    VIEW_IMPORT_ROW,
    {.name = "--output",
     .short_name = 'o',
     .value = "FILE",
     ARG_INTO(ARG_TEXT, tune_settings, in.view.output),
     .help = "text to write the options to, for --options FILE"},
};
static const arg_table file_table = ARG_TABLE("Files", file_rows);

static const arg fit_rows[] = {
    {.name = "--fit",
     .value = "WORDS",
     ARG_INTO(ARG_TEXT, tune_settings, fit),
     .computed = "radius,thickness,falloff,contrast, as far as the method reads them",
     .help = "what may change, with commas in between; intensity can be named, too"},
    {.name = "--time",
     .value = "S",
     ARG_RANGE(0.1, 1e6),
     .unit = "seconds",
     .initial = "10",
     ARG_INTO(ARG_NUMBER, tune_settings, time_s),
     .help = "for tracing truths and for the search; reading and ray casting the view "
             "come on top. An interrupt keeps the best so far"},
    {.name = "--evaluations",
     .value = "N",
     ARG_RANGE(1, 1000000),
     ARG_INTO(ARG_INT, tune_settings, evaluations),
     .help = "runs of the method, about, instead of --time: always the same result"},
};
static const arg_table fit_table = ARG_TABLE("Fit", fit_rows);

static const arg truth_rows[] = {
    {.name = "--truth",
     .value = "FILE[:CHANNEL]",
     ARG_INTO(ARG_TEXT, tune_settings, truth),
     .computed = "the frame's own pass of ambient occlusion",
     .help = "of a frame: picture of its accessibility, 1 where it is open"},
    {.name = "--truth-radius",
     .value = "R",
     ARG_RANGE(1e-9, 1e9),
     .unit = "scene units",
     ARG_INTO(ARG_NUMBER, tune_settings, truth_radius),
     .computed = "--radius",
     .help = "of a mesh, whose truth is ray-traced: its radius"},
    {.name = "--truth-weighting",
     .value = "KIND",
     .choices = target_weightings,
     ARG_INTO(ARG_CHOICE, tune_settings, truth_weighting),
     .computed = "what the method estimates",
     .help = "its weighting"},
    {.name = "--truth-falloff",
     .value = "KIND",
     .choices = target_falloffs,
     ARG_INTO(ARG_CHOICE, tune_settings, truth_falloff),
     .computed = "what the method estimates",
     .help = "its falloff"},
    {.name = "--rays",
     .value = "N",
     ARG_RANGE(16, REFERENCE_MAX_RAYS),
     ARG_INTO(ARG_INT, tune_settings, rays),
     .computed = "a fifth of the time for each view, or less if that is enough",
     .help = "rays for each of some ten thousand pixels; noise that they leave is told, "
             "and taken off the errors"},
};
static const arg_table truth_table = ARG_TABLE("Truth", truth_rows);

static const arg check_rows[] = {
    {.name = "--check-orbit",
     .value = "DEG",
     ARG_RANGE(-360.0, 360.0),
     .unit = "degrees",
     .initial = "40",
     ARG_INTO(ARG_NUMBER, tune_settings, check_orbit_deg),
     .help = "of a mesh: the camera goes around its target to a view that is not "
             "fitted, and shows whether the gain holds there; 0: none"},
    {.name = "--check-eye",
     .value = "X,Y,Z",
     .unit = "in scene units",
     ARG_INTO(ARG_VECTOR, tune_settings, check_eye),
     .help = "of a mesh: where the camera goes instead"},
    {.name = "--check",
     .value = "FILE",
     ARG_INTO(ARG_TEXT, tune_settings, check),
     .help = "of a frame: another frame that is not fitted"},
    {.name = "--check-truth",
     .value = "FILE[:CHANNEL]",
     ARG_INTO(ARG_TEXT, tune_settings, check_truth),
     .computed = "its own pass of ambient occlusion",
     .help = "the truth of that frame"},
};
static const arg_table check_table = ARG_TABLE("Other view", check_rows);

static const arg_table *const tables[] = {
    &file_table,    &fit_table,         &truth_table,  &check_table,
    &viewer_passes, &viewer_camera,     &view_buffers, &args_threads,
    &args_device,   &args_output_lines, NULL};

static const char *const examples[] = {
    "the options at which bitmask comes nearest to ray tracing",
    "crevice tune model.glb --method bitmask -o options.txt",
    "hbao as near as it comes to cosine weighting without falloff",
    "crevice tune model.glb --truth-weighting cosine --truth-falloff none --radius 0.5",
    "as the renderer's own pass looks, then for the whole shot",
    "crevice tune shot.0001.exr --vfov 35 --check shot.0100.exr -o options.txt && "
    "crevice ao shot.####.exr --frames 1-240 --vfov 35 --options options.txt -o "
    "ao.####.exr",
    "a truth in a file of its own; only strength may change",
    "crevice tune frame.exr --vfov 35 --truth ao.exr:AO --fit intensity,contrast",
    NULL,
};

static const char *mesh_mistake(const tune_settings *s)
{
    if (s->truth || s->check || s->check_truth)
        return "--truth: is for frames, the truth of a mesh is ray-traced; leave out "
               "--truth, --check and --check-truth";
    if (s->check_eye.given && s->check_orbit_deg.given)
        return "--check-eye: contradicts --check-orbit; give one of them";
    return NULL;
}

static const char *frame_mistake(const tune_settings *s)
{
    if (s->in.view.size.given)
        return "--size: is for meshes; a frame has the size that it was rendered with";
    if (s->check_eye.given || s->check_orbit_deg.given)
        return "--check-eye, --check-orbit: are for meshes; give another frame with "
               "--check";
    if (s->truth_radius.given || s->truth_weighting.given || s->truth_falloff.given
        || s->rays.given)
        return "--truth-radius, --truth-weighting, --truth-falloff, --rays: are for "
               "meshes; the truth of a frame is a picture";
    if (s->check_truth && !s->check)
        return "--check-truth: belongs to --check; add that";
    return NULL;
}

static int check(const tune_settings *s, unsigned *fits, report *r)
{
    const crv_method *method = s->in.view.common.options.method;
    const bool is_frame = pass_is_frame(s->in.view.model);
    const unsigned wanted = s->fit ? tune_parse(s->fit) : TUNE_USUAL;
    const char *mistake = viewer_mistake(&s->in);
    char words[64];
    if (!mistake)
        mistake = is_frame ? frame_mistake(s) : mesh_mistake(s);
    if (!mistake && estimate_is_of_relief(&s->in.view.common.options))
        mistake = "--characteristic field: there is no relief to fit; leave it out";
    if (mistake) {
        report_error(r, "%s", mistake);
        return EXIT_USAGE;
    }
    *fits = tune_applicable(wanted, method);
    if (s->fit && (wanted == 0 || *fits != wanted)) {
        report_error(r, "--fit: \"%s\" is not of %s; give some of %s", s->fit,
                     method->name, tune_words(tune_applicable(TUNE_ALL, method), words));
        return EXIT_USAGE;
    }
    return s->in.view.output ? output_spare(s->in.view.output, s->in.view.model, r)
                             : EXIT_DONE;
}

bool tune_work_stop(void *user)
{
    (void)user;
    return interrupt_waits();
}

/* What the library logs of the many runs of the search is of no use to anybody. */
typedef struct voice {
    report *r;
    bool muted;
} voice;

static void take_line(void *user, crv_log_level level, const char *line)
{
    const voice *v = user;
    if (!v->muted)
        v->r->logger.fn(v->r->logger.user, level, line);
}

/* Runs tell how far they are. One that an interrupt finds goes on for half a second. */
static int32_t watch_run(void *user, int32_t done, int32_t total)
{
    const crv_progress shown = progress_runs(user);
    shown.fn(shown.user, done, total);
    return interrupt_is_late();
}

/* False after an error line. */
static bool has_run(const tune_work *w, crv_status status, const char *doing)
{
    if (status != CRV_ERROR_STOPPED)
        return report_ok(w->r, status, doing);
    report_error(w->r, "%s: interrupted before anything was fitted", w->s->in.view.model);
    return false;
}

typedef struct watching {
    report *r;
    progress p;
    double start, seconds; /* of the search; seconds 0: evaluations are counted */
} watching;

static void show_run(void *user, int32_t evaluations, double rmse)
{
    watching *w = user;
    report_detail(w->r, "  run %d: RMSE %.6f at best", evaluations, rmse);
    progress_show(&w->p, w->seconds > 0.0 ? (int64_t)(1e3 * (report_seconds() - w->start))
                                          : (int64_t)evaluations);
}

static int fit(tune_work *w, unsigned fits, tune_result *out)
{
    const tune_settings *s = w->s;
    const bool by_count = s->evaluations.given;
    watching watch = {.r = w->r, .start = report_seconds()};
    tune_request q = {.view = &w->view[TUNE_FITTED],
                      .start = w->start,
                      .fits = fits,
                      .evaluations = s->evaluations.value,
                      .seconds = INFINITY,
                      .watch = show_run,
                      .stop = tune_work_stop,
                      .user = &watch};
    if (!by_count || s->time_s.given) {
        q.seconds = (1.0 - w->truth_share) * s->time_s.value - w->truth_s;
        watch.seconds = by_count ? 0.0 : q.seconds;
    }
    if (!by_count)
        progress_announce(w->r, "fit", q.seconds);
    watch.p = progress_begin(
        w->r, "fit", 0, by_count ? s->evaluations.value : (int64_t)(1e3 * q.seconds));
    const bool done = has_run(w, tune_fit(&q, out), "fit");
    progress_end(&watch.p);
    if (!done)
        return EXIT_FAILED;
    report_info(w->r, "fit: %d runs, %.2f s%s", out->evaluations,
                report_seconds() - watch.start,
                out->finished ? "" : "; the search was not at its end");
    return EXIT_DONE;
}

/* The other view with both sets of options. */
static int compare_other(tune_work *w, const tune_result *found, voice *log)
{
    tune_view *v = &w->view[TUNE_OTHER];
    tune_error before, after;
    bool shows = false;
    int result = pass_is_frame(w->s->in.view.model) ? tune_frame_other(w, &shows)
                                                    : tune_mesh_other(w, &shows);
    if (interrupt_waits())
        return EXIT_DONE;
    if (result != EXIT_DONE || !shows)
        return result;
    log->muted = true; /* it said what there is to say of the options before */
    const crv_status first = tune_view_measure(v, &w->start, &before);
    const crv_status second = tune_view_measure(v, &found->options, &after);
    log->muted = false;
    if (first == CRV_ERROR_STOPPED || second == CRV_ERROR_STOPPED)
        return EXIT_DONE;
    if (!report_ok(w->r, first, "other view") || !report_ok(w->r, second, "other view"))
        return EXIT_FAILED;
    tune_print_pair(w, TUNE_OTHER, &before, &after);
    if (after.mean_square > before.mean_square)
        report_warning(w->r,
                       "the other view got worse, so these options suit the fitted view "
                       "alone; fit less with --fit, or a view that shows more");
    return EXIT_DONE;
}

static int load(tune_work *w)
{
    const char *model = w->s->in.view.model;
    const tune_view *v = &w->view[TUNE_FITTED];
    const bool is_frame = pass_is_frame(model);
    const int result = is_frame ? tune_frame_load(w) : tune_mesh_load(w);
    if (result == EXIT_DONE && v->count == 0) {
        report_error(w->r, "%s: no surface is in view, so there is nothing to fit; %s",
                     model, is_frame ? "check its depth" : "change the camera");
        return EXIT_FAILED;
    }
    if (result != EXIT_DONE && interrupt_waits() && w->r->errors == 0)
        report_error(w->r, "%s: interrupted before anything was fitted", model);
    return result;
}

static int tune(tune_work *w, unsigned fits, voice *log)
{
    tune_error first;
    tune_result found;
    char flags[OPTION_TEXT_SIZE];
    int result = load(w);
    if (result != EXIT_DONE)
        return result;
    w->run = progress_begin(w->r, "estimation", 0, 0);
    if (!has_run(w, tune_view_measure(&w->view[TUNE_FITTED], &w->start, &first),
                 "estimation"))
        return EXIT_FAILED;
    if (first.correlation < OPPOSITE)
        report_warning(w->r, "the truth is dark where the method is bright; is it "
                             "occlusion (1 - accessibility), or of another view?");
    log->muted = true;
    result = fit(w, fits, &found);
    log->muted = false;
    if (result != EXIT_DONE)
        return result;
    printf("view     options       RMSE       bias\n");
    tune_print_pair(w, TUNE_FITTED, &found.before, &found.after);
    /* Whatever becomes of the other view, the options are there. */
    const int other = interrupt_waits() ? EXIT_DONE : compare_other(w, &found, log);
    printf("options:%s\n", option_flags(&found.options, flags));
    result = tune_write_options(w, &found);
    return result == EXIT_DONE ? other : result;
}

static void free_work(tune_work *w)
{
    for (int i = 0; i < TUNE_VIEWS; i++) {
        tune_view_free(&w->view[i]);
        crv_gbuffer_destroy(w->gbuffer[i]);
        scene_gbuffer_free(&w->cast[i]);
    }
    scene_free(w->model);
    estimate_close(&w->e);
}

static int run(const void *settings, report *r)
{
    const tune_settings *s = settings;
    tune_work w = {.s = s, .r = r, .start = s->in.view.common.options};
    voice log = {.r = r};
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = (crv_logger){take_line, &log};
    desc.progress = (crv_progress){watch_run, &w.run};
    unsigned fits;
    int result = check(s, &fits, r);
    if (result != EXIT_DONE)
        return result;
    interrupt_hold(GRACE_S);
    result = device_context_in(&s->in.view.common, &desc, r, &w.e.context);
    if (result == EXIT_DONE)
        result = tune(&w, fits, &log);
    free_work(&w);
    fflush(stdout);
    interrupt_release();
    return result;
}

const command command_tune = {
    .name = "tune",
    .summary =
        "fit options of a method to the truth: of a mesh ray-traced, of a frame its "
        "own pass",
    .synopsis = "INPUT [--method NAME] [-o FILE] [options]",
    .details =
        "Options given are those that the search begins with; what --fit does not name "
        "stays. The truth of a mesh is ray-traced: that which the method estimates with "
        "these options, or what --truth-radius and so on say. Errors are over surfaces, "
        "before and after, also of a view that was not fitted: a gain that does not hold "
        "there is chance. The last line has the options as flags.",
    .tables = tables,
    .library_options = true,
    .examples = examples,
    .settings_size = sizeof(tune_settings),
    .run = run,
};

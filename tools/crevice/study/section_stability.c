/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plot.h"
#include "sections.h"
#include "stability_reference.h"

enum { MAX_METHODS = 10 };

/* RMS motion of surface points from frame to frame: slow, and not a whole number, so that
 * points do not keep their place in the grid of pixels. */
static const double MOTION_PX = 0.75;

enum { RAW = 0, FILTERED = 1, KINDS = 2 };

typedef struct row {
    crv_options options; /* medium, with its filter */
    study_target target;
    double lookups[KINDS];
    double moving2[KINDS];               /* mean squared change of points */
    double pair[KINDS][MOVE_FRAMES - 1]; /* RMS from each frame to the next */
    /* Between the first two frames, of the points that are steady in the reference. */
    const stability_truth *truth;
    double excess[KINDS];   /* RMS change without the reference's own */
    double wobble[KINDS];   /* RMS change of the error */
    double redrawn2[KINDS]; /* mean squared change where the camera stands and the noise
                               tile is another one */
} row;

/* The last two frames, raw and filtered, in turn. */
typedef struct planes {
    float *raw[2], *filtered[2];
} planes;

static void free_planes(planes *p)
{
    for (int32_t n = 0; n < 2; n++) {
        free(p->raw[n]);
        free(p->filtered[n]);
    }
}

/* Both pictures of one frame, in the planes of that parity. */
static int estimate(study *s, study_view *v, const crv_options *options, int32_t parity,
                    planes *p)
{
    size_t pixels = (size_t)v->width * (size_t)v->height;
    crv_options raw = *options;
    study_estimate e;
    int code;

    raw.filter = NULL;
    code = study_run(s, v, &raw, STUDY_ONE_LAYER, 0, &e);
    if (code != EXIT_DONE)
        return code;
    free(p->raw[parity]);
    p->raw[parity] = e.accessibility;
    if (p->filtered[parity] == NULL)
        p->filtered[parity] = malloc(pixels * sizeof(float));
    if (p->filtered[parity] == NULL)
        return report_no_memory(s->r);
    if (options->filter != NULL)
        return study_filter(s, v, options, e.accessibility, p->filtered[parity]);
    memcpy(p->filtered[parity], e.accessibility, pixels * sizeof(float));
    return EXIT_DONE;
}

/* From the picture of one parity, seen in frame `former`, to that of the other. */
static stability compare(const camera_move *o, const planes *p, int32_t kind,
                         int32_t former, int32_t latter, int32_t parity,
                         const uint8_t *mask)
{
    stability_frame a = o->frames[former], b = o->frames[latter];
    stability sum = {0};

    a.accessibility = kind == RAW ? p->raw[parity] : p->filtered[parity];
    b.accessibility = kind == RAW ? p->raw[1 - parity] : p->filtered[1 - parity];
    b.mask = mask;
    stability_add(&sum, &a, &b);
    return sum;
}

/* Methods that estimate the same integral share one reference. */
static int find_truth(study *s, const camera_move *o, stability_truth *truths, row *r)
{
    stability_truth *t = truths;

    for (; t->planes != NULL; t++) {
        if (strcmp(study_target_name(&t->target), study_target_name(&r->target)) == 0) {
            r->truth = t;
            return EXIT_DONE;
        }
    }
    r->truth = t;
    return stability_truth_trace(s, o, &r->target, t);
}

/* p holds the first two frames. */
static int compare_truth(study *s, const camera_move *o, const planes *p, row *r)
{
    int code = EXIT_DONE;

    for (int32_t kind = 0; kind < KINDS && code == EXIT_DONE; kind++) {
        double change2 = 0.0, error2 = 0.0;
        code = stability_truth_compare(s, o, r->truth, kind == RAW ? p->raw : p->filtered,
                                       &change2, &error2);
        r->excess[kind] = sqrt(fmax(0.0, change2 - r->truth->steady2));
        r->wobble[kind] = sqrt(error2);
    }
    return code;
}

static int measure_moving(study *s, camera_move *o, planes *p, row *out)
{
    double squares[KINDS] = {0.0, 0.0}, points[KINDS] = {0.0, 0.0};

    for (int32_t k = 0; k < MOVE_FRAMES; k++) {
        int code = estimate(s, &o->views[k], &out->options, k % 2, p);
        if (code != EXIT_DONE)
            return code;
        for (int32_t kind = 0; kind < KINDS && k > 0; kind++) {
            stability sum = compare(o, p, kind, k - 1, k, (k - 1) % 2, NULL);
            squares[kind] += sum.change2;
            points[kind] += (double)sum.points;
            out->pair[kind][k - 1] = sqrt(sum.change2 / (double)sum.points);
        }
        if (k == 1)
            code = compare_truth(s, o, p, out);
        if (code != EXIT_DONE)
            return code;
    }
    for (int32_t kind = 0; kind < KINDS; kind++)
        out->moving2[kind] = squares[kind] / points[kind];
    return EXIT_DONE;
}

static int measure_redrawn(study *s, camera_move *o, planes *p, row *out)
{
    crv_options other = out->options;
    int code = estimate(s, &o->views[1], &out->options, 0, p);

    other.seed++;
    if (code == EXIT_DONE)
        code = estimate(s, &o->views[1], &other, 1, p);
    for (int32_t kind = 0; kind < KINDS && code == EXIT_DONE; kind++) {
        stability sum = compare(o, p, kind, 1, 1, 0, out->truth->steady);
        out->redrawn2[kind] = sum.change2 / (double)sum.points;
    }
    return code;
}

static int measure_row(study *s, camera_move *o, stability_truth *truths, row *r,
                       int32_t index)
{
    planes p = {{NULL, NULL}, {NULL, NULL}};
    int code;

    r->options = study_options(&o->base, crv_method_at(index)->name, CRV_PRESET_MEDIUM);
    r->target = study_target_of(&r->options);
    r->lookups[RAW] = r->lookups[FILTERED] = study_samples(&r->options);
    study_progress(s, "stability: %s", r->options.method->name);
    code = find_truth(s, o, truths, r);
    if (code == EXIT_DONE)
        code = measure_moving(s, o, &p, r);
    if (code == EXIT_DONE)
        code = measure_redrawn(s, o, &p, r);
    free_planes(&p);
    return code;
}

static void table_all(study *s, const row *rows, int32_t count)
{
    static const char *const headers[] = {"method", "filter",         "look-ups",
                                          "change", "change, filter", "reference's"};

    page_table_begin(
        s->page,
        "All points: RMS change of accessibility from frame to frame, preset "
        "medium, without and with its filter",
        headers, 6);
    for (int32_t i = 0; i < count; i++) {
        const row *r = &rows[i];
        page_cell(s->page, "%s", r->options.method->name);
        page_cell(s->page, "%s",
                  r->options.filter != NULL ? r->options.filter->name : "none");
        page_cell(s->page, "%.0f", r->lookups[RAW]);
        page_cell(s->page, "%.4f", sqrt(r->moving2[RAW]));
        page_cell(s->page, "%.4f", sqrt(r->moving2[FILTERED]));
        page_cell(s->page, "%.4f", sqrt(r->truth->all2));
    }
    page_table_end(s->page);
}

static void cell_least(page *p, const row *rows, int32_t count, double value,
                       const double *(*column)(const row *r))
{
    bool least = true;

    for (int32_t i = 0; i < count; i++)
        least = least && value <= *column(&rows[i]);
    if (least)
        page_cell_strong(p, "%.4f", value);
    else
        page_cell(p, "%.4f", value);
}

static const double *excess_filtered(const row *r)
{
    return &r->excess[FILTERED];
}

static const double *wobble_filtered(const row *r)
{
    return &r->wobble[FILTERED];
}

static void table_steady(study *s, const row *rows, int32_t count)
{
    static const char *const headers[] = {
        "method",         "integral", "points",          "reference's", "excess",
        "excess, filter", "error's",  "error's, filter", "still",       "still, filter"};

    page_table_begin(
        s->page,
        "Steady points: RMS excess over the reference's change, change of the "
        "error, and change where the camera stands still and the noise is "
        "drawn again",
        headers, 10);
    for (int32_t i = 0; i < count; i++) {
        const row *r = &rows[i];
        page_cell(s->page, "%s", r->options.method->name);
        page_cell(s->page, "%s", study_target_name(&r->target));
        page_cell(s->page, "%.1f %%", 100.0 * r->truth->share);
        page_cell(s->page, "%.4f", sqrt(r->truth->steady2));
        page_cell(s->page, "%.4f", r->excess[RAW]);
        cell_least(s->page, rows, count, r->excess[FILTERED], excess_filtered);
        page_cell(s->page, "%.4f", r->wobble[RAW]);
        cell_least(s->page, rows, count, r->wobble[FILTERED], wobble_filtered);
        page_cell(s->page, "%.4f", sqrt(r->redrawn2[RAW]));
        page_cell(s->page, "%.4f", sqrt(r->redrawn2[FILTERED]));
    }
    page_table_end(s->page);
}

static void draw(study *s, const row *rows, int32_t count)
{
    static const char *const labels[KINDS] = {"no filter", "filter of the preset"};
    plot_series series[MAX_METHODS];

    for (int32_t i = 0; i < count; i++)
        series[i] = (plot_series){.name = rows[i].options.method->name,
                                  .x = rows[i].lookups,
                                  .y = rows[i].wobble,
                                  .labels = labels,
                                  .count = KINDS,
                                  .is_line = true};
    page_plot(
        s->page,
        &(plot){.caption =
                    "Change of the error over work at steady points, preset medium. "
                    "Each line joins a method without and with its filter.",
                .x_title = "buffer look-ups for each pixel",
                .y_title = "RMS change of the error from frame to frame",
                .log_x = true,
                .log_y = true,
                .series = series,
                .series_count = count});
}

static void sum_up(study *s, const row *rows, int32_t count)
{
    const row *calm = &rows[0];
    int32_t filters = 0, gains = 0, smoother = 0;

    for (int32_t i = 0; i < count; i++) {
        const row *r = &rows[i];
        filters += r->options.filter != NULL;
        gains += r->options.filter != NULL && r->wobble[FILTERED] < r->wobble[RAW];
        smoother += !(r->excess[FILTERED] > 0.0);
        if (r->wobble[FILTERED] < calm->wobble[FILTERED])
            calm = r;
    }
    page_text(s->page,
              "With its filter, the error of `%s` changes least, by %.4f (RMS). Filters "
              "make the error steadier for %d of %d methods%s",
              calm->options.method->name, calm->wobble[FILTERED], (int)gains,
              (int)filters,
              gains < filters ? "; for the others, what they average changes by more "
                                "from frame to frame than the noise that they remove."
                              : ".");
    if (smoother > 0)
        page_text(s->page,
                  "With their filters, %d methods change less at steady points than "
                  "their reference: their pictures are smoother than the truth.",
                  (int)smoother);
}

static void explain_motion(study *s, const camera_move *o)
{
    page_text(s->page,
              "The camera of view `%s` moves sideways by %.3g scene units a frame, over "
              "%d frames of %d x %d pixels; surface points move by %.2f pixels (RMS).",
              s->main->name, o->step, (int)MOVE_FRAMES, (int)o->base.width,
              (int)o->base.height, o->motion_px);
    page_text(s->page,
              "Each point of a frame is looked up in the frame before, bilinearly "
              "between four texels that all lie in its tangent plane, to within a "
              "pixel's footprint, and face the same way. Points for which they do not "
              "are left out: those that were hidden or outside, and those on "
              "silhouettes. On a surface the truth does not depend on the camera, so an "
              "ideal picture would change by the look-up only.");
}

/* r: any row; integrals differ little in this. */
static void explain_reference(study *s, const row *r)
{
    const stability_truth *t = r->truth;
    double outside = t->all2 > 0.0 ? 1.0 - t->share * t->steady2 / t->all2 : 0.0;

    page_text(s->page,
              "The ray-traced reference of the same integral shows how much that is: the "
              "blur of the look-up where the truth has detail as fine as a pixel. The "
              "second table leaves out points where the reference changes by %.2g or "
              "more (for %s: %.1f %% of the points, which make %.0f %% of its mean "
              "square) and takes off the rest, both between the first two frames.",
              STABILITY_STEADY, study_target_name(&t->target), 100.0 * (1.0 - t->share),
              100.0 * outside);
    page_text(s->page,
              "Excess is the root of the mean squared change less that of the reference; "
              "0 where the reference changes more. The error's change takes the "
              "reference's change off at each point before it is squared: it also counts "
              "detail that does not move along. The reference is traced twice with %d "
              "other rays for each pixel, and products of both results are averaged, so "
              "that the noise of the rays drops out.",
              (int)STABILITY_RAYS);
}

static void explain_noise(study *s)
{
    page_text(s->page,
              "The tile of rotations and jitters is fixed to the screen. A still camera "
              "therefore sees no change at all, whatever the noise, and a moving one "
              "sees it as a pattern that surfaces slide under. The last two columns of "
              "the second table are what a renderer gets that draws another tile for "
              "each frame, to average over time: the camera stands still, and all change "
              "is noise. In the other columns the look-up averages up to four pixels of "
              "the frame before, so that noise counts a little less there.");
}

static void write_page(study *s, const camera_move *o, const row *rows, int32_t count)
{
    explain_motion(s, o);
    explain_reference(s, &rows[0]);
    explain_noise(s);
    table_all(s, rows, count);
    table_steady(s, rows, count);
    draw(s, rows, count);
    sum_up(s, rows, count);
}

static void add_pair(cJSON *to, const char *name, double raw, double filtered)
{
    const double values[KINDS] = {raw, filtered};

    cJSON_AddItemToObject(to, name, cJSON_CreateDoubleArray(values, KINDS));
}

static void add_results(study *s, const camera_move *o, const row *rows, int32_t count)
{
    cJSON *json = cJSON_AddObjectToObject(s->results, "stability");
    cJSON *methods;

    cJSON_AddStringToObject(json, "view", s->main->name);
    cJSON_AddNumberToObject(json, "frames", MOVE_FRAMES);
    cJSON_AddNumberToObject(json, "width", o->base.width);
    cJSON_AddNumberToObject(json, "height", o->base.height);
    cJSON_AddNumberToObject(json, "step", o->step);
    cJSON_AddNumberToObject(json, "motion_px", o->motion_px);
    cJSON_AddStringToObject(json, "pairs", "without filter, with the preset's filter");
    methods = cJSON_AddArrayToObject(json, "methods");
    for (int32_t i = 0; i < count; i++) {
        const row *r = &rows[i];
        cJSON *item = cJSON_CreateObject();
        cJSON_AddItemToArray(methods, item);
        cJSON_AddStringToObject(item, "method", r->options.method->name);
        cJSON_AddStringToObject(
            item, "filter", r->options.filter != NULL ? r->options.filter->name : "none");
        cJSON_AddStringToObject(item, "target", study_target_name(&r->target));
        cJSON_AddNumberToObject(item, "lookups", r->lookups[RAW]);
        add_pair(item, "rms_change", sqrt(r->moving2[RAW]), sqrt(r->moving2[FILTERED]));
        cJSON_AddNumberToObject(item, "reference_rms_change", sqrt(r->truth->all2));
        cJSON_AddNumberToObject(item, "steady_share", r->truth->share);
        cJSON_AddNumberToObject(item, "steady_reference_rms_change",
                                sqrt(r->truth->steady2));
        add_pair(item, "rms_excess", r->excess[RAW], r->excess[FILTERED]);
        add_pair(item, "rms_change_of_error", r->wobble[RAW], r->wobble[FILTERED]);
        add_pair(item, "rms_still", sqrt(r->redrawn2[RAW]), sqrt(r->redrawn2[FILTERED]));
        cJSON_AddItemToObject(
            item, "rms_change_by_frame",
            cJSON_CreateDoubleArray(r->pair[FILTERED], MOVE_FRAMES - 1));
    }
}

int study_stability(study *s)
{
    camera_move o;
    row *rows = calloc(MAX_METHODS, sizeof *rows);
    stability_truth truths[MAX_METHODS + 1] = {{.planes = NULL}};
    int32_t count = crv_method_count() < MAX_METHODS ? crv_method_count() : MAX_METHODS;
    int code;

    if (rows == NULL)
        return report_no_memory(s->r);
    page_heading(s->page, 2, "stability", "Temporal stability");
    study_progress(s, "stability: frames");
    code = camera_move_open(s, MOTION_PX, &o);
    for (int32_t i = 0; i < count && code == EXIT_DONE; i++)
        code = measure_row(s, &o, truths, &rows[i], i);
    if (code == EXIT_DONE) {
        write_page(s, &o, rows, count);
        add_results(s, &o, rows, count);
    }
    camera_move_close(&o);
    for (int32_t i = 0; i < count; i++)
        stability_truth_free(&truths[i]);
    free(rows);
    return code;
}

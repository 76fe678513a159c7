/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "closed_forms_reference.h"
#include "fitted_order.h"
#include "groove_forms.h"
#include "plot.h"
#include "sections.h"

enum { MAX_FORMS = 12, MAX_POINTS = 8 };

/* The picture that errors over work are measured in: the radius is 256 pixels. */
static const int32_t FINE_PX = 256;

/* Pictures that the converged estimates are measured in, the fine one last. */
static const int32_t SIZES_PX[] = {16, 32, 64, 256};
enum { SIZES = sizeof SIZES_PX / sizeof *SIZES_PX };

/* What the sampling promises. The horizon is found up to one step late, so the error of
 * jittered equal steps falls like 1/Ns; independent samples have 1/sqrt(n). */
static const double ORDER_OF_STEPS = 1.0, ORDER_OF_SAMPLES = 0.5;

/* All pixels of a draw share one pattern of samples, so that an error is known to some
 * 20 percent; over the factor of 8 to 64 that is fitted, an order to about 0.1. */
static const double ORDER_MARGIN = 0.1;

/* The error of one form over a row of efforts. */
typedef struct sweep {
    double x[MAX_POINTS], rms[MAX_POINTS];
    int32_t count;
} sweep;

typedef struct convergence {
    const groove_form *form;
    char name[64];
    sweep work;               /* x: look-ups, or n */
    sweep directions, steps;  /* x: Nd, Ns */
    groove_error most[SIZES]; /* converged, for each picture */
    double px[SIZES], rms[SIZES];
} convergence;

static bool marches(const groove_form *form)
{
    return strcmp(form->method, "raymarch") == 0;
}

/* Nd = Ns, and for hsao one normal ray, as its preset medium has it; none is blocked over
 * the horizons of a height field. raymarch has only its rays, and takes Nd / 4 in each
 * direction. */
static groove_effort joint_effort(const groove_form *form, int32_t n)
{
    return (groove_effort){n, n, marches(form) ? (n + 3) / 4 : 1, 1};
}

/* The groove has a size of its own: where small pictures are asked for, for a quick look,
 * the work is cut by leaving out the last points. */
static int32_t points_left_out(const study *s)
{
    return s->main->height < 180 ? 2 : 0;
}

/* raymarch costs Nd^3 / 4: it stops earlier than the others. */
static int32_t point_count(const study *s, const groove_form *form)
{
    return (marches(form) ? 5 : 6) - points_left_out(s);
}

static groove_effort joint_point(const groove_form *form, int32_t k)
{
    return joint_effort(form, 4 << k);
}

static groove_effort sample_point(int32_t k)
{
    return (groove_effort){1, 1, 1, 4 << (2 * k)};
}

static groove_effort most_effort(const study *s, const groove_form *form)
{
    int32_t last = point_count(s, form) - 1;

    return groove_form_is_directional(form) ? joint_point(form, last)
                                            : sample_point(last);
}

static int add_point(study *s, groove *g, const groove_form *form, groove_effort effort,
                     double x, sweep *out)
{
    groove_error error;
    int code = groove_measure(s, g, form, &effort, &error);

    out->x[out->count] = x > 0.0 ? x : error.lookups;
    out->rms[out->count++] = error.rms;
    return code;
}

static int measure_directional(study *s, groove *g, convergence *c)
{
    int32_t points = point_count(s, c->form);
    int32_t fine_steps = 128 >> points_left_out(s);
    int code = EXIT_DONE;

    for (int32_t k = 0; k < points && code == EXIT_DONE; k++)
        code = add_point(s, g, c->form, joint_point(c->form, k), 0.0, &c->work);
    /* One of the two is refined while the other is fine. */
    for (int32_t k = 0; k < points && code == EXIT_DONE; k++) {
        groove_effort effort = {2 << k, fine_steps, marches(c->form) ? 4 : 1, 1};
        code = add_point(s, g, c->form, effort, effort.directions, &c->directions);
        effort.directions = 2 * fine_steps;
        effort.steps = 4 << k;
        if (code == EXIT_DONE)
            code = add_point(s, g, c->form, effort, effort.steps, &c->steps);
    }
    return code;
}

static int measure_form(study *s, groove *g, convergence *c)
{
    int code = EXIT_DONE;

    if (groove_form_is_directional(c->form))
        return measure_directional(s, g, c);
    for (int32_t k = 0; k < point_count(s, c->form) && code == EXIT_DONE; k++) {
        groove_effort effort = sample_point(k);
        code = add_point(s, g, c->form, effort, effort.samples, &c->work);
    }
    return code;
}

static int measure_most(study *s, convergence *all, int32_t count)
{
    int code = EXIT_DONE;

    for (int32_t k = 0; k < SIZES && code == EXIT_DONE; k++) {
        groove g;
        code = groove_open(s, SIZES_PX[k], &g);
        for (int32_t i = 0; i < count && code == EXIT_DONE; i++) {
            groove_effort effort = most_effort(s, all[i].form);
            code = groove_measure(s, &g, all[i].form, &effort, &all[i].most[k]);
            all[i].px[k] = SIZES_PX[k];
            all[i].rms[k] = all[i].most[k].rms;
        }
        groove_close(&g);
    }
    return code;
}

static int measure(study *s, convergence *all, int32_t *count)
{
    groove g;
    int code = groove_open(s, FINE_PX, &g);

    *count = 0;
    for (const groove_form *f;
         code == EXIT_DONE && *count < MAX_FORMS && (f = groove_form_at(*count)) != NULL;
         ++*count) {
        convergence *c = &all[*count];
        c->form = f;
        snprintf(c->name, sizeof c->name, "%s, %s", f->method, f->integral);
        study_progress(s, "closed forms: %s", c->name);
        code = measure_form(s, &g, c);
    }
    groove_close(&g);
    return code == EXIT_DONE ? measure_most(s, all, *count) : code;
}

/* A line of x^-order that passes above the largest first error. */
static plot_series guide(const char *name, double order, const double ends[2],
                         double start, double values[2])
{
    values[0] = start;
    values[1] = start * pow(ends[1] / ends[0], -order);
    return (plot_series){.name = name,
                         .x = ends,
                         .y = values,
                         .count = 2,
                         .is_line = true,
                         .is_guide = true};
}

static void plot_work(study *s, const convergence *all, int32_t count, bool directional)
{
    plot_series series[PLOT_MAX_SERIES];
    double ends[2] = {INFINITY, 0.0}, start = 0.0, root[2], linear[2];
    int32_t n = 0;

    for (int32_t i = 0; i < count && n < PLOT_MAX_SERIES - 2; i++) {
        const sweep *w = &all[i].work;
        if (groove_form_is_directional(all[i].form) != directional)
            continue;
        series[n++] = (plot_series){.name = all[i].name,
                                    .x = w->x,
                                    .y = w->rms,
                                    .count = w->count,
                                    .is_line = true};
        ends[0] = fmin(ends[0], w->x[0]);
        ends[1] = fmax(ends[1], w->x[w->count - 1]);
        start = fmax(start, w->rms[0]);
    }
    series[n++] = guide("1/sqrt(n)", 0.5, ends, start, root);
    series[n++] = guide("1/n", 1.0, ends, start, linear);
    page_plot(s->page,
              &(plot){.caption =
                          directional
                              ? "Marching methods, Nd = Ns doubled from point to point "
                                "(hsao: Nn 1; raymarch: Nn = Nd/4). RMS error of single "
                                "pixels, no filter."
                              : "Sampling methods, n quadrupled from point to point. RMS "
                                "error of single pixels, no filter. alchemy at a quarter "
                                "of its intensity, its error multiplied by four.",
                      .x_title = directional ? "buffer look-ups for each pixel"
                                             : "samples n for each pixel",
                      .y_title = "RMS error of accessibility",
                      .log_x = true,
                      .log_y = true,
                      .series = series,
                      .series_count = n});
}

static double order_of(const sweep *w)
{
    return fitted_order(w->x, w->rms, w->count);
}

/* The order that is promised, and what it is over. */
static double promised(const convergence *c)
{
    return c->steps.count > 0 ? ORDER_OF_STEPS : ORDER_OF_SAMPLES;
}

static bool is_kept(const convergence *c)
{
    return order_of(c->steps.count > 0 ? &c->steps : &c->work)
           > promised(c) - ORDER_MARGIN;
}

static void cell_order(page *p, const sweep *w)
{
    if (w->count > 0)
        page_cell(p, "%.2f", order_of(w));
    else
        page_cell(p, "–");
}

static void table_orders(study *s, const convergence *all, int32_t count)
{
    static const char *const headers[] = {"method",  "closed form", "over look-ups",
                                          "over Nd", "over Ns",     "promised",
                                          "kept"};

    page_table_begin(s->page,
                     "Measured order p: the RMS error falls like work to the power -p",
                     headers, 7);
    for (int32_t i = 0; i < count; i++) {
        const convergence *c = &all[i];
        page_cell(s->page, "%s", c->form->method);
        page_cell(s->page, "%s", c->form->integral);
        cell_order(s->page, &c->work);
        cell_order(s->page, &c->directions);
        cell_order(s->page, &c->steps);
        page_cell(s->page, "%.1f over %s", promised(c), c->steps.count > 0 ? "Ns" : "n");
        page_cell(s->page, "%s", is_kept(c) ? "yes" : "no");
    }
    page_table_end(s->page);
}

static void table_reached(study *s, const convergence *all, int32_t count)
{
    static const char *const headers[] = {"method",    "closed form",  "look-ups",
                                          "R = 16 px", "32 px",        "64 px",
                                          "256 px",    "mean, 256 px", "largest, 256 px"};

    page_table_begin(
        s->page,
        "How near each method comes to its closed form: RMS error with the "
        "most work, the radius R being so many pixels; mean and largest error",
        headers, 9);
    for (int32_t i = 0; i < count; i++) {
        const convergence *c = &all[i];
        page_cell(s->page, "%s", c->form->method);
        page_cell(s->page, "%s", c->form->integral);
        page_cell(s->page, "%.0f", c->most[0].lookups);
        for (int32_t k = 0; k < SIZES; k++)
            page_cell(s->page, "%.5f", c->rms[k]);
        page_cell(s->page, "%+.5f", c->most[SIZES - 1].mean);
        page_cell(s->page, "%.5f", c->most[SIZES - 1].largest);
    }
    page_table_end(s->page);
}

static void add_sweep(cJSON *to, const char *name, const sweep *w)
{
    cJSON *item = cJSON_AddObjectToObject(to, name);

    cJSON_AddItemToObject(item, "x", cJSON_CreateDoubleArray(w->x, w->count));
    cJSON_AddItemToObject(item, "rmse", cJSON_CreateDoubleArray(w->rms, w->count));
    cJSON_AddNumberToObject(item, "order", order_of(w));
}

static void add_results(cJSON *methods, const convergence *c)
{
    cJSON *item = cJSON_CreateObject();

    cJSON_AddItemToArray(methods, item);
    cJSON_AddStringToObject(item, "method", c->form->method);
    cJSON_AddStringToObject(item, "closed_form", c->form->integral);
    add_sweep(item, "work", &c->work);
    if (c->steps.count > 0) {
        add_sweep(item, "directions", &c->directions);
        add_sweep(item, "steps", &c->steps);
    }
    cJSON_AddNumberToObject(item, "promised_order", promised(c));
    cJSON_AddBoolToObject(item, "kept", is_kept(c));
    cJSON_AddNumberToObject(item, "most_lookups", c->most[0].lookups);
    cJSON_AddItemToObject(item, "px_per_radius", cJSON_CreateDoubleArray(c->px, SIZES));
    cJSON_AddItemToObject(item, "reached_rmse", cJSON_CreateDoubleArray(c->rms, SIZES));
    cJSON_AddNumberToObject(item, "reached_mean", c->most[SIZES - 1].mean);
    cJSON_AddNumberToObject(item, "reached_largest", c->most[SIZES - 1].largest);
}

/* What the tables say, in words that the numbers choose. */
static void explain(study *s, const convergence *c)
{
    const sweep *w = c->steps.count > 0 ? &c->steps : &c->work;
    int32_t last = w->count - 1;
    double final =
        log(w->rms[last - 1] / w->rms[last]) / log(w->x[last] / w->x[last - 1]);

    page_text(
        s->page, "%s does not; its order between the last two points is %.2f. %s",
        c->name, final,
        final < promised(c) - ORDER_MARGIN && c->steps.count == 0
            ? "Its samples are likely worse spread than independent ones."
        : final > order_of(w)
            ? "The order still rises with the work: coarse steps likely pass a near "
              "wall altogether, which costs more than a step found late."
            : "Something other than the steps likely limits it by then.");
}

static void sum_up_orders(study *s, const convergence *all, int32_t count)
{
    int32_t kept = 0;

    for (int32_t i = 0; i < count; i++)
        kept += is_kept(&all[i]);
    page_text(s->page, "%d of %d rows keep the promised order, less %.1f for the fit.",
              (int)kept, (int)count, ORDER_MARGIN);
    for (int32_t i = 0; i < count; i++)
        if (!is_kept(&all[i]))
            explain(s, &all[i]);
}

static void sum_up_reached(study *s, const convergence *all, int32_t count)
{
    const convergence *worst = &all[0];
    int32_t texels = 0;

    for (int32_t i = 0; i < count; i++) {
        const convergence *c = &all[i];
        /* Noise of the fit does not double an error. */
        texels += c->rms[0] > 2.0 * c->rms[SIZES - 1];
        if (c->rms[SIZES - 1] > worst->rms[SIZES - 1])
            worst = c;
    }
    page_text(
        s->page,
        "With the most work and R = %d pixels every row is within %.4f (RMS) of its "
        "closed form; %s is the farthest. Where R is %d pixels only, %d of %d rows "
        "are more than twice as far off: depth is read at texel centres, and there "
        "the size of a texel limits them. In the other rows it is the number of "
        "samples in both.",
        (int)SIZES_PX[SIZES - 1], worst->rms[SIZES - 1], worst->name, (int)SIZES_PX[0],
        (int)texels, (int)count);
}

static void write_page(study *s, const convergence *all, int32_t count)
{
    page_text(
        s->page,
        "A 90-degree V groove, seen by an orthographic camera along its bisector, is "
        "a height field whose occlusion is known in closed form. Errors are over a "
        "strip of its floor, 0.1 to 1 radius off the wall; the pixels are single "
        "estimates, each with its own rotation and jitter, no filter, no bias angle, "
        "surfaces solid without end. "
        "R is %d pixels in the plots.",
        (int)FINE_PX);
    plot_work(s, all, count, true);
    plot_work(s, all, count, false);
    page_text(
        s->page,
        "Each order is the slope of a straight line through the last %d points in the "
        "log-log plot, down to the first that is within twice the smallest error of "
        "its row. Over Nd, Ns is %d; over Ns, Nd is %d. A horizon is found up to "
        "one step late, so that order 1 over Ns is what jittered equal steps promise, "
        "which over look-ups is less, since these pay for directions, too; "
        "independent samples promise 0.5 over n.",
        ORDER_POINTS, 128 >> points_left_out(s), 256 >> points_left_out(s));
    table_orders(s, all, count);
    sum_up_orders(s, all, count);
    table_reached(s, all, count);
    sum_up_reached(s, all, count);
}

int study_closed_forms(study *s)
{
    convergence *all = calloc(MAX_FORMS, sizeof *all);
    cJSON *json = cJSON_AddObjectToObject(s->results, "closed_forms");
    cJSON *methods = cJSON_AddArrayToObject(json, "methods");
    int32_t count = 0;
    int code;

    if (all == NULL || methods == NULL) {
        free(all);
        return report_no_memory(s->r);
    }
    page_heading(s->page, 2, "closed-forms", "Convergence to closed forms");
    code = measure(s, all, &count);
    if (code == EXIT_DONE) {
        write_page(s, all, count);
        for (int32_t i = 0; i < count; i++)
            add_results(methods, &all[i]);
        code = closed_forms_reference(s, json);
    }
    free(all);
    return code;
}

/* SPDX-License-Identifier: MIT */
#include "plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "page_internal.h"
#include "plot_axis.h"

enum { WIDTH = 760, HEIGHT = 430, LEFT = 72, RIGHT = 18, TOP = 14, BOTTOM = 56 };
enum { MARKERS_MAX = 64 }; /* denser lines go without */

typedef struct canvas {
    const plot *what;
    plot_axis x, y;
    text out;
    int32_t number; /* of the plot on the page */
} canvas;

/* Shapes about the origin; those after the first six are outlines. */
static const char *const shapes[PLOT_MAX_SERIES] = {
    "M4 0A4 4 0 1 1-4 0 4 4 0 1 1 4 0Z",
    "M-3.7-3.7H3.7V3.7H-3.7Z",
    "M0-4.8L4.6 3.4H-4.6Z",
    "M0-5.2L5.2 0 0 5.2-5.2 0Z",
    "M0 4.8L4.6-3.4H-4.6Z",
    "M-5-1.6H-1.6V-5H1.6V-1.6H5V1.6H1.6V5H-1.6V1.6H-5Z",
    "M4 0A4 4 0 1 1-4 0 4 4 0 1 1 4 0Z",
    "M-3.6-3.6H3.6V3.6H-3.6Z",
    "M0-4.8L4.6 3.4H-4.6Z",
    "M0-5L5 0 0 5-5 0Z",
    "M0 4.8L4.6-3.4H-4.6Z",
    "M-4-4L4 4M-4 4L4-4",
};
static const char *const dashes[] = {"", "8 3", "3 3", "10 3 2 3"};

static const char *shape_class(int32_t series)
{
    return series < PLOT_MAX_SERIES / 2 ? "mark" : "open";
}

static bool shown(const plot *what, double x, double y)
{
    return isfinite(x) && isfinite(y) && (!what->log_x || x > 0.0)
           && (!what->log_y || y > 0.0);
}

/* Guides do not widen y; x is widened by all. Without a point: 1 to 10. */
static void find_ranges(const plot *what, double low[2], double high[2])
{
    bool guides_only = true;

    low[0] = low[1] = INFINITY;
    high[0] = high[1] = -INFINITY;
    for (int32_t s = 0; s < what->series_count; s++)
        guides_only = guides_only && what->series[s].is_guide;
    for (int32_t s = 0; s < what->series_count; s++) {
        const plot_series *series = &what->series[s];
        for (int32_t i = 0; i < series->count; i++) {
            if (!shown(what, series->x[i], series->y[i]))
                continue;
            low[0] = fmin(low[0], series->x[i]);
            high[0] = fmax(high[0], series->x[i]);
            if (series->is_guide && !guides_only)
                continue;
            low[1] = fmin(low[1], series->y[i]);
            high[1] = fmax(high[1], series->y[i]);
        }
    }
    for (int k = 0; k < 2; k++) {
        if (low[k] <= high[k])
            continue;
        low[k] = 1.0;
        high[k] = 10.0;
    }
}

static double at_x(const canvas *c, double x)
{
    return LEFT + plot_axis_place(&c->x, x) * (WIDTH - LEFT - RIGHT);
}

static double at_y(const canvas *c, double y)
{
    return HEIGHT - BOTTOM - plot_axis_place(&c->y, y) * (HEIGHT - TOP - BOTTOM);
}

static void add_ticks(canvas *c)
{
    char label[40];

    for (int32_t i = 0; i < c->x.tick_count; i++) {
        const plot_tick *tick = &c->x.ticks[i];
        double x = at_x(c, tick->value);
        text_addf(&c->out, "<path class=\"%s\" d=\"M%.1f %dV%d\"/>",
                  tick->has_label ? "rule" : "minor", x, TOP, HEIGHT - BOTTOM);
        plot_axis_label(tick->value, label, sizeof label);
        if (tick->has_label)
            text_addf(&c->out,
                      "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%s</text>", x,
                      HEIGHT - BOTTOM + 18, label);
    }
    for (int32_t i = 0; i < c->y.tick_count; i++) {
        const plot_tick *tick = &c->y.ticks[i];
        double y = at_y(c, tick->value);
        text_addf(&c->out, "<path class=\"%s\" d=\"M%d %.1fH%d\"/>",
                  tick->has_label ? "rule" : "minor", LEFT, y, WIDTH - RIGHT);
        plot_axis_label(tick->value, label, sizeof label);
        if (tick->has_label)
            text_addf(&c->out, "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%s</text>",
                      LEFT - 8, y + 4.5, label);
    }
    text_addf(&c->out, "<path class=\"axis\" d=\"M%d %dV%dH%d\"/>\n", LEFT, TOP,
              HEIGHT - BOTTOM, WIDTH - RIGHT);
}

static void add_titles(canvas *c)
{
    text_addf(&c->out, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">",
              (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 12);
    text_add_escaped(&c->out, c->what->x_title);
    text_addf(&c->out,
              "</text><text transform=\"translate(16 %d) rotate(-90)\" "
              "text-anchor=\"middle\">",
              (TOP + HEIGHT - BOTTOM) / 2);
    text_add_escaped(&c->out, c->what->y_title);
    text_add(&c->out, "</text>\n");
}

static void add_line(canvas *c, const plot_series *series, int32_t index)
{
    bool pen_down = false;

    text_addf(&c->out,
              "<path class=\"%s\" clip-path=\"url(#plot-clip-%d)\" "
              "stroke-dasharray=\"%s\" d=\"",
              series->is_guide ? "guide" : "line", c->number,
              series->is_guide       ? "2 4"
              : dashes[index % 4][0] ? dashes[index % 4]
                                     : "none");
    for (int32_t i = 0; i < series->count; i++) {
        if (!shown(c->what, series->x[i], series->y[i])) {
            pen_down = false;
            continue;
        }
        text_addf(&c->out, "%s%.1f %.1f", pen_down ? "L" : "M", at_x(c, series->x[i]),
                  at_y(c, series->y[i]));
        pen_down = true;
    }
    text_add(&c->out, "\"><title>");
    text_add_escaped(&c->out, series->name);
    text_add(&c->out, "</title></path>");
}

static void add_markers(canvas *c, const plot_series *series, int32_t index)
{
    for (int32_t i = 0; i < series->count; i++) {
        if (!shown(c->what, series->x[i], series->y[i]))
            continue;
        text_addf(
            &c->out,
            "<path class=\"%s\" transform=\"translate(%.1f %.1f)\" d=\"%s\"><title>",
            shape_class(index), at_x(c, series->x[i]), at_y(c, series->y[i]),
            shapes[index]);
        text_add_escaped(&c->out, series->name);
        if (series->labels != NULL && series->labels[i] != NULL) {
            text_add(&c->out, " ");
            text_add_escaped(&c->out, series->labels[i]);
        }
        text_addf(&c->out, ": %.4g, %.4g</title></path>", series->x[i], series->y[i]);
    }
}

static void add_series(canvas *c, int32_t index)
{
    const plot_series *series = &c->what->series[index];

    text_addf(&c->out, "<g class=\"s%d\">", index);
    if (series->is_guide || series->is_line)
        add_line(c, series, index);
    if (!series->is_guide && !(series->is_line && series->count > MARKERS_MAX))
        add_markers(c, series, index);
    text_add(&c->out, "</g>\n");
}

typedef struct point {
    double x, y;
} point;

static int compare_points(const void *a, const void *b)
{
    const point *p = a, *q = b;

    if (p->x < q->x || p->x > q->x)
        return p->x < q->x ? -1 : 1;
    return (p->y > q->y) - (p->y < q->y);
}

/* Down to each point of the front and on to the right. */
static void draw_stairs(canvas *c, point *points, int32_t count)
{
    qsort(points, (size_t)count, sizeof *points, compare_points);
    text_addf(&c->out, "<path class=\"pareto\" d=\"M%.1f %d", at_x(c, points[0].x), TOP);
    for (int32_t i = 0; i < count; i++)
        text_addf(&c->out, "H%.1fV%.1f", at_x(c, points[i].x), at_y(c, points[i].y));
    text_addf(&c->out, "H%d\"><title>Pareto front</title></path>\n", WIDTH - RIGHT);
}

static void add_pareto(canvas *c)
{
    const plot *what = c->what;
    int32_t total = 0, count = 0, kept = 0;
    double *x, *y;
    bool *on_front;
    point *front;

    for (int32_t s = 0; s < what->series_count; s++)
        total += what->series[s].is_guide ? 0 : what->series[s].count;
    if (total == 0)
        return;
    x = malloc((size_t)total * sizeof *x);
    y = malloc((size_t)total * sizeof *y);
    on_front = malloc((size_t)total * sizeof *on_front);
    front = malloc((size_t)total * sizeof *front);
    if (x == NULL || y == NULL || on_front == NULL || front == NULL)
        c->out.failed = true;
    for (int32_t s = 0; s < what->series_count && !c->out.failed; s++)
        for (int32_t i = 0; i < what->series[s].count && !what->series[s].is_guide; i++)
            if (shown(what, what->series[s].x[i], what->series[s].y[i])) {
                x[count] = what->series[s].x[i];
                y[count++] = what->series[s].y[i];
            }
    if (!c->out.failed && count > 0) {
        plot_pareto(x, y, count, on_front);
        for (int32_t i = 0; i < count; i++)
            if (on_front[i])
                front[kept++] = (point){x[i], y[i]};
        draw_stairs(c, front, kept);
    }
    free(x);
    free(y);
    free(on_front);
    free(front);
}

static void add_legend(canvas *c)
{
    text_add(&c->out, "<ul class=\"legend\">");
    for (int32_t s = 0; s < c->what->series_count; s++) {
        const plot_series *series = &c->what->series[s];

        text_addf(&c->out,
                  "<li><svg class=\"s%d\" viewBox=\"-17 -7 34 14\" "
                  "aria-hidden=\"true\">",
                  s);
        if (series->is_guide || series->is_line)
            text_addf(&c->out,
                      "<path class=\"%s\" stroke-dasharray=\"%s\" d=\"M-17 0H17\"/>",
                      series->is_guide ? "guide" : "line",
                      series->is_guide   ? "2 4"
                      : dashes[s % 4][0] ? dashes[s % 4]
                                         : "none");
        if (!series->is_guide)
            text_addf(&c->out, "<path class=\"%s\" d=\"%s\"/>", shape_class(s),
                      shapes[s]);
        text_add(&c->out, "</svg><span>");
        text_add_escaped(&c->out, series->name);
        text_add(&c->out, "</span></li>");
    }
    if (c->what->pareto)
        text_add(&c->out, "<li><svg viewBox=\"-17 -7 34 14\" aria-hidden=\"true\"><path "
                          "class=\"pareto\" d=\"M-17 0H17\"/></svg><span>Pareto "
                          "front</span></li>");
    text_add(&c->out, "</ul>\n");
}

void page_plot(page *p, const plot *what)
{
    canvas c = {.what = what, .number = page_next_number(p)};
    double low[2], high[2];

    if (page_failed(p))
        return;
    find_ranges(what, low, high);
    c.x = plot_axis_make(low[0], high[0], what->log_x, false);
    c.y = plot_axis_make(low[1], high[1], what->log_y, what->y_from_zero);
    text_addf(&c.out,
              "<figure class=\"plot\"><div class=\"scroll\"><svg viewBox=\"0 0 %d %d\" "
              "role=\"img\" aria-label=\"",
              WIDTH, HEIGHT);
    text_add_escaped(&c.out, what->caption);
    text_addf(&c.out,
              "\"><clipPath id=\"plot-clip-%d\"><path d=\"M%d %dH%dV%dH%dZ\"/>"
              "</clipPath>\n",
              c.number, LEFT, TOP, WIDTH - RIGHT, HEIGHT - BOTTOM, LEFT);
    add_ticks(&c);
    add_titles(&c);
    if (what->pareto)
        add_pareto(&c);
    for (int32_t s = 0; s < what->series_count && s < PLOT_MAX_SERIES; s++)
        add_series(&c, s);
    text_add(&c.out, "</svg></div>\n");
    add_legend(&c);
    if (c.out.failed)
        page_fail_memory(p);
    else
        page_raw(p, c.out.data);
    page_raw(p, "<figcaption>");
    page_words(p, what->caption);
    page_raw(p, "</figcaption></figure>\n");
    text_free(&c.out);
}

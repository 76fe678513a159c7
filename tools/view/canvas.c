/* SPDX-License-Identifier: MIT */
/* The picture: both halves, the line between them, names and the scale of differences. */
#include "app.h"

#include <math.h>
#include <string.h>

#include "common/heatmap.h"
#include "explain.h"
#include "io.h"

enum { MARGIN = 10, PADDING = 6, SCALE_WIDTH = 160, SCALE_HEIGHT = 12 };

void canvas_size(const app *a, int32_t *width, int32_t *height)
{
    const int factor = gtk_widget_get_scale_factor(a->canvas);
    *width = MAX(1, gtk_widget_get_width(a->canvas) * factor);
    *height = MAX(1, gtk_widget_get_height(a->canvas) * factor);
}

void canvas_place(const app *a, double *scale_x, double *scale_y, double *x, double *y)
{
    const shown *s = &a->shown;
    int32_t width, height;
    canvas_size(a, &width, &height);
    *x = *y = 0.0;
    if (a->session.source.model) {
        /* While a window is being resized the picture before fills it. */
        *scale_x = (double)s->coarseness * width / s->wish.width;
        *scale_y = (double)s->coarseness * height / s->wish.height;
        return;
    }
    const double fit =
        fmin((double)width / s->buffers->width, (double)height / s->buffers->height);
    /* A small picture is not blurred to fill the window. */
    *scale_x = *scale_y = a->zoom > 0.0 ? a->zoom : fit < 1.0 ? fit : floor(fit);
    *x = a->zoom > 0.0 ? a->left : floor(0.5 * (width - *scale_x * s->buffers->width));
    *y = a->zoom > 0.0 ? a->top : floor(0.5 * (height - *scale_y * s->buffers->height));
}

bool canvas_pixel(const app *a, double x, double y, int32_t *column, int32_t *row)
{
    const shown *s = &a->shown;
    double scale_x, scale_y, left, top;
    if (!s->buffers)
        return false;
    const int factor = gtk_widget_get_scale_factor(a->canvas);
    canvas_place(a, &scale_x, &scale_y, &left, &top);
    const double px = floor((x * factor - left) / scale_x);
    const double py = floor((y * factor - top) / scale_y);
    if (!(px >= 0.0 && py >= 0.0 && px < s->buffers->width && py < s->buffers->height))
        return false;
    *column = (int32_t)px;
    *row = (int32_t)py;
    return true;
}

/* Device px from here on. */
static void draw_half(const app *a, cairo_t *c, int half, double from, double to)
{
    double scale_x, scale_y, x, y;
    int32_t width, height;
    canvas_size(a, &width, &height);
    canvas_place(a, &scale_x, &scale_y, &x, &y);
    cairo_save(c);
    cairo_rectangle(c, from, 0.0, to - from, height);
    cairo_clip(c);
    cairo_translate(c, x, y);
    cairo_scale(c, scale_x, scale_y);
    cairo_set_source_surface(c, a->picture[half], 0.0, 0.0);
    /* Pixels stay pixels when they are enlarged, and are averaged when they shrink. */
    cairo_pattern_set_filter(cairo_get_source(c),
                             scale_x >= 1.0 ? CAIRO_FILTER_NEAREST : CAIRO_FILTER_GOOD);
    cairo_paint(c);
    cairo_restore(c);
}

static void draw_text(const app *a, cairo_t *c, const char *text, double x, double y,
                      bool right)
{
    PangoLayout *layout = gtk_widget_create_pango_layout(a->canvas, text);
    int width, height;
    pango_layout_get_pixel_size(layout, &width, &height);
    if (right)
        x -= width + 2 * PADDING;
    cairo_set_source_rgba(c, 0.0, 0.0, 0.0, 0.6);
    cairo_rectangle(c, x, y, width + 2 * PADDING, height + PADDING);
    cairo_fill(c);
    cairo_set_source_rgb(c, 1.0, 1.0, 1.0);
    cairo_move_to(c, x + PADDING, y + PADDING / 2);
    pango_cairo_show_layout(c, layout);
    g_object_unref(layout);
}

/* What a half's accessibility comes from; the caller frees it. */
static char *content_of(const app *a, int half)
{
    const half_wish *h = &a->shown.wish.half[half];
    const half_shown *s = &a->shown.half[half];
    if (h->content == HALF_OPEN)
        return g_strdup("no occlusion");
    if (h->content == HALF_METHOD)
        return g_strdup(h->options.method->name);
    if (!s->has_truth)
        return g_strdup("ray-traced truth");
    if (s->truth.passes == 0)
        return g_strdup_printf(
            "ray-traced truth, first rays: %d %%",
            (int)(100 * s->truth.known
                  / MAX(1, (int64_t)a->shown.buffers->width * a->shown.buffers->height)));
    return g_strdup_printf("ray-traced truth, %d rays",
                           s->truth.passes * TRUTH_PASS_RAYS);
}

static char *name_of(const app *a, int half)
{
    const half_look look = a->shown.wish.half[half].look;
    char *content = content_of(a, half), *name;
    if (look == LOOK_DIFFERENCE) {
        char *left = content_of(a, 0), *right = content_of(a, 1);
        name = g_strdup_printf("%s minus %s", left, right);
        g_free(left);
        g_free(right);
    } else {
        name = g_strdup_printf("%s%s", content, look == LOOK_LIT ? ", lit" : "");
    }
    g_free(content);
    return name;
}

/* The colours of the heat map from -scale to scale. */
static void draw_scale(const app *a, cairo_t *c, double x, double y)
{
    char *ends[] = {g_strdup_printf("-%g", a->shown.wish.heat_scale), g_strdup("0"),
                    g_strdup_printf("+%g", a->shown.wish.heat_scale)};
    for (int i = 0; i < SCALE_WIDTH; i++) {
        float linear[3];
        heatmap_colour(2.0 * (i + 0.5) / SCALE_WIDTH - 1.0, linear);
        cairo_set_source_rgb(c, io_quantise(linear[0], true, 255) / 255.0,
                             io_quantise(linear[1], true, 255) / 255.0,
                             io_quantise(linear[2], true, 255) / 255.0);
        cairo_rectangle(c, x + i, y, 1.0, SCALE_HEIGHT);
        cairo_fill(c);
    }
    draw_text(a, c, ends[0], x, y + SCALE_HEIGHT, false);
    draw_text(a, c, ends[1], x + SCALE_WIDTH / 2 - PADDING - 4, y + SCALE_HEIGHT, false);
    draw_text(a, c, ends[2], x + SCALE_WIDTH, y + SCALE_HEIGHT, true);
    for (int i = 0; i < 3; i++)
        g_free(ends[i]);
}

/* A texel's centre on the widget. */
static void texel_centre(const app *a, int32_t x, int32_t y, double *out_x, double *out_y)
{
    const int factor = gtk_widget_get_scale_factor(a->canvas);
    double scale_x, scale_y, left, top;
    canvas_place(a, &scale_x, &scale_y, &left, &top);
    *out_x = (left + (x + 0.5) * scale_x) / factor;
    *out_y = (top + (y + 0.5) * scale_y) / factor;
}

/* The radius around the pixel, and the horizon of each direction: the redder, the higher.
 */
static void draw_explanation(const app *a, cairo_t *c)
{
    int32_t x, y;
    double px, py, edge, unused;
    explanation e;
    if (a->pointer_x < 0.0 || !canvas_pixel(a, a->pointer_x, a->pointer_y, &x, &y))
        return;
    const int half = a->pointer_x >= a->split * gtk_widget_get_width(a->canvas);
    if (!explain_pixel(a->shown.buffers, x, y,
                       (double)a->shown.wish.half[half].options.radius, &e))
        return;
    texel_centre(a, x, y, &px, &py);
    texel_centre(a, x + (int32_t)lround(fmin(e.radius_px, 1e6)), y, &edge, &unused);
    cairo_set_line_width(c, 1.5);
    cairo_set_source_rgba(c, 0.1, 0.4, 1.0, 0.9);
    cairo_arc(c, px, py, edge - px, 0.0, 2.0 * G_PI);
    cairo_stroke(c);
    for (int i = 0; i < EXPLAIN_DIRECTIONS; i++) {
        const explain_horizon *h = &e.horizon[i];
        double hx, hy;
        if (!h->found)
            continue;
        texel_centre(a, h->x, h->y, &hx, &hy);
        cairo_set_source_rgba(c, 1.0, 0.85 * (1.0 - h->sine), 0.0, 0.9);
        cairo_move_to(c, px, py);
        cairo_line_to(c, hx, hy);
        cairo_stroke(c);
        cairo_arc(c, hx, hy, 3.0, 0.0, 2.0 * G_PI);
        cairo_fill(c);
    }
}

/* Widget px from here on. */
static void draw_overlay(const app *a, cairo_t *c, int width, int height)
{
    const double x = floor(a->split * width) + 0.5;
    if (a->split > 0.0 && a->split < 1.0) {
        cairo_set_line_width(c, 3.0);
        cairo_set_source_rgba(c, 0.0, 0.0, 0.0, 0.5);
        cairo_move_to(c, x, 0.0);
        cairo_line_to(c, x, height);
        cairo_stroke(c);
        cairo_set_line_width(c, 1.0);
        cairo_set_source_rgb(c, 1.0, 1.0, 1.0);
        cairo_move_to(c, x, 0.0);
        cairo_line_to(c, x, height);
        cairo_stroke(c);
        cairo_arc(c, x, 0.5 * height, 5.0, 0.0, 2.0 * G_PI);
        cairo_fill(c);
    }
    if (a->explains)
        draw_explanation(a, c);
    char *names[] = {name_of(a, 0), name_of(a, 1)};
    if (a->split > 0.0)
        draw_text(a, c, names[0], MARGIN, MARGIN, false);
    if (a->split < 1.0)
        draw_text(a, c, names[1], width - MARGIN, MARGIN, true);
    for (int i = 0; i < HALVES; i++)
        g_free(names[i]);
    if (a->shown.wish.half[0].look == LOOK_DIFFERENCE)
        draw_scale(a, c, MARGIN, height - MARGIN - 40);
    if (a->shown.wish.half[1].look == LOOK_DIFFERENCE)
        draw_scale(a, c, width - MARGIN - SCALE_WIDTH, height - MARGIN - 40);
}

static void draw(GtkDrawingArea *area, cairo_t *c, int width, int height, gpointer user)
{
    app *a = user;
    const int factor = gtk_widget_get_scale_factor(GTK_WIDGET(area));
    cairo_set_source_rgb(c, 0.25, 0.25, 0.25);
    cairo_paint(c);
    if (!a->picture[0]) {
        draw_text(a, c, a->told[0] ? a->told : "loading ...", MARGIN, MARGIN, false);
        return;
    }
    const double line = floor(a->split * width) * factor;
    cairo_save(c);
    cairo_scale(c, 1.0 / factor, 1.0 / factor);
    draw_half(a, c, 0, 0.0, line);
    draw_half(a, c, 1, line, (double)width * factor);
    cairo_restore(c);
    if (a->overlay)
        draw_overlay(a, c, width, height);
    a->painted_number = a->shown_number;
}

static void on_resize(GtkDrawingArea *area, int width, int height, gpointer user)
{
    (void)area;
    (void)width;
    (void)height;
    app *a = user;
    wish *w = &a->session.wish;
    const int32_t before_width = w->width, before_height = w->height;
    if (!a->session.source.model)
        return;
    canvas_size(a, &w->width, &w->height);
    if (a->asked == 0)
        app_ask(a);
    else if (w->width != before_width || w->height != before_height)
        app_move(a);
}

GtkWidget *canvas_make(app *a)
{
    a->canvas = gtk_drawing_area_new();
    gtk_widget_set_hexpand(a->canvas, TRUE);
    gtk_widget_set_vexpand(a->canvas, TRUE);
    gtk_widget_set_focusable(a->canvas, TRUE);
    gtk_drawing_area_set_draw_func(GTK_DRAWING_AREA(a->canvas), draw, a, NULL);
    g_signal_connect(a->canvas, "resize", G_CALLBACK(on_resize), a);
    gtk_accessible_update_property(GTK_ACCESSIBLE(a->canvas),
                                   GTK_ACCESSIBLE_PROPERTY_LABEL, "the picture", -1);
    canvas_take_input(a);
    return a->canvas;
}

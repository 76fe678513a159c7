/* SPDX-License-Identifier: MIT */
/* What lies over the picture: the line, the halves' names, the scale of differences and
 * what explains a pixel. */
#include "app.h"

#include <math.h>

#include "common/heatmap.h"
#include "explain.h"
#include "io.h"

enum { PADDING = 6, SCALE_WIDTH = 160, SCALE_HEIGHT = 12, SCALE_STOPS = 33 };

static const GdkRGBA white = {1.0f, 1.0f, 1.0f, 1.0f};
static const GdkRGBA shade = {0.0f, 0.0f, 0.0f, 0.6f};

static graphene_rect_t rectangle(double x, double y, double width, double height)
{
    return GRAPHENE_RECT_INIT((float)x, (float)y, (float)width, (float)height);
}

void overlay_text(const app *a, GtkSnapshot *to, const char *text, double x, double y,
                  bool right)
{
    PangoLayout *layout = gtk_widget_create_pango_layout(a->canvas, text);
    int width, height;
    pango_layout_get_pixel_size(layout, &width, &height);
    if (right)
        x -= width + 2 * PADDING;
    const graphene_rect_t box = rectangle(x, y, width + 2 * PADDING, height + PADDING);
    const graphene_point_t at =
        GRAPHENE_POINT_INIT((float)x + PADDING, (float)y + PADDING / 2);
    gtk_snapshot_append_color(to, &shade, &box);
    gtk_snapshot_save(to);
    gtk_snapshot_translate(to, &at);
    gtk_snapshot_append_layout(to, layout, &white);
    gtk_snapshot_restore(to);
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
static void snapshot_scale(const app *a, GtkSnapshot *to, double x, double y)
{
    char *ends[] = {g_strdup_printf("-%g", a->shown.wish.heat_scale), g_strdup("0"),
                    g_strdup_printf("+%g", a->shown.wish.heat_scale)};
    const graphene_rect_t box = rectangle(x, y, SCALE_WIDTH, SCALE_HEIGHT);
    const graphene_point_t begin = GRAPHENE_POINT_INIT((float)x, (float)y);
    const graphene_point_t end = GRAPHENE_POINT_INIT((float)x + SCALE_WIDTH, (float)y);
    GskColorStop stops[SCALE_STOPS];
    for (int i = 0; i < SCALE_STOPS; i++) {
        const double t = (double)i / (SCALE_STOPS - 1);
        float linear[3];
        heatmap_colour(2.0 * t - 1.0, linear);
        stops[i] = (GskColorStop){
            .offset = (float)t,
            .color = {(float)io_quantise(linear[0], true, 255) / 255.0f,
                      (float)io_quantise(linear[1], true, 255) / 255.0f,
                      (float)io_quantise(linear[2], true, 255) / 255.0f, 1.0f}};
    }
    gtk_snapshot_append_linear_gradient(to, &box, &begin, &end, stops, SCALE_STOPS);
    overlay_text(a, to, ends[0], x, y + SCALE_HEIGHT, false);
    overlay_text(a, to, ends[1], x + SCALE_WIDTH / 2 - PADDING - 4, y + SCALE_HEIGHT,
                 false);
    overlay_text(a, to, ends[2], x + SCALE_WIDTH, y + SCALE_HEIGHT, true);
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

/* The texels that the method reads. */
static void draw_samples(const app *a, cairo_t *c, int32_t x, int32_t y)
{
    const samples *s = a->shown.samples;
    if (!s || s->x != x || s->y != y)
        return;
    for (int32_t i = 0; i < s->count; i++) {
        const sample *at = &s->list[i];
        double px, py;
        texel_centre(a, at->x, at->y, &px, &py);
        cairo_set_source_rgba(c, 0.0, 0.0, 0.0, 0.8);
        cairo_arc(c, px, py, at->counts ? 4.0 : 3.0, 0.0, 2.0 * G_PI);
        cairo_fill(c);
        cairo_set_source_rgb(c, 1.0, at->counts ? 0.6 : 1.0, at->counts ? 0.1 : 1.0);
        cairo_arc(c, px, py, at->counts ? 3.0 : 2.0, 0.0, 2.0 * G_PI);
        cairo_fill(c);
    }
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
    }
    draw_samples(a, c, x, y);
}

/* White with dark edges, and a dot to drag it by. */
static void snapshot_line(GtkSnapshot *to, double x, int height)
{
    static const GdkRGBA edge = {0.0f, 0.0f, 0.0f, 0.5f};
    const graphene_rect_t wide = rectangle(x - 1.0, 0.0, 3.0, height);
    const graphene_rect_t narrow = rectangle(x, 0.0, 1.0, height);
    const graphene_rect_t ring = rectangle(x - 5.5, 0.5 * height - 6.0, 12.0, 12.0);
    const graphene_rect_t box = rectangle(x - 4.5, 0.5 * height - 5.0, 10.0, 10.0);
    GskRoundedRect dot, around;
    gsk_rounded_rect_init_from_rect(&around, &ring, 6.0f);
    gsk_rounded_rect_init_from_rect(&dot, &box, 5.0f);
    gtk_snapshot_append_color(to, &edge, &wide);
    gtk_snapshot_append_color(to, &white, &narrow);
    gtk_snapshot_push_rounded_clip(to, &around);
    gtk_snapshot_append_color(to, &edge, &ring);
    gtk_snapshot_pop(to);
    gtk_snapshot_push_rounded_clip(to, &dot);
    gtk_snapshot_append_color(to, &white, &box);
    gtk_snapshot_pop(to);
}

void overlay_snapshot(const app *a, GtkSnapshot *to, int width, int height)
{
    if (a->split > 0.0 && a->split < 1.0)
        snapshot_line(to, floor(a->split * width), height);
    if (a->explains) {
        const graphene_rect_t all = rectangle(0.0, 0.0, width, height);
        cairo_t *c = gtk_snapshot_append_cairo(to, &all);
        draw_explanation(a, c);
        cairo_destroy(c);
    }
    char *names[] = {name_of(a, 0), name_of(a, 1)};
    if (a->split > 0.0)
        overlay_text(a, to, names[0], OVERLAY_MARGIN, OVERLAY_MARGIN, false);
    if (a->split < 1.0)
        overlay_text(a, to, names[1], width - OVERLAY_MARGIN, OVERLAY_MARGIN, true);
    for (int i = 0; i < HALVES; i++)
        g_free(names[i]);
    const double y = height - OVERLAY_MARGIN - 40;
    if (a->shown.wish.half[0].look == LOOK_DIFFERENCE)
        snapshot_scale(a, to, OVERLAY_MARGIN, y);
    if (a->shown.wish.half[1].look == LOOK_DIFFERENCE)
        snapshot_scale(a, to, width - OVERLAY_MARGIN - SCALE_WIDTH, y);
}

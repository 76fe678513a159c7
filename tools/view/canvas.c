/* SPDX-License-Identifier: MIT */
/* The picture: both halves, with what canvas_overlay.c puts over them. */
#include "app.h"

#include <math.h>

/* A GtkDrawingArea that draws by nodes of GTK's scene graph: a texture is uploaded once,
 * and only what has changed is drawn anew. */
typedef struct CreviceCanvas {
    GtkDrawingArea parent;
    app *app;
} CreviceCanvas;

typedef struct CreviceCanvasClass {
    GtkDrawingAreaClass parent;
} CreviceCanvasClass;

static GType canvas_get_type(void);
G_DEFINE_TYPE(CreviceCanvas, canvas, GTK_TYPE_DRAWING_AREA)

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

void canvas_forget(app *a)
{
    for (int i = 0; i < HALVES; i++) {
        g_clear_pointer(&a->picture[i].surface, cairo_surface_destroy);
        g_clear_pointer(&a->picture[i].surface_before, cairo_surface_destroy);
        g_clear_object(&a->picture[i].texture);
        a->picture[i] = (picture){0};
    }
}

/* The half's columns as they are, device px; `from` and `to` lie within the picture. */
static GdkTexture *texture_of(app *a, int half, int32_t from, int32_t to)
{
    picture *p = &a->picture[half];
    if (p->texture && p->from == from && p->to == to)
        return p->texture;
    const buffers *b = a->shown.buffers;
    uint32_t *pixels = a->shown.half[half].pixels;
    const size_t stride = (size_t)b->width * sizeof *pixels;
    GBytes *bytes = g_bytes_new_with_free_func(
        pixels + from, stride * (size_t)b->height - (size_t)from * sizeof *pixels,
        pool_release, pool_hold(pixels));
    g_clear_object(&p->texture);
    p->texture =
        gdk_memory_texture_new(to - from, b->height, GDK_MEMORY_DEFAULT, bytes, stride);
    g_bytes_unref(bytes);
    p->from = from;
    p->to = to;
    return p->texture;
}

static cairo_surface_t *surface_of(app *a, int half)
{
    static const cairo_user_data_key_t holder;
    picture *p = &a->picture[half];
    const buffers *b = a->shown.buffers;
    uint32_t *pixels = a->shown.half[half].pixels;
    if (p->surface)
        return p->surface;
    p->surface = cairo_image_surface_create_for_data(
        (unsigned char *)pixels, CAIRO_FORMAT_RGB24, b->width, b->height, 4 * b->width);
    cairo_surface_set_user_data(p->surface, &holder, pool_hold(pixels), pool_release);
    return p->surface;
}

/* The part of the widget that shows a half, device px. */
typedef struct stripe {
    double from, to, height;
    double scale_x, scale_y, left, top; /* how the picture lies */
    float factor;                       /* device px a px of the widget */
    bool by_cairo;                      /* as GTK's renderer draws */
} stripe;

static graphene_rect_t in_widget(const stripe *s, double x, double y, double width,
                                 double height)
{
    return GRAPHENE_RECT_INIT((float)x / s->factor, (float)y / s->factor,
                              (float)width / s->factor, (float)height / s->factor);
}

static bool is_whole(double x)
{
    return !(x < floor(x) || x > floor(x));
}

static bool is_pixel_by_pixel(const stripe *s)
{
    return !(s->scale_x < 1.0 || s->scale_x > 1.0 || s->scale_y < 1.0 || s->scale_y > 1.0)
           && is_whole(s->left) && is_whole(s->top);
}

static void snapshot_texture(app *a, GtkSnapshot *to, int half, const stripe *s)
{
    const buffers *b = a->shown.buffers;
    const int32_t first = (int32_t)fmin(fmax(s->from - s->left, 0.0), b->width);
    const int32_t last = (int32_t)fmin(fmax(s->to - s->left, 0.0), b->width);
    if (last <= first)
        return;
    const graphene_rect_t at =
        in_widget(s, s->left + first, s->top, last - first, b->height);
    gtk_snapshot_append_texture(to, texture_of(a, half, first, last), &at);
}

/* Pixels stay pixels when they are enlarged, and are averaged when they shrink. */
static void snapshot_scaled(app *a, GtkSnapshot *to, int half, const stripe *s)
{
    const graphene_rect_t at = in_widget(s, s->from, 0.0, s->to - s->from, s->height);
    cairo_t *c = gtk_snapshot_append_cairo(to, &at);
    cairo_scale(c, 1.0 / (double)s->factor, 1.0 / (double)s->factor);
    cairo_translate(c, s->left, s->top);
    cairo_scale(c, s->scale_x, s->scale_y);
    cairo_set_source_surface(c, surface_of(a, half), 0.0, 0.0);
    cairo_pattern_set_filter(cairo_get_source(c), s->scale_x >= 1.0 ? CAIRO_FILTER_NEAREST
                                                                    : CAIRO_FILTER_GOOD);
    cairo_paint(c);
    cairo_destroy(c);
}

static void snapshot_half(app *a, GtkSnapshot *to, int half, const stripe *s)
{
    picture *p = &a->picture[half];
    if (!(s->to > s->from))
        return;
    if (p->pixels != a->shown.half[half].pixels) {
        g_clear_pointer(&p->surface_before, cairo_surface_destroy);
        p->surface_before = g_steal_pointer(&p->surface);
        g_clear_object(&p->texture);
        p->pixels = a->shown.half[half].pixels;
    }
    /* GTK's Cairo renderer converts textures slowly before it draws them. */
    if (is_pixel_by_pixel(s) && !s->by_cairo)
        snapshot_texture(a, to, half, s);
    else
        snapshot_scaled(a, to, half, s);
}

static void canvas_snapshot(GtkWidget *widget, GtkSnapshot *to)
{
    static const GdkRGBA around = {0.25f, 0.25f, 0.25f, 1.0f};
    app *a = ((CreviceCanvas *)(void *)widget)->app;
    const int width = gtk_widget_get_width(widget);
    const int height = gtk_widget_get_height(widget);
    const int factor = gtk_widget_get_scale_factor(widget);
    const graphene_rect_t all = GRAPHENE_RECT_INIT(0, 0, (float)width, (float)height);
    gtk_snapshot_push_clip(to, &all);
    if (!a->session.source.model || !a->shown.buffers)
        gtk_snapshot_append_color(to, &around, &all);
    if (a->shown.buffers) {
        const double line = floor(a->split * width) * factor;
        stripe s = {
            .to = line, .height = (double)height * factor, .factor = (float)factor};
        s.by_cairo =
            GSK_IS_CAIRO_RENDERER(gtk_native_get_renderer(gtk_widget_get_native(widget)));
        canvas_place(a, &s.scale_x, &s.scale_y, &s.left, &s.top);
        a->painted_s = report_seconds();
        if (!(a->first_painted_s > 0.0))
            a->first_painted_s = a->painted_s;
        snapshot_half(a, to, 0, &s);
        s.from = line;
        s.to = (double)width * factor;
        snapshot_half(a, to, 1, &s);
        if (a->overlay)
            overlay_snapshot(a, to, width, height);
        a->painted_number = a->shown_number;
    } else {
        overlay_text(a, to, a->told[0] ? a->told : "loading ...", OVERLAY_MARGIN,
                     OVERLAY_MARGIN, false);
    }
    gtk_snapshot_pop(to);
}

static void canvas_class_init(CreviceCanvasClass *c)
{
    GTK_WIDGET_CLASS(c)->snapshot = canvas_snapshot;
}

static void canvas_init(CreviceCanvas *c)
{
    c->app = NULL;
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
    a->canvas = g_object_new(canvas_get_type(), NULL);
    ((CreviceCanvas *)(void *)a->canvas)->app = a;
    gtk_widget_set_hexpand(a->canvas, TRUE);
    gtk_widget_set_vexpand(a->canvas, TRUE);
    gtk_widget_set_focusable(a->canvas, TRUE);
    g_signal_connect(a->canvas, "resize", G_CALLBACK(on_resize), a);
    gtk_accessible_update_property(GTK_ACCESSIBLE(a->canvas),
                                   GTK_ACCESSIBLE_PROPERTY_LABEL, "the picture", -1);
    canvas_take_input(a);
    return a->canvas;
}

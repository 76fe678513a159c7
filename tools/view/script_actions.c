/* SPDX-License-Identifier: MIT */
/* The actions of scripts: what a user would do, and looks at what comes of it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command_text.h"
#include "common/motion.h"
#include "common/option_text.h"
#include "panel.h"
#include "script.h"

enum { LAYOUT_US = 2000000, LAYOUTS_MAX = 5 };

static const char *const no_half = "the half is left or right";
static const char *const no_number = "a number is missing";
static const char *const no_mesh = "is for meshes";

static bool numbers(char **word, int count, double *out)
{
    for (int i = 0; i < count; i++)
        if (!script_number(word[i], &out[i]))
            return false;
    return true;
}

/* The picture of the last wish is on the screen. */
static bool is_still(script *s)
{
    const app *a = s->app;
    return a->asked > 0 && !a->settle && a->shown_number >= a->asked
           && !a->shown.more_follows
           && (a->painted_number >= a->asked || !a->shown.buffers);
}

static const char *do_wait(script *s, char **word)
{
    (void)word;
    s->done = is_still;
    return NULL;
}

static bool has_truth(script *s)
{
    const half_shown *h = s->app->shown.half;
    return is_still(s) && h[0].has_truth && h[0].truth.passes >= s->number[0]
           && h[1].has_truth && h[1].truth.passes >= s->number[0];
}

static const char *do_wait_truth(script *s, char **word)
{
    double passes;
    if (!script_number(word[0], &passes))
        return no_number;
    s->number[0] = (int32_t)passes;
    s->done = has_truth;
    return NULL;
}

/* The window stays as it is, however often it is asked. */
static void give_size_up(script *s, int32_t width, int32_t height)
{
    GdkSurface *surface = gtk_native_get_surface(GTK_NATIVE(s->app->window));
    GdkMonitor *screen = gdk_display_get_monitor_at_surface(
        gtk_widget_get_display(s->app->window), surface);
    GdkRectangle at = {.width = 0};
    if (screen)
        gdk_monitor_get_geometry(screen, &at);
    snprintf(s->wrong, sizeof s->wrong,
             "the picture stays at %d x %d; give another size, the screen is %d x %d",
             width, height, at.width, at.height);
}

static bool has_size(script *s)
{
    const app *a = s->app;
    int32_t width, height;
    canvas_size(a, &width, &height);
    if (width == s->number[0] && height == s->number[1])
        return is_still(s);
    /* A window lays itself out some time after it was asked to; if it cannot be of that
     * size, it is asked again. */
    const bool changed = width != s->number[2] || height != s->number[3];
    if (width == 1 || (!changed && g_get_monotonic_time() - s->tried < LAYOUT_US))
        return false;
    s->attempts = changed ? 0 : s->attempts + 1;
    if (s->attempts == LAYOUTS_MAX) {
        give_size_up(s, width, height);
        return false;
    }
    s->number[2] = width;
    s->number[3] = height;
    const int factor = gtk_widget_get_scale_factor(a->canvas);
    int window_width, window_height;
    s->tried = g_get_monotonic_time();
    gtk_window_get_default_size(GTK_WINDOW(a->window), &window_width, &window_height);
    gtk_window_set_default_size(GTK_WINDOW(a->window),
                                window_width + (s->number[0] - width) / factor,
                                window_height + (s->number[1] - height) / factor);
    return false;
}

static const char *do_size(script *s, char **word)
{
    double size[2];
    if (!numbers(word, 2, size))
        return no_number;
    for (int i = 0; i < 2; i++)
        s->number[i] = (int32_t)size[i];
    s->number[2] = s->number[3] = s->attempts = 0;
    s->done = has_size;
    return NULL;
}

static const char *do_show(script *s, char **word)
{
    const int half = script_half(word[0]);
    if (half < 0)
        return no_half;
    return panel_choose(s->app->panel[half], word[1]) ? NULL
                                                      : "shows a method, truth, or open";
}

static const char *do_as(script *s, char **word)
{
    const int half = script_half(word[0]);
    if (half < 0)
        return no_half;
    return panel_set_look(s->app->panel[half], word[1])
               ? NULL
               : "is shown as accessibility, lit or difference";
}

static const char *do_set(script *s, char **word)
{
    const int half = script_half(word[0]);
    if (half < 0)
        return no_half;
    if (!session_set_option(&s->app->session, half, word[1], word[2]))
        return "cannot be set";
    panel_sync(s->app->panel[half]);
    app_ask(s->app);
    return NULL;
}

static const char *do_slide(script *s, char **word)
{
    const int half = script_half(word[0]);
    double value;
    if (half < 0)
        return no_half;
    if (!script_number(word[2], &value))
        return no_number;
    return panel_slide(s->app->panel[half], word[1], value) ? NULL : "has no slider";
}

static const char *do_preset(script *s, char **word)
{
    const int half = script_half(word[0]);
    if (half < 0)
        return no_half;
    for (int i = 0; i < CRV_PRESET_COUNT; i++) {
        if (strcmp(crv_preset_name((crv_preset)i), word[1]) != 0)
            continue;
        session_set_preset(&s->app->session, half, (crv_preset)i);
        panel_sync(s->app->panel[half]);
        app_ask(s->app);
        return NULL;
    }
    return "there is no such preset";
}

static const char *do_reset(script *s, char **word)
{
    const int half = script_half(word[0]);
    if (half < 0)
        return no_half;
    session_reset(&s->app->session, half);
    panel_sync(s->app->panel[half]);
    app_ask(s->app);
    return NULL;
}

static bool is_tuned(script *s)
{
    const tuning *t = &s->app->tuning;
    char text[TUNING_TEXT_SIZE];
    if (t->half != s->number[0] || t->phase < TUNING_DONE)
        return false;
    puts(tuning_text(t, text));
    return true;
}

static const char *do_tune(script *s, char **word)
{
    double seconds;
    s->number[0] = script_half(word[0]);
    if (s->number[0] < 0)
        return no_half;
    if (!script_number(word[1], &seconds) || !(seconds > 0.0))
        return no_number;
    worker_tune(s->app->session.worker, s->number[0], seconds);
    s->app->tuning = (tuning){.phase = TUNING_RUNS, .half = s->number[0]};
    s->done = is_tuned;
    return NULL;
}

static const char *do_wait_tune(script *s, char **word)
{
    (void)word;
    s->number[0] = s->app->tuning.half;
    s->done = is_tuned;
    return NULL;
}

static const char *do_take_over(script *s, char **word)
{
    const int half = script_half(word[0]);
    if (half < 0)
        return no_half;
    return app_take_over(s->app, half) ? NULL : "nothing was fitted for this half";
}

static const char *do_half(script *s, char **word)
{
    if (script_half(word[0]) < 0)
        return no_half;
    gtk_stack_set_visible_child_name(GTK_STACK(s->app->stack), word[0]);
    return NULL;
}

static const char *do_split(script *s, char **word)
{
    double x;
    if (!script_number(word[0], &x))
        return no_number;
    s->app->split = fmin(fmax(x, 0.0), 1.0);
    gtk_widget_queue_draw(s->app->canvas);
    return NULL;
}

static const char *do_overlay(script *s, char **word)
{
    s->app->overlay = strcmp(word[0], "on") == 0;
    gtk_widget_queue_draw(s->app->canvas);
    return NULL;
}

static const char *do_dark(script *s, char **word)
{
    app_set_dark(s->app, strcmp(word[0], "on") == 0);
    return NULL;
}

static const char *do_heat_scale(script *s, char **word)
{
    double scale;
    if (!script_number(word[0], &scale) || !(scale > 0.0))
        return no_number;
    s->app->session.wish.heat_scale = scale;
    app_ask(s->app);
    return NULL;
}

/* Six numbers: eye and target. */
static const char *do_view(script *s, char **word)
{
    scene_view *v = &s->app->session.wish.view;
    double value[6];
    if (!s->app->session.source.model)
        return no_mesh;
    if (!numbers(word, 6, value))
        return no_number;
    for (int i = 0; i < 3; i++) {
        v->eye[i] = value[i];
        v->target[i] = value[3 + i];
    }
    app_move(s->app);
    return NULL;
}

/* Degrees. */
static const char *do_orbit(script *s, char **word)
{
    double angle[2];
    if (!s->app->session.source.model)
        return no_mesh;
    if (!numbers(word, 2, angle))
        return no_number;
    motion_orbit(&s->app->session.wish.view, angle[0] * G_PI / 180.0,
                 angle[1] * G_PI / 180.0);
    app_move(s->app);
    return NULL;
}

static const char *do_fit(script *s, char **word)
{
    (void)word;
    canvas_fit(s->app);
    return NULL;
}

/* As GDK names them: "Left", "plus", "w". */
static const char *do_key(script *s, char **word)
{
    const guint key = gdk_keyval_from_name(word[0]);
    if (key == GDK_KEY_VoidSymbol)
        return "there is no such key";
    return canvas_key(s->app, key, false) ? NULL : "the key does nothing";
}

/* The pointer over a pixel of the picture. */
static const char *do_point(script *s, char **word)
{
    double at[2], scale_x, scale_y, left, top;
    app *a = s->app;
    const int factor = gtk_widget_get_scale_factor(a->canvas);
    if (!numbers(word, 2, at))
        return no_number;
    if (!a->shown.buffers)
        return "there is no picture yet";
    canvas_place(a, &scale_x, &scale_y, &left, &top);
    a->pointer_x = (left + (at[0] + 0.5) * scale_x) / factor;
    a->pointer_y = (top + (at[1] + 0.5) * scale_y) / factor;
    probe_tell(a);
    app_explain(a);
    gtk_widget_queue_draw(a->canvas);
    return NULL;
}

static const char *do_frame(script *s, char **word)
{
    double frame;
    if (!script_number(word[0], &frame))
        return no_number;
    app_set_frame(s->app, (int)frame);
    return NULL;
}

static const char *do_save(script *s, char **word)
{
    const int half = script_half(word[0]);
    if (half < 0)
        return no_half;
    return app_save(s->app, half, word[1]) ? NULL : "could not be written";
}

/* What GTK draws of a widget, as a PNG. False if it is about to be drawn anew. */
static bool shoot(GtkWidget *widget, const char *path)
{
    GdkPaintable *paintable = gtk_widget_paintable_new(widget);
    GtkSnapshot *snapshot = gtk_snapshot_new();
    gdk_paintable_snapshot(paintable, snapshot, gtk_widget_get_width(widget),
                           gtk_widget_get_height(widget));
    GskRenderNode *node = gtk_snapshot_free_to_node(snapshot);
    GskRenderer *renderer = gtk_native_get_renderer(gtk_widget_get_native(widget));
    bool done = false;
    if (node) {
        GdkTexture *texture = gsk_renderer_render_texture(renderer, node, NULL);
        done = gdk_texture_save_to_png(texture, path);
        g_object_unref(texture);
        gsk_render_node_unref(node);
    }
    g_object_unref(paintable);
    return done;
}

static bool has_shot(script *s)
{
    return is_still(s)
           && shoot(s->number[0] ? s->app->window : s->app->canvas, s->path_out);
}

static const char *take_shot(script *s, const char *path, bool window)
{
    g_strlcpy(s->path_out, path, sizeof s->path_out);
    s->number[0] = window;
    s->done = has_shot;
    return NULL;
}

static const char *do_screenshot(script *s, char **word)
{
    return take_shot(s, word[0], true);
}

static const char *do_canvas(script *s, char **word)
{
    return take_shot(s, word[0], false);
}

static const char *do_command(script *s, char **word)
{
    const int half = script_half(word[0]);
    char text[COMMAND_SIZE];
    if (half < 0)
        return no_half;
    puts(command_text(&s->app->session.source, &s->app->session.wish, half, text));
    return NULL;
}

static const char *do_options(script *s, char **word)
{
    const int half = script_half(word[0]);
    char text[OPTION_TEXT_SIZE];
    if (half < 0)
        return no_half;
    fputs(option_lines(&s->app->session.wish.half[half].options, text), stdout);
    return NULL;
}

static const char *do_probe(script *s, char **word)
{
    double at[2];
    char text[512];
    if (!numbers(word, 2, at))
        return no_number;
    if (!probe_text(s->app, (int32_t)at[0], (int32_t)at[1], text, sizeof text))
        return "lies outside the picture";
    puts(text);
    return NULL;
}

static const char *do_status(script *s, char **word)
{
    (void)word;
    puts(gtk_label_get_text(GTK_LABEL(s->app->status)));
    return NULL;
}

/* A window that changes its size all the time. */
static bool has_stormed(script *s)
{
    if (s->number[0] <= 0)
        return is_still(s);
    const int n = s->number[0]--;
    gtk_window_set_default_size(GTK_WINDOW(s->app->window), 500 + n * 97 % 700,
                                400 + n * 61 % 400);
    return false;
}

static const char *do_resize_storm(script *s, char **word)
{
    double count;
    if (!script_number(word[0], &count))
        return no_number;
    s->number[0] = (int32_t)count;
    s->done = has_stormed;
    return NULL;
}

static const char *do_quit(script *s, char **word)
{
    (void)word;
    fflush(stdout);
    gtk_window_destroy(GTK_WINDOW(s->app->window));
    return NULL;
}

const script_action script_actions[] = {
    {"wait", 0, do_wait},
    {"wait-truth", 1, do_wait_truth},
    {"size", 2, do_size},
    {"show", 2, do_show},
    {"as", 2, do_as},
    {"set", 3, do_set},
    {"slide", 3, do_slide},
    {"preset", 2, do_preset},
    {"reset", 1, do_reset},
    {"tune", 2, do_tune},
    {"wait-tune", 0, do_wait_tune},
    {"take-over", 1, do_take_over},
    {"half", 1, do_half},
    {"split", 1, do_split},
    {"overlay", 1, do_overlay},
    {"dark", 1, do_dark},
    {"heat-scale", 1, do_heat_scale},
    {"view", 6, do_view},
    {"orbit", 2, do_orbit},
    {"fit", 0, do_fit},
    {"key", 1, do_key},
    {"point", 2, do_point},
    {"frame", 1, do_frame},
    {"save", 2, do_save},
    {"screenshot", 1, do_screenshot},
    {"canvas", 1, do_canvas},
    {"command", 1, do_command},
    {"options", 1, do_options},
    {"probe", 2, do_probe},
    {"status", 0, do_status},
    {"measure", 5, script_measure},
    {"start", 0, script_start_times},
    {"resize-storm", 1, do_resize_storm},
    {"quit", 0, do_quit},
    {NULL, 0, NULL},
};

/* SPDX-License-Identifier: MIT */
#include "app.h"

#include <stdarg.h>
#include <string.h>

#include "command_text.h"
#include "io.h"
#include "common/option_text.h"
#include "panel.h"

/* A view is still after this. */
enum { STILL_MS = 180 };

void app_ask(app *a)
{
    a->asked = session_ask(&a->session);
}

void app_explain(app *a)
{
    wish *w = &a->session.wish;
    int32_t x, y;
    const bool explains = a->explains && a->pointer_x >= 0.0
                          && canvas_pixel(a, a->pointer_x, a->pointer_y, &x, &y);
    if (!explains) {
        w->explains = false;
        return;
    }
    const int half = a->pointer_x >= a->split * gtk_widget_get_width(a->canvas);
    const bool same = w->explains && w->explained_half == half && w->explained_x == x
                      && w->explained_y == y;
    w->explains = true;
    w->explained_half = half;
    w->explained_x = x;
    w->explained_y = y;
    if (!same)
        app_ask(a);
}

static gboolean on_still(gpointer user)
{
    app *a = user;
    a->settle = 0;
    a->session.wish.moving = false;
    app_ask(a);
    return G_SOURCE_REMOVE;
}

void app_move(app *a)
{
    a->session.wish.moving = true;
    if (a->settle)
        g_source_remove(a->settle);
    a->settle = g_timeout_add(STILL_MS, on_still, a);
    app_ask(a);
}

void app_tell(app *a, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(a->told, sizeof a->told, format, arguments);
    va_end(arguments);
    probe_tell(a);
}

int app_half(const app *a)
{
    const char *name = gtk_stack_get_visible_child_name(GTK_STACK(a->stack));
    return name && strcmp(name, "right") == 0 ? 1 : 0;
}

static void copy(app *a, const char *text, const char *what)
{
    gdk_clipboard_set_text(gtk_widget_get_clipboard(a->window), text);
    app_tell(a, "%s: copied", what);
}

void app_copy_command(app *a)
{
    char text[COMMAND_SIZE];
    command_text(&a->session.source, &a->session.wish, app_half(a), text);
    copy(a, text, text[0] == '#' ? text + 2 : "command");
}

void app_copy_options(app *a)
{
    char text[OPTION_TEXT_SIZE];
    copy(a, option_lines(&a->session.wish.half[app_half(a)].options, text),
         "options, for --options FILE");
}

void app_set_dark(app *a, bool dark)
{
    g_object_set(gtk_settings_get_default(), "gtk-application-prefer-dark-theme",
                 (gboolean)dark, NULL);
    gtk_toggle_button_set_active(GTK_TOGGLE_BUTTON(a->dark), dark);
}

void app_title(app *a)
{
    char path[4096];
    const char *name =
        source_frame_name(&a->session.source, a->session.wish.frame, path, sizeof path);
    char *base = g_path_get_basename(name ? name : a->settings->view.model);
    char *title = g_strdup_printf("%s - Crevice", base);
    gtk_window_set_title(GTK_WINDOW(a->window), title);
    g_free(title);
    g_free(base);
}

void app_set_frame(app *a, int index)
{
    wish *w = &a->session.wish;
    const int32_t last = a->session.source.frame_count - 1;
    index = index < 0 ? 0 : index > last ? last : index;
    if (last < 0 || w->frame == index)
        return;
    w->frame = index;
    if (a->scrubber)
        gtk_range_set_value(GTK_RANGE(a->scrubber), index);
    app_title(a);
    app_ask(a);
}

/* As `crevice tune` by itself. */
#define TUNE_SECONDS 10.0

void app_tune(app *a, int half)
{
    if (a->tuning.phase == TUNING_RUNS)
        worker_stop_tuning(a->session.worker);
    else
        worker_tune(a->session.worker, half, TUNE_SECONDS);
}

bool app_take_over(app *a, int half)
{
    if (a->tuning.half != half || !session_take_over(&a->session, &a->tuning))
        return false;
    panel_sync(a->panel[half]);
    app_ask(a);
    return true;
}

/* What a half shows is grey or colour; both are kept as bytes that PNG writes as they
 * are. */
bool app_save(app *a, int half, const char *path)
{
    static const char *const names[] = {"R", "G", "B"};
    const shown *s = &a->shown;
    report *r = a->session.r;
    io_image image = {0};
    if (!s->buffers) {
        app_tell(a, "there is no picture yet");
        return false;
    }
    const bool grey = s->wish.half[half].look == LOOK_ACCESSIBILITY;
    const char *const one[] = {"AO"};
    if (io_image_init(&image, s->buffers->width, s->buffers->height, grey ? one : names,
                      grey ? 1 : 3, &r->logger)
        != 0)
        return false;
    const size_t count = (size_t)image.width * (size_t)image.height;
    for (size_t i = 0; i < count; i++) {
        if (grey) {
            image.channels[0].data[i] = s->half[half].accessibility[i];
            continue;
        }
        for (int c = 0; c < 3; c++)
            image.channels[c].data[i] =
                (float)(s->half[half].pixels[i] >> (16 - 8 * c) & 255u) / 255.0f;
    }
    const bool done = io_write(path, &image, NULL, &r->logger) == 0;
    io_image_free(&image);
    app_tell(a, done ? "wrote %s" : "could not write %s; see the terminal", path);
    return done;
}

/* SPDX-License-Identifier: MIT */
/* crevice-view: `crevice view` in a program of its own, so that the tool links no GTK. */
#include <string.h>

#include "app.h"
#include "common/help.h"
#include "panel.h"
#include "script.h"

/* A failed wish leaves the picture before on the screen, with a line that says why. */
static void take_picture(app *a)
{
    shown s;
    uint64_t number;
    if (!worker_take(a->session.worker, &s, &number))
        return;
    const bool same = number == a->shown_number && s.buffers == a->shown.buffers
                      && s.half[0].pixels == a->shown.half[0].pixels
                      && s.half[1].pixels == a->shown.half[1].pixels
                      && s.samples == a->shown.samples;
    a->shown_number = number;
    if (!s.buffers) {
        app_tell(a, "%s", s.problem);
        shown_free(&s);
        gtk_widget_queue_draw(a->canvas);
        return;
    }
    shown_free(&a->shown);
    a->shown = s;
    if (!same) {
        a->taken_s = report_seconds();
        gtk_widget_queue_draw(a->canvas);
    }
    if (s.more_follows)
        return;
    for (int i = 0; i < HALVES; i++)
        panel_show_numbers(a->panel[i]);
    probe_tell(a);
}

static gboolean on_ready(gpointer user)
{
    app *a = user;
    atomic_store(&a->notified, 0);
    if (!a->window)
        return G_SOURCE_REMOVE;
    take_picture(a);
    /* Once it is painted the window has its size; the truth comes again and again. */
    if (a->tunes_first && a->shown.buffers && a->painted_number >= a->asked) {
        a->tunes_first = false;
        app_tune(a, 0);
    }
    worker_tuning(a->session.worker, &a->tuning);
    for (int i = 0; i < HALVES; i++)
        panel_show_tuning(a->panel[i]);
    return G_SOURCE_REMOVE;
}

/* By the worker's thread. */
static void ready(void *user)
{
    app *a = user;
    if (atomic_exchange(&a->notified, 1) == 0)
        g_idle_add_full(G_PRIORITY_HIGH_IDLE, on_ready, a, NULL);
}

static void on_destroy(GtkWidget *window, gpointer user)
{
    (void)window;
    app *a = user;
    if (a->settle)
        g_source_remove(a->settle);
    a->settle = 0;
    a->window = NULL;
}

/* No GtkApplication: nothing here needs a session bus, which servers lack. */
static int run_window(app *a)
{
    window_make(a);
    a->window_s = report_seconds();
    g_signal_connect(a->window, "destroy", G_CALLBACK(on_destroy), a);
    if (!a->session.source.model)
        app_ask(a);
    if (a->script)
        script_start(a->script, a);
    while (a->window)
        g_main_context_iteration(NULL, TRUE);
    return a->result;
}

static int run(const viewer_settings *settings, double begun_s, report *r)
{
    app a = {.settings = settings,
             .begun_s = begun_s,
             .tunes_first = settings->tune,
             .split = 0.5,
             .overlay = true,
             .pointer_x = -1.0};
    int result = EXIT_DONE;
    if (settings->script)
        result = script_load(settings->script, &a.script, r);
    if (result == EXIT_DONE)
        result = session_open(&a.session, settings, ready, &a, r);
    if (result == EXIT_DONE)
        result = run_window(&a);
    session_close(&a.session);
    while (g_main_context_iteration(NULL, FALSE))
        continue;
    canvas_forget(&a);
    shown_free(&a.shown);
    for (int i = 0; i < HALVES; i++)
        panel_free(a.panel[i]);
    script_free(a.script);
    return result;
}

static bool wants_help(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0)
            return true;
    return false;
}

int main(int argc, char **argv)
{
    static viewer_settings settings;
    const double begun_s = report_seconds();
    report r;
    report_init(&r);
    if (wants_help(argc, argv)) {
        help_command(stdout, &command_view,
                     args_method(&command_view, argc - 1, argv + 1));
        return EXIT_DONE;
    }
    int result = args_parse(&command_view, argc - 1, argv + 1, &settings, &r);
    if (result != EXIT_DONE)
        return result;
    /* Numbers are read and written with a point everywhere. */
    gtk_disable_setlocale();
    if (!gtk_init_check()) {
        report_error(&r, "view: there is no display; set DISPLAY or WAYLAND_DISPLAY, or "
                         "use `crevice render`");
        return EXIT_FAILED;
    }
    result = run(&settings, begun_s, &r);
    if (result != EXIT_DONE && r.errors == 0)
        report_error(&r, "view: failed");
    return result;
}

/* SPDX-License-Identifier: MIT */
/* How long it takes from a slider's change until the new picture has been drawn. */
#include <stdio.h>
#include <string.h>

#include "common/quantile.h"
#include "panel.h"
#include "script.h"

static void slide_on(script *s)
{
    const double share = s->count > 1 ? (double)s->taken / (s->count - 1) : 0.0;
    s->started_ms = 1e3 * report_seconds();
    panel_slide(s->app->panel[s->half], s->key, s->from + share * (s->to - s->from));
}

/* The frame that was drawn holds the picture of the last wish. */
static void on_painted(GdkFrameClock *clock, gpointer user)
{
    (void)clock;
    script *s = user;
    const app *a = s->app;
    if (s->taken >= s->count || a->painted_number < a->asked)
        return;
    const double time_ms = 1e3 * report_seconds() - s->started_ms;
    g_array_append_val(s->times, time_ms);
    if (++s->taken < s->count)
        slide_on(s);
}

static bool has_measured(script *s)
{
    if (s->taken < s->count)
        return false;
    double *times = (double *)(void *)s->times->data;
    g_signal_handler_disconnect(s->clock, s->painted);
    g_clear_object(&s->clock);
    quantile_sort(times, s->times->len);
    printf("%s: %d changes, median %.1f ms, 90 percent within %.1f ms; the method alone "
           "%.1f ms\n",
           s->key, s->count, quantile(times, s->times->len, 0.5),
           quantile(times, s->times->len, 0.9), s->app->shown.half[s->half].time_ms);
    return true;
}

const char *script_measure(script *s, char **word)
{
    double count;
    s->half = script_half(word[0]);
    if (s->half < 0)
        return "the half is left or right";
    if (!script_number(word[2], &s->from) || !script_number(word[3], &s->to)
        || !script_number(word[4], &count) || !(count >= 1.0 && count <= 1e6))
        return "gives KEY FROM TO COUNT";
    snprintf(s->key, sizeof s->key, "%s", word[1]);
    s->count = (int)count;
    s->taken = 0;
    g_array_set_size(s->times, 0);
    s->clock = g_object_ref(gtk_widget_get_frame_clock(s->app->canvas));
    s->painted = g_signal_connect(s->clock, "after-paint", G_CALLBACK(on_painted), s);
    s->done = has_measured;
    slide_on(s);
    return NULL;
}

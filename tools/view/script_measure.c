/* SPDX-License-Identifier: MIT */
/* How long it takes from a slider's change until the new picture has been drawn, and from
 * the start until there is one. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/quantile.h"
#include "panel.h"
#include "script.h"

static void slide_on(script *s)
{
    const double share = s->count > 1 ? (double)s->taken / (s->count - 1) : 0.0;
    s->started_s = report_seconds();
    panel_slide(s->app->panel[s->half], s->key, s->from + share * (s->to - s->from));
}

/* GTK hands what the mouse does to the widgets when a frame begins; so does this. */
static void on_frame(GdkFrameClock *clock, gpointer user)
{
    (void)clock;
    script *s = user;
    if (s->waits_for_frame)
        slide_on(s);
    s->waits_for_frame = false;
}

static void slide_with_next_frame(script *s)
{
    s->waits_for_frame = true;
    gdk_frame_clock_request_phase(s->clock, GDK_FRAME_CLOCK_PHASE_FLUSH_EVENTS);
}

static script_times times_of(const script *s, double now_s)
{
    const app *a = s->app;
    const shown *p = &a->shown;
    script_times t = {{0}};
    t.ms[STAGE_ASK] = 1e3 * (p->began_s - s->started_s);
    t.ms[STAGE_METHOD] = p->half[s->half].time_ms;
    t.ms[STAGE_COLOURS] = 1e3 * (p->made_s - p->began_s) - t.ms[STAGE_METHOD];
    t.ms[STAGE_TAKE] = 1e3 * (a->taken_s - p->made_s);
    t.ms[STAGE_FRAME] = 1e3 * (a->painted_s - a->taken_s);
    t.ms[STAGE_DRAW] = 1e3 * (now_s - a->painted_s);
    t.ms[STAGE_ALL] = 1e3 * (now_s - s->started_s);
    return t;
}

/* The frame that was drawn holds the picture of the last wish. */
static void on_painted(GdkFrameClock *clock, gpointer user)
{
    (void)clock;
    script *s = user;
    const app *a = s->app;
    if (s->taken >= s->count || s->waits_for_frame || a->painted_number < a->asked)
        return;
    const script_times times = times_of(s, report_seconds());
    g_array_append_val(s->times, times);
    if (++s->taken < s->count)
        slide_with_next_frame(s);
}

/* NAN without memory. */
static double time_quantile(const GArray *times, script_stage stage, double share)
{
    double *ms = malloc(times->len * sizeof *ms);
    if (!ms)
        return NAN;
    for (guint i = 0; i < times->len; i++)
        ms[i] = g_array_index(times, script_times, i).ms[stage];
    quantile_sort(ms, times->len);
    const double result = quantile(ms, times->len, share);
    free(ms);
    return result;
}

static bool has_measured(script *s)
{
    static const char *const names[] = {"until it begins", "method",     "colours",
                                        "handed back",     "next frame", "drawn"};
    if (s->taken < s->count)
        return false;
    g_signal_handler_disconnect(s->clock, s->painted);
    g_signal_handler_disconnect(s->clock, s->framed);
    g_clear_object(&s->clock);
    printf("%s: %d changes, median %.1f ms, 90 percent within %.1f ms (", s->key,
           s->count, time_quantile(s->times, STAGE_ALL, 0.5),
           time_quantile(s->times, STAGE_ALL, 0.9));
    for (int i = 0; i < STAGE_ALL; i++)
        printf("%s%s %.1f", i ? ", " : "", names[i],
               time_quantile(s->times, (script_stage)i, 0.5));
    puts(")");
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
    s->framed = g_signal_connect(s->clock, "flush-events", G_CALLBACK(on_frame), s);
    s->done = has_measured;
    slide_with_next_frame(s);
    return NULL;
}

const char *script_start_times(script *s, char **word)
{
    (void)word;
    const app *a = s->app;
    if (!(a->first_painted_s > 0.0))
        return "there is no picture yet";
    printf("start: input read after %.0f ms, window %.0f ms and first picture %.0f ms "
           "after that\n",
           1e3 * (a->session.input_s - a->begun_s),
           1e3 * (a->window_s - a->session.input_s),
           1e3 * (a->first_painted_s - a->session.input_s));
    return NULL;
}

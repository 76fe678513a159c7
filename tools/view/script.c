/* SPDX-License-Identifier: MIT */
#include "script.h"

#include <stdlib.h>
#include <string.h>

/* Between two looks at what is waited for, and until it is given up: under valgrind all
 * takes minutes. */
enum { LOOK_MS = 4, GIVE_UP_S = 900 };

int script_load(const char *path, script **out, report *r)
{
    char *text = NULL;
    GError *error = NULL;
    if (!g_file_get_contents(path, &text, NULL, &error)) {
        report_error(r, "%s: cannot be read (%s)", path, error->message);
        g_error_free(error);
        return EXIT_FAILED;
    }
    script *s = g_new0(script, 1);
    s->path = path;
    s->lines = g_strsplit(text, "\n", -1);
    s->times = g_array_new(FALSE, FALSE, sizeof(script_times));
    g_free(text);
    *out = s;
    return EXIT_DONE;
}

void script_free(script *s)
{
    if (!s)
        return;
    g_strfreev(s->lines);
    g_array_free(s->times, TRUE);
    g_free(s);
}

int script_half(const char *word)
{
    return strcmp(word, "left") == 0 ? 0 : strcmp(word, "right") == 0 ? 1 : -1;
}

bool script_number(const char *word, double *out)
{
    return args_number(word, out);
}

static const char *run_words(script *s, char **words)
{
    const int count = (int)g_strv_length(words);
    for (const script_action *action = script_actions; action->name; action++) {
        if (strcmp(action->name, words[0]) != 0)
            continue;
        if (count - 1 < action->words)
            return "words are missing";
        return action->run(s, words + 1);
    }
    return "no such action; see docs/viewer.md";
}

static const char *run_line(script *s, const char *line)
{
    char *clean = g_strstrip(g_strdup(line));
    const char *wrong = NULL;
    if (clean[0] != '\0' && clean[0] != '#') {
        char **words = g_strsplit_set(clean, " \t", SCRIPT_WORDS);
        wrong = run_words(s, words);
        g_strfreev(words);
    }
    g_free(clean);
    return wrong;
}

static gboolean fail(script *s, const char *wrong)
{
    report_error(s->app->session.r, "%s:%d: %s: %s", s->path, s->line,
                 s->lines[s->line - 1], wrong);
    s->app->result = EXIT_FAILED;
    if (s->app->window)
        gtk_window_destroy(GTK_WINDOW(s->app->window));
    return G_SOURCE_REMOVE;
}

static gboolean on_look(gpointer user)
{
    script *s = user;
    if (!s->app->window)
        return G_SOURCE_REMOVE;
    const bool is_done = !s->done || s->done(s);
    if (s->wrong[0])
        return fail(s, s->wrong);
    if (!is_done) {
        if (g_get_monotonic_time() - s->since > (gint64)GIVE_UP_S * 1000000)
            return fail(s, "did not come to an end");
        return G_SOURCE_CONTINUE;
    }
    s->done = NULL;
    while (!s->done && s->lines[s->line]) {
        s->since = g_get_monotonic_time();
        report_detail(s->app->session.r, "%s:%d: %s", s->path, s->line + 1,
                      s->lines[s->line]);
        const char *wrong = run_line(s, s->lines[s->line++]);
        if (wrong)
            return fail(s, wrong);
        if (!s->app->window)
            return G_SOURCE_REMOVE;
    }
    return s->done ? G_SOURCE_CONTINUE : G_SOURCE_REMOVE;
}

void script_start(script *s, app *a)
{
    s->app = a;
    g_timeout_add(LOOK_MS, on_look, s);
}

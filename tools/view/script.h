/* SPDX-License-Identifier: MIT */
/* script.h: a text of actions, one a line, that a window does by itself. */
#ifndef VIEW_SCRIPT_H
#define VIEW_SCRIPT_H

#include "app.h"

enum { SCRIPT_WORDS = 8 }; /* of a line, at most */

struct script {
    app *app;
    const char *path;
    char **lines;            /* owned, as g_strsplit() makes them */
    int line;                /* the next, from 0 */
    bool (*done)(script *s); /* what is waited for; NULL: nothing */
    int32_t number[4];       /* of the action that is waited for */
    gint64 since, tried;     /* when the wait began, and the last attempt, us */
    int attempts;            /* in vain, one after the other */
    char wrong[96];          /* why the wait cannot end; "": it may */
    char path_out[4096];     /* of a screenshot that waits to be taken */
    /* measure: */
    gulong painted, framed;
    bool waits_for_frame;
    GdkFrameClock *clock; /* owned while it measures */
    int half, count, taken;
    double from, to, started_s;
    char key[64];
    GArray *times; /* of script_times; owned */
};

/* What a slider's change was spent on, ms. */
typedef enum script_stage {
    STAGE_ASK,     /* until the worker begins */
    STAGE_METHOD,  /* the method's run, its filter included */
    STAGE_COLOURS, /* the rest of the picture */
    STAGE_TAKE,    /* until the window has it */
    STAGE_FRAME,   /* until the window's next frame begins */
    STAGE_DRAW,    /* until that is drawn */
    STAGE_ALL,
    STAGE_COUNT
} script_stage;

typedef struct script_times {
    double ms[STAGE_COUNT];
} script_times;

/* Reads it. Returns an exit code. */
int script_load(const char *path, script **out, report *r);
void script_free(script *s);

/* Does the lines from now on. A line that fails ends the program with an error line and
 * exit code 1. */
void script_start(script *s, app *a);

/* One line, in words. NULL, or what is wrong with it. */
typedef struct script_action {
    const char *name;
    int words; /* that follow */
    const char *(*run)(script *s, char **word);
} script_action;
extern const script_action script_actions[]; /* name NULL ends them */

/* The word's half, 0 or 1; -1: neither. */
int script_half(const char *word);
bool script_number(const char *word, double *out);

/* script_measure.c: measure HALF KEY FROM TO COUNT. */
const char *script_measure(script *s, char **word);
/* start: how long it took until there was a picture. */
const char *script_start_times(script *s, char **word);

#endif

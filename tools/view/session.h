/* SPDX-License-Identifier: MIT */
/*
 * session.h: all that the viewer knows, without a window: the input, the wish, and the
 * threads that fulfil it. Windows and scripts change it by the same calls.
 */
#ifndef VIEW_SESSION_H
#define VIEW_SESSION_H

#include "common/viewer_args.h"
#include "worker.h"

typedef struct session {
    source source;
    engine engine;
    truth *truth;
    worker *worker;
    wish wish;
    float usual_radius; /* what suits the first view */
    double input_s;     /* when the mesh or the first frame was read, report_seconds() */
    report *r;
    void (*ready)(void *user); /* called by any thread: a new picture is there */
    void *user;
} session;

/* Loads the input and starts the threads; nothing is asked for yet. settings must outlive
 * it. Returns an exit code; close it in any case. */
int session_open(session *s, const viewer_settings *settings, void (*ready)(void *user),
                 void *user, report *r);
void session_close(session *s);

/* Asks for the wish as it is; returns its number. */
uint64_t session_ask(session *s);

/* Changes of a half; false, with the wish unchanged, if the text means nothing: the log
 * has a line. A new method has its own defaults and keeps the radius. */
bool session_set_method(session *s, int half, const char *name);
bool session_set_option(session *s, int half, const char *key, const char *value);
void session_set_preset(session *s, int half, crv_preset preset);
/* The method's defaults, and the radius that suits the first view. */
void session_reset(session *s, int half);

/* Takes over the options that were fitted for a half, whose truth stays what it was until
 * it gets another method or is reset. False if there are none, or its method is another
 * by now. */
bool session_take_over(session *s, const tuning *t);

/* The view that shows the whole mesh. */
void session_fit(session *s);
/* A level one from its middle along its longer side. */
void session_enter(session *s);

#endif

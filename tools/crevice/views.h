/* SPDX-License-Identifier: MIT */
/* views.h: the eyes of stereo frames, in one run. */
#ifndef TOOL_VIEWS_H
#define TOOL_VIEWS_H

#include "ao_settings.h"
#include "io.h"

enum { MAX_VIEWS = 8 };

typedef struct view_list {
    int32_t count; /* 1 without --views, of the name "" */
    char name[MAX_VIEWS][IO_VIEW_SIZE];
} view_list;

/* What is wrong with the settings, or NULL; fills *out. */
const char *views_mistake(const ao_settings *s, view_list *out);

/* Whether a name has a place for the view: %V, or %v for its first letter. */
bool views_have_place(const char *pattern);

/* Fills the places. False if the name does not fit. */
bool views_name(const char *pattern, const char *view, char *out, size_t size);

/* The name of a view's channel in a file of several: the view stands before the last
 * piece, as in "View Layer.left.AO" and "left.AO". */
void views_channel(const char *channel, const char *view, char out[IO_NAME_SIZE]);

#endif

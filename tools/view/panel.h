/* SPDX-License-Identifier: MIT */
/* panel.h: what the sidebar has for one half. */
#ifndef VIEW_PANEL_H
#define VIEW_PANEL_H

#include "app.h"

panel *panel_make(app *a, int half);
GtkWidget *panel_widget(const panel *p);
void panel_free(panel *p);

/* Shows what the wish says, which has changed elsewhere. */
void panel_sync(panel *p);

/* The numbers of the picture that is shown. */
void panel_show_numbers(panel *p);

/* How the fit to the truth stands. */
void panel_show_tuning(panel *p);

/* As the user would: the row "Shows", and the control of an option. False: no such name.
 */
bool panel_choose(panel *p, const char *content);
bool panel_set_look(panel *p, const char *look);
bool panel_slide(panel *p, const char *key, double value);

#endif

/* SPDX-License-Identifier: MIT */
/* option_row.h: a row of the option table as a label and a control. */
#ifndef VIEW_OPTION_ROW_H
#define VIEW_OPTION_ROW_H

#include <gtk/gtk.h>
#include <stdbool.h>

#include "knob.h"

typedef struct option_row {
    const crv_option *option;
    GtkWidget *widget;  /* the whole row */
    GtkWidget *slider;  /* numbers; NULL: typed in */
    GtkWidget *entry;   /* numbers */
    GtkWidget *control; /* switch or choice */
    knob knob;
    double usual;             /* the default that the view has for it; 0: none */
    const crv_method *method; /* whose default the tooltip tells; NULL: none yet */
    bool syncing;             /* the control follows the options, not the user */
    /* The user's change, as text that crv_options_set() takes. */
    void (*changed)(void *user, const crv_option *option, const char *value);
    void *user;
} option_row;

/* row must not move afterwards. usual: see knob_of(). */
void option_row_init(option_row *row, const crv_option *option, double usual,
                     void (*changed)(void *user, const crv_option *option,
                                     const char *value),
                     void *user);

/* Shows the options' value, or hides the row if these do not read it. */
void option_row_sync(option_row *row, const crv_options *options);

#endif

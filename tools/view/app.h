/* SPDX-License-Identifier: MIT */
/* app.h: what the files of the window share. Everything here is for the main thread. */
#ifndef VIEW_APP_H
#define VIEW_APP_H

#include <gtk/gtk.h>

#include "session.h"

typedef struct panel panel;
typedef struct script script;

typedef struct app {
    const viewer_settings *settings;
    session session;
    GtkWidget *window, *canvas, *status, *stack, *scrubber, *dark;
    panel *panel[HALVES];
    script *script; /* NULL: none runs */
    int result;     /* the exit code */

    shown shown; /* what is on the screen; its buffers are NULL before the first */
    cairo_surface_t *picture[HALVES];             /* over shown's pixels */
    uint64_t asked, shown_number, painted_number; /* of wishes */
    bool overlay;                                 /* line, names and scale */
    bool explains; /* horizons around the pixel under the pointer are drawn */

    double split;                /* the line between the halves, 0 to 1 */
    double zoom, left, top;      /* of frames: device px a pixel; the corner; 0: fit */
    double pointer_x, pointer_y; /* px of the widget; negative: outside */
    guint settle;                /* the timer that ends moving; 0: none runs */
    atomic_int notified;         /* a picture waits to be taken */
    char told[PROBLEM_SIZE];     /* what the status line says besides; "" */
} app;

/* app.c: a change of the wish was made: asks for the picture. */
void app_ask(app *a);
/* The view changed: coarse pictures until it is still for a while. */
void app_move(app *a);
/* A line for the status bar, which stays until the next. */
void app_tell(app *a, const char *format, ...) G_GNUC_PRINTF(2, 3);
/* The half that the sidebar shows, and which buttons and keys are about. */
int app_half(const app *a);
void app_copy_command(app *a);
void app_copy_options(app *a);
void app_set_dark(app *a, bool dark);
void app_set_frame(app *a, int index);
/* The window is called as the input, or as the frame of it. */
void app_title(app *a);
/* Writes what a half shows, without the line and the names: as `render` would. */
bool app_save(app *a, int half, const char *path);

/* window.c */
void window_make(app *a);

/* canvas.c, canvas_input.c */
GtkWidget *canvas_make(app *a);
void canvas_take_input(app *a);
/* The key's effect on the view; false: it has none. */
bool canvas_key(app *a, guint key, bool shift);
/* The pixel of the picture under a point of the widget; false: none. */
bool canvas_pixel(const app *a, double x, double y, int32_t *column, int32_t *row);
/* How the picture lies on the widget: device px a pixel, and its corner. */
void canvas_place(const app *a, double *scale_x, double *scale_y, double *x, double *y);
/* The widget's size in device px. */
void canvas_size(const app *a, int32_t *width, int32_t *height);
void canvas_fit(app *a);

/* probe.c: the pixel under the pointer in the status line. */
void probe_tell(app *a);
/* The same as text; false outside the picture. */
bool probe_text(const app *a, int32_t x, int32_t y, char *out, size_t size);

#endif

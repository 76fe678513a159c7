/* SPDX-License-Identifier: MIT */
/* app.h: what the files of the window share. Everything here is for the main thread. */
#ifndef VIEW_APP_H
#define VIEW_APP_H

#include <gtk/gtk.h>

#include "session.h"

typedef struct panel panel;
typedef struct script script;

/* A half's pixels as GTK takes them, kept while they are the same. */
typedef struct picture {
    const uint32_t *pixels;   /* which; NULL: none yet */
    cairo_surface_t *surface; /* owned; all of them, for Cairo; NULL: not made */
    /* Owned: that of the pixels before. The window's last frame was recorded with it:
     * without it now, Cairo would copy it. */
    cairo_surface_t *surface_before;
    GdkTexture *texture; /* owned; some columns, pixel by pixel; NULL: not made */
    int32_t from, to;    /* the texture's columns */
} picture;

typedef struct app {
    const viewer_settings *settings;
    session session;
    GtkWidget *window, *canvas, *status, *stack, *scrubber, *dark;
    panel *panel[HALVES];
    script *script; /* NULL: none runs */
    int result;     /* the exit code */

    shown shown; /* what is on the screen; its buffers are NULL before the first */
    picture picture[HALVES];
    uint64_t asked, shown_number, painted_number; /* of wishes */
    /* report_seconds(): of the newest picture, and of the start: the program runs, the
     * window is made, the first picture is painted. */
    double taken_s, painted_s, begun_s, window_s, first_painted_s;
    bool overlay;  /* line, names and scale */
    bool explains; /* horizons around the pixel under the pointer are drawn */

    double split;                /* the line between the halves, 0 to 1 */
    double zoom, left, top;      /* of frames: device px a pixel; the corner; 0: fit */
    double pointer_x, pointer_y; /* px of the widget; negative: outside */
    guint settle;                /* the timer that ends moving; 0: none runs */
    atomic_int notified;         /* a picture waits to be taken */
    tuning tuning;               /* the last fit */
    bool tunes_first;            /* one is to be made as soon as there is a picture */
    char told[PROBLEM_SIZE];     /* what the status line says besides; "" */
} app;

/* app.c: a change of the wish was made: asks for the picture. */
void app_ask(app *a);
/* The pixel under the pointer, or what is wanted of it, is another: asks for its samples
 * if they are drawn. */
void app_explain(app *a);
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
/* Begins to fit a half's options to the truth, or ends that with the best so far. */
void app_tune(app *a, int half);
/* The options that were fitted become the half's. False: there are none. */
bool app_take_over(app *a, int half);
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
void canvas_enter(app *a);
/* What GTK was given of the picture before. */
void canvas_forget(app *a);

/* canvas_overlay.c: the line, names and scales over the picture, in px of the widget. */
void overlay_snapshot(const app *a, GtkSnapshot *to, int width, int height);
/* White on dark; right: x is where it ends. */
void overlay_text(const app *a, GtkSnapshot *to, const char *text, double x, double y,
                  bool right);
enum { OVERLAY_MARGIN = 10 };

/* probe.c: the pixel under the pointer in the status line. */
void probe_tell(app *a);
/* The same as text; false outside the picture. */
bool probe_text(const app *a, int32_t x, int32_t y, char *out, size_t size);

#endif

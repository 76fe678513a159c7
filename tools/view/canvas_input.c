/* SPDX-License-Identifier: MIT */
/* The mouse and the keys over the picture. */
#include "app.h"

#include <math.h>

#include "common/motion.h"

/* How near to the line a drag takes it, px; how much a key does. */
static const double grip_px = 8.0, key_turn = 0.06, key_share = 0.04, key_zoom = 1.15;
static const double split_step = 0.02, turn_per_height = 3.2;
/* A double click leaves so much of the distance. */
static const double focus_factor = 0.6;

typedef struct drag {
    app *app;
    double last_x, last_y; /* offsets so far */
    bool line;
    guint button;
} drag;

static bool is_mesh(const app *a)
{
    return a->session.source.model;
}

static void redraw(app *a)
{
    gtk_widget_queue_draw(a->canvas);
}

/* Frames: from "fit" to a corner and a zoom of its own. */
static void fix_zoom(app *a)
{
    double scale_y;
    if (a->shown.buffers && !(a->zoom > 0.0))
        canvas_place(a, &a->zoom, &scale_y, &a->left, &a->top);
}

/* About a point of the widget. */
static void zoom_frame(app *a, double factor, double x, double y)
{
    const int device = gtk_widget_get_scale_factor(a->canvas);
    fix_zoom(a);
    double zoom = fmin(fmax(a->zoom * factor, 0.02), 64.0);
    if (zoom > 1.0 && factor > 1.0)
        zoom = ceil(zoom - 0.01); /* whole pixels */
    else if (zoom > 1.0)
        zoom = floor(zoom + 0.01);
    a->left = floor(x * device - (x * device - a->left) * zoom / a->zoom);
    a->top = floor(y * device - (y * device - a->top) * zoom / a->zoom);
    a->zoom = zoom;
    redraw(a);
}

static void pan_frame(app *a, double dx, double dy)
{
    const int device = gtk_widget_get_scale_factor(a->canvas);
    fix_zoom(a);
    a->left += dx * device;
    a->top += dy * device;
    redraw(a);
}

void canvas_fit(app *a)
{
    a->zoom = 0.0;
    if (is_mesh(a)) {
        session_fit(&a->session);
        app_move(a);
    }
    redraw(a);
}

void canvas_enter(app *a)
{
    if (!is_mesh(a))
        return;
    session_enter(&a->session);
    app_move(a);
}

/* What is under a point of the widget comes to the middle, from nearer. */
static bool focus_on(app *a, double x, double y)
{
    const buffers *b = a->shown.buffers;
    int32_t column, row;
    double p[3];
    if (!is_mesh(a) || !canvas_pixel(a, x, y, &column, &row)
        || !buffers_point(b, column + b->g.desc.guard_left, row + b->g.desc.guard_top, p))
        return false;
    a->session.wish.view = a->shown.wish.view;
    motion_focus(&a->session.wish.view, p, focus_factor);
    app_move(a);
    return true;
}

static void on_press(GtkGestureClick *click, int count, double x, double y, gpointer user)
{
    (void)click;
    if (count == 2)
        focus_on(user, x, y);
}

/* The pointer's place, or the middle. */
static bool focus_key(app *a)
{
    const bool inside = a->pointer_x >= 0.0;
    return focus_on(a, inside ? a->pointer_x : 0.5 * gtk_widget_get_width(a->canvas),
                    inside ? a->pointer_y : 0.5 * gtk_widget_get_height(a->canvas));
}

static void set_split(app *a, double split)
{
    a->split = fmin(fmax(split, 0.0), 1.0);
    redraw(a);
}

static void drag_view(app *a, guint button, bool shift, double dx, double dy)
{
    const double height = gtk_widget_get_height(a->canvas);
    if (!is_mesh(a)) {
        pan_frame(a, dx, dy);
        return;
    }
    scene_view *v = &a->session.wish.view;
    if (button == GDK_BUTTON_PRIMARY && !shift)
        motion_orbit(v, -turn_per_height * dx / height, turn_per_height * dy / height);
    else
        motion_pan(v, dx / height, dy / height);
    app_move(a);
}

static void on_drag_begin(GtkGestureDrag *gesture, double x, double y, gpointer user)
{
    (void)y;
    drag *d = user;
    const double line = d->app->split * gtk_widget_get_width(d->app->canvas);
    d->last_x = d->last_y = 0.0;
    d->button = gtk_gesture_single_get_current_button(GTK_GESTURE_SINGLE(gesture));
    d->line = d->button == GDK_BUTTON_PRIMARY && fabs(x - line) < grip_px;
    gtk_widget_grab_focus(d->app->canvas);
}

static void on_drag(GtkGestureDrag *gesture, double x, double y, gpointer user)
{
    drag *d = user;
    const double dx = x - d->last_x, dy = y - d->last_y;
    const GdkModifierType state =
        gtk_event_controller_get_current_event_state(GTK_EVENT_CONTROLLER(gesture));
    d->last_x = x;
    d->last_y = y;
    if (d->line)
        set_split(d->app, d->app->split + dx / gtk_widget_get_width(d->app->canvas));
    else
        drag_view(d->app, d->button, state & GDK_SHIFT_MASK, dx, dy);
}

static gboolean on_scroll(GtkEventControllerScroll *scroll, double dx, double dy,
                          gpointer user)
{
    (void)scroll;
    (void)dx;
    app *a = user;
    if (is_mesh(a)) {
        motion_dolly(&a->session.wish.view, pow(key_zoom, dy));
        app_move(a);
    } else {
        zoom_frame(a, pow(2.0, -dy), a->pointer_x, a->pointer_y);
    }
    return TRUE;
}

static void on_motion(GtkEventControllerMotion *motion, double x, double y, gpointer user)
{
    (void)motion;
    app *a = user;
    const double line = a->split * gtk_widget_get_width(a->canvas);
    a->pointer_x = x;
    a->pointer_y = y;
    gtk_widget_set_cursor_from_name(a->canvas,
                                    fabs(x - line) < grip_px ? "col-resize" : NULL);
    probe_tell(a);
    app_explain(a);
    if (a->explains)
        redraw(a);
}

static void on_leave(GtkEventControllerMotion *motion, gpointer user)
{
    (void)motion;
    app *a = user;
    a->pointer_x = -1.0;
    probe_tell(a);
}

void canvas_take_input(app *a)
{
    GtkGesture *gesture = gtk_gesture_drag_new();
    GtkGesture *click = gtk_gesture_click_new();
    GtkEventController *scroll =
        gtk_event_controller_scroll_new(GTK_EVENT_CONTROLLER_SCROLL_VERTICAL);
    GtkEventController *motion = gtk_event_controller_motion_new();
    drag *d = g_new0(drag, 1);
    d->app = a;
    gtk_gesture_single_set_button(GTK_GESTURE_SINGLE(gesture), 0);
    g_object_set_data_full(G_OBJECT(a->canvas), "drag", d, g_free);
    g_signal_connect(gesture, "drag-begin", G_CALLBACK(on_drag_begin), d);
    g_signal_connect(gesture, "drag-update", G_CALLBACK(on_drag), d);
    g_signal_connect(click, "pressed", G_CALLBACK(on_press), a);
    g_signal_connect(scroll, "scroll", G_CALLBACK(on_scroll), a);
    g_signal_connect(motion, "motion", G_CALLBACK(on_motion), a);
    g_signal_connect(motion, "leave", G_CALLBACK(on_leave), a);
    gtk_widget_add_controller(a->canvas, GTK_EVENT_CONTROLLER(gesture));
    gtk_widget_add_controller(a->canvas, GTK_EVENT_CONTROLLER(click));
    gtk_widget_add_controller(a->canvas, scroll);
    gtk_widget_add_controller(a->canvas, motion);
}

/* Arrows turn or pan the camera of a mesh, or pan a frame. */
static bool arrow_key(app *a, guint key, bool shift)
{
    const double x = key == GDK_KEY_Left ? -1.0 : key == GDK_KEY_Right ? 1.0 : 0.0;
    const double y = key == GDK_KEY_Up ? -1.0 : key == GDK_KEY_Down ? 1.0 : 0.0;
    scene_view *v = &a->session.wish.view;
    if (fabs(x) + fabs(y) < 0.5)
        return false;
    if (!is_mesh(a)) {
        pan_frame(a, -32.0 * x, -32.0 * y);
        return true;
    }
    if (shift)
        motion_pan(v, -key_share * x, -key_share * y);
    else
        motion_orbit(v, key_turn * x, -key_turn * y);
    app_move(a);
    return true;
}

static bool fly_key(app *a, guint key)
{
    static const struct {
        guint key;
        double right, up, forward;
    } keys[] = {{GDK_KEY_w, 0, 0, 1}, {GDK_KEY_s, 0, 0, -1}, {GDK_KEY_a, -1, 0, 0},
                {GDK_KEY_d, 1, 0, 0}, {GDK_KEY_e, 0, 1, 0},  {GDK_KEY_q, 0, -1, 0}};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0] && is_mesh(a); i++) {
        if (gdk_keyval_to_lower(key) != keys[i].key)
            continue;
        motion_fly(&a->session.wish.view, key_share * keys[i].right,
                   key_share * keys[i].up, key_share * keys[i].forward);
        app_move(a);
        return true;
    }
    return false;
}

static bool look_key(app *a, guint key)
{
    const double x = key == GDK_KEY_j ? -1.0 : key == GDK_KEY_l ? 1.0 : 0.0;
    const double y = key == GDK_KEY_i ? 1.0 : key == GDK_KEY_k ? -1.0 : 0.0;
    if (!is_mesh(a) || fabs(x) + fabs(y) < 0.5)
        return false;
    motion_look(&a->session.wish.view, key_turn * x, key_turn * y);
    app_move(a);
    return true;
}

static bool zoom_key(app *a, guint key)
{
    const bool nearer =
        key == GDK_KEY_plus || key == GDK_KEY_equal || key == GDK_KEY_KP_Add;
    if (!nearer && key != GDK_KEY_minus && key != GDK_KEY_KP_Subtract)
        return false;
    if (is_mesh(a)) {
        motion_dolly(&a->session.wish.view, nearer ? 1.0 / key_zoom : key_zoom);
        app_move(a);
    } else {
        zoom_frame(a, nearer ? 2.0 : 0.5, 0.5 * gtk_widget_get_width(a->canvas),
                   0.5 * gtk_widget_get_height(a->canvas));
    }
    return true;
}

static const char *const legend =
    "circle: the radius; lines: horizons, redder is higher; dots: texels that are read, "
    "orange if they count";

bool canvas_key(app *a, guint key, bool shift)
{
    if (arrow_key(a, key, shift) || fly_key(a, key) || look_key(a, key)
        || zoom_key(a, key))
        return true;
    switch (key) {
    case GDK_KEY_bracketleft:
        set_split(a, a->split - split_step);
        return true;
    case GDK_KEY_bracketright:
        set_split(a, a->split + split_step);
        return true;
    case GDK_KEY_x:
        a->explains = !a->explains;
        app_tell(a, "%s", a->explains ? legend : "");
        app_explain(a);
        redraw(a);
        return true;
    case GDK_KEY_Return:
    case GDK_KEY_KP_Enter:
        return focus_key(a);
    case GDK_KEY_c:
        canvas_enter(a);
        return is_mesh(a);
    case GDK_KEY_f:
    case GDK_KEY_Home:
        canvas_fit(a);
        return true;
    case GDK_KEY_Page_Up:
        app_set_frame(a, a->session.wish.frame - 1);
        return true;
    case GDK_KEY_Page_Down:
        app_set_frame(a, a->session.wish.frame + 1);
        return true;
    default:
        return false;
    }
}

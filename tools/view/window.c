/* SPDX-License-Identifier: MIT */
/* The window: the picture, a panel for each half, the buttons and the keys. */
#include "app.h"

#include <string.h>

#include "panel.h"

enum { SIDEBAR_WIDTH = 330 };

static void on_copy(GtkButton *button, gpointer user)
{
    (void)button;
    app_copy_command(user);
}

static void on_copy_options(GtkButton *button, gpointer user)
{
    (void)button;
    app_copy_options(user);
}

static void on_fit(GtkButton *button, gpointer user)
{
    (void)button;
    canvas_fit(user);
}

static void on_enter(GtkButton *button, gpointer user)
{
    (void)button;
    canvas_enter(user);
}

static void on_dark(GtkToggleButton *button, gpointer user)
{
    app_set_dark(user, gtk_toggle_button_get_active(button));
}

static void on_save_answer(GtkNativeDialog *dialog, int answer, gpointer user)
{
    app *a = user;
    if (answer == GTK_RESPONSE_ACCEPT) {
        GFile *file = gtk_file_chooser_get_file(GTK_FILE_CHOOSER(dialog));
        char *path = file ? g_file_get_path(file) : NULL;
        if (path)
            app_save(a, app_half(a), path);
        g_free(path);
        g_clear_object(&file);
    }
    g_object_unref(dialog);
}

static void save(app *a)
{
    GtkFileChooserNative *dialog = gtk_file_chooser_native_new(
        "Save picture (.png, .exr or .pfm)", GTK_WINDOW(a->window),
        GTK_FILE_CHOOSER_ACTION_SAVE, "_Save", "_Cancel");
    gtk_file_chooser_set_current_name(GTK_FILE_CHOOSER(dialog), "ao.png");
    gtk_native_dialog_set_modal(GTK_NATIVE_DIALOG(dialog), TRUE);
    g_signal_connect(dialog, "response", G_CALLBACK(on_save_answer), a);
    gtk_native_dialog_show(GTK_NATIVE_DIALOG(dialog));
}

static void on_save(GtkButton *button, gpointer user)
{
    (void)button;
    save(user);
}

static const char *const help_text =
    "Mouse\n"
    "  drag the line: compare      wheel: nearer, farther\n"
    "  drag: turn (frames: move)   Shift or right drag: move\n"
    "  double click: to the middle, nearer\n\n"
    "Keys in the picture\n"
    "  arrows: turn (frames: move) Shift+arrows: move\n"
    "  w s a d e q: fly            i j k l: look around\n"
    "  + -: nearer, farther        f or Home: all in view\n"
    "  Return: as a double click   c: from the middle of it\n"
    "  [ ]: the line               Page Up, Page Down: frames\n"
    "  x: what the pixel under the pointer is made of\n\n"
    "Everywhere\n"
    "  F6: picture or sidebar      Ctrl+1, Ctrl+2: left, right half\n"
    "  Ctrl+Shift+C: copy command  Ctrl+E: copy options\n"
    "  Ctrl+S: save picture        Ctrl+D: dark\n"
    "  Ctrl+T: fit to truth, stop  Ctrl+Shift+T: take over\n"
    "  F1: this                    Ctrl+Q: quit";

static gboolean on_help_key(GtkEventControllerKey *keys, guint key, guint code,
                            GdkModifierType state, gpointer user)
{
    (void)keys;
    (void)code;
    (void)state;
    if (key == GDK_KEY_Escape)
        gtk_window_close(GTK_WINDOW(user));
    return key == GDK_KEY_Escape;
}

static void show_keys(app *a)
{
    GtkWidget *window = gtk_window_new(), *label = gtk_label_new(NULL);
    char *markup = g_markup_printf_escaped("<tt>%s</tt>", help_text);
    gtk_label_set_markup(GTK_LABEL(label), markup);
    g_free(markup);
    gtk_widget_set_margin_start(label, 18);
    gtk_widget_set_margin_end(label, 18);
    gtk_widget_set_margin_top(label, 18);
    gtk_widget_set_margin_bottom(label, 18);
    gtk_window_set_title(GTK_WINDOW(window), "Mouse and keys");
    gtk_window_set_transient_for(GTK_WINDOW(window), GTK_WINDOW(a->window));
    gtk_window_set_destroy_with_parent(GTK_WINDOW(window), TRUE);
    gtk_window_set_child(GTK_WINDOW(window), label);
    GtkEventController *keys = gtk_event_controller_key_new();
    g_signal_connect(keys, "key-pressed", G_CALLBACK(on_help_key), window);
    gtk_widget_add_controller(window, keys);
    gtk_window_present(GTK_WINDOW(window));
}

static void on_keys(GtkButton *button, gpointer user)
{
    (void)button;
    show_keys(user);
}

static void other_place(app *a)
{
    GtkWidget *focus = gtk_window_get_focus(GTK_WINDOW(a->window));
    if (focus == a->canvas)
        gtk_widget_child_focus(panel_widget(a->panel[app_half(a)]), GTK_DIR_TAB_FORWARD);
    else
        gtk_widget_grab_focus(a->canvas);
}

static bool control_key(app *a, guint key, bool shift)
{
    switch (gdk_keyval_to_lower(key)) {
    case GDK_KEY_c:
        if (shift)
            app_copy_command(a);
        return shift;
    case GDK_KEY_e:
        app_copy_options(a);
        return true;
    case GDK_KEY_s:
        save(a);
        return true;
    case GDK_KEY_t:
        if (shift)
            app_take_over(a, app_half(a));
        else
            app_tune(a, app_half(a));
        return true;
    case GDK_KEY_d:
        app_set_dark(a, !gtk_toggle_button_get_active(GTK_TOGGLE_BUTTON(a->dark)));
        return true;
    case GDK_KEY_1:
        gtk_stack_set_visible_child_name(GTK_STACK(a->stack), "left");
        return true;
    case GDK_KEY_2:
        gtk_stack_set_visible_child_name(GTK_STACK(a->stack), "right");
        return true;
    case GDK_KEY_q:
        gtk_window_close(GTK_WINDOW(a->window));
        return true;
    default:
        return false;
    }
}

/* Before the focused widget, which would take arrows for moving the focus. */
static gboolean on_key(GtkEventControllerKey *keys, guint key, guint code,
                       GdkModifierType state, gpointer user)
{
    (void)keys;
    (void)code;
    app *a = user;
    const bool shift = state & GDK_SHIFT_MASK;
    if (state & GDK_CONTROL_MASK)
        return control_key(a, key, shift);
    if (key == GDK_KEY_F1)
        show_keys(a);
    else if (key == GDK_KEY_F6)
        other_place(a);
    else
        return gtk_window_get_focus(GTK_WINDOW(a->window)) == a->canvas
               && canvas_key(a, key, shift);
    return TRUE;
}

static void add_button(GtkWidget *bar, const char *label, const char *tooltip,
                       GCallback clicked, app *a)
{
    GtkWidget *button = gtk_button_new_with_label(label);
    gtk_widget_set_tooltip_text(button, tooltip);
    g_signal_connect(button, "clicked", clicked, a);
    gtk_header_bar_pack_start(GTK_HEADER_BAR(bar), button);
}

static GtkWidget *make_bar(app *a)
{
    GtkWidget *bar = gtk_header_bar_new();
    GtkWidget *keys = gtk_button_new_with_label("?");
    add_button(bar, "Fit", "all in view (f)", G_CALLBACK(on_fit), a);
    if (a->session.source.model)
        add_button(bar, "Inside", "from the middle of it (c): rooms",
                   G_CALLBACK(on_enter), a);
    add_button(bar, "Copy command",
               "the command that writes what this half shows (Ctrl+Shift+C)",
               G_CALLBACK(on_copy), a);
    add_button(bar, "Copy options", "this half's options as text (Ctrl+E)",
               G_CALLBACK(on_copy_options), a);
    add_button(bar, "Save picture", "what this half shows (Ctrl+S)", G_CALLBACK(on_save),
               a);
    a->dark = gtk_toggle_button_new_with_label("Dark");
    g_signal_connect(a->dark, "toggled", G_CALLBACK(on_dark), a);
    g_signal_connect(keys, "clicked", G_CALLBACK(on_keys), a);
    gtk_widget_set_tooltip_text(keys, "mouse and keys (F1)");
    gtk_header_bar_pack_end(GTK_HEADER_BAR(bar), keys);
    gtk_header_bar_pack_end(GTK_HEADER_BAR(bar), a->dark);
    return bar;
}

static void on_heat(GtkRange *range, gpointer user)
{
    app *a = user;
    a->session.wish.heat_scale = pow(10.0, gtk_range_get_value(range));
    app_ask(a);
}

/* From 0.01 to 1. */
static GtkWidget *make_heat(app *a)
{
    GtkWidget *row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    GtkWidget *scale =
        gtk_scale_new_with_range(GTK_ORIENTATION_HORIZONTAL, -2.0, 0.0, 0.05);
    gtk_scale_set_draw_value(GTK_SCALE(scale), FALSE);
    gtk_range_set_value(GTK_RANGE(scale), log10(a->session.wish.heat_scale));
    gtk_widget_set_hexpand(scale, TRUE);
    gtk_widget_set_tooltip_text(row, "the difference that gets the darkest colours");
    g_signal_connect(scale, "value-changed", G_CALLBACK(on_heat), a);
    gtk_box_append(GTK_BOX(row), gtk_label_new("Heat scale"));
    gtk_box_append(GTK_BOX(row), scale);
    return row;
}

static void on_page(GObject *stack, GParamSpec *spec, gpointer user)
{
    (void)stack;
    (void)spec;
    probe_tell(user);
}

static GtkWidget *make_sidebar(app *a)
{
    static const char *const names[] = {"left", "right"};
    static const char *const titles[] = {"Left half", "Right half"};
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 8);
    GtkWidget *switcher = gtk_stack_switcher_new();
    a->stack = gtk_stack_new();
    for (int i = 0; i < HALVES; i++) {
        a->panel[i] = panel_make(a, i);
        gtk_stack_add_titled(GTK_STACK(a->stack), panel_widget(a->panel[i]), names[i],
                             titles[i]);
    }
    gtk_stack_switcher_set_stack(GTK_STACK_SWITCHER(switcher), GTK_STACK(a->stack));
    gtk_widget_set_halign(switcher, GTK_ALIGN_CENTER);
    g_signal_connect(a->stack, "notify::visible-child", G_CALLBACK(on_page), a);
    gtk_widget_set_size_request(box, SIDEBAR_WIDTH, -1);
    gtk_widget_set_hexpand(box, FALSE);
    gtk_widget_set_margin_start(box, 10);
    gtk_widget_set_margin_end(box, 6);
    gtk_widget_set_margin_top(box, 8);
    gtk_widget_set_margin_bottom(box, 8);
    gtk_box_append(GTK_BOX(box), switcher);
    gtk_box_append(GTK_BOX(box), a->stack);
    gtk_box_append(GTK_BOX(box), make_heat(a));
    return box;
}

static void on_scrub(GtkRange *range, gpointer user)
{
    app_set_frame(user, (int)(gtk_range_get_value(range) + 0.5));
}

static GtkWidget *make_left(app *a)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0);
    const int last = a->session.source.frame_count - 1;
    gtk_box_append(GTK_BOX(box), canvas_make(a));
    if (last > 0) {
        a->scrubber =
            gtk_scale_new_with_range(GTK_ORIENTATION_HORIZONTAL, 0.0, last, 1.0);
        gtk_scale_set_draw_value(GTK_SCALE(a->scrubber), FALSE);
        g_signal_connect(a->scrubber, "value-changed", G_CALLBACK(on_scrub), a);
        gtk_box_append(GTK_BOX(box), a->scrubber);
    }
    a->status = gtk_label_new("");
    gtk_label_set_xalign(GTK_LABEL(a->status), 0.0f);
    gtk_label_set_ellipsize(GTK_LABEL(a->status), PANGO_ELLIPSIZE_END);
    gtk_widget_set_margin_start(a->status, 8);
    gtk_widget_set_margin_top(a->status, 4);
    gtk_widget_set_margin_bottom(a->status, 4);
    gtk_box_append(GTK_BOX(box), a->status);
    return box;
}

void window_make(app *a)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 0);
    GtkEventController *keys = gtk_event_controller_key_new();
    const arg_size size = a->settings->view.size;
    a->window = gtk_window_new();
    app_title(a);
    gtk_window_set_titlebar(GTK_WINDOW(a->window), make_bar(a));
    gtk_box_append(GTK_BOX(box), make_left(a));
    gtk_box_append(GTK_BOX(box), gtk_separator_new(GTK_ORIENTATION_VERTICAL));
    gtk_box_append(GTK_BOX(box), make_sidebar(a));
    gtk_window_set_child(GTK_WINDOW(a->window), box);
    gtk_window_set_default_size(GTK_WINDOW(a->window), size.width + SIDEBAR_WIDTH,
                                size.height + 70);
    gtk_event_controller_set_propagation_phase(keys, GTK_PHASE_CAPTURE);
    g_signal_connect(keys, "key-pressed", G_CALLBACK(on_key), a);
    gtk_widget_add_controller(a->window, keys);
    gtk_window_present(GTK_WINDOW(a->window));
    gtk_widget_grab_focus(a->canvas);
}

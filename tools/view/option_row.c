/* SPDX-License-Identifier: MIT */
#include "option_row.h"

#include <string.h>

#include "common/option_text.h"

static const double step = 0.01, page = 0.1;

static void tell(option_row *row, const char *value)
{
    if (!row->syncing)
        row->changed(row->user, row->option, value);
}

static void on_slide(GtkRange *range, gpointer user)
{
    option_row *row = user;
    char text[64];
    tell(row, option_value_text(
                  row->option, knob_value(&row->knob, gtk_range_get_value(range)), text));
}

static void on_type(GtkEntry *entry, gpointer user)
{
    tell(user, gtk_editable_get_text(GTK_EDITABLE(entry)));
}

static void on_leave(GtkEventControllerFocus *focus, gpointer user)
{
    (void)focus;
    option_row *row = user;
    on_type(GTK_ENTRY(row->entry), row);
}

static void on_switch(GObject *object, GParamSpec *spec, gpointer user)
{
    (void)spec;
    tell(user, gtk_switch_get_active(GTK_SWITCH(object)) ? "on" : "off");
}

static void on_choose(GObject *object, GParamSpec *spec, gpointer user)
{
    (void)spec;
    option_row *row = user;
    const guint index = gtk_drop_down_get_selected(GTK_DROP_DOWN(object));
    if (index != GTK_INVALID_LIST_POSITION)
        tell(row, row->option->choices[index]);
}

static GtkWidget *number_control(option_row *row)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    if (knob_is_slider(row->option)) {
        row->slider =
            gtk_scale_new_with_range(GTK_ORIENTATION_HORIZONTAL, 0.0, 1.0, step);
        gtk_range_set_increments(GTK_RANGE(row->slider), step, page);
        gtk_scale_set_draw_value(GTK_SCALE(row->slider), FALSE);
        gtk_widget_set_hexpand(row->slider, TRUE);
        g_signal_connect(row->slider, "value-changed", G_CALLBACK(on_slide), row);
        gtk_box_append(GTK_BOX(box), row->slider);
    }
    row->entry = gtk_entry_new();
    gtk_editable_set_width_chars(GTK_EDITABLE(row->entry), 8);
    gtk_editable_set_max_width_chars(GTK_EDITABLE(row->entry), 8);
    gtk_entry_set_alignment(GTK_ENTRY(row->entry), 1.0f);
    gtk_widget_set_hexpand(row->entry, !row->slider);
    g_signal_connect(row->entry, "activate", G_CALLBACK(on_type), row);
    GtkEventController *focus = gtk_event_controller_focus_new();
    g_signal_connect(focus, "leave", G_CALLBACK(on_leave), row);
    gtk_widget_add_controller(row->entry, focus);
    gtk_box_append(GTK_BOX(box), row->entry);
    return box;
}

static GtkWidget *make_control(option_row *row)
{
    switch (row->option->type) {
    case CRV_OPTION_BOOL:
        row->control = gtk_switch_new();
        gtk_widget_set_halign(row->control, GTK_ALIGN_START);
        g_signal_connect(row->control, "notify::active", G_CALLBACK(on_switch), row);
        return row->control;
    case CRV_OPTION_CHOICE:
        row->control = gtk_drop_down_new_from_strings(row->option->choices);
        g_signal_connect(row->control, "notify::selected", G_CALLBACK(on_choose), row);
        return row->control;
    case CRV_OPTION_FLOAT:
    case CRV_OPTION_INT:
        break;
    }
    return number_control(row);
}

/* "max radius px" for "max_radius_px", with the unit. */
static char *title_of(const crv_option *option)
{
    char *key = g_strdelimit(g_strdup(option->key), "_", ' ');
    char *title =
        option->unit[0] ? g_strdup_printf("%s (%s)", key, option->unit) : g_strdup(key);
    g_free(key);
    return title;
}

/* Meaning, range and default, as the tool's help has them. */
static void sync_tooltip(option_row *row, const crv_method *method)
{
    char text[OPTION_TOOLTIP_SIZE];
    if (row->method == method)
        return;
    row->method = method;
    gtk_widget_set_tooltip_text(row->widget,
                                option_tooltip(row->option, method, row->usual, text));
}

void option_row_init(option_row *row, const crv_option *option, double usual,
                     void (*changed)(void *user, const crv_option *option,
                                     const char *value),
                     void *user)
{
    *row = (option_row){.option = option,
                        .knob = knob_of(option, usual),
                        .usual = usual,
                        .changed = changed,
                        .user = user};
    char *title = title_of(option);
    GtkWidget *label = gtk_label_new(title), *control = make_control(row);
    row->widget = gtk_box_new(GTK_ORIENTATION_VERTICAL, 2);
    gtk_label_set_xalign(GTK_LABEL(label), 0.0f);
    gtk_box_append(GTK_BOX(row->widget), label);
    gtk_box_append(GTK_BOX(row->widget), control);
    /* For screen readers. */
    GtkWidget *named = row->slider ? row->slider : row->entry ? row->entry : row->control;
    gtk_accessible_update_property(GTK_ACCESSIBLE(named), GTK_ACCESSIBLE_PROPERTY_LABEL,
                                   title, -1);
    g_free(title);
}

/* Whether the option has an effect: two numbers belong to one falloff each. Methods with
 * a falloff of their own have no choice. */
static bool has_effect(const crv_option *option, const crv_options *options)
{
    if (!crv_option_applies(crv_option_find("falloff"), options->method, NULL))
        return true;
    if (strcmp(option->key, "tau") == 0)
        return options->falloff == CRV_FALLOFF_EXPONENTIAL;
    return strcmp(option->key, "u") != 0 || options->falloff == CRV_FALLOFF_ALCHEMY;
}

void option_row_sync(option_row *row, const crv_options *options)
{
    const double value = crv_options_get(options, row->option);
    const gboolean applies =
        crv_option_applies(row->option, options->method, options->filter) != 0;
    char text[64];
    row->syncing = true;
    sync_tooltip(row, options->method);
    if (gtk_widget_get_visible(row->widget) != applies)
        gtk_widget_set_visible(row->widget, applies);
    gtk_widget_set_sensitive(row->widget, has_effect(row->option, options));
    option_value_text(row->option, value, text);
    if (row->entry && strcmp(gtk_editable_get_text(GTK_EDITABLE(row->entry)), text) != 0)
        gtk_editable_set_text(GTK_EDITABLE(row->entry), text);
    if (row->slider)
        gtk_range_set_value(GTK_RANGE(row->slider), knob_position(&row->knob, value));
    if (row->option->type == CRV_OPTION_BOOL)
        gtk_switch_set_active(GTK_SWITCH(row->control), value > 0.0);
    if (row->option->type == CRV_OPTION_CHOICE)
        gtk_drop_down_set_selected(GTK_DROP_DOWN(row->control), (guint)value);
    row->syncing = false;
}

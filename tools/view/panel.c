/* SPDX-License-Identifier: MIT */
#include "panel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "option_row.h"

enum { OPTIONS_MAX = 64, CONTENTS_MAX = 64 };

/* In the order of half_look; some frames have no picture to be lit. */
static const char *const looks[] = {"accessibility", "lit", "difference", NULL};
static const char *const frame_looks[] = {"accessibility", "difference", NULL};

struct panel {
    app *app;
    int half;
    GtkWidget *box, *content, *look, *preset, *filter, *options, *numbers;
    GtkWidget *tune, *take_over, *tuned;
    const char *contents[CONTENTS_MAX]; /* methods, "truth", "open", NULL */
    int methods;
    bool syncing;
    option_row row[OPTIONS_MAX];
    int rows;
};

static half_wish *wish_of(panel *p)
{
    return &p->app->session.wish.half[p->half];
}

static void changed(panel *p)
{
    panel_sync(p);
    app_ask(p->app);
}

static void on_option(void *user, const crv_option *option, const char *value)
{
    panel *p = user;
    const half_wish *h = wish_of(p);
    const double old = crv_options_get(&h->options, option);
    if (!session_set_option(&p->app->session, p->half, option->key, value))
        app_tell(p->app, "%s: %s is not valid; see its tooltip", option->key, value);
    const double now = crv_options_get(&h->options, option);
    if (now > old || now < old)
        changed(p);
    else
        panel_sync(p);
}

static guint selected(GtkWidget *drop)
{
    return gtk_drop_down_get_selected(GTK_DROP_DOWN(drop));
}

static void on_content(GObject *object, GParamSpec *spec, gpointer user)
{
    (void)object;
    (void)spec;
    panel *p = user;
    const int index = (int)selected(p->content);
    if (p->syncing)
        return;
    if (index < p->methods) {
        if (wish_of(p)->options.method != crv_method_at(index))
            session_set_method(&p->app->session, p->half, p->contents[index]);
        wish_of(p)->content = HALF_METHOD;
    } else {
        wish_of(p)->content = index == p->methods ? HALF_TRUTH : HALF_OPEN;
    }
    changed(p);
}

static const char *const *looks_of(const panel *p)
{
    const source *s = &p->app->session.source;
    return s->model || s->has_beauty ? looks : frame_looks;
}

static half_look look_at(const panel *p, guint index)
{
    for (guint i = 0; looks[i]; i++)
        if (strcmp(looks[i], looks_of(p)[index]) == 0)
            return (half_look)i;
    return LOOK_ACCESSIBILITY;
}

static guint index_of_look(const panel *p, half_look look)
{
    guint index = 0;
    while (looks_of(p)[index + 1] && look_at(p, index) != look)
        index++;
    return index;
}

static void on_look(GObject *object, GParamSpec *spec, gpointer user)
{
    (void)object;
    (void)spec;
    panel *p = user;
    if (p->syncing)
        return;
    wish_of(p)->look = look_at(p, selected(p->look));
    changed(p);
}

static void on_preset(GObject *object, GParamSpec *spec, gpointer user)
{
    (void)object;
    (void)spec;
    panel *p = user;
    const guint index = selected(p->preset);
    if (p->syncing || index == 0)
        return;
    session_set_preset(&p->app->session, p->half, (crv_preset)(index - 1));
    changed(p);
}

static void on_filter(GObject *object, GParamSpec *spec, gpointer user)
{
    (void)object;
    (void)spec;
    panel *p = user;
    if (p->syncing)
        return;
    wish_of(p)->options.filter = crv_filter_at((int32_t)selected(p->filter) - 1);
    changed(p);
}

static void on_reset(GtkButton *button, gpointer user)
{
    (void)button;
    panel *p = user;
    session_reset(&p->app->session, p->half);
    changed(p);
}

static void on_tune(GtkButton *button, gpointer user)
{
    (void)button;
    panel *p = user;
    app_tune(p->app, p->half);
}

static void on_take_over(GtkButton *button, gpointer user)
{
    (void)button;
    panel *p = user;
    app_take_over(p->app, p->half);
}

static void append_row(GtkWidget *box, const char *title, GtkWidget *control,
                       const char *tooltip)
{
    GtkWidget *row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    GtkWidget *label = gtk_label_new(title);
    gtk_label_set_xalign(GTK_LABEL(label), 0.0f);
    gtk_label_set_width_chars(GTK_LABEL(label), 7);
    gtk_widget_set_hexpand(control, TRUE);
    gtk_widget_set_tooltip_text(row, tooltip);
    gtk_accessible_update_property(GTK_ACCESSIBLE(control), GTK_ACCESSIBLE_PROPERTY_LABEL,
                                   title, -1);
    gtk_box_append(GTK_BOX(row), label);
    gtk_box_append(GTK_BOX(row), control);
    gtk_box_append(GTK_BOX(box), row);
}

static void make_contents(panel *p)
{
    const char *shown_as[CONTENTS_MAX] = {NULL};
    for (; p->methods < CONTENTS_MAX - 3 && crv_method_at(p->methods); p->methods++)
        shown_as[p->methods] = p->contents[p->methods] = crv_method_at(p->methods)->name;
    p->contents[p->methods] = "truth";
    shown_as[p->methods] = "ray-traced truth";
    p->contents[p->methods + 1] = "open";
    shown_as[p->methods + 1] = "no occlusion";
    p->content = gtk_drop_down_new_from_strings(shown_as);
    g_signal_connect(p->content, "notify::selected", G_CALLBACK(on_content), p);
}

static void make_choices(panel *p)
{
    const char *presets[CRV_PRESET_COUNT + 2] = {"choose ..."};
    const char *filters[32] = {"none"};
    for (int i = 0; i < CRV_PRESET_COUNT; i++)
        presets[i + 1] = crv_preset_name((crv_preset)i);
    for (int i = 0; i < 30 && crv_filter_at(i); i++)
        filters[i + 1] = crv_filter_at(i)->name;
    p->look = gtk_drop_down_new_from_strings(looks_of(p));
    p->preset = gtk_drop_down_new_from_strings(presets);
    p->filter = gtk_drop_down_new_from_strings(filters);
    g_signal_connect(p->look, "notify::selected", G_CALLBACK(on_look), p);
    g_signal_connect(p->preset, "notify::selected", G_CALLBACK(on_preset), p);
    g_signal_connect(p->filter, "notify::selected", G_CALLBACK(on_filter), p);
}

static GtkWidget *make_label(void)
{
    GtkWidget *label = gtk_label_new("");
    gtk_label_set_xalign(GTK_LABEL(label), 0.0f);
    gtk_label_set_wrap(GTK_LABEL(label), TRUE);
    gtk_label_set_max_width_chars(GTK_LABEL(label), 36); /* the sidebar stays as wide */
    gtk_label_set_selectable(GTK_LABEL(label), TRUE);
    return label;
}

/* Above the options and scrolled with them: its lines take no room of the picture. */
static void make_tuning(panel *p)
{
    GtkWidget *row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    p->tune = gtk_button_new_with_label("Fit to truth");
    p->take_over = gtk_button_new_with_label("Take over");
    p->tuned = make_label();
    gtk_widget_set_tooltip_text(
        p->tune,
        "search the radius, thickness, falloff and contrast that bring this half "
        "nearest to the truth as it is now, and look whether that holds in "
        "another view (Ctrl+T)");
    gtk_widget_set_tooltip_text(
        p->take_over, "set the fitted options; the truth stays what they were fitted to "
                      "until the next method or reset (Ctrl+Shift+T)");
    g_signal_connect(p->tune, "clicked", G_CALLBACK(on_tune), p);
    g_signal_connect(p->take_over, "clicked", G_CALLBACK(on_take_over), p);
    gtk_box_append(GTK_BOX(row), p->tune);
    gtk_box_append(GTK_BOX(row), p->take_over);
    gtk_box_append(GTK_BOX(p->options), row);
    gtk_box_append(GTK_BOX(p->options), p->tuned);
    gtk_widget_set_visible(p->tuned, FALSE);
}

static GtkWidget *make_options(panel *p)
{
    GtkWidget *scrolled = gtk_scrolled_window_new();
    p->options = gtk_box_new(GTK_ORIENTATION_VERTICAL, 10);
    gtk_widget_set_margin_end(p->options, 12);
    make_tuning(p);
    for (; p->rows < OPTIONS_MAX && crv_option_at(p->rows); p->rows++) {
        const crv_option *option = crv_option_at(p->rows);
        const bool is_radius = strcmp(option->key, "radius") == 0;
        option_row_init(&p->row[p->rows], option,
                        is_radius ? (double)p->app->session.usual_radius : 0.0, on_option,
                        p);
        gtk_box_append(GTK_BOX(p->options), p->row[p->rows].widget);
    }
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(scrolled), p->options);
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scrolled), GTK_POLICY_NEVER,
                                   GTK_POLICY_AUTOMATIC);
    gtk_widget_set_vexpand(scrolled, TRUE);
    return scrolled;
}

panel *panel_make(app *a, int half)
{
    panel *p = calloc(1, sizeof *p);
    if (!p)
        return NULL;
    p->app = a;
    p->half = half;
    p->box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 8);
    make_contents(p);
    make_choices(p);
    append_row(p->box, "Shows", p->content, "what this half's accessibility comes from");
    append_row(
        p->box, "As", p->look,
        "accessibility: white is open. lit: the scene, or the frame's picture, with "
        "it. difference: left "
        "minus right; orange where the left is brighter, blue where it is darker");
    p->numbers = make_label();
    gtk_widget_set_tooltip_text(
        p->numbers, "root mean square and mean of this half minus the ray-traced truth, "
                    "over the surfaces; what the truth's own noise adds is taken off");
    gtk_box_append(GTK_BOX(p->box), p->numbers);
    gtk_box_append(GTK_BOX(p->box), gtk_separator_new(GTK_ORIENTATION_HORIZONTAL));
    GtkWidget *presets = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    GtkWidget *reset = gtk_button_new_with_label("Reset");
    g_signal_connect(reset, "clicked", G_CALLBACK(on_reset), p);
    gtk_widget_set_tooltip_text(reset,
                                "the method's defaults, and the radius that suits");
    gtk_widget_set_hexpand(p->preset, TRUE);
    gtk_box_append(GTK_BOX(presets), p->preset);
    gtk_box_append(GTK_BOX(presets), reset);
    append_row(p->box, "Preset", presets, "sets of options of the method");
    append_row(p->box, "Filter", p->filter, "smooths the method's noise");
    gtk_box_append(GTK_BOX(p->box), make_options(p));
    panel_sync(p);
    return p;
}

GtkWidget *panel_widget(const panel *p)
{
    return p->box;
}

void panel_free(panel *p)
{
    free(p);
}

static guint index_of_filter(const crv_filter *filter)
{
    for (int32_t i = 0; crv_filter_at(i); i++)
        if (crv_filter_at(i) == filter)
            return (guint)i + 1;
    return 0;
}

void panel_sync(panel *p)
{
    const half_wish *h = wish_of(p);
    int content = p->methods + (h->content == HALF_OPEN);
    for (int i = 0; i < p->methods && h->content == HALF_METHOD; i++)
        if (crv_method_at(i) == h->options.method)
            content = i;
    p->syncing = true;
    gtk_drop_down_set_selected(GTK_DROP_DOWN(p->content), (guint)content);
    gtk_drop_down_set_selected(GTK_DROP_DOWN(p->look), index_of_look(p, h->look));
    gtk_drop_down_set_selected(GTK_DROP_DOWN(p->preset), 0);
    gtk_drop_down_set_selected(GTK_DROP_DOWN(p->filter),
                               index_of_filter(h->options.filter));
    const gboolean method = h->content == HALF_METHOD;
    gtk_widget_set_sensitive(p->options, method);
    gtk_widget_set_sensitive(p->filter, method);
    gtk_widget_set_sensitive(p->preset, method);
    panel_show_tuning(p);
    for (int i = 0; i < p->rows; i++)
        option_row_sync(&p->row[i], &h->options);
    p->syncing = false;
}

void panel_show_tuning(panel *p)
{
    const half_wish *h = wish_of(p);
    const tuning *t = &p->app->tuning;
    const bool own = t->half == p->half, runs = t->phase == TUNING_RUNS;
    char text[TUNING_TEXT_SIZE];
    gtk_button_set_label(GTK_BUTTON(p->tune), own && runs ? "Stop" : "Fit to truth");
    gtk_widget_set_sensitive(p->tune, h->content == HALF_METHOD && (own || !runs));
    gtk_widget_set_sensitive(p->take_over,
                             own && t->phase == TUNING_DONE && h->content == HALF_METHOD
                                 && h->options.method == t->found.options.method);
    gtk_label_set_text(GTK_LABEL(p->tuned), own ? tuning_text(t, text) : "");
    gtk_widget_set_visible(p->tuned, own && t->phase != TUNING_NONE);
}

void panel_show_numbers(panel *p)
{
    const shown *s = &p->app->shown;
    const half_shown *h = &s->half[p->half];
    GString *text = g_string_new(NULL);
    if (h->time_ms > 0.0)
        g_string_append_printf(text, "%.1f ms", h->time_ms);
    if (h->measured)
        g_string_append_printf(text, "%sRMSE %s%.4f, bias %+.4f", text->len ? ", " : "",
                               h->rmse > 0.0 ? "" : "below ",
                               h->rmse > 0.0 ? h->rmse : h->truth.error, h->bias);
    if (h->has_truth && h->truth.passes > 0)
        g_string_append_printf(text, "%struth%s of %d rays, standard error %.4f",
                               text->len ? "\n" : "",
                               s->wish.half[p->half].keeps_target ? " of the fit," : "",
                               h->truth.passes * TRUTH_PASS_RAYS, h->truth.error);
    else if (h->has_truth)
        g_string_append_printf(text, "%struth: first rays ...", text->len ? "\n" : "");
    gtk_label_set_text(GTK_LABEL(p->numbers), text->str);
    g_string_free(text, TRUE);
}

bool panel_choose(panel *p, const char *content)
{
    for (guint i = 0; p->contents[i]; i++)
        if (strcmp(p->contents[i], content) == 0) {
            gtk_drop_down_set_selected(GTK_DROP_DOWN(p->content), i);
            return true;
        }
    return false;
}

bool panel_set_look(panel *p, const char *look)
{
    for (guint i = 0; looks_of(p)[i]; i++)
        if (strcmp(looks_of(p)[i], look) == 0) {
            gtk_drop_down_set_selected(GTK_DROP_DOWN(p->look), i);
            return true;
        }
    return false;
}

bool panel_slide(panel *p, const char *key, double value)
{
    for (int i = 0; i < p->rows; i++) {
        option_row *row = &p->row[i];
        if (strcmp(row->option->key, key) != 0 || !row->slider)
            continue;
        gtk_range_set_value(GTK_RANGE(row->slider), knob_position(&row->knob, value));
        return true;
    }
    return false;
}

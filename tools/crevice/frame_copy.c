/* SPDX-License-Identifier: MIT */
#include "frame_copy.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/multi_bounce.h"
#include "common/output.h"
#include "common/reading.h"
#include "passes/views.h"
#include "views.h"

enum { MAX_MULTIPLIED = 64 };

/* The channels of --apply, layers as their colours. */
typedef struct multiplied {
    char name[MAX_MULTIPLIED][IO_NAME_SIZE];
    const char *list[MAX_MULTIPLIED];
    int32_t count;
} multiplied;

bool append_is_wanted(const ao_settings *s)
{
    return s->append || s->apply;
}

const char *append_channel(const ao_settings *s)
{
    return s->channel ? s->channel : "AO";
}

const char *append_mistake(const ao_settings *s)
{
    if (s->channel && !append_is_wanted(s))
        return "--channel: is for --append; add that";
    if (s->replace && !s->append)
        return "--replace: is for --append; add that";
    if (s->tint.given && !s->apply)
        return "--tint: is for --apply; add that";
    double albedo[3];
    if (s->albedo && !s->apply)
        return "--albedo: is for --apply; add that";
    if (s->albedo && multi_bounce_parse(s->albedo, albedo)
        && !multi_bounce_is_albedo(albedo))
        return "--albedo: must lie between 0 (black) and 1; give RHO, R,G,B or the name "
               "of a colour pass";
    for (int i = 0; s->tint.given && i < 3; i++)
        if (!(s->tint.value[i] >= 0.0 && s->tint.value[i] <= 1.0))
            return "--tint: must lie between 0 (black) and 1; give R,G,B";
    if (append_is_wanted(s) && s->aa.value > 1)
        return "--aa: the result is smaller than the frame and cannot be put into it; "
               "leave out --append and --apply";
    if (append_is_wanted(s) && !io_keeps_windows(s->output))
        return s->append ? "--append: keeps the channels of the frame, which only .exr "
                           "can; write .exr"
                         : "--apply: keeps the channels of the frame, which only .exr "
                           "can; write .exr";
    return NULL;
}

static bool add(multiplied *m, const char *name)
{
    if (m->count == MAX_MULTIPLIED)
        return false;
    snprintf(m->name[m->count], IO_NAME_SIZE, "%s", name);
    m->list[m->count] = m->name[m->count];
    m->count++;
    return true;
}

/* Whether a channel is meant by NAME: its own, or a colour of that layer. In a file of
 * several views the view is left out of the channel's name. */
static bool is_meant(const io_channel *channel, const char *name, const char *view,
                     bool *is_colour)
{
    char plain[IO_NAME_SIZE];
    const size_t length = strlen(name);
    snprintf(plain, sizeof plain, "%s", channel->name);
    if (view[0] && !io_channel_is_of_view(channel, view, plain))
        return false;
    *is_colour = !strncmp(plain, name, length) && plain[length] == '.'
                 && strchr("RGBrgb", plain[length + 1]) && plain[length + 1]
                 && !plain[length + 2];
    return *is_colour || !strcmp(plain, name);
}

/* A channel as it is called, or a layer's red, green and blue; a name that is neither is
 * left to io_append(), which lists those that there are. */
static bool add_channels(multiplied *m, const io_image *probed, const char *name,
                         const char *view)
{
    bool room = true, found = false, is_colour;
    for (int pass = 0; pass < 2 && !found; pass++)
        for (int32_t i = 0; i < probed->channel_count; i++)
            if (is_meant(&probed->channels[i], name, view, &is_colour)
                && is_colour == (pass == 1)) {
                room = room && add(m, probed->channels[i].name);
                found = true;
            }
    return found ? room : add(m, name);
}

/* The red, green and blue of --albedo's layer, or its one channel for all of them; none
 * if it is a number. Names point into the probed image. */
static int find_albedo(const ao_settings *s, const char *input, const io_image *probed,
                       const char *view, const char *names[3], report *r)
{
    static const char letters[] = "RGBrgb";
    double constant[3];
    names[0] = names[1] = names[2] = NULL;
    if (!s->albedo || multi_bounce_parse(s->albedo, constant))
        return EXIT_DONE;
    for (int32_t i = 0; i < probed->channel_count; i++) {
        const char *name = probed->channels[i].name;
        bool is_colour;
        if (!is_meant(&probed->channels[i], s->albedo, view, &is_colour))
            continue;
        const size_t letter = strcspn(letters, name + strlen(name) - 1);
        for (size_t k = 0; k < 3; k++)
            if (!is_colour || letter % 3 == k)
                names[k] = name;
    }
    if (names[0] && names[1] && names[2])
        return EXIT_DONE;
    report_error(r,
                 "%s: has no colours \"%s\" for --albedo; name a layer of red, green and "
                 "blue, or give a number",
                 input, s->albedo);
    return EXIT_FAILED;
}

/* The albedo of the result's pixels; 0 where the pass does not cover them. */
static int fill_albedo(const ao_settings *s, const char *input, const char *view,
                       io_image *out, report *r)
{
    const size_t count = (size_t)out->width * (size_t)out->height;
    const char *names[3];
    double constant[3];
    io_image probed = {0}, pass = {0};
    if (multi_bounce_parse(s->albedo, constant)) {
        for (int k = 0; k < 3; k++)
            for (size_t i = 0; i < count; i++)
                out->channels[k].data[i] = (float)constant[k];
        return EXIT_DONE;
    }
    if (io_probe(input, &probed, &r->logger) != 0)
        return EXIT_FAILED;
    int code = find_albedo(s, input, &probed, view, names, r);
    if (code == EXIT_DONE
        && reading_picture(input, names, names[0] == names[1] ? 1 : 3, &pass, &r->logger,
                           r)
               != 0)
        code = EXIT_FAILED;
    for (int k = 0; k < 3 && code == EXIT_DONE; k++)
        io_copy_window(&pass, io_image_find(&pass, names[k])->data, out,
                       out->channels[k].data);
    io_image_free(&pass);
    io_image_free(&probed);
    return code;
}

/* What the result's colours are multiplied by with --albedo; the caller frees it. */
static int make_factors(const ao_settings *s, const char *input, const ao_result *result,
                        const char *view, io_image *out, report *r)
{
    static const char *const colours[] = {"R", "G", "B"};
    const io_image *ao = &result->ao;
    const size_t count = (size_t)ao->width * (size_t)ao->height;
    if (io_image_init(out, ao->width, ao->height, colours, 3, &r->logger) != 0)
        return EXIT_FAILED;
    out->data_x = ao->data_x;
    out->data_y = ao->data_y;
    const int code = fill_albedo(s, input, view, out, r);
    for (int k = 0; k < 3 && code == EXIT_DONE; k++)
        multi_bounce_plane(ao->channels[0].data, out->channels[k].data, count,
                           out->channels[k].data);
    return code;
}

static int find_multiplied(const ao_settings *s, const char *input, const char *view,
                           multiplied *m, report *r)
{
    const char *albedo[3];
    io_image probed = {0};
    m->count = 0;
    if (!s->apply)
        return EXIT_DONE;
    if (io_probe(input, &probed, &r->logger) != 0)
        return EXIT_FAILED;
    if (find_albedo(s, input, &probed, view, albedo, r) != EXIT_DONE) {
        io_image_free(&probed);
        return EXIT_FAILED;
    }
    bool room = true;
    for (const char *at = s->apply; room && at; at = strchr(at, ',')) {
        char name[IO_NAME_SIZE];
        at += *at == ',';
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at, ","), at);
        room = add_channels(m, &probed, name, view);
    }
    io_image_free(&probed);
    if (!room)
        report_error(r,
                     "--apply: names more than %d channels; name layers in several runs",
                     MAX_MULTIPLIED);
    return room ? EXIT_DONE : EXIT_USAGE;
}

static io_append_options options_of(const ao_settings *s)
{
    return (io_append_options){.half = s->half,
                               .replace = s->replace,
                               .tint = {(float)s->tint.value[0], (float)s->tint.value[1],
                                        (float)s->tint.value[2]}};
}

/* The view that names of channels of a file of several views hold; else "". */
static const char *view_in_file(const ao_result *results, int32_t count, int32_t i)
{
    return count > 1 ? results[i].view : "";
}

/* What becomes of the results, and the names that this takes. */
typedef struct appended {
    io_addition additions[MAX_VIEWS * 4]; /* of a view in a row, accessibility first */
    int32_t count, first[MAX_VIEWS];
    char bent[MAX_VIEWS * 4][IO_NAME_SIZE];
    multiplied multiplied[MAX_VIEWS];
} appended;

static void add_bent_normals(const ao_result *result, const char *beside, appended *a)
{
    for (int32_t k = 1; k <= 3; k++) {
        char *name = a->bent[a->count];
        bent_name(result->bent_layer, k, name);
        a->additions[a->count++] = (io_addition){.channel = k,
                                                 .beside = beside,
                                                 .name = name,
                                                 .is_added = true,
                                                 .zero_outside = true,
                                                 .part = result->bent_layer};
    }
}

/* The caller frees *out, also after an error. */
static int make_additions(const ao_settings *s, const char *input,
                          const ao_result *results, int32_t count, appended **out,
                          report *r)
{
    appended *a = *out = calloc(1, sizeof *a);
    int result = a ? EXIT_DONE : report_no_memory(r);
    for (int32_t i = 0; i < count && result == EXIT_DONE; i++) {
        multiplied *m = &a->multiplied[i];
        const char *beside = results[i].frame.image.channels[0].name;
        result = find_multiplied(s, input, view_in_file(results, count, i), m, r);
        a->first[i] = a->count;
        a->additions[a->count++] = (io_addition){.beside = beside,
                                                 .name = results[i].channel,
                                                 .is_added = s->append,
                                                 .multiplied_count = m->count,
                                                 .multiplied = m->list};
        if (s->append && s->common.options.bent_normal)
            add_bent_normals(&results[i], beside, a);
    }
    return result;
}

int append_check(const ao_settings *s, const char *input, const ao_result *results,
                 int32_t count, report *r)
{
    appended *a = NULL;
    if (!append_is_wanted(s))
        return EXIT_DONE;
    if (!io_keeps_windows(input)) {
        report_error(r,
                     "%s: has no channels to keep; leave out --append and --apply, or "
                     "give an .exr",
                     input);
        return EXIT_FAILED;
    }
    int result = make_additions(s, input, results, count, &a, r);
    const io_append_options options = options_of(s);
    const crv_logger quiet = report_errors_only(r);
    if (result == EXIT_DONE
        && io_append_check(input, a->additions, a->count, &options, &quiet) != 0)
        result = EXIT_FAILED;
    free(a);
    return result;
}

int append_write(const ao_settings *s, const char *input, const char *output,
                 const ao_result *results, int32_t count, report *r)
{
    appended *a = NULL;
    io_image factors[MAX_VIEWS] = {{0}};
    int result = make_additions(s, input, results, count, &a, r);
    const io_append_options options = options_of(s);
    for (int32_t i = 0; i < count && result == EXIT_DONE; i++) {
        const int32_t end = i + 1 < count ? a->first[i + 1] : a->count;
        for (int32_t k = a->first[i]; k < end; k++)
            a->additions[k].picture = &results[i].ao;
        a->additions[a->first[i]].made = results[i].ao.made;
        if (s->albedo) {
            result = make_factors(s, input, &results[i], view_in_file(results, count, i),
                                  &factors[i], r);
            a->additions[a->first[i]].factors = &factors[i];
        }
    }
    if (result == EXIT_DONE)
        result = output_append(input, output, a->additions, a->count, &options, r);
    for (int32_t i = 0; i < count; i++)
        io_image_free(&factors[i]);
    free(a);
    return result;
}

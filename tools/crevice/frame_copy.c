/* SPDX-License-Identifier: MIT */
#include "frame_copy.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/output.h"
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

static int find_multiplied(const ao_settings *s, const char *input, const char *view,
                           multiplied *m, report *r)
{
    io_image probed = {0};
    m->count = 0;
    if (!s->apply)
        return EXIT_DONE;
    if (io_probe(input, &probed, &r->logger) != 0)
        return EXIT_FAILED;
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

/* Fills an addition for each result. The caller frees *names. */
static int make_additions(const ao_settings *s, const char *input,
                          const ao_result *results, int32_t count,
                          io_addition additions[MAX_VIEWS], multiplied **names, report *r)
{
    multiplied *m = calloc((size_t)count, sizeof *m);
    int result = m ? EXIT_DONE : report_no_memory(r);
    for (int32_t i = 0; i < count && result == EXIT_DONE; i++) {
        result = find_multiplied(s, input, count > 1 ? results[i].view : "", &m[i], r);
        additions[i] = (io_addition){.beside = results[i].frame.image.channels[0].name,
                                     .name = results[i].channel,
                                     .is_added = s->append,
                                     .multiplied_count = m[i].count,
                                     .multiplied = m[i].list};
    }
    *names = m;
    return result;
}

int append_check(const ao_settings *s, const char *input, const ao_result *results,
                 int32_t count, report *r)
{
    multiplied *names = NULL;
    io_addition additions[MAX_VIEWS];
    if (!append_is_wanted(s))
        return EXIT_DONE;
    if (!io_keeps_windows(input)) {
        report_error(r,
                     "%s: has no channels to keep; leave out --append and --apply, or "
                     "give an .exr",
                     input);
        return EXIT_FAILED;
    }
    int result = make_additions(s, input, results, count, additions, &names, r);
    const io_append_options options = options_of(s);
    const crv_logger quiet = report_errors_only(r);
    if (result == EXIT_DONE
        && io_append_check(input, additions, count, &options, &quiet) != 0)
        result = EXIT_FAILED;
    free(names);
    return result;
}

int append_write(const ao_settings *s, const char *input, const char *output,
                 const ao_result *results, int32_t count, report *r)
{
    multiplied *names = NULL;
    io_addition additions[MAX_VIEWS];
    int result = make_additions(s, input, results, count, additions, &names, r);
    const io_append_options options = options_of(s);
    for (int32_t i = 0; i < count && result == EXIT_DONE; i++) {
        additions[i].picture = &results[i].ao;
        additions[i].made = results[i].ao.made;
    }
    if (result == EXIT_DONE)
        result = output_append(input, output, additions, count, &options, r);
    free(names);
    return result;
}

/* SPDX-License-Identifier: MIT */
#include "frame_copy.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "common/output.h"

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

/* A channel as it is called, or a layer's red, green and blue; a name that is neither is
 * left to io_append(), which lists those that there are. */
static bool add_channels(multiplied *m, const io_image *probed, const char *name)
{
    static const char letters[] = "RGB";
    const size_t length = strlen(name);
    bool room = true, found = false;
    if (io_image_find(probed, name))
        return add(m, name);
    for (int c = 0; c < 3; c++)
        for (int32_t i = 0; i < probed->channel_count; i++) {
            const char *channel = probed->channels[i].name;
            if (strncmp(channel, name, length) || channel[length] != '.'
                || strncasecmp(channel + length + 1, &letters[c], 1)
                || channel[length + 2] != '\0')
                continue;
            room = room && add(m, channel);
            found = true;
        }
    return found ? room : add(m, name);
}

static int find_multiplied(const ao_settings *s, const char *input, multiplied *m,
                           report *r)
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
        room = add_channels(m, &probed, name);
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

static io_addition addition_of(const ao_settings *s, const io_frame *frame,
                               const multiplied *m)
{
    return (io_addition){.beside = frame->image.channels[0].name,
                         .name = append_channel(s),
                         .is_added = s->append,
                         .multiplied_count = m->count,
                         .multiplied = m->list};
}

int append_check(const ao_settings *s, const char *input, const io_frame *frame,
                 report *r)
{
    multiplied m;
    if (!append_is_wanted(s))
        return EXIT_DONE;
    if (!io_keeps_windows(input)) {
        report_error(r,
                     "%s: has no channels to keep; leave out --append and --apply, or "
                     "give an .exr",
                     input);
        return EXIT_FAILED;
    }
    const int result = find_multiplied(s, input, &m, r);
    if (result != EXIT_DONE)
        return result;
    const io_addition addition = addition_of(s, frame, &m);
    const io_append_options options = options_of(s);
    const crv_logger quiet = report_errors_only(r);
    return io_append_check(input, &addition, 1, &options, &quiet) == 0 ? EXIT_DONE
                                                                       : EXIT_FAILED;
}

int append_write(const ao_settings *s, const char *input, const char *output,
                 const io_frame *frame, const io_image *ao, report *r)
{
    multiplied m;
    const int result = find_multiplied(s, input, &m, r);
    if (result != EXIT_DONE)
        return result;
    io_addition addition = addition_of(s, frame, &m);
    const io_append_options options = options_of(s);
    addition.picture = ao;
    addition.made = ao->made;
    return output_append(input, output, &addition, 1, &options, r);
}

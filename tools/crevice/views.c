/* SPDX-License-Identifier: MIT */
#include "views.h"

#include <stdio.h>
#include <string.h>

static bool parse(const char *text, view_list *out)
{
    *out = (view_list){0};
    for (const char *at = text; at; at = strchr(at, ',')) {
        at += *at == ',' && at > text;
        const size_t length = strcspn(at, ",");
        if (out->count == MAX_VIEWS || length == 0 || length >= IO_VIEW_SIZE)
            return false;
        snprintf(out->name[out->count], IO_VIEW_SIZE, "%.*s", (int)length, at);
        for (int32_t i = 0; i < out->count; i++)
            if (!strcmp(out->name[i], out->name[out->count]))
                return false;
        out->count++;
    }
    return true;
}

bool views_have_place(const char *pattern)
{
    return strstr(pattern, "%V") || strstr(pattern, "%v");
}

/* Whether the name is the same for two views: left and lower, with %v. */
static bool is_shared(const char *pattern, const view_list *views)
{
    char a[4096], b[4096];
    for (int32_t i = 0; i < views->count; i++)
        for (int32_t j = 0; j < i; j++)
            if (views_name(pattern, views->name[i], a, sizeof a)
                && views_name(pattern, views->name[j], b, sizeof b) && !strcmp(a, b))
                return true;
    return false;
}

const char *views_mistake(const ao_settings *s, view_list *out)
{
    const bool places = views_have_place(s->output);
    *out = (view_list){.count = 1};
    if (!s->views)
        return views_have_place(s->input) || places
                       || (s->bent.output && views_have_place(s->bent.output))
                   ? "--views: is missing for a name with %V in it; add --views "
                     "left,right"
                   : NULL;
    if (!parse(s->views, out))
        return "--views: takes up to 8 different names with commas in between, such as "
               "left,right";
    if (s->passes.depth || (s->passes.normal && strcmp(s->passes.normal, "none") != 0))
        return "--views: finds the passes of each view by their names; leave out --depth "
               "and --normal";
    if (s->bent.output && out->count > 1
        && (!views_have_place(s->bent.output) || is_shared(s->bent.output, out)))
        return "--bent-output: needs a file for each view; name it with %V";
    if (places && is_shared(s->output, out))
        return "-o: two views have one file name; use %V instead of %v";
    if (!places && out->count > 1 && !io_keeps_windows(s->output))
        return "-o: only .exr holds several views; write .exr, or a file for each, named "
               "with %V";
    if (!places && out->count > 1 && (s->append || s->apply)
        && views_have_place(s->input))
        return "-o: the views come from several files; name the outputs with %V";
    if ((s->receive || s->occlude) && out->count > 1 && !views_have_place(s->input))
        return "--views: mattes are those of one view; give a file for each view, named "
               "with %V";
    return NULL;
}

bool views_name(const char *pattern, const char *view, char *out, size_t size)
{
    size_t used = 0;
    while (*pattern) {
        const bool is_place =
            pattern[0] == '%' && (pattern[1] == 'V' || pattern[1] == 'v');
        const int length = !is_place ? snprintf(out + used, size - used, "%c", *pattern)
                           : pattern[1] == 'V'
                               ? snprintf(out + used, size - used, "%s", view)
                               : snprintf(out + used, size - used, "%.1s", view);
        if (length < 0 || (size_t)length >= size - used)
            return false;
        used += (size_t)length;
        pattern += is_place ? 2 : 1;
    }
    return used < size;
}

void views_channel(const char *channel, const char *view, char out[IO_NAME_SIZE])
{
    const char *dot = strrchr(channel, '.');
    const char *last = dot ? dot + 1 : channel;
    snprintf(out, IO_NAME_SIZE, "%.*s%s%s%s", (int)(last - channel), channel, view,
             view[0] ? "." : "", last);
}

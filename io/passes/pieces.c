/* SPDX-License-Identifier: MIT */
/*
 * pieces.c: a channel is "PREFIX.LAYER.VIEW.COMPONENT", of which the prefix ("ViewLayer",
 * a part's name) may be anything and may be missing, and the view ("left") is there in
 * stereo frames only. Case does not matter.
 */
#include "pieces.h"

#include <stdio.h>
#include <string.h>

#include "system/text.h"

#define COUNT(a) (sizeof(a) / sizeof(a)[0])

bool io__same_text(const char *a, size_t length, const char *b)
{
    return strlen(b) == length && text_is_same_start(a, b, length);
}

bool io__contains(const char *text, size_t length, const char *word)
{
    const size_t size = strlen(word);
    for (size_t i = 0; i + size <= length; i++)
        if (text_is_same_start(text + i, word, size))
            return true;
    return false;
}

static bool is_view(const char *text, size_t length)
{
    static const char *const views[] = {"left", "right", "center", "centre", "l", "r"};
    for (size_t i = 0; i < COUNT(views); i++)
        if (io__same_text(text, length, views[i]))
            return true;
    return false;
}

static const char *piece_before(const char *name, const char *end)
{
    while (end > name && end[-1] != '.')
        end--;
    return end;
}

io__pieces io__split_layer(const char *name, const char *end)
{
    io__pieces s = {.view = end, .component = ""};
    const char *layer = piece_before(name, end);
    /* A view stands behind a layer; alone it may be a part's name. */
    if (layer > name && is_view(layer, (size_t)(end - layer))) {
        s.view = layer;
        s.view_length = (size_t)(end - layer);
        end = layer - 1;
        layer = piece_before(name, end);
    }
    s.layer = layer;
    s.prefix = (size_t)(layer - name);
    s.layer_length = (size_t)(end - layer);
    return s;
}

io__pieces io__split_channel(const char *name, bool with_component)
{
    const char *dot = with_component ? strrchr(name, '.') : NULL;
    io__pieces s = io__split_layer(name, dot ? dot : name + strlen(name));
    s.component = dot ? dot + 1 : "";
    return s;
}

int io__row_of(const io__pieces *s, io_pass_kind kind)
{
    int rank = 0;
    for (size_t i = 0; i < io_convention_count; i++) {
        if (io_conventions[i].kind != kind)
            continue;
        if (io__same_text(s->layer, s->layer_length, io_conventions[i].name))
            return rank;
        rank++;
    }
    return -1;
}

const char *io__find_name(const io_image *image, const char *name)
{
    for (int32_t i = 0; i < image->channel_count; i++)
        if (text_is_same(image->channels[i].name, name))
            return image->channels[i].name;
    return NULL;
}

bool io__find_components(const io_image *probed, const char *base, size_t length,
                         const char *found[3])
{
    static const char *const sets[][3] = {
        {".X", ".Y", ".Z"}, {".R", ".G", ".B"}, {"X", "Y", "Z"}};
    for (size_t set = 0; set < COUNT(sets); set++) {
        int c = 0;
        for (; c < 3; c++) {
            char name[IO_NAME_SIZE + 8];
            snprintf(name, sizeof name, "%.*s%s", (int)length, base, sets[set][c]);
            found[c] = io__find_name(probed, name);
            if (!found[c])
                break;
        }
        if (c == 3)
            return true;
    }
    found[0] = found[1] = found[2] = NULL;
    return false;
}

size_t io__vector_base_length(const char *name)
{
    const size_t length = strlen(name);
    const char last = length ? name[length - 1] : '\0';
    if (length >= 3 && name[length - 2] == '.' && strchr("XxRr", last))
        return length - 2;
    return length >= 2 && (last == 'X' || last == 'x') ? length - 1 : 0;
}

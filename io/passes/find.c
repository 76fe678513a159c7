/* SPDX-License-Identifier: MIT */
/* find.c: passes by their usual names, without a word about it. */
#include <string.h>

#include "names.h"
#include "passes.h"
#include "pieces.h"
#include "system/text.h"

/* Whether a name begins or ends with the word "AO". */
static bool has_ao(const char *layer, size_t length)
{
    return length > 3
           && ((text_is_same_start(layer, "ao", 2) && strchr("_- ", layer[2]))
               || (text_is_same_start(layer + length - 2, "ao", 2)
                   && strchr("_- ", layer[length - 3])));
}

static int ao_rank_of(const char *name, bool with_component)
{
    static const char *const components[] = {"R", "V", "Y"};
    const io__pieces s = io__split_channel(name, with_component);
    int component = 0;
    while (with_component && component < 3
           && !text_is_same(s.component, components[component]))
        component++;
    if (component == 3 || (with_component && !s.component[0]))
        return IO__NO_MATCH;
    const int row = io__row_of(&s, IO_PASS_AO);
    if (row >= 0)
        return 4 * row + component;
    return io__contains(s.layer, s.layer_length, "occlusion")
                   || has_ao(s.layer, s.layer_length)
               ? IO__LOOKS_LIKE + component
               : IO__NO_MATCH;
}

static int find_ao(const io_image *probed, const char *found[3])
{
    int best = IO__NO_MATCH;
    for (int32_t i = 0; i < probed->channel_count; i++) {
        const char *name = probed->channels[i].name;
        for (int with = 0; with < 2; with++) {
            const int rank = ao_rank_of(name, with);
            if (rank < best) {
                best = rank;
                found[0] = name;
            }
        }
    }
    return best < IO__NO_MATCH ? 1 : 0;
}

static int find_bent_normals(const io_image *probed, const char *found[3])
{
    int best = IO__NO_MATCH;
    for (int32_t i = 0; i < probed->channel_count; i++) {
        const char *name = probed->channels[i].name, *components[3];
        const size_t length = io__vector_base_length(name);
        const io__pieces s = io__split_layer(name, name + length);
        const int row = length ? io__row_of(&s, IO_PASS_BENT_NORMAL) : -1;
        if (row < 0 || row >= best
            || !io__find_components(probed, name, length, components))
            continue;
        best = row;
        memcpy(found, components, sizeof components);
    }
    return best < IO__NO_MATCH ? 3 : 0;
}

/* Whether the channel is a red with a green and a blue beside it, which it fills in. */
static bool find_colours(const io_image *probed, const char *red, const char *found[3])
{
    char name[IO_NAME_SIZE];
    const size_t last = strlen(red) - 1;
    found[0] = red;
    for (int c = 1; c < 3; c++) {
        memcpy(name, red, last + 2);
        name[last] = red[last] == 'R' ? "RGB"[c] : "rgb"[c];
        found[c] = io__find_name(probed, name);
    }
    return found[1] && found[2];
}

/* A lone R, G, B comes after the rows of the table. */
static int find_beauty(const io_image *probed, const char *found[3])
{
    int best = IO__NO_MATCH;
    for (int32_t i = 0; i < probed->channel_count; i++) {
        const char *name = probed->channels[i].name, *colours[3];
        const io__pieces s = io__split_channel(name, true);
        const bool is_lone = text_is_same(name, "R");
        const int row =
            text_is_same(s.component, "R") ? io__row_of(&s, IO_PASS_BEAUTY) : -1;
        const int rank = is_lone ? IO__LOOKS_LIKE : row >= 0 ? row : IO__NO_MATCH;
        if (rank < best && find_colours(probed, name, colours)) {
            best = rank;
            memcpy(found, colours, sizeof colours);
        }
    }
    return best < IO__NO_MATCH ? 3 : 0;
}

int io_find_pass(const io_image *probed, io_pass_kind kind, const char *found[3])
{
    const io_passes_request request = {0};
    io__pass_names names = {0};
    if (kind == IO_PASS_AO)
        return find_ao(probed, found);
    if (kind == IO_PASS_BENT_NORMAL)
        return find_bent_normals(probed, found);
    if (kind == IO_PASS_BEAUTY)
        return find_beauty(probed, found);
    if (io__choose_depth("", probed, &request, &names, NULL))
        return 0;
    /* A lone Y may be anything. */
    if (kind == IO_PASS_DEPTH && !names.position[0] && !text_is_same(names.depth[0], "Y")
        && !text_is_same(names.depth[0], "V")) {
        found[0] = names.depth[0];
        return 1;
    }
    if (kind == IO_PASS_NORMAL && !io__choose_normals("", probed, &request, &names, NULL)
        && names.normal[0]) {
        memcpy(found, names.normal, sizeof names.normal);
        return 3;
    }
    if (kind == IO_PASS_POSITION && names.position[0]) {
        memcpy(found, names.position, sizeof names.position);
        return 3;
    }
    return 0;
}

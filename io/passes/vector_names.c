/* SPDX-License-Identifier: MIT */
/* vector_names.c: which layers are normals and positions. */
#include <string.h>

#include "internal.h"
#include "names.h"
#include "pieces.h"

static const char *normal_remedy(const io_passes_request *request)
{
    return request->remedies.normal ? request->remedies.normal : "name the normals";
}

static int position_rank(const char *name, size_t length)
{
    static const char *const others[] = {"ref",   "rest",   "object",
                                         "local", "screen", "composition"};
    const io__pieces s = io__split_layer(name, name + length);
    const int row = io__row_of(&s, IO_PASS_POSITION);
    const int right = s.view_length && strchr("rR", s.view[0]) ? 1 : 0;
    if (row >= 0)
        return 2 * row + right;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        if (io__contains(s.layer, s.layer_length, others[i]))
            return IO__NO_MATCH;
    return io__contains(s.layer, s.layer_length, "position") ? IO__LOOKS_LIKE + right
                                                             : IO__NO_MATCH;
}

bool io__find_positions(const io_image *probed, io__pass_names *out)
{
    int best_rank = IO__NO_MATCH;
    for (int32_t i = 0; i < probed->channel_count; i++) {
        const char *name = probed->channels[i].name;
        const char *found[3];
        const size_t length = io__vector_base_length(name);
        const int rank = length ? position_rank(name, length) : IO__NO_MATCH;
        if (rank >= best_rank || !io__find_components(probed, name, length, found))
            continue;
        best_rank = rank;
        memcpy(out->position, found, sizeof found);
    }
    return best_rank < IO__NO_MATCH;
}

bool io__request_positions(const io_image *probed, const char *wanted,
                           io__pass_names *out)
{
    const char *found[3];
    if (io_image_find(probed, wanted)
        || !io__find_components(probed, wanted, strlen(wanted), found))
        return false;
    /* A grey depth may have been written as colour. */
    const size_t length = strlen(found[0]);
    if (strchr("Rr", found[0][length - 1])
        && position_rank(wanted, strlen(wanted)) == IO__NO_MATCH)
        return false;
    memcpy(out->position, found, sizeof found);
    return true;
}

/* Whether the normals are of the depth's part or view layer, and of its eye. Of "right.Z"
 * the prefix is "right": that is no name for depth, but a view or a layer. */
static bool is_together(const io__pass_names *chosen, const char *name,
                        const io__pieces *normal)
{
    const char *depth = chosen->depth[0];
    const size_t base = chosen->position[0] ? io__vector_base_length(depth) : 0;
    const io__pieces s =
        base ? io__split_layer(depth, depth + base) : io__split_channel(depth, true);
    const bool named =
        base || !s.component[0] || io__depth_name_rank(depth, true) < IO__NO_MATCH;
    const size_t prefix = named ? s.prefix : s.prefix + s.layer_length + 1;
    if (!named && s.view_length) { /* "part.left.Z" goes with "part.left.N.X", too */
        const size_t part = prefix + s.view_length + 1;
        if (part == normal->prefix && text_is_same_start(name, depth, part))
            return true;
    }
    return prefix == normal->prefix && text_is_same_start(name, depth, prefix)
           && s.view_length == normal->view_length
           && text_is_same_start(s.view, normal->view, s.view_length);
}

static int normal_rank(const char *name, size_t length, const io__pass_names *chosen)
{
    const io__pieces s = io__split_layer(name, name + length);
    const int apart = is_together(chosen, name, &s) ? 0 : (int)io_convention_count;
    const int row = io__row_of(&s, IO_PASS_NORMAL);
    if (row >= 0)
        return apart + row;
    return io__contains(s.layer, s.layer_length, "normal") ? IO__LOOKS_LIKE + apart
                                                           : IO__NO_MATCH;
}

static void find_normals(const char *path, const io_image *probed,
                         const io_passes_request *request, io__pass_names *out,
                         const crv_logger *log)
{
    int best_rank = IO__NO_MATCH, matches = 0;
    for (int32_t i = 0; i < probed->channel_count; i++) {
        const char *name = probed->channels[i].name;
        const char *found[3];
        const size_t length = io__vector_base_length(name);
        const int rank = length ? normal_rank(name, length, out) : IO__NO_MATCH;
        if (rank == IO__NO_MATCH || !io__find_components(probed, name, length, found))
            continue;
        matches++;
        if (rank >= best_rank)
            continue;
        best_rank = rank;
        memcpy(out->normal, found, sizeof found);
        snprintf(out->normal_base, sizeof out->normal_base, "%.*s", (int)length, name);
    }
    if (matches && best_rank % IO__LOOKS_LIKE >= (int)io_convention_count)
        io__warn(log, path, "normals \"%s\" are of another layer than depth \"%s\"; %s",
                 out->normal_base, out->depth[0], normal_remedy(request));
    if (matches > 1)
        io__info(log, path, "several layers may be normals; \"%s\" is used (%s)",
                 out->normal_base, normal_remedy(request));
}

int io__choose_normals(const char *path, const io_image *probed,
                       const io_passes_request *request, io__pass_names *out,
                       const crv_logger *log)
{
    const char *wanted = request->normal;
    if (!wanted) {
        find_normals(path, probed, request, out, log);
        return 0;
    }
    if (text_is_same(wanted, "none"))
        return 0;
    if (io_image_find(probed, wanted))
        return io__fail(log, path,
                        "\"%.255s\" is one channel; name normals without their .X .Y .Z, "
                        "as N of N.X N.Y N.Z",
                        wanted);
    if (strlen(wanted) >= IO_NAME_SIZE
        || !io__find_components(probed, wanted, strlen(wanted), out->normal))
        return io__fail_channel(log, path, wanted, probed);
    snprintf(out->normal_base, sizeof out->normal_base, "%s", wanted);
    return 0;
}

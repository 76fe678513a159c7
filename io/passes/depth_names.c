/* SPDX-License-Identifier: MIT */
/* depth_names.c: which channel is depth. */
#include <ctype.h>
#include <string.h>

#include "internal.h"
#include "names.h"
#include "pieces.h"

#define COUNT(a) (sizeof(a) / sizeof(a)[0])

/* "" stands for a layer that is a channel itself. */
static const char *const depth_components[] = {"", "Z", "V", "Y", "R", "T", "depth"};

/* Whether the channel "BASE.letter" exists, BASE being name without its component. */
static bool has_sibling(const io_image *image, const char *name, const char *letter)
{
    const char *dot = strrchr(name, '.');
    const size_t length = dot ? (size_t)(dot - name) + 1 : 0;
    for (int32_t i = 0; i < image->channel_count; i++) {
        const char *other = image->channels[i].name;
        if (text_is_same_start(other, name, length)
            && text_is_same(other + length, letter))
            return true;
    }
    return false;
}

static int component_rank(const char *component)
{
    for (size_t c = 0; c < COUNT(depth_components); c++)
        if (text_is_same(component, depth_components[c]))
            return (int)c;
    return -1;
}

/* Right eyes come after left ones, and layers with a prefix after those without. */
static int tail_rank(const io__pieces *s)
{
    return (s->view_length && tolower((unsigned char)s->view[0]) == 'r' ? 2 : 0)
           + (s->prefix ? 1 : 0);
}

int io__depth_name_rank(const char *name, bool with_component)
{
    const io__pieces s = io__split_channel(name, with_component);
    const int component = component_rank(s.component),
              row = io__row_of(&s, IO_PASS_DEPTH);
    if (with_component == !s.component[0] || component < 0)
        return IO__NO_MATCH;
    if (io__contains(s.layer, s.layer_length, "denois"))
        return io__contains(s.layer, s.layer_length, "depth") ? IO__FOR_DENOISER
                                                              : IO__NO_MATCH;
    /* Whose Z "shadow.Z" is, nobody knows. */
    if (!with_component && s.prefix && io__same_text(s.layer, s.layer_length, "Z"))
        return IO__NO_MATCH;
    const int rank =
        1 + ((row < 0 ? 0 : row) * (int)COUNT(depth_components) + component) * 4
        + tail_rank(&s);
    if (row >= 0)
        return rank;
    return io__contains(s.layer, s.layer_length, "depth") ? IO__LOOKS_LIKE + rank
                                                          : IO__NO_MATCH;
}

/* Of x, y, z without dots: Px, Py, Pz are a position, as pbrt writes it. */
static bool is_of_vector(const io_image *image, const char *name)
{
    char other[IO_NAME_SIZE];
    const size_t length = strlen(name);
    if (length < 2 || !strchr("Zz", name[length - 1]) || strchr(name, '.'))
        return false;
    for (int32_t i = 0; i < image->channel_count; i++) {
        snprintf(other, sizeof other, "%s", image->channels[i].name);
        if (strlen(other) == length && text_is_same_start(other, name, length - 1)
            && strchr("Xx", other[length - 1]))
            return true;
    }
    return false;
}

static int depth_rank(const io_image *image, const char *name)
{
    const io__pieces s = io__split_channel(name, true);
    const bool is_z = text_is_same(s.component, "Z");
    if (text_is_same(name, "Z"))
        return 0;
    /* Of a vector. */
    if ((is_z && has_sibling(image, name, "X")) || is_of_vector(image, name))
        return IO__NO_MATCH;
    const int with = io__depth_name_rank(name, true),
              without = io__depth_name_rank(name, false);
    const int rank = with < without ? with : without;
    if (rank < IO__NO_MATCH)
        return rank;
    /* "Anything.Z" is depth; Blender's mist is not. */
    if (is_z && !io__same_text(s.layer, s.layer_length, "mist"))
        return IO__ANY_Z;
    if (image->channel_count == 1 && (text_is_same(name, "Y") || text_is_same(name, "V")))
        return IO__ONLY_CHANNEL;
    return IO__NO_MATCH;
}

/* The channel as it is called, or one component of a layer of that name. */
static const char *find_requested_depth(const io_image *probed, const char *wanted)
{
    const io_channel *exact = io_image_find(probed, wanted);
    if (exact)
        return exact->name;
    for (size_t c = 1; c < COUNT(depth_components); c++) {
        char name[IO_NAME_SIZE + 8];
        snprintf(name, sizeof name, "%.255s.%s", wanted, depth_components[c]);
        const char *found = io__find_name(probed, name);
        if (found)
            return found;
    }
    return NULL;
}

static const char *depth_remedy(const io_passes_request *request)
{
    return request->remedies.depth ? request->remedies.depth : "name the depth channel";
}

static const char *find_depth(const char *path, const io_image *probed,
                              const io_passes_request *request, io__pass_names *out,
                              const crv_logger *log)
{
    const char *best = NULL, *second = NULL;
    int best_rank = IO__NO_MATCH, second_rank = IO__NO_MATCH;
    for (int32_t i = 0; i < probed->channel_count; i++) {
        const char *name = probed->channels[i].name;
        const int rank = depth_rank(probed, name);
        /* Further layers of ours are no rivals of the first. */
        if (strlen(name) == 8
            && (text_is_same_start(name, "layer", 5)
                || text_is_same_start(name, "solid", 5)))
            continue;
        if (rank < best_rank) {
            second = best;
            second_rank = best_rank;
            best = name;
            best_rank = rank;
        } else if (rank < second_rank) {
            second = name;
            second_rank = rank;
        }
    }
    /* Depth for a denoiser sees through mirrors, and of "Anything.Z" only Z is known. */
    if (best_rank >= IO__ANY_Z && io__find_positions(probed, out))
        return out->position[0];
    if (second && second_rank < IO__NO_MATCH)
        io__info(log, path,
                 "several channels may be depth; \"%s\" is used, not \"%s\" (%s)", best,
                 second, depth_remedy(request));
    return best;
}

int io__choose_depth(const char *path, const io_image *probed,
                     const io_passes_request *request, io__pass_names *out,
                     const crv_logger *log)
{
    const char *wanted = request->depth;
    out->layers = 1;
    out->layer_kind = CRV_LAYERS_SURFACES;
    if (wanted && io__request_positions(probed, wanted, out))
        out->depth[0] = out->position[0];
    else
        out->depth[0] = wanted ? find_requested_depth(probed, wanted)
                               : find_depth(path, probed, request, out, log);
    if (out->position[0])
        return 0;
    if (!wanted && out->depth[0] && io_keeps_windows(path)
        && text_is_same(out->depth[0], "Y"))
        return io__fail(log, path,
                        "its only channel, Y, is luminance by the rules of EXR; if it is "
                        "depth, %s",
                        depth_remedy(request));
    if (!out->depth[0] && wanted)
        return io__fail_channel(log, path, wanted, probed);
    if (!out->depth[0]) {
        char list[1500];
        io__list_channels(probed, list, sizeof list);
        return io__fail(log, path, "no channel looks like depth (there are: %s); %s",
                        list, depth_remedy(request));
    }
    if (!text_is_same(out->depth[0], "Z"))
        return 0;
    const bool solid =
        io__find_name(probed, "solid2.Z") && !io__find_name(probed, "layer2.Z");
    out->layer_kind = solid ? CRV_LAYERS_SOLID : CRV_LAYERS_SURFACES;
    while (out->layers < CRV_MAX_LAYERS) {
        char name[32];
        snprintf(name, sizeof name, "%s%d.Z", solid ? "solid" : "layer",
                 (int)out->layers + 1);
        const char *layer = io__find_name(probed, name);
        if (!layer)
            break;
        out->depth[out->layers++] = layer;
    }
    return 0;
}

/* SPDX-License-Identifier: MIT */
/*
 * names.c: which channels are depth and normals. A channel is
 * "PREFIX.LAYER.VIEW.COMPONENT", of which the prefix ("ViewLayer", a part's name) may be
 * anything and may be missing, and the view ("left") is there in stereo frames only. The
 * names of layers are those of conventions.c; case does not matter.
 */
#include <ctype.h>
#include <string.h>
#include <strings.h>

#include "conventions.h"
#include "internal.h"
#include "names.h"

#define COUNT(a) (sizeof(a) / sizeof(a)[0])

/* "" stands for a layer that is a channel itself. */
static const char *const depth_components[] = {"", "Z", "V", "Y", "R", "T", "depth"};

/* A channel's name in its pieces; lengths in bytes. */
typedef struct split_name {
    const char *layer; /* the last piece but component and view */
    size_t prefix;     /* length of what stands before the layer, its dot included */
    size_t layer_length;
    const char *view; /* "left" of a stereo frame, not terminated */
    size_t view_length;
    const char *component; /* "" for a name without dots */
} split_name;

static bool same_text(const char *a, size_t length, const char *b)
{
    return strlen(b) == length && !strncasecmp(a, b, length);
}

static bool contains(const char *text, size_t length, const char *word)
{
    const size_t size = strlen(word);
    for (size_t i = 0; i + size <= length; i++)
        if (!strncasecmp(text + i, word, size))
            return true;
    return false;
}

static bool is_view(const char *text, size_t length)
{
    static const char *const views[] = {"left", "right", "center", "centre", "l", "r"};
    for (size_t i = 0; i < COUNT(views); i++)
        if (same_text(text, length, views[i]))
            return true;
    return false;
}

static const char *piece_before(const char *name, const char *end)
{
    while (end > name && end[-1] != '.')
        end--;
    return end;
}

/* A layer's name from `name` to `end`, without its component. */
static split_name split_layer(const char *name, const char *end)
{
    split_name s = {.view = end, .component = ""};
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

/* The component is the last piece, or empty if the layer is itself a channel. */
static split_name split(const char *name, bool with_component)
{
    const char *dot = with_component ? strrchr(name, '.') : NULL;
    split_name s = split_layer(name, dot ? dot : name + strlen(name));
    s.component = dot ? dot + 1 : "";
    return s;
}

/* The rank of a layer in the rows of its kind, or -1. */
static int row_of(const split_name *s, bool is_normal)
{
    int rank = 0;
    for (size_t i = 0; i < io_convention_count; i++) {
        if (io_conventions[i].is_normal != is_normal)
            continue;
        if (same_text(s->layer, s->layer_length, io_conventions[i].name))
            return rank;
        rank++;
    }
    return -1;
}

/* Whether the channel "BASE.letter" exists, BASE being name without its component. */
static bool has_sibling(const io_image *image, const char *name, const char *letter)
{
    const char *dot = strrchr(name, '.');
    const size_t length = dot ? (size_t)(dot - name) + 1 : 0;
    for (int32_t i = 0; i < image->channel_count; i++) {
        const char *other = image->channels[i].name;
        if (!strncasecmp(other, name, length) && !strcasecmp(other + length, letter))
            return true;
    }
    return false;
}

/* Ranks: lower is better. Names of the table come first, then names that look like it. */
enum {
    LOOKS_LIKE = 1 << 16,
    ANY_Z = 1 << 18,
    FOR_DENOISER, /* sees through mirrors */
    ONLY_CHANNEL,
    NO_MATCH = 1 << 20
};

static int component_rank(const char *component)
{
    for (size_t c = 0; c < COUNT(depth_components); c++)
        if (!strcasecmp(component, depth_components[c]))
            return (int)c;
    return -1;
}

/* Right eyes come after left ones, and layers with a prefix after those without. */
static int tail_rank(const split_name *s)
{
    return (s->view_length && tolower((unsigned char)s->view[0]) == 'r' ? 2 : 0)
           + (s->prefix ? 1 : 0);
}

static int depth_rank_of(const char *name, bool with_component)
{
    const split_name s = split(name, with_component);
    const int component = component_rank(s.component), row = row_of(&s, false);
    if (with_component == !s.component[0] || component < 0)
        return NO_MATCH;
    if (contains(s.layer, s.layer_length, "denois"))
        return contains(s.layer, s.layer_length, "depth") ? FOR_DENOISER : NO_MATCH;
    /* Whose Z "shadow.Z" is, nobody knows. */
    if (!with_component && s.prefix && same_text(s.layer, s.layer_length, "Z"))
        return NO_MATCH;
    const int rank =
        1 + ((row < 0 ? 0 : row) * (int)COUNT(depth_components) + component) * 4
        + tail_rank(&s);
    if (row >= 0)
        return rank;
    return contains(s.layer, s.layer_length, "depth") ? LOOKS_LIKE + rank : NO_MATCH;
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
        if (strlen(other) == length && !strncasecmp(other, name, length - 1)
            && strchr("Xx", other[length - 1]))
            return true;
    }
    return false;
}

static int depth_rank(const io_image *image, const char *name)
{
    const split_name s = split(name, true);
    const bool is_z = !strcasecmp(s.component, "Z");
    if (!strcasecmp(name, "Z"))
        return 0;
    /* Of a vector. */
    if ((is_z && has_sibling(image, name, "X")) || is_of_vector(image, name))
        return NO_MATCH;
    const int with = depth_rank_of(name, true), without = depth_rank_of(name, false);
    const int rank = with < without ? with : without;
    if (rank < NO_MATCH)
        return rank;
    /* "Anything.Z" is depth; Blender's mist is not. */
    if (is_z && !same_text(s.layer, s.layer_length, "mist"))
        return ANY_Z;
    if (image->channel_count == 1 && (!strcasecmp(name, "Y") || !strcasecmp(name, "V")))
        return ONLY_CHANNEL;
    return NO_MATCH;
}

static const char *find_name(const io_image *image, const char *name)
{
    for (int32_t i = 0; i < image->channel_count; i++)
        if (!strcasecmp(image->channels[i].name, name))
            return image->channels[i].name;
    return NULL;
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
        const char *found = find_name(probed, name);
        if (found)
            return found;
    }
    return NULL;
}

static const char *depth_remedy(const io_passes_request *request)
{
    return request->remedies.depth ? request->remedies.depth : "name the depth channel";
}

static const char *normal_remedy(const io_passes_request *request)
{
    return request->remedies.normal ? request->remedies.normal : "name the normals";
}

static const char *find_depth(const char *path, const io_image *probed,
                              const io_passes_request *request, const crv_logger *log)
{
    const char *best = NULL, *second = NULL;
    int best_rank = NO_MATCH, second_rank = NO_MATCH;
    for (int32_t i = 0; i < probed->channel_count; i++) {
        const char *name = probed->channels[i].name;
        const int rank = depth_rank(probed, name);
        /* Further layers of ours are no rivals of the first. */
        if (strlen(name) == 8
            && (!strncasecmp(name, "layer", 5) || !strncasecmp(name, "solid", 5)))
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
    if (second && second_rank < NO_MATCH)
        io__info(log, path,
                 "several channels may be depth; \"%s\" is used, not \"%s\" (%s)", best,
                 second, depth_remedy(request));
    return best;
}

static int choose_depth(const char *path, const io_image *probed,
                        const io_passes_request *request, io__pass_names *out,
                        const crv_logger *log)
{
    const char *wanted = request->depth;
    out->depth[0] = wanted ? find_requested_depth(probed, wanted)
                           : find_depth(path, probed, request, log);
    out->layers = 1;
    out->layer_kind = CRV_LAYERS_SURFACES;
    if (!wanted && out->depth[0] && io_keeps_windows(path)
        && !strcasecmp(out->depth[0], "Y"))
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
    if (strcasecmp(out->depth[0], "Z"))
        return 0;
    const bool solid = find_name(probed, "solid2.Z") && !find_name(probed, "layer2.Z");
    out->layer_kind = solid ? CRV_LAYERS_SOLID : CRV_LAYERS_SURFACES;
    while (out->layers < CRV_MAX_LAYERS) {
        char name[32];
        snprintf(name, sizeof name, "%s%d.Z", solid ? "solid" : "layer",
                 (int)out->layers + 1);
        const char *layer = find_name(probed, name);
        if (!layer)
            break;
        out->depth[out->layers++] = layer;
    }
    return 0;
}

/* Finds BASE.X .Y .Z, BASE.R .G .B, or BASEX BASEY BASEZ. */
static bool find_components(const io_image *probed, const char *base, size_t length,
                            const char *found[3])
{
    static const char *const sets[][3] = {
        {".X", ".Y", ".Z"}, {".R", ".G", ".B"}, {"X", "Y", "Z"}};
    for (size_t set = 0; set < COUNT(sets); set++) {
        int c = 0;
        for (; c < 3; c++) {
            char name[IO_NAME_SIZE + 8];
            snprintf(name, sizeof name, "%.*s%s", (int)length, base, sets[set][c]);
            found[c] = find_name(probed, name);
            if (!found[c])
                break;
        }
        if (c == 3)
            return true;
    }
    found[0] = found[1] = found[2] = NULL;
    return false;
}

/* The length of a normal layer's name when `name` is its X (or R) component, else 0. */
static size_t normal_base_length(const char *name)
{
    const size_t length = strlen(name);
    const char last = length ? name[length - 1] : '\0';
    if (length >= 3 && name[length - 2] == '.' && strchr("XxRr", last))
        return length - 2;
    return length >= 2 && (last == 'X' || last == 'x') ? length - 1 : 0;
}

/* Whether the normals are of the depth's part or view layer, and of its eye. Of "right.Z"
 * the prefix is "right": that is no name for depth, but a view or a layer. */
static bool is_together(const char *depth, const char *name, const split_name *normal)
{
    const split_name s = split(depth, true);
    const bool named = !s.component[0] || depth_rank_of(depth, true) < NO_MATCH;
    const size_t prefix = named ? s.prefix : s.prefix + s.layer_length + 1;
    return prefix == normal->prefix && !strncasecmp(name, depth, prefix)
           && s.view_length == normal->view_length
           && !strncasecmp(s.view, normal->view, s.view_length);
}

static int normal_rank(const char *name, size_t length, const char *depth)
{
    const split_name s = split_layer(name, name + length);
    const int apart = is_together(depth, name, &s) ? 0 : (int)io_convention_count;
    const int row = row_of(&s, true);
    if (row >= 0)
        return apart + row;
    return contains(s.layer, s.layer_length, "normal") ? LOOKS_LIKE + apart : NO_MATCH;
}

static void find_normals(const char *path, const io_image *probed,
                         const io_passes_request *request, io__pass_names *out,
                         const crv_logger *log)
{
    int best_rank = NO_MATCH, matches = 0;
    for (int32_t i = 0; i < probed->channel_count; i++) {
        const char *name = probed->channels[i].name;
        const char *found[3];
        const size_t length = normal_base_length(name);
        const int rank = length ? normal_rank(name, length, out->depth[0]) : NO_MATCH;
        if (rank == NO_MATCH || !find_components(probed, name, length, found))
            continue;
        matches++;
        if (rank >= best_rank)
            continue;
        best_rank = rank;
        memcpy(out->normal, found, sizeof found);
        snprintf(out->normal_base, sizeof out->normal_base, "%.*s", (int)length, name);
    }
    if (matches && best_rank % LOOKS_LIKE >= (int)io_convention_count)
        io__warn(log, path, "normals \"%s\" are of another layer than depth \"%s\"; %s",
                 out->normal_base, out->depth[0], normal_remedy(request));
    if (matches > 1)
        io__info(log, path, "several layers may be normals; \"%s\" is used (%s)",
                 out->normal_base, normal_remedy(request));
}

static int choose_normals(const char *path, const io_image *probed,
                          const io_passes_request *request, io__pass_names *out,
                          const crv_logger *log)
{
    const char *wanted = request->normal;
    if (!wanted) {
        find_normals(path, probed, request, out, log);
        return 0;
    }
    if (!strcasecmp(wanted, "none"))
        return 0;
    if (io_image_find(probed, wanted))
        return io__fail(log, path,
                        "\"%.255s\" is one channel; name normals without their .X .Y .Z, "
                        "as N of N.X N.Y N.Z",
                        wanted);
    if (strlen(wanted) >= IO_NAME_SIZE
        || !find_components(probed, wanted, strlen(wanted), out->normal))
        return io__fail_channel(log, path, wanted, probed);
    snprintf(out->normal_base, sizeof out->normal_base, "%s", wanted);
    return 0;
}

int io__choose_passes(const char *path, const io_image *probed,
                      const io_passes_request *request, io__pass_names *out,
                      const crv_logger *log)
{
    memset(out, 0, sizeof *out);
    if (choose_depth(path, probed, request, out, log)
        || choose_normals(path, probed, request, out, log))
        return -1;
    io__info(log, path, "depth: \"%s\" (%d layer%s%s); normals: %s%s%s", out->depth[0],
             (int)out->layers, out->layers > 1 ? "s" : "",
             out->layer_kind == CRV_LAYERS_SOLID ? " of solids" : "",
             out->normal[0] ? "\"" : "", out->normal[0] ? out->normal_base : "from depth",
             out->normal[0] ? "\"" : "");
    return 0;
}

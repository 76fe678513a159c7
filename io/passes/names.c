/* SPDX-License-Identifier: MIT */
/*
 * names.c: the names that renderers give to depth and normals. A channel is
 * "PREFIX.LAYER.COMPONENT", of which the prefix ("ViewLayer", a part's name) may be
 * anything and may be missing. Tables are in order of preference; case does not matter.
 */
#include <string.h>
#include <strings.h>

#include "internal.h"
#include "names.h"

static const char *const depth_layers[] = {
    "depth",            /* Blender, Redshift, Karma, Nuke, Mitsuba, LuxCore */
    "z",                /* Arnold, RenderMan, Redshift */
    "zdepth",           /* V-Ray, Octane */
    "z-depth",          /* Octane */
    "z_depth",          /* Corona */
    "z depth",          /* Octane, older */
    "vrayzdepth",       /* V-Ray for 3ds Max */
    "vray_zdepth",      /* V-Ray for Maya */
    "cgeometry_zdepth", /* Corona */
    "pz",               /* Mantra */
    "__depth",          /* RenderMan's denoiser */
    "scenedepth",       /* Unreal */
    "worlddepth",       /* Unreal */
    "finalimageworlddepth",
    "zfiltered", /* RenderMan */
    "depth_filtered",
    "denoising depth" /* Cycles: last, since it sees through mirrors */
};

/* "" stands for a layer that is a channel itself. */
static const char *const depth_components[] = {"", "Z", "V", "Y", "R", "T", "depth"};

static const char *const normal_layers[] = {
    "n",              /* Arnold, RenderMan, Mantra, Redshift, Cycles */
    "normal",         /* Blender, Cinema 4D */
    "normals",        /* Redshift, V-Ray */
    "nn",             /* RenderMan */
    "vraynormals",    /* V-Ray */
    "shading normal", /* Octane */
    "shading_normal", /* LuxCore */
    "sh_normal",      /* Mitsuba */
    "ns",             /* pbrt */
    "hitn",           /* Karma */
    "worldnormal",    /* Unreal */
    "world_normal",
    "normalworld",
    "normal_world",
    "nworld",   /* RenderMan */
    "__nworld", /* RenderMan's denoiser */
    "ncam",
    "finalimageworldnormal",
    "geometric normal",          /* Octane */
    "geometry_normal",           /* LuxCore */
    "geo_normal",                /* Mitsuba */
    "cgeometry_normalsgeometry", /* Corona */
    "ng",
    "bumpnormals", /* Redshift */
    "denoising normal"};

#define COUNT(a) (sizeof(a) / sizeof(a)[0])

/* A channel's name in its pieces; lengths in bytes. */
typedef struct split_name {
    const char *layer; /* the last piece but one, or the whole of a name without dots */
    size_t prefix;     /* length of what stands before the layer, its dot included */
    size_t layer_length;
    const char *component; /* "" for a name without dots */
} split_name;

static bool same_text(const char *a, size_t length, const char *b)
{
    return strlen(b) == length && !strncasecmp(a, b, length);
}

/* The component is the last piece, or empty if the layer is itself a channel. */
static split_name split(const char *name, bool with_component)
{
    const char *end = name + strlen(name);
    const char *dot = with_component ? strrchr(name, '.') : NULL;
    const char *layer_end = dot ? dot : end;
    const char *layer = layer_end;
    while (layer > name && layer[-1] != '.')
        layer--;
    return (split_name){.layer = layer,
                        .prefix = (size_t)(layer - name),
                        .layer_length = (size_t)(layer_end - layer),
                        .component = dot ? dot + 1 : ""};
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

enum { NO_MATCH = 1 << 20 };

static int depth_rank_of(const char *name, bool with_component)
{
    const split_name s = split(name, with_component);
    if (with_component == !s.component[0])
        return NO_MATCH;
    for (size_t layer = 0; layer < COUNT(depth_layers); layer++)
        for (size_t c = 0; c < COUNT(depth_components); c++)
            if (same_text(s.layer, s.layer_length, depth_layers[layer])
                && !strcasecmp(s.component, depth_components[c]))
                return 1 + (int)((layer * COUNT(depth_components) + c) * 2)
                       + (s.prefix ? 1 : 0);
    return NO_MATCH;
}

/* Lower is better. */
static int depth_rank(const io_image *image, const char *name)
{
    const split_name s = split(name, true);
    const bool is_z = !strcasecmp(s.component, "Z");
    if (!strcasecmp(name, "Z"))
        return 0;
    if (is_z && has_sibling(image, name, "X")) /* of a vector */
        return NO_MATCH;
    const int with = depth_rank_of(name, true), without = depth_rank_of(name, false);
    const int rank = with < without ? with : without;
    if (rank < NO_MATCH)
        return rank;
    /* "Anything.Z" is depth; Blender's mist is not. */
    if (is_z && !same_text(s.layer, s.layer_length, "mist"))
        return NO_MATCH - 2;
    if (image->channel_count == 1 && (!strcasecmp(name, "Y") || !strcasecmp(name, "V")))
        return NO_MATCH - 1;
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

/* The length of what stands before the layer of a depth, its dot included. Of "right.Z"
 * that is all but the Z: "right" is no name for depth, but a view or a layer. */
static size_t depth_prefix_length(const char *depth)
{
    const split_name s = split(depth, true);
    if (!s.component[0] || depth_rank_of(depth, true) < NO_MATCH)
        return s.prefix;
    return s.prefix + s.layer_length + 1;
}

static bool is_together(const char *depth, const char *name, size_t prefix)
{
    return prefix == depth_prefix_length(depth) && !strncasecmp(name, depth, prefix);
}

static int normal_rank(const char *name, size_t length, const char *depth)
{
    const char *layer = name + length;
    while (layer > name && layer[-1] != '.')
        layer--;
    const size_t prefix = (size_t)(layer - name);
    for (size_t i = 0; i < COUNT(normal_layers); i++)
        if (same_text(layer, length - prefix, normal_layers[i])) {
            /* Of the same view layer as the depth, if possible. */
            return (is_together(depth, name, prefix) ? 0 : (int)COUNT(normal_layers))
                   + (int)i;
        }
    return NO_MATCH;
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
    if (matches && best_rank >= (int)COUNT(normal_layers))
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

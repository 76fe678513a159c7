/* SPDX-License-Identifier: MIT */
/* The option table: the one place that knows an option's default, range and meaning. */
#include "core/options.h"

#include "base/log.h"
#include "base/structs.h"
#include "core/registry.h"

#include <math.h>
#include <string.h>

static const char *const FALLOFFS[] = {"none",        "linear",  "sqrt", "cubic",
                                       "exponential", "alchemy", NULL};
static const char *const NORMALISERS[] = {"weighted", "analytic", NULL};
static const char *const CHARACTERISTICS[] = {"product", "depth", "field", NULL};
static const char *const SPACINGS[] = {"equal", "quadratic", NULL};
static const char *const ATTENUATIONS[] = {"slab", "horizon", NULL};
static const char *const WEIGHTINGS[] = {"uniform", "cosine", NULL};
static const char *const THICKNESSES[] = {"width", "run", "constant", "layers", NULL};
static const char *const BORDERS[] = {"extrapolate", "background", NULL};

/* Who reads an option. */
typedef enum reader { EVERY_METHOD, SOME_METHODS, SOME_FILTERS } reader;

typedef struct row {
    crv_option info;
    size_t offset;
    reader reader;
} row;

#define FLOAT(key, unit, standard, low, high, who, help)                                 \
    {                                                                                    \
        {#key, CRV_OPTION_FLOAT, unit, standard, low, high, NULL, help},                 \
            offsetof(crv_options, key), who                                              \
    }
#define INT(key, unit, standard, low, high, who, help)                                   \
    {                                                                                    \
        {#key, CRV_OPTION_INT, unit, standard, low, high, NULL, help},                   \
            offsetof(crv_options, key), who                                              \
    }
#define BOOL(key, standard, who, help)                                                   \
    {                                                                                    \
        {#key, CRV_OPTION_BOOL, "", standard, 0, 1, NULL, help},                         \
            offsetof(crv_options, key), who                                              \
    }
#define CHOICE(key, standard, names, who, help)                                          \
    {                                                                                    \
        {#key,  CRV_OPTION_CHOICE,                                                       \
         "",    standard,                                                                \
         0,     sizeof names / sizeof names[0] - 2,                                      \
         names, help},                                                                   \
            offsetof(crv_options, key), who                                              \
    }

static const row TABLE[] = {
    FLOAT(radius, "scene units", 1, 1e-9, 1e9, EVERY_METHOD,
          "radius of influence: occluders farther away do not count; try a tenth of the "
          "largest thing in view"),
    CHOICE(falloff, CRV_FALLOFF_LINEAR, FALLOFFS, SOME_METHODS,
           "how the weight of an occluder falls with its distance; none shows a border "
           "at the radius"),
    FLOAT(tau, "1/radius", 3, 0, 1e3, SOME_METHODS, "decay of the exponential falloff"),
    FLOAT(u, "radius", 0.1, 1e-3, 1, SOME_METHODS,
          "distance at which the alchemy falloff peaks"),
    INT(directions, "", 8, 1, 256, SOME_METHODS,
        "Nd: directions around a pixel; above 16 rarely helps with a filter"),
    INT(steps, "", 8, 1, 256, SOME_METHODS,
        "Ns: samples in each direction; more for large radii, above 16 rarely helps; "
        "containment: points tested on the way to each"),
    CHOICE(spacing, CRV_SPACING_QUADRATIC, SPACINGS, SOME_METHODS,
           "of the steps over the radius: equal, as in the papers, or quadratic, denser "
           "near the point"),
    FLOAT(
        bias_deg, "degrees", 0, 0, 89, SOME_METHODS,
        "ignores occluders that rise less than this over the surface; 5 to 15 hides the "
        "facets of coarse meshes"),
    CHOICE(attenuation, CRV_ATTENUATION_SLAB, ATTENUATIONS, SOME_METHODS,
           "slab: each occluder weights the elevations that it is the first to block; "
           "horizon: the highest occluder weights its whole slice"),
    CHOICE(weighting, CRV_WEIGHTING_COSINE, WEIGHTINGS, SOME_METHODS,
           "of the hemisphere: cosine as in renderers' AO passes, or uniform as in hbao"),
    CHOICE(border, CRV_BORDER_EXTRAPOLATE, BORDERS, SOME_METHODS,
           "what lies beyond the picture: extrapolate, surfaces continue as planes; "
           "background, nothing"),
    INT(normal_rays, "", 1, 0, 64, SOME_METHODS,
        "Nn: rays above the horizon (hsao) or over the hemisphere (raymarch) for each "
        "direction"),
    BOOL(growing_sphere, 0, SOME_METHODS,
         "deflect only towards occluders that are nearer than the length of the march"),
    FLOAT(thickness, "radius", 0.5, 0, 1e3, SOME_METHODS,
          "how far behind its front a surface is solid; less for grass, 0: without end"),
    CHOICE(thickness_rule, CRV_THICKNESS_WIDTH, THICKNESSES, SOME_METHODS,
           "how far behind its front a surface is solid: width, as far as it is seen to "
           "extend, at most its width; run, without that limit, faster; constant, "
           "`thickness`; layers, up to the next layer"),
    INT(samples, "", 12, 1, 4096, SOME_METHODS,
        "n: points, lines or pipes; twice as many cut the noise by a third"),
    INT(bands, "", 1, 1, 16, SOME_METHODS,
        "levels of detail: small projected radii take 1/bands of the samples, and so on"),
    FLOAT(band_px, "px", 96, 1, CRV_MAX_SIZE, SOME_METHODS,
          "projected radius from which on all samples are taken"),
    FLOAT(
        alchemy_bias, "", 1e-4, 0, 1, SOME_METHODS,
        "beta: height over the surface below which occluders are ignored, as a share of "
        "the depth"),
    FLOAT(alchemy_eps, "radius^2", 1e-4, 1e-9, 1, SOME_METHODS,
          "eps: keeps the nearest occluders from dividing by zero"),
    CHOICE(normaliser, CRV_NORMALISER_WEIGHTED, NORMALISERS, SOME_METHODS,
           "weighted: by the chords that were sampled; analytic: by the sphere's volume"),
    CHOICE(
        characteristic, CRV_CHARACTERISTIC_PRODUCT, CHARACTERISTICS, SOME_METHODS,
        "what tells inside from outside: the depth buffer, the height field or implicit "
        "surface, or both"),
    BOOL(rescale, 0, SOME_METHODS, "double the result, so that a flat wall is white"),
    FLOAT(max_radius_px, "px", 0, 0, CRV_MAX_SIZE, SOME_METHODS,
          "samples no farther than this from the pixel, to bound the cost of close-ups; "
          "0: no limit"),
    FLOAT(intensity, "", 1, 0, 100, EVERY_METHOD,
          "strength s in max(0, 1 - s (1 - A))^contrast; 1 is what the method computes"),
    FLOAT(contrast, "", 1, 1e-2, 100, EVERY_METHOD,
          "exponent k in max(0, 1 - intensity (1 - A))^k"),
    INT(noise_size, "px", 4, 1, 64, EVERY_METHOD,
        "edge of the tile of rotations and jitters; 4 for box4, 1 without a filter"),
    INT(seed, "", 0, 0, 2147483647, EVERY_METHOD, "different noise, same expected error"),
    INT(noise_index, "", 0, 0, 2147483647, EVERY_METHOD,
        "frame number, if temporal antialiasing averages frames: different noise for "
        "each; else 0"),
    BOOL(bent_normal, 0, SOME_METHODS,
         "compute the bent normal, too: the mean open direction, for lighting"),
    FLOAT(
        filter_depth, "radius", 0.05, 1e-4, 1e3, SOME_FILTERS,
        "depth deviation at which a filter tap stops counting; less keeps more edges and "
        "more noise"),
    BOOL(filter_slope, 1, SOME_FILTERS,
         "measure depth deviation from the plane of the surface; off: from the centre's "
         "depth, as in the papers"),
    FLOAT(filter_normal, "degrees", 25, 1, 180, SOME_FILTERS,
          "angle between normals at which a filter tap stops counting; 180: normals do "
          "not count"),
};

enum { ROW_COUNT = sizeof TABLE / sizeof TABLE[0] };

int32_t crv_option_count(void)
{
    return ROW_COUNT;
}

const crv_option *crv_option_at(int32_t index)
{
    return index >= 0 && index < ROW_COUNT ? &TABLE[index].info : NULL;
}

/* Equal but for dashes and underscores. */
static int keys_match(const char *a, const char *b)
{
    for (; *a && *b; a++, b++) {
        if ((*a == '-' ? '_' : *a) != (*b == '-' ? '_' : *b))
            return 0;
    }
    return *a == *b;
}

const crv_option *crv_option_find(const char *key)
{
    for (int i = 0; key && i < ROW_COUNT; i++) {
        if (keys_match(key, TABLE[i].info.key))
            return &TABLE[i].info;
    }
    return NULL;
}

static const row *row_of(const crv_option *option)
{
    for (int i = 0; i < ROW_COUNT; i++) {
        if (&TABLE[i].info == option)
            return &TABLE[i];
    }
    return NULL;
}

static int lists(const char *const *keys, const char *key)
{
    for (; keys && *keys; keys++) {
        if (strcmp(*keys, key) == 0)
            return 1;
    }
    return 0;
}

int crv_option_applies(const crv_option *option, const crv_method *method,
                       const crv_filter *filter)
{
    const row *r = row_of(option);
    if (!r)
        return 0;
    if (r->reader == EVERY_METHOD)
        return 1;
    if (r->reader == SOME_METHODS)
        return method && lists(method->options, option->key);
    return filter && lists(filter->options, option->key);
}

bool crv__options_have(const crv_options *options, const crv_option *option)
{
    return row_of(option)->offset + 4 <= options->struct_size;
}

_Static_assert(sizeof(crv_falloff) == 4 && sizeof(crv_attenuation) == 4,
               "choices are read and written as int32_t");

void crv__options_put(crv_options *options, const crv_option *option, double value)
{
    char *member = (char *)options + row_of(option)->offset;
    if (option->type == CRV_OPTION_FLOAT) {
        float number = (float)value;
        memcpy(member, &number, sizeof number);
    } else {
        int32_t number = (int32_t)value;
        memcpy(member, &number, sizeof number);
    }
}

static const crv__struct OPTIONS = {.name = "options",
                                    .init = "crv_options_init()",
                                    .first = CRV__SIZE_TO(crv_options, radius),
                                    .size = sizeof(crv_options)};

bool crv__options_known(const crv_options *options)
{
    return options && options->struct_size >= OPTIONS.first
           && options->struct_size <= OPTIONS.size;
}

/* The defaults for a method, preset included. */
static crv_options defaults_of(const crv_method *method)
{
    crv_options options = {.struct_size = sizeof options,
                           .method = method,
                           .filter = crv_filter_find("edges15")};
    for (int i = 0; i < ROW_COUNT; i++)
        crv__options_put(&options, &TABLE[i].info, TABLE[i].info.default_value);
    crv_options_preset(&options, CRV_PRESET_MEDIUM);
    return options;
}

crv_status crv_options_init(crv_options *options, size_t struct_size, const char *method)
{
    const crv_method *chosen = crv_method_find(method ? method : "bitmask");
    if (!chosen)
        return CRV_ERROR_INVALID_ARGUMENT;
    const crv_options defaults = defaults_of(chosen);
    return crv__struct_init(&OPTIONS, options, struct_size, &defaults);
}

double crv_options_get(const crv_options *options, const crv_option *option)
{
    const row *r = row_of(option);
    if (!options || !r)
        return NAN;
    if (!crv__options_have(options, option)) {
        const crv_options defaults = defaults_of(options->method);
        return crv_options_get(&defaults, option);
    }
    const char *member = (const char *)options + r->offset;
    if (option->type == CRV_OPTION_FLOAT) {
        float value;
        memcpy(&value, member, sizeof value);
        return (double)value;
    }
    int32_t value; /* enums are int-sized: see the assertion */
    memcpy(&value, member, sizeof value);
    return value;
}

crv_status crv__option_check(const crv_option *option, double value,
                             const crv_logger *logger)
{
    /* The range is compared as floats where the value is one, so that its ends are
     * inside. */
    const int is_float = option->type == CRV_OPTION_FLOAT;
    const double low = is_float ? (double)(float)option->min : option->min;
    const double high = is_float ? (double)(float)option->max : option->max;
    if (value >= low && value <= high)
        return CRV_OK;
    return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                     "%s: %.10g is out of range; it is from %.10g to %.10g%s%s",
                     option->key, value, option->min, option->max,
                     option->unit[0] ? " " : "", option->unit);
}

static int is_registered(const crv_options *options)
{
    int method = 0, filter = !options->filter;
    for (int32_t i = 0; i < crv_method_count(); i++)
        method |= crv_method_at(i) == options->method;
    for (int32_t i = 0; i < crv_filter_count(); i++)
        filter |= crv_filter_at(i) == options->filter;
    return method && filter;
}

static crv_status check_values(const crv_options *options, const crv_logger *logger)
{
    for (int i = 0; i < ROW_COUNT; i++) {
        const crv_option *option = &TABLE[i].info;
        const double value = crv_options_get(options, option);
        crv_status status = crv__option_check(option, value, logger);
        if (status)
            return status;
        const double standard = option->type == CRV_OPTION_FLOAT
                                    ? (double)(float)option->default_value
                                    : option->default_value;
        if (value != standard
            && !crv_option_applies(option, options->method, options->filter))
            crv__log(logger, CRV_LOG_WARNING,
                     "%s: not used by %s with filter %s; ignored", option->key,
                     options->method->name,
                     options->filter ? options->filter->name : "none");
    }
    return CRV_OK;
}

crv_status crv__options_take(const crv_logger *logger, const crv_options *from,
                             crv_options *options)
{
    crv_options given = {.struct_size = 0};
    crv_status status = crv__struct_take(&OPTIONS, logger, from, &given);
    if (status == CRV_OK && !is_registered(&given))
        status = crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                           "options: unknown method or filter; take them from the "
                           "registry, and begin with crv_options_init()");
    if (status)
        return status;
    *options = defaults_of(given.method);
    crv__struct_take(&OPTIONS, logger, from, options);
    return check_values(options, logger);
}

crv_status crv_options_check(const crv_options *options, const crv_logger *logger)
{
    crv_options full;
    return crv__options_take(logger, options, &full);
}

/* SPDX-License-Identifier: MIT */
/*
 * options.h: methods, filters, and every number that steers them.
 *
 * A method is named by a text: "hbao". crv_method_at() lists all of them; docs/methods.md
 * says which to choose, with errors and times.
 *
 * One table describes the options. Defaults, checks, the command line and its help come
 * from it. A host's user interface can list options, methods and filters by the functions
 * below. Everything here is thread-safe: the tables are constant.
 */
#ifndef CREVICE_OPTIONS_H
#define CREVICE_OPTIONS_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * How a method weights the hemisphere. w: direction, n: normal, V: 1 if the ray is
 * blocked, else 0, W: falloff. A: accessibility. B: bent normal, the direction of the
 * mean of what is open; n if nothing is open.
 */
typedef enum crv_weighting {
    /* A = 1 - 1/(2 pi) Int V W dw,   B = norm(Int (1 - V W) w dw) */
    CRV_WEIGHTING_UNIFORM = 0,
    /* A = 1 - 1/pi Int V W (n.w) dw,   B = norm(Int (1 - V W) (n.w) w dw) */
    CRV_WEIGHTING_COSINE = 1
} crv_weighting;

/* How the weight W of an occluder falls with its distance r. R: radius, q = r / R. W is 0
 * from R on. */
typedef enum crv_falloff {
    CRV_FALLOFF_NONE = 0,        /* 1 */
    CRV_FALLOFF_LINEAR = 1,      /* 1 - q */
    CRV_FALLOFF_SQRT = 2,        /* 1 - sqrt(q) */
    CRV_FALLOFF_CUBIC = 3,       /* 1 - q^3 */
    CRV_FALLOFF_EXPONENTIAL = 4, /* exp(-tau q), option `tau` */
    CRV_FALLOFF_ALCHEMY = 5      /* u q / max(u, q)^2, option `u`: rises to 1 at q = u */
} crv_falloff;

/* How horizon methods apply the falloff. */
typedef enum crv_attenuation {
    /* Each occluder weights the elevations that it is the first to block: the exact
     * integral of W. */
    CRV_ATTENUATION_SLAB = 0,
    /* The highest occluder weights its whole slice: eq. 3 of Bavoil, Sainz, Dimitrov
     * 2008, read literally. */
    CRV_ATTENUATION_HORIZON = 1
} crv_attenuation;

/* How the samples of a direction are spaced over the radius. */
typedef enum crv_spacing {
    CRV_SPACING_EQUAL = 0, /* equal steps, as in the papers */
    /* With the square of the step: dense near the point, where most occluders are. */
    CRV_SPACING_QUADRATIC = 1
} crv_spacing;

/* bitmask: thickness of a surface, that is, how far behind its front it is solid. WIDTH
 * and RUN give at least 0.1 R. A further layer ends the solid in front of it. If layers
 * are solid, their backs give the thickness, whatever the rule. */
typedef enum crv_thickness {
    /* As far as the surface is seen to extend along the slice, but no more than its
     * width: the distance between the silhouettes on both sides of it in the picture. */
    CRV_THICKNESS_WIDTH = 0,
    /* As far as the surface is seen to extend along the slice. Faster: needs no pass for
     * the widths. */
    CRV_THICKNESS_RUN = 1,
    CRV_THICKNESS_CONSTANT = 2, /* option `thickness`, as in the paper */
    /* Up to the next layer; option `thickness` behind the last. */
    CRV_THICKNESS_LAYERS = 3
} crv_thickness;

/* What lies beyond the borders of the buffers. */
typedef enum crv_border {
    /* The surfaces at the border continue as planes. */
    CRV_BORDER_EXTRAPOLATE = 0,
    CRV_BORDER_BACKGROUND = 1 /* nothing */
} crv_border;

/* What vao divides the open length of its pipes by. */
typedef enum crv_normaliser {
    /* The length of the chords: weighted importance sampling. */
    CRV_NORMALISER_WEIGHTED = 0,
    /* The exact volume of the tangent sphere. */
    CRV_NORMALISER_ANALYTIC = 1
} crv_normaliser;

/* What tells inside from outside, for the methods that test points. */
typedef enum crv_characteristic {
    /* The depth buffer and, if the G-buffer has one, the height field or implicit
     * surface: outside is outside of both. */
    CRV_CHARACTERISTIC_PRODUCT = 0,
    CRV_CHARACTERISTIC_DEPTH = 1, /* the depth buffer alone */
    CRV_CHARACTERISTIC_FIELD = 2  /* the height field or implicit surface alone */
} crv_characteristic;

/* A method of the registry. Static storage. */
typedef struct crv_method {
    const char *name;  /* "hbao" */
    const char *title; /* "Horizon-based ambient occlusion" */
    const char *paper; /* authors, year, title */
    crv_weighting weighting;
    const char *const *options; /* keys of the options that it reads, NULL-terminated;
                                   those that every method reads are not listed */
    int32_t bent_normal;        /* 0 or 1: gives bent normals, see crv_weighting */
} crv_method;

/* A filter of the registry. Static storage. */
typedef struct crv_filter {
    const char *name;  /* "edges15" */
    const char *title; /* what it does, a line */
    const char *paper;
    const char *const *options; /* keys of the options that it reads, NULL-terminated */
} crv_filter;

/* Sets of options of each method. Start with medium; low for real time on small GPUs,
 * high and ultra for stills. */
typedef enum crv_preset {
    CRV_PRESET_LOW = 0,
    CRV_PRESET_MEDIUM = 1, /* the defaults of crv_options_init() */
    CRV_PRESET_HIGH = 2,
    CRV_PRESET_ULTRA = 3,
    CRV_PRESET_PAPER = 4 /* the numbers of the main figure of the method's paper */
} crv_preset;
#define CRV_PRESET_COUNT 5

/* "low", "medium", "high", "ultra", "paper"; NULL for another number. */
CRV_API const char *crv_preset_name(crv_preset preset);

/* The registries: index in [0, count), NULL beyond; find returns NULL for an unknown
 * name. */
CRV_API int32_t crv_method_count(void);
CRV_API const crv_method *crv_method_at(int32_t index);
CRV_API const crv_method *crv_method_find(const char *name);
CRV_API int32_t crv_filter_count(void);
CRV_API const crv_filter *crv_filter_at(int32_t index);
CRV_API const crv_filter *crv_filter_find(const char *name);

/*
 * All options of a run. Begin with crv_options_init(): a zeroed struct is not valid. The
 * option table (crv_option_at()) has unit, range, default and help of each. Boolean
 * options are int32_t, 0 or 1. crv_option_applies() tells which options a method reads.
 */
typedef struct crv_options {
    size_t struct_size; /* set by crv_options_init() */

    const crv_method *method; /* default bitmask */
    const crv_filter *filter; /* NULL: none. Default edges15 */

    /* R, radius of influence, scene units, > 0. Default 1, which seldom fits. */
    float radius;
    crv_falloff falloff; /* default LINEAR */
    float tau;           /* exponential falloff: decay over one radius. Default 3 */
    float u;             /* alchemy falloff: its peak, in radii. Default 0.1 */

    int32_t directions; /* Nd. Default 8; bitmask 4, hsao 7 */
    /* Ns, per direction; containment: points tested on a ray. Default 8; hsao 12,
     * containment 5. */
    int32_t steps;
    crv_spacing spacing; /* hbao, gtao, bitmask. Default QUADRATIC */
    /* hbao: raises the tangent: lower occluders are ignored. Degrees, default 0. */
    float bias_deg;
    crv_attenuation attenuation;  /* hbao, gtao, hsao. Default SLAB */
    crv_weighting weighting;      /* gtao, bitmask: their integral. Default COSINE */
    crv_border border;            /* gtao, bitmask. Default EXTRAPOLATE */
    crv_thickness thickness_rule; /* bitmask. Default WIDTH */
    int32_t normal_rays;          /* Nn, per direction: hsao, default 1; raymarch, 4 */
    /* hsao: 1 deflects only towards surfaces that are nearer than the march has come.
     * Default 0. */
    int32_t growing_sphere;
    /* Thickness of surfaces whose back no layer shows, along the view axis, in radii. 0:
     * infinite. Default 0.5: visible objects are usually thinner than the space behind
     * them. */
    float thickness;
    /* hbao, gtao and bitmask take no samples farther than this from the pixel. Default 0:
     * no limit. */
    float max_radius_px;

    int32_t samples; /* n: points, lines or pipes. Default 12; containment 24, ssao 16 */
    int32_t bands;   /* alchemy: levels of detail of the sample count. Default 1 */
    /* alchemy: projected radius from which all samples are taken, px. Default 96. */
    float band_px;
    float alchemy_bias; /* alchemy: beta of eq. 10. Default 1e-4 */
    float alchemy_eps;  /* alchemy: eps of eq. 10, in radii squared. Default 1e-4 */
    crv_normaliser normaliser;         /* vao. Default WEIGHTED */
    crv_characteristic characteristic; /* vao, containment. Default PRODUCT */
    int32_t rescale; /* ssao: 1 doubles A, so that a wall is white. Default 0 */

    float intensity;    /* A' = max(0, 1 - intensity (1 - A))^contrast. Default 1 */
    float contrast;     /* default 1 */
    int32_t noise_size; /* edge of the noise tile, px. Default 4 */
    int32_t seed; /* different noise and sample pattern, same expected error. Default 0 */

    /* Depth deviation at which a filter tap stops counting, in radii. Default 0.05. */
    float filter_depth;
    /* 1: that deviation is measured from the plane of the surface. 0: from the depth of
     * the centre, as in the papers. Default 1. */
    int32_t filter_slope;
    /* Angle between normals, degrees, at which a filter tap stops counting. 180: normals
     * do not count. Default 25. */
    float filter_normal;

    /* Number of the frame: different noise for each, same expected error. Count it up if
     * temporal antialiasing averages frames: the mean converges fast. Leave it at 0, the
     * default, if nothing averages them, or the noise flickers. */
    int32_t noise_index;

    /* 1: plans have the memory for bent normals, and crv_plan_run_result() computes them
     * if it is given an image for them. Lighting looks a sky or a probe up along them.
     * Methods whose crv_method.bent_normal is 1. Default 0. */
    int32_t bent_normal;
} crv_options;

/* Sets every option to its default for the named method (NULL: bitmask). Pass sizeof
 * *options as struct_size (base.h). Errors: INVALID_ARGUMENT if options is NULL, the size
 * does not fit, or there is no such method (options untouched). */
CRV_API crv_status crv_options_init(crv_options *options, size_t struct_size,
                                    const char *method);

/* Sets the options of a preset of options->method, and no others; never the radius.
 * Errors: INVALID_ARGUMENT if options is NULL or not initialised, or there is no such
 * preset. */
CRV_API crv_status crv_options_preset(crv_options *options, crv_preset preset);

/* The options of a preset, as "key=value key=value". NULL if an argument is unknown.
 * Static storage. */
CRV_API const char *crv_preset_text(const crv_method *method, crv_preset preset);

typedef enum crv_option_type {
    CRV_OPTION_FLOAT = 0,
    CRV_OPTION_INT = 1,
    CRV_OPTION_BOOL = 2,
    CRV_OPTION_CHOICE = 3 /* an enum, by name */
} crv_option_type;

/* A row of the table; the default is hbao's. Static storage. */
typedef struct crv_option {
    const char *key; /* "max_radius_px": the name of the struct's member */
    crv_option_type type;
    const char *unit;               /* "px"; "" if there is none */
    double default_value, min, max; /* inclusive; a choice's are its values */
    const char *const *choices;     /* NULL-terminated, choices only; else NULL */
    const char *help;               /* one line */
} crv_option;

/* The table without method and filter: index in [0, count), NULL beyond. find takes
 * dashes for underscores and returns NULL for an unknown key. */
CRV_API int32_t crv_option_count(void);
CRV_API const crv_option *crv_option_at(int32_t index);
CRV_API const crv_option *crv_option_find(const char *key);

/* Whether this method with this filter (NULL: none) reads the option: 1 or 0. */
CRV_API int crv_option_applies(const crv_option *option, const crv_method *method,
                               const crv_filter *filter);

/* Sets an option from text. `method` and `filter` ("none" for none) are keys, too.
 * Numbers have a decimal point in every locale; bool is 0/1/true/false/on/off/yes/no;
 * choices are given by name. For an unknown key or name the log has the nearest known
 * one. Errors, with options untouched: INVALID_ARGUMENT; UNSUPPORTED if a struct of an
 * earlier size does not have the option. */
CRV_API crv_status crv_options_set(crv_options *options, const char *key,
                                   const char *value, const crv_logger *logger);

/* The value of an option; choices and bools as numbers. NaN if an argument is NULL. */
CRV_API double crv_options_get(const crv_options *options, const crv_option *option);

/* Checks every value against the table (INVALID_ARGUMENT, with a line that names the
 * option), and warns of options that differ from their default but are not read by the
 * chosen method and filter. */
CRV_API crv_status crv_options_check(const crv_options *options,
                                     const crv_logger *logger);

#ifdef __cplusplus
}
#endif
#endif

/* SPDX-License-Identifier: MIT */
/* What a method and a filter are to the rest of the library. */
#ifndef CRV_CORE_REGISTRY_H
#define CRV_CORE_REGISTRY_H

#include "core/frame.h"
#include "core/ids.h"
#include "crevice/options.h"

/* A plane that a method reads beside depth and normals, computed from them before the
 * estimate, over the whole buffers. */
typedef struct crv__map {
    const char *name;
    const char *option; /* key of the option that asks for it */
    float (*value)(const crv__frame *frame, int32_t x, int32_t y);
} crv__map;

typedef struct crv__method {
    crv_method info;
    /* The specification: raw accessibility of the pixel (x, y) of the buffers, which is
     * not background; may leave [0, 1] by its sampling error. */
    float (*accessibility)(const crv__frame *frame, int32_t x, int32_t y);
    /* The same accessibility, and the bent normal if `bent` is not NULL. NULL: the method
     * gives none. */
    float (*estimate)(const crv__frame *frame, int32_t x, int32_t y, crv__vec3 *bent);
    int32_t volumetric; /* 0 or 1: needs to know what is inside, so that further layers
                           help only as pairs of front and back */
    /* The method's sample pattern: fills options->samples points of four floats. Methods
     * with a pattern are turned by the noise through the full circle, the others through
     * one direction's sector. NULL: none. */
    void (*pattern_fill)(const crv_options *options, float *points);
    /* The map that these options need, in crv__frame.map; returns NULL if none. NULL:
     * never one. */
    const crv__map *(*map)(const crv_options *options);
    /* What crv_options_preset() sets, as "key=value key=value", in the order of
     * crv_preset. */
    const char *presets[CRV_PRESET_COUNT];
} crv__method;

typedef struct crv__filter {
    crv_filter info;
    int32_t passes;
    int32_t radius_px; /* a pixel of the result depends on input at most this far away */
    /* The specification: the pixel (x, y), which is not background, of a pass. input
     * holds the estimate in the first pass and the output of the pass before in the
     * others. Bent normals, if input has them, are weighted means of the pass's taps, and
     * not normalised. */
    crv__estimate (*filter)(const crv__frame *frame, const crv__picture *input,
                            int32_t pass, int32_t x, int32_t y);
} crv__filter;

/* The places of a method and of a filter in their lists. */
crv__method_id crv__method_id_of(const crv__method *method);
crv__filter_id crv__filter_id_of(const crv__filter *filter);

/* info is the first member, so the public pointer is the internal one. */
static inline const crv__method *crv__method_of(const crv_method *method)
{
    return (const crv__method *)(const void *)method;
}

static inline const crv__filter *crv__filter_of(const crv_filter *filter)
{
    return (const crv__filter *)(const void *)filter;
}

#endif

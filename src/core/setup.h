/* SPDX-License-Identifier: MIT */
/* What a plan is made of: the same for all its runs, on any backend. */
#ifndef CRV_CORE_SETUP_H
#define CRV_CORE_SETUP_H

#include "core/context.h"
#include "core/registry.h"

#include <stdbool.h>

typedef struct crv__setup {
    const crv_context *context;
    const crv__method *method;
    const crv__filter *filter; /* NULL: none */
    const crv__map *map;       /* that there is memory for; NULL: none */
    bool has_bent;             /* there is memory for bent normals */
    crv_options options;
    crv_gbuffer_desc desc;
    /* crv__setup_patterns() */
    crv__noise_texel *noise; /* as in crv__frame */
    float *directions, *pattern;
    uint32_t *noise_scratch;
    size_t noise_count, direction_count, point_count; /* that there is memory for */
} crv__setup;

/* Copies and checks what the host says, and makes a setup of it without its patterns.
 * INVALID_ARGUMENT with a line. */
crv_status crv__setup_take(const crv_context *context, const crv_options *options,
                           const crv_gbuffer_desc *desc, crv__setup *setup);

/* A setup without its patterns. options and desc are valid, of today's sizes. */
crv__setup crv__setup_make(const crv_context *context, const crv_options *options,
                           const crv_gbuffer_desc *desc);

/* Takes memory for directions, noise and the method's own points, and fills it;
 * OUT_OF_MEMORY without a line. Release gives back what there is. */
crv_status crv__setup_patterns(crv__setup *setup);
void crv__setup_release(crv__setup *setup);

/* The key of an option that needs other memory than the setup and its planes have; NULL:
 * none does. Valid options only. */
const char *crv__setup_obstacle(const crv__setup *setup, const crv_options *options);

/* Gives the setup other options if all its memory and the planes serve them as well; else
 * changes nothing and returns false. Valid options only. The patterns are out of date
 * until crv__setup_fill(). */
bool crv__setup_revise(crv__setup *setup, const crv_options *options);
void crv__setup_fill(const crv__setup *setup);

/* The map that the setup's options need; NULL: none. */
const crv__map *crv__setup_map(const crv__setup *setup);

/* Whether the setup's options ask for bent normals of a method that gives them. */
bool crv__setup_bent(const crv__setup *setup);

/* Fills what does not depend on the frame. */
void crv__setup_params(const crv__setup *setup, crv__params *params);

/* The result and, where the guard band has room, the margin that the filter reads beyond
 * it, so that neighbouring pieces of a picture fit together after filtering too. */
typedef struct crv__rectangle {
    int32_t x, y, width, height; /* of the buffers */
} crv__rectangle;
crv__rectangle crv__setup_rectangle(const crv__setup *setup);

#endif

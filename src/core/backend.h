/* SPDX-License-Identifier: MIT */
/* What a device does for a plan. */
#ifndef CRV_CORE_BACKEND_H
#define CRV_CORE_BACKEND_H

#include "core/context.h"
#include "core/registry.h"

/* What a plan is made of: the same for all its runs. */
typedef struct crv__setup {
    const crv_context *context;
    const crv__method *method;
    const crv__filter *filter; /* NULL: none */
    crv_options options;
    crv_gbuffer_desc desc;
    crv__noise_texel *noise; /* as in crv__frame */
    float *directions, *pattern;
} crv__setup;

/* Fills what does not depend on the frame. */
void crv__setup_params(const crv__setup *setup, crv__params *params);

/* Takes and fills directions, noise and the method's own points; 0, or -1 where memory is
 * out. Release gives back what there is. */
int crv__setup_patterns(crv__setup *setup);
void crv__setup_release(crv__setup *setup);

/* The result and, where the guard band has room, the margin that the filter reads. */
typedef struct crv__rectangle {
    int32_t x, y, width, height; /* of the buffers */
} crv__rectangle;
crv__rectangle crv__setup_rectangle(const crv__setup *setup);

typedef struct crv__work {
    const crv__setup *setup;
    void *state; /* the backend's own, from plan_create() */
    const crv__frame *frame;
} crv__work;

/*
 * A plan's two planes cover the same rectangle: the result and, where the guard band has
 * room, the margin that the filter reads beyond it.
 */
struct crv__backend {
    const char *name;
    /* Takes all that runs need beside the planes, with the context's allocator; *state
     * may stay NULL. Logs its own error line. */
    crv_status (*plan_create)(const crv__setup *setup, const crv__plane *rectangle,
                              void **state);
    void (*plan_destroy)(const crv__setup *setup, void *state);
    /* Writes the accessibility of every pixel to planes[0], intensity and contrast
     * applied, background 1; with `filter_only` planes[0] holds it already. Then runs the
     * filter's passes to and fro. *result is the plane that holds the outcome. Allocates
     * nothing. */
    crv_status (*run)(const crv__work *work, int filter_only, const crv__plane planes[2],
                      const crv__plane **result);
    /* The last run's, see crv_plan_device_times(); NULL: there are none. */
    crv_status (*times)(const crv__setup *setup, const void *state,
                        crv_device_time *times, int32_t *count);
    void (*close)(crv_context *context); /* its device; NULL: nothing to do */
};

extern const crv__backend crv__cpu_backend;

/* Gives the context a Vulkan device and its backend. UNSUPPORTED with a line where there
 * is none, or the library was built without (vulkan/absent.c). */
crv_status crv__vulkan_open(crv_context *context, int32_t index);

/* A context on the CPU that is not yet anybody's: crv_context_create() without the
 * device. */
crv_status crv__context_create_bare(const crv_context_desc *desc, crv_context **out);

#endif

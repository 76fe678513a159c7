/* SPDX-License-Identifier: MIT */
/* Backends: what computes a plan. */
#ifndef CRV_CORE_BACKEND_H
#define CRV_CORE_BACKEND_H

#include "core/setup.h"

/* One run of a plan. */
typedef struct crv__work {
    const crv__setup *setup;
    void *state; /* the backend's own, from plan_create() */
    const crv__frame *frame;
    bool filter_only; /* the estimate is there already */
    bool with_bent;   /* bent normals are wanted, and the plan has their planes */
    /* The host's image that the filtered accessibility may be written to, instead of a
     * plane; NULL: only when the run has come to its end */
    const crv_image *target;
} crv__work;

/* A plan's two pictures cover the same rectangle, crv__setup_rectangle(). */
struct crv__backend {
    const char *name;
    crv_device device;
    /* Makes the context compute on the device with this number: its backend, and what
     * else of the context the backend brings. Logs its own error line. */
    crv_status (*open)(crv_context *context, int32_t index);
    void (*close)(crv_context *context); /* gives back the device; NULL: nothing to do */
    /* Takes all that runs need beside the planes, with the context's allocator; *state
     * may stay NULL. Logs its own error line. */
    crv_status (*plan_create)(const crv__setup *setup, const crv__plane *rectangle,
                              void **state);
    void (*plan_destroy)(const crv__setup *setup, void *state);
    /* The setup has new options (crv__setup_revise()). Makes the state that of a plan
     * created with them, without memory; false, and nothing is changed, if that cannot be
     * done. NULL: it never can. */
    bool (*plan_update)(const crv__setup *setup, void *state);
    /* Writes the accessibility of every pixel to pictures[0], intensity and contrast
     * applied, background 1, and the bent normals of those that are not background; then
     * runs the filter's passes to and fro. *result: the planes that hold the outcome.
     * Its bent normals need not have unit length. Allocates nothing. */
    crv_status (*run)(const crv__work *work, const crv__picture pictures[2],
                      crv__picture *result);
    /* The last run's, see crv_plan_device_times(); NULL: there are none. */
    crv_status (*times)(const crv__setup *setup, const void *state,
                        crv_device_time *times, int32_t *count);
};

/* All of them, NULL at the end (src/backends.c). The first computes on the host: every
 * context begins with it. */
extern const crv__backend *const crv__backends[];

#endif

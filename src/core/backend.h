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
} crv__work;

/* A plan's two planes cover the same rectangle, crv__setup_rectangle(). */
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
    /* Writes the accessibility of every pixel to planes[0], intensity and contrast
     * applied, background 1; with `filter_only` planes[0] holds it already. Then runs the
     * filter's passes to and fro. *result is the plane that holds the outcome. Allocates
     * nothing. */
    crv_status (*run)(const crv__work *work, int filter_only, const crv__plane planes[2],
                      const crv__plane **result);
    /* The last run's, see crv_plan_device_times(); NULL: there are none. */
    crv_status (*times)(const crv__setup *setup, const void *state,
                        crv_device_time *times, int32_t *count);
};

/* All of them, NULL at the end (src/backends.c). The first computes on the host: every
 * context begins with it. */
extern const crv__backend *const crv__backends[];

#endif

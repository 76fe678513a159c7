/* SPDX-License-Identifier: MIT */
/* What a device does for a plan. */
#ifndef CRV_CORE_BACKEND_H
#define CRV_CORE_BACKEND_H

#include "core/context.h"
#include "core/registry.h"

typedef struct crv__work {
    const crv_context *context;
    const crv__frame *frame;
} crv__work;

typedef struct crv__backend {
    const char *name;
    /* Writes the accessibility of every pixel of out's rectangle, intensity and contrast
     * applied, background 1. */
    void (*estimate)(const crv__work *work, const crv__method *method,
                     const crv__plane *out);
    /* One pass of a filter from input to the same rectangle of out, background 1. */
    void (*filter)(const crv__work *work, const crv__filter *filter, int32_t pass,
                   const crv__plane *input, const crv__plane *out);
} crv__backend;

extern const crv__backend crv__cpu_backend;

#endif

/* SPDX-License-Identifier: MIT */
/* The registry of backends: one line each. */
#include "core/backend.h"

extern const crv__backend crv__cpu_backend, crv__vulkan_backend;

const crv__backend *const crv__backends[] = {
    &crv__cpu_backend,
    &crv__vulkan_backend,
    NULL,
};

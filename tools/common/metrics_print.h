/* SPDX-License-Identifier: MIT */
#ifndef TOOL_METRICS_PRINT_H
#define TOOL_METRICS_PRINT_H

#include "metrics.h"
#include "metrics_angles.h"
#include "metrics_fit.h"
#include "report.h"

/* All that was found out about two pictures. */
typedef struct metrics_findings {
    const char *a, *b; /* their files */
    int32_t width, height;
    metrics m;
    metrics_fit fit;
    double flip, flip_ppd;
    bool has_bent; /* both have bent normals */
    double open;   /* accessibility of B above which surfaces are open */
    metrics_angles bent, bent_open;
    const char *heat_map; /* NULL: none was written */
    double heat_scale;
} metrics_findings;

/* To stdout. Returns an exit code; numbers that are not finite are null. */
int metrics_print_json(const metrics_findings *f, report *r);

void metrics_print_text(const metrics_findings *f);

#endif

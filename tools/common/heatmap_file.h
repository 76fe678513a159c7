/* SPDX-License-Identifier: MIT */
#ifndef TOOL_HEATMAP_FILE_H
#define TOOL_HEATMAP_FILE_H

#include "report.h"

/* What is painted: see heatmap_fill(). */
typedef struct heatmap_source {
    const float *a, *b;
    const uint8_t *mask;
    int32_t width, height;
    double scale;
} heatmap_source;

/* Whether a heat map could be written there, and would not replace one of the inputs.
 * Returns an exit code; meant for before the work. */
int heatmap_check(const char *path, const char *input_a, const char *input_b, report *r);

/* PNG: R, G, B. EXR: these in linear light, and the signed error itself in a channel
 * "error", 0 in the background. Returns an exit code. */
int heatmap_write(const char *path, const heatmap_source *source, report *r);

#endif

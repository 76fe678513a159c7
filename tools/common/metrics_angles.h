/* SPDX-License-Identifier: MIT */
/* metrics_angles.h: how far the directions of two pictures are apart. */
#ifndef TOOL_METRICS_ANGLES_H
#define TOOL_METRICS_ANGLES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct metrics_angles {
    int64_t pixels; /* compared: those where both have a direction */
    /* Half and 95 percent of the angles are below; between two angles in a line. NAN
     * without a pixel. */
    double median_deg, q95_deg;
} metrics_angles;

/* a, b: planes of x, y and z, of any length above 0 (0: no direction), finite where they
 * are compared. mask: a byte for each pixel, nonzero to compare it, or NULL for all.
 * Returns false if memory ran out. */
bool metrics_compare_angles(const float *const a[3], const float *const b[3],
                            const uint8_t *mask, size_t count, metrics_angles *out);

#endif

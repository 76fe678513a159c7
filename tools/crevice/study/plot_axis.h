/* SPDX-License-Identifier: MIT */
/* plot_axis.h: axes with round numbers. */
#ifndef TOOL_STUDY_PLOT_AXIS_H
#define TOOL_STUDY_PLOT_AXIS_H

#include <stdbool.h>
#include <stdint.h>

enum { PLOT_MAX_TICKS = 64 };

typedef struct plot_tick {
    double value;
    bool has_label; /* the others are thin */
} plot_tick;

typedef struct plot_axis {
    double low, high; /* both ends are ticks */
    bool is_log;
    plot_tick ticks[PLOT_MAX_TICKS];
    int32_t tick_count;
} plot_axis;

/* An axis that shows all of low to high, which are finite, above 0 where is_log. */
plot_axis plot_axis_make(double low, double high, bool is_log, bool from_zero);

/* Where a value lies between low (0) and high (1). */
double plot_axis_place(const plot_axis *axis, double value);

/* "0.25", "1e-5". */
void plot_axis_label(double value, char *out, int32_t size);

#endif

/* SPDX-License-Identifier: MIT */
/*
 * plot.h: line and scatter plots as SVG on a page. Colours come from the page's style
 * sheet, so that they suit light and dark; series differ by marker and dash as well as by
 * colour. Non-finite points, and points not above 0 on a logarithmic axis, are left out.
 */
#ifndef TOOL_STUDY_PLOT_H
#define TOOL_STUDY_PLOT_H

#include "page.h"

#define PLOT_MAX_SERIES 12

typedef struct plot_series {
    const char *name;
    const double *x, *y;
    const char *const *labels; /* one for each point (shown as its tooltip), or NULL */
    int32_t count;
    bool is_line;  /* points joined in order; else points alone */
    bool is_guide; /* a bound or an ideal: thin, dashed, without markers */
} plot_series;

typedef struct plot {
    const char *caption;
    const char *x_title, *y_title; /* with units */
    bool log_x, log_y;
    bool y_from_zero; /* linear y axes begin at 0 */
    const plot_series *series;
    int32_t series_count; /* PLOT_MAX_SERIES at most */
    /* Draws the stairs of the points that no other beats in both x and y, smaller being
     * better. */
    bool pareto;
} plot;

void page_plot(page *p, const plot *what);

/* Which points no other is as good as in both and better than in one: sets on_front[i].
 * Equal points are both on it; points that are not finite are not. */
void plot_pareto(const double *x, const double *y, int32_t count, bool *on_front);

#endif

/* SPDX-License-Identifier: MIT */
/* frame_facts.h: what a user would want to be told of a frame before its picture. */
#ifndef TOOL_FRAME_FACTS_H
#define TOOL_FRAME_FACTS_H

#include "common/estimate.h"
#include "passes/passes.h"

/* Zeroed: of no frame yet. */
typedef struct frame_facts {
    bool known, has_normals;
    crv_gbuffer_desc desc;
    int32_t display_width, display_height;
} frame_facts;

/* Keeps the facts of the first frame of a shot, and warns if a later one has other
 * passes, another size or overscan. */
void facts_compare(frame_facts *first, const io_frame *frame, const char *path,
                   report *r);

/* Warns if a picture is open everywhere because no pixel has a usable depth. Returns
 * an exit code. */
int facts_check_surface(estimator *e, const io_image *ao, const char *path, report *r);

/* Makes the image's data window its display window; what it did not cover is open.
 * Returns an exit code. */
int facts_fill_display(io_image *ao, report *r);

#endif

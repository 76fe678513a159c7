/* SPDX-License-Identifier: MIT */
/* The pixel under the pointer, in words. */
#include "app.h"

#include <stdio.h>
#include <string.h>

bool probe_text(const app *a, int32_t x, int32_t y, char *out, size_t size)
{
    const shown *s = &a->shown;
    const buffers *b = s->buffers;
    if (!b || x < 0 || y < 0 || x >= b->width || y >= b->height)
        return false;
    const size_t i = (size_t)y * (size_t)b->width + (size_t)x;
    const size_t g = buffers_index(b, x, y);
    const float *n = b->g.normals + 3 * g;
    int used = snprintf(out, size, "pixel %d,%d  ", x, y);
    if (!b->surface[i]) {
        snprintf(out + used, size - (size_t)used, "background");
        return true;
    }
    used += snprintf(out + used, size - (size_t)used, "depth %.6g  normal %.3f,%.3f,%.3f",
                     (double)b->g.depth[0][g], (double)n[0], (double)n[1], (double)n[2]);
    for (int k = 0; k < HALVES; k++) {
        const half_shown *h = &s->half[k];
        const bool known = s->wish.half[k].content != HALF_TRUTH || s->coarseness > 1
                           || (h->has_truth && (int64_t)i < h->truth.known);
        used +=
            snprintf(out + used, size - (size_t)used, known ? "  %s %.4f" : "  %s ...",
                     k == 0 ? "left" : "right", (double)h->accessibility[i]);
    }
    const half_shown *h = &s->half[x >= a->split * b->width];
    if (h->has_truth && (int64_t)i < h->truth.known)
        snprintf(out + used, size - (size_t)used, "  truth %.4f",
                 (double)h->truth_plane[i]);
    return true;
}

void probe_tell(app *a)
{
    char text[512] = "";
    int32_t x, y;
    if (!a->status)
        return;
    if (a->pointer_x >= 0.0 && canvas_pixel(a, a->pointer_x, a->pointer_y, &x, &y))
        probe_text(a, x, y, text, sizeof text);
    char *line =
        g_strdup_printf("%s%s%s", text, text[0] && a->told[0] ? "   " : "", a->told);
    gtk_label_set_text(GTK_LABEL(a->status), line);
    g_free(line);
}

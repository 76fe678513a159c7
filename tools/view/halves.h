/* SPDX-License-Identifier: MIT */
/* halves.h: what an engine makes of its G-buffer: accessibility, pixels and numbers. */
#ifndef VIEW_HALVES_H
#define VIEW_HALVES_H

#include "engine.h"

/* Makes both halves of the picture; false after a failure. */
bool halves_make(engine *e, const wish *w, shown *out);

/* Tells the thread of the truth what is wanted. */
void halves_want_truths(engine *e, const wish *w);

/* What the truth of a half is, for this input. */
reference_options halves_target(const engine *e, const wish *w, int half);

/* All that was made of the G-buffer is void. */
void halves_forget(engine *e);

/* Whether the picture is more than a glimpse. */
bool halves_are_settled(const engine *e, const wish *w);

/* Pixels inside the guard band. */
size_t halves_plane_count(const engine *e);

/* halves_paint.c: the pixels of a half whose accessibility is there. */
bool halves_paint(engine *e, const wish *w, int half, shown *out);
void halves_forget_paint(engine *e);

#endif

/* SPDX-License-Identifier: MIT */
#include "pattern_search.h"

#include <math.h>

static double limited(const search *s, int number, double value)
{
    return fmin(fmax(value, s->low[number]), s->high[number]);
}

/* Whether the point moved by `by` along one number is better; then *best is that. */
static bool try_move(const search *s, const search_point *from, int number, double by,
                     search_point *best)
{
    search_point to = *from;
    to.number[number] = limited(s, number, from->number[number] + by);
    if (!(fabs(to.number[number] - from->number[number]) > 0.0) || s->stop(s->user))
        return false;
    s->evaluate(s->user, &to);
    if (!(to.value < best->value))
        return false;
    *best = to;
    return true;
}

static bool is_searched(const search *s, unsigned numbers, const search_point *at, int i)
{
    return (numbers >> i & 1u) != 0 && s->depends(s->user, at, i);
}

/* The best of *at and its neighbours, along one number after the other. */
static void explore(const search *s, unsigned numbers, double step, search_point *at)
{
    for (int i = 0; i < SEARCH_NUMBERS; i++) {
        const search_point from = *at;
        if (is_searched(s, numbers, &from, i) && !try_move(s, &from, i, step, at))
            try_move(s, &from, i, -step, at);
    }
}

/* As far again as from `a` to `b`. */
static search_point beyond(const search *s, unsigned numbers, const search_point *a,
                           const search_point *b)
{
    search_point to = *b;
    for (int i = 0; i < SEARCH_NUMBERS; i++)
        if (is_searched(s, numbers, b, i))
            to.number[i] = limited(s, i, 2.0 * b->number[i] - a->number[i]);
    return to;
}

void search_downhill(const search *s, unsigned numbers, double step, double least,
                     search_point *best)
{
    while (step >= least && !s->stop(s->user)) {
        search_point next = *best;
        explore(s, numbers, step, &next);
        if (!(next.value < best->value)) {
            step *= 0.5;
            continue;
        }
        /* As long as going on in the same direction helps. */
        while (next.value < best->value) {
            search_point ahead = beyond(s, numbers, best, &next);
            *best = next;
            if (s->stop(s->user))
                return;
            s->evaluate(s->user, &ahead);
            explore(s, numbers, step, &ahead);
            next = ahead;
        }
    }
}

void search_scan(const search *s, int number, double step, int count, search_point *best)
{
    const search_point from = *best;
    if (!s->depends(s->user, &from, number))
        return;
    for (int i = 1; i <= count; i++) {
        try_move(s, &from, number, i * step, best);
        try_move(s, &from, number, -i * step, best);
    }
}

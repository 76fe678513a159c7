/* SPDX-License-Identifier: MIT */
/*
 * pattern_search.h: the least of a function of a few numbers, without its derivatives
 * (Hooke, Jeeves 1961, "Direct search" solution of numerical and statistical problems).
 */
#ifndef TOOL_PATTERN_SEARCH_H
#define TOOL_PATTERN_SEARCH_H

#include <stdbool.h>
#include <stdint.h>

enum { SEARCH_NUMBERS = 4, SEARCH_CHOICES = 2 };

/* Where the function is looked at. Choices are carried along. */
typedef struct search_point {
    double number[SEARCH_NUMBERS];
    int32_t choice[SEARCH_CHOICES];
    double value; /* of the function; INFINITY: it has none there */
} search_point;

typedef struct search {
    double low[SEARCH_NUMBERS], high[SEARCH_NUMBERS];
    /* Sets at->value. It may also set the numbers that are not searched. */
    void (*evaluate)(void *user, search_point *at);
    /* Whether the function depends on this number there. */
    bool (*depends)(void *user, const search_point *at, int number);
    /* Asked before each evaluation: true ends the search. */
    bool (*stop)(void *user);
    void *user;
} search;

/* Goes downhill from *best, whose value is known: along the numbers whose bits are set,
 * at first by `step`, then by half of it and so on while it is at least `least`. */
void search_downhill(const search *s, unsigned numbers, double step, double least,
                     search_point *best);

/* Looks at `count` points on each side of *best along one number, `step` apart. */
void search_scan(const search *s, int number, double step, int count, search_point *best);

#endif

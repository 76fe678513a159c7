/* SPDX-License-Identifier: MIT */
#include "quadrature.h"

#include <math.h>

/* Midpoints of rings and sectors: with a kink on the groove's edge and a jump at the
 * radius the error is of the order of 1 / RINGS. */
enum { RINGS = 1000, SECTORS = 2000 };

static const double PI = 3.14159265358979323846;

/* Calls a function for the parts of a disk, (dx, dy) from its centre, weights summing to
 * its area. */
typedef void (*part_fn)(void *data, double dx, double dy, double area);

static void for_disk(double radius, part_fn part, void *data)
{
    const double width = radius / RINGS, angle = 2 * PI / SECTORS;
    for (int i = 0; i < RINGS; i++) {
        const double r = (i + 0.5) * width;
        for (int k = 0; k < SECTORS; k++) {
            const double a = (k + 0.5) * angle;
            part(data, r * cos(a), r * sin(a), r * width * angle);
        }
    }
}

typedef struct alchemy_sum {
    const quadrature_site *site;
    const quadrature_alchemy *numbers;
    double sum;
} alchemy_sum;

static void add_alchemy(void *data, double dx, double dy, double area)
{
    alchemy_sum *s = data;
    const quadrature_site *site = s->site;
    const double rise =
        fabs(site->x + dx) - site->x; /* of the surface, towards the eye */
    const double squared = dx * dx + dy * dy + rise * rise;
    if (squared > site->radius * site->radius)
        return;
    const double along_n = sqrt(0.5) * (rise - dx); /* n = (-1, 0, 1) / sqrt 2 */
    const double d = site->depth - site->x;
    s->sum +=
        area * fmax(0, along_n - d * s->numbers->beta) / (squared + s->numbers->eps);
}

double quadrature_of_alchemy(const quadrature_site *site,
                             const quadrature_alchemy *numbers)
{
    alchemy_sum s = {site, numbers, 0};
    for_disk(site->radius, add_alchemy, &s);
    return 1 - 2 * numbers->sigma * s.sum / (PI * site->radius * site->radius);
}

typedef struct vo_sum {
    const quadrature_site *site;
    double open, chords;
} vo_sum;

static void add_vo(void *data, double dx, double dy, double area)
{
    vo_sum *s = data;
    const quadrature_site *site = s->site;
    const double half = sqrt(fmax(0, site->radius * site->radius - dx * dx - dy * dy));
    const double behind = site->x - fabs(site->x + dx); /* the surface, from the point */
    s->open += area * (fmin(fmax(behind, -half), half) + half);
    s->chords += area * 2 * half;
}

double quadrature_of_vo(const quadrature_site *site)
{
    vo_sum s = {site, 0, 0};
    for_disk(site->radius, add_vo, &s);
    return fmin(1, 2 * s.open / s.chords);
}

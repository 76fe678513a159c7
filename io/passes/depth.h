/* SPDX-License-Identifier: MIT */
/* depth.h: what the numbers of a depth channel tell. */
#ifndef CREVICE_IO_PASSES_DEPTH_H
#define CREVICE_IO_PASSES_DEPTH_H

#include "passes.h"

/* What the numbers of a depth channel look like, before any conversion. */
typedef struct io__depth_facts {
    size_t count; /* finite numbers */
    float smallest, largest;
    size_t at_largest;      /* how many are exactly the largest */
    size_t at_smallest;     /* the smallest */
    size_t near_by, behind; /* how many others are at least a 1.5th, an 8th of it */
    bool
        bare_at_largest; /* pixels at the largest have no normal, and there are normals */
    bool is_half;        /* all have the bits of half floats */
} io__depth_facts;

/* normals may be NULL. Numbers from `background` on are not looked at. */
io__depth_facts io__depth_facts_of(const crv_image *depth, const crv_image *normals,
                                   float background);

/* Whether the largest depth is sky that nobody marked. */
bool io__largest_is_sky(const io__depth_facts *facts);

#endif

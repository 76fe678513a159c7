/* SPDX-License-Identifier: MIT */
/*
 * The one rule for public structs that begin with size_t struct_size. Members are added
 * at the end, so that the size tells which of them a program knows: every earlier size is
 * accepted, and missing members take their defaults. A larger size is refused, since what
 * it asks for is not known here.
 */
#ifndef CRV_BASE_STRUCTS_H
#define CRV_BASE_STRUCTS_H

#include "crevice/base.h"

#include <stdbool.h>

/* The size up to the end of a member: the least that a struct must have. */
#define CRV__SIZE_TO(type, member) (offsetof(type, member) + sizeof(((type *)0)->member))

typedef struct crv__struct {
    const char *name; /* "gbuffer desc", for the log */
    const char *init; /* "crv_gbuffer_desc_init()" */
    size_t first;     /* the least size that is accepted */
    size_t size;      /* today's */
} crv__struct;

/* What every _init does: copies the defaults as far as struct_size goes. If struct_size
 * does not fit, everything but struct_size is zeroed, so that later calls refuse it. */
crv_status crv__struct_init(const crv__struct *rule, void *to, size_t struct_size,
                            const void *defaults);

/* What every call that takes such a struct does: copies it over *to, which holds the
 * defaults. INVALID_ARGUMENT with a line if it is NULL, not initialised or too large. */
crv_status crv__struct_take(const crv__struct *rule, const crv_logger *logger,
                            const void *from, void *to);

#endif

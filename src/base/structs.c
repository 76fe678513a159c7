/* SPDX-License-Identifier: MIT */
#include "base/structs.h"

#include "base/log.h"

#include <string.h>

static bool fits(const crv__struct *rule, size_t size)
{
    return size >= rule->first && size <= rule->size;
}

crv_status crv__struct_init(const crv__struct *rule, void *to, size_t struct_size,
                            const void *defaults)
{
    if (!to || struct_size < sizeof struct_size)
        return CRV_ERROR_INVALID_ARGUMENT;
    if (fits(rule, struct_size))
        memcpy(to, defaults, struct_size);
    else
        memset(to, 0, struct_size);
    memcpy(to, &struct_size, sizeof struct_size);
    return fits(rule, struct_size) ? CRV_OK : CRV_ERROR_INVALID_ARGUMENT;
}

crv_status crv__struct_take(const crv__struct *rule, const crv_logger *logger,
                            const void *from, void *to)
{
    size_t given = 0;
    if (from)
        memcpy(&given, from, sizeof given);
    if (given > rule->size)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "%s: struct_size is %zu, libcrevice %s knows %zu bytes; use a "
                         "library that is as new as the headers, and begin with %s",
                         rule->name, given, crv_version(), rule->size, rule->init);
    if (given < rule->first)
        return crv__fail(logger, CRV_ERROR_INVALID_ARGUMENT,
                         "%s: NULL or not initialised; begin with %s", rule->name,
                         rule->init);
    memcpy(to, from, given);
    memcpy(to, &rule->size, sizeof rule->size);
    return CRV_OK;
}

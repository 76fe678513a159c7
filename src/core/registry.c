/* SPDX-License-Identifier: MIT */
#include "core/registry.h"

#include <string.h>

#define CRV__METHOD(name) extern const crv__method crv__method_##name;
#include "methods/list.h"
#undef CRV__METHOD
#define CRV__FILTER(name) extern const crv__filter crv__filter_##name;
#include "filters/list.h"
#undef CRV__FILTER

static const crv__method *const METHODS[] = {
#define CRV__METHOD(name) &crv__method_##name,
#include "methods/list.h"
#undef CRV__METHOD
};

static const crv__filter *const FILTERS[] = {
#define CRV__FILTER(name) &crv__filter_##name,
#include "filters/list.h"
#undef CRV__FILTER
};

enum {
    METHOD_COUNT = sizeof METHODS / sizeof METHODS[0],
    FILTER_COUNT = sizeof FILTERS / sizeof FILTERS[0]
};

int32_t crv_method_count(void)
{
    return METHOD_COUNT;
}

const crv_method *crv_method_at(int32_t index)
{
    return index >= 0 && index < METHOD_COUNT ? &METHODS[index]->info : NULL;
}

const crv_method *crv_method_find(const char *name)
{
    for (int32_t i = 0; name && i < METHOD_COUNT; i++) {
        if (strcmp(METHODS[i]->info.name, name) == 0)
            return &METHODS[i]->info;
    }
    return NULL;
}

int32_t crv_filter_count(void)
{
    return FILTER_COUNT;
}

const crv_filter *crv_filter_at(int32_t index)
{
    return index >= 0 && index < FILTER_COUNT ? &FILTERS[index]->info : NULL;
}

const crv_filter *crv_filter_find(const char *name)
{
    for (int32_t i = 0; name && i < FILTER_COUNT; i++) {
        if (strcmp(FILTERS[i]->info.name, name) == 0)
            return &FILTERS[i]->info;
    }
    return NULL;
}

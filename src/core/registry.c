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

int32_t crv_method_count(void)
{
    return CRV__METHOD_COUNT;
}

const crv_method *crv_method_at(int32_t index)
{
    return index >= 0 && index < CRV__METHOD_COUNT ? &METHODS[index]->info : NULL;
}

const crv_method *crv_method_find(const char *name)
{
    for (int32_t i = 0; name && i < CRV__METHOD_COUNT; i++) {
        if (strcmp(METHODS[i]->info.name, name) == 0)
            return &METHODS[i]->info;
    }
    return NULL;
}

int32_t crv_filter_count(void)
{
    return CRV__FILTER_COUNT;
}

const crv_filter *crv_filter_at(int32_t index)
{
    return index >= 0 && index < CRV__FILTER_COUNT ? &FILTERS[index]->info : NULL;
}

const crv_filter *crv_filter_find(const char *name)
{
    for (int32_t i = 0; name && i < CRV__FILTER_COUNT; i++) {
        if (strcmp(FILTERS[i]->info.name, name) == 0)
            return &FILTERS[i]->info;
    }
    return NULL;
}

crv__method_id crv__method_id_of(const crv__method *method)
{
    int32_t id = 0;
    while (METHODS[id] != method)
        id++;
    return (crv__method_id)id;
}

crv__filter_id crv__filter_id_of(const crv__filter *filter)
{
    int32_t id = 0;
    while (FILTERS[id] != filter)
        id++;
    return (crv__filter_id)id;
}

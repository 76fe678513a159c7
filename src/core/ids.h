/* SPDX-License-Identifier: MIT */
/* The numbers of methods and filters, in the order of their lists. */
#ifndef CRV_CORE_IDS_H
#define CRV_CORE_IDS_H

typedef enum crv__method_id {
#define CRV__METHOD(name) CRV__METHOD_##name,
#include "methods/list.h"
#undef CRV__METHOD
    CRV__METHOD_COUNT
} crv__method_id;

typedef enum crv__filter_id {
#define CRV__FILTER(name) CRV__FILTER_##name,
#include "filters/list.h"
#undef CRV__FILTER
    CRV__FILTER_COUNT
} crv__filter_id;

#endif

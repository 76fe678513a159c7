/* SPDX-License-Identifier: MIT */
/* The kernels of this instruction set. */
#include "cpu/kernels/kernel.h"
#include "cpu/simd/vector.h"

#define CRV__ESTIMATE(name)                                                              \
    void CRV__NAME(name)(const crv__frame *, int32_t, int32_t, int32_t, float *);
#define CRV__LEAN(name) CRV__ESTIMATE(name##_lean)
#define CRV__FILTER(name)                                                                \
    void CRV__NAME(name)(const crv__frame *, const crv__plane *, const crv__plane *,     \
                         crv__tile);
#define CRV__FAST(name, ...)                                                             \
    int CRV__NAME(name##_fast)(const crv__frame *, const crv__fast *,                    \
                               const crv__fast_tile *, const crv__plane *);
#include "cpu/kernels/list.h"
#undef CRV__ESTIMATE
#undef CRV__LEAN
#undef CRV__FILTER
#undef CRV__FAST

void CRV__NAME(deal)(const crv__frame *, const crv__fast *, int32_t);

static const crv__named_estimate ESTIMATES[] = {
#define CRV__ESTIMATE(name) {#name, CRV__NAME(name)},
#define CRV__LEAN(name)
#define CRV__FILTER(name)
#define CRV__FAST(...)
#include "cpu/kernels/list.h"
#undef CRV__ESTIMATE
#undef CRV__LEAN
    {0}};

static const crv__named_estimate LEAN[] = {
#define CRV__ESTIMATE(name)
#define CRV__LEAN(name) {#name, CRV__NAME(name##_lean)},
#include "cpu/kernels/list.h"
#undef CRV__LEAN
#undef CRV__FILTER
    {0}};

static const crv__named_filter FILTERS[] = {
#define CRV__LEAN(name)
#define CRV__FILTER(name) {#name, CRV__NAME(name)},
#include "cpu/kernels/list.h"
#undef CRV__FILTER
#undef CRV__FAST
    {0}};

static const crv__fast_kind FAST[] = {
#define CRV__FILTER(name)
#define CRV__FAST(name, ...) {#name, CRV__NAME(name##_fast), __VA_ARGS__},
#include "cpu/kernels/list.h"
    {0}};

void CRV__NAME(depth_row)(const crv__depth_map *, const float *, ptrdiff_t, int32_t,
                          int32_t, float *);
void CRV__NAME(rotated_row)(const float *, const float *, ptrdiff_t, ptrdiff_t, int32_t,
                            float *const *);
void CRV__NAME(normals_row)(const crv__params *, const crv__plane *, const crv__plane *,
                            int32_t, int32_t);

extern const crv__kernels CRV__NAME(kernels);
const crv__kernels CRV__NAME(kernels) = {
    ESTIMATES,
    LEAN,
    FILTERS,
    FAST,
    CRV__NAME(deal),
    {CRV__NAME(depth_row), CRV__NAME(rotated_row), CRV__NAME(normals_row)}};

/* SPDX-License-Identifier: MIT */
/* The kernels of this instruction set. */
#include "cpu/kernels/kernel.h"
#include "cpu/simd/vector.h"

#define CRV__ESTIMATE(name)                                                              \
    void CRV__NAME(name)(const crv__frame *, int32_t, int32_t, int32_t, float *);
#define CRV__BENT(name)                                                                  \
    void CRV__NAME(name##_bent)(const crv__frame *, int32_t, int32_t, int32_t, float *,  \
                                float *const[3]);
#define CRV__MAP(method, name)                                                           \
    void CRV__NAME(name)(const crv__frame *, const crv__plane *, crv__tile);
#define CRV__FILTER(name)                                                                \
    void CRV__NAME(name)(const crv__frame *, const crv__picture *, const crv__picture *, \
                         crv__tile);
#define CRV__DEINTERLEAVED(name)                                                         \
    extern const crv__deinterleaved_method CRV__NAME(name##_deinterleaved);
#include "cpu/kernels/list.h"
#undef CRV__ESTIMATE
#undef CRV__BENT
#undef CRV__MAP
#undef CRV__FILTER
#undef CRV__DEINTERLEAVED

void CRV__NAME(deinterleave)(const crv__frame *, const crv__deinterleaved *, int32_t);
void CRV__NAME(depth_row)(const crv__depth_map *, const crv__texel_row *, int32_t,
                          int32_t, float *);
void CRV__NAME(rotated_row)(const float *, const crv__texel_row *, int32_t,
                            float *const *);
void CRV__NAME(normals_row)(const crv__params *, const crv__plane *, const crv__plane *,
                            int32_t, int32_t);

extern const crv__kernels CRV__NAME(kernels);
const crv__kernels CRV__NAME(kernels) = {
#define CRV__ESTIMATE(name)    .estimates[CRV__METHOD_##name] = CRV__NAME(name),
#define CRV__BENT(name)        .bents[CRV__METHOD_##name] = CRV__NAME(name##_bent),
#define CRV__MAP(method, name) .maps[CRV__METHOD_##method] = CRV__NAME(name),
#define CRV__FILTER(name)      .filters[CRV__FILTER_##name] = CRV__NAME(name),
#define CRV__DEINTERLEAVED(name)                                                         \
    .deinterleaved[CRV__METHOD_##name] = &CRV__NAME(name##_deinterleaved),
#include "cpu/kernels/list.h"
    .deinterleave = CRV__NAME(deinterleave),
    .conversions = {.depth_row = CRV__NAME(depth_row),
                    .rotated_row = CRV__NAME(rotated_row),
                    .normals_row = CRV__NAME(normals_row)}};

/* SPDX-License-Identifier: MIT */
/* Deinterleaves depth by the phases of the noise tile. */
#include "cpu/kernels/groups.h"

void CRV__NAME(deinterleave)(const crv__frame *f, const crv__deinterleaved *di,
                             int32_t y);
void CRV__NAME(deinterleave)(const crv__frame *f, const crv__deinterleaved *di, int32_t y)
{
    const vf background = vf_set(di->background);
    const int32_t end =
        (di->columns + CRV__GROUP_PIXELS - 1) / CRV__GROUP_PIXELS * CRV__GROUP_PIXELS;
    float room[CRV__GROUP_SPAN];
    const int32_t layers = f->params->layers, planes = layers + (f->map ? 1 : 0);
    for (int32_t layer = 0; layer < planes; layer++) {
        const crv__plane *plane = layer < layers ? &f->depth[layer] : f->map;
        float *first = di->depth + layer * di->layer_pitch, *rows[CRV__PHASES];
        for (int32_t k = 0; k < CRV__PHASES; k++)
            rows[k] = first + crv__deinterleaved_index(di, y, k, 0);
        for (int32_t m = 0; m < end; m += CRV__GROUP_PIXELS) {
            const float *span = crv__span_read(plane, m * CRV__PHASES - di->left, y,
                                               di->background, room, CRV__GROUP_SPAN);
            for (int32_t i = 0; i < CRV__GROUP_PIXELS; i += CRV__LANES) {
                vf parts[4];
                vf_split4(span + 4 * i, parts);
                for (int32_t k = 0; k < CRV__PHASES; k++)
                    vf_store(rows[k] + m + i,
                             vf_min(parts[k], background)); /* NaN becomes that too */
            }
        }
        for (int32_t i = 0; i < CRV__ROW_PADDING; i += CRV__LANES) {
            for (int32_t k = 0; k < CRV__PHASES; k++) {
                vf_store(rows[k] - CRV__ROW_PADDING + i, background);
                vf_store(rows[k] + end + i, background);
            }
        }
        for (int32_t i = 0; y == 0 && i < di->pitch; i += CRV__GROUP_PIXELS)
            for (int32_t k = 0; k < CRV__GROUP_PIXELS; k += CRV__LANES)
                vf_store(first + i + k, background);
    }
}

/* SPDX-License-Identifier: MIT */
/* Deals depth out to the phases of the fast structure. */
#include "cpu/kernels/groups.h"

void CRV__NAME(deal)(const crv__frame *f, const crv__fast *fast, int32_t y);
void CRV__NAME(deal)(const crv__frame *f, const crv__fast *fast, int32_t y)
{
    const vf background = vf_set(fast->background);
    const int32_t end =
        (fast->columns + CRV__FAST_GROUP - 1) / CRV__FAST_GROUP * CRV__FAST_GROUP;
    float room[CRV__FAST_SPAN];
    for (int32_t layer = 0; layer < f->params->layers; layer++) {
        float *first = fast->depth + layer * fast->layer_pitch, *rows[CRV__FAST_PHASES];
        for (int32_t k = 0; k < CRV__FAST_PHASES; k++)
            rows[k] = first + crv__fast_index(fast, y, k, 0);
        for (int32_t m = 0; m < end; m += CRV__FAST_GROUP) {
            const float *span =
                crv__span_read(&f->depth[layer], m * CRV__FAST_PHASES - fast->left, y,
                               fast->background, room, CRV__FAST_SPAN);
            for (int32_t i = 0; i < CRV__FAST_GROUP; i += CRV__LANES) {
                vf parts[4];
                vf_split4(span + 4 * i, parts);
                for (int32_t k = 0; k < CRV__FAST_PHASES; k++)
                    vf_store(rows[k] + m + i,
                             vf_min(parts[k], background)); /* NaN becomes that too */
            }
        }
        for (int32_t i = 0; i < CRV__FAST_PADDING; i += CRV__LANES) {
            for (int32_t k = 0; k < CRV__FAST_PHASES; k++) {
                vf_store(rows[k] - CRV__FAST_PADDING + i, background);
                vf_store(rows[k] + end + i, background);
            }
        }
        for (int32_t i = 0; y == 0 && i < fast->pitch; i += CRV__FAST_GROUP)
            for (int32_t k = 0; k < CRV__FAST_GROUP; k += CRV__LANES)
                vf_store(first + i + k, background);
    }
}

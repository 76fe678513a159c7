/* SPDX-License-Identifier: MIT */
/* Deals depth out to the phases of the fast structure. */
#include "cpu/kernels/groups.h"

void CRV__NAME(deal)(const crv__frame *f, const crv__fast *fast, int32_t y);
void CRV__NAME(deal)(const crv__frame *f, const crv__fast *fast, int32_t y)
{
    const vf background = vf_set(fast->background);
    float room[CRV__FAST_SPAN];
    for (int32_t layer = 0; layer < f->params->layers; layer++) {
        float *row = fast->depth + layer * fast->layer_pitch + y * fast->pitch;
        for (int32_t m = 0; m < fast->columns; m += CRV__FAST_GROUP) {
            const float *span =
                crv__span_read(&f->depth[layer], m * CRV__FAST_PHASES - fast->left, y,
                               fast->background, room);
            for (int32_t i = 0; i < CRV__FAST_GROUP; i += CRV__LANES) {
                vf parts[4];
                vf_split4(span + 4 * i, parts);
                for (int32_t k = 0; k < 4; k++)
                    vf_store(row + k * fast->segment + CRV__FAST_PADDING + m + i,
                             vf_min(parts[k], background)); /* NaN becomes that too */
            }
        }
        for (int32_t k = 0; k < CRV__FAST_PHASES; k++) {
            float *segment = row + k * fast->segment;
            const int32_t end =
                (fast->columns + CRV__FAST_GROUP - 1) / CRV__FAST_GROUP * CRV__FAST_GROUP;
            for (int32_t i = 0; i < CRV__FAST_PADDING; i += CRV__LANES) {
                vf_store(segment + i, background);
                vf_store(segment + CRV__FAST_PADDING + end + i, background);
            }
        }
    }
}

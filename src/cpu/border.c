/* SPDX-License-Identifier: MIT */
#include "cpu/border.h"

#include "core/border.h"

size_t crv__border_size(const crv__deinterleaved *di)
{
    return (size_t)crv__border_column(di, 2, 0, 0);
}

static void fill_row(const crv__deinterleaved *di, const crv__frame *f, int32_t is_bottom)
{
    const int32_t right = f->params->width - 1;
    const int32_t y = is_bottom ? f->params->height - 1 : 0;
    for (int32_t px = 0; px < CRV__PHASES; px++) {
        float *linear = di->border + crv__border_row(di, is_bottom, 0, px, 0),
              *slope = di->border + crv__border_row(di, is_bottom, 1, px, 0);
        for (int32_t m = -CRV__ROW_PADDING; m < di->pitch - CRV__ROW_PADDING; m++) {
            const int32_t column = m * CRV__PHASES + px - di->left;
            const int32_t x = column < 0 ? 0 : column > right ? right : column;
            linear[m] = crv__border_linear(f, x, y);
            slope[m] = crv__border_outward(f, x, y, 0, is_bottom ? -1 : 1, linear[m]);
        }
    }
}

static void fill_column(const crv__deinterleaved *di, const crv__frame *f,
                        int32_t is_right)
{
    const int32_t x = is_right ? f->params->width - 1 : 0;
    float *linear = di->border + crv__border_column(di, is_right, 0, 0),
          *slope = di->border + crv__border_column(di, is_right, 1, 0);
    for (int32_t y = 0; y < f->params->height; y++) {
        linear[y] = crv__border_linear(f, x, y);
        slope[y] = crv__border_outward(f, x, y, is_right ? -1 : 1, 0, linear[y]);
    }
}

void crv__border_fill(const crv__deinterleaved *di, const crv__frame *frame)
{
    for (int32_t i = 0; i < 2; i++) {
        fill_row(di, frame, i);
        fill_column(di, frame, i);
    }
}

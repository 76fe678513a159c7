/* SPDX-License-Identifier: MIT */
#include "knob.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Ends of a range this far apart ask for a logarithmic slider. */
#define MUCH 200.0
/* So does a range from 0 to this. */
#define MANY 100.0
/* How far a slider goes beyond what is usual, if the range allows for more. */
#define BEYOND 100.0

bool knob_is_slider(const crv_option *option)
{
    return option->type == CRV_OPTION_FLOAT
           || (option->type == CRV_OPTION_INT && option->max < 1e9);
}

knob knob_of(const crv_option *option, double usual)
{
    knob k = {.scale = KNOB_LINEAR,
              .whole = option->type == CRV_OPTION_INT,
              .min = option->min,
              .max = option->max};
    const double centre = usual > 0.0                   ? usual
                          : option->default_value > 0.0 ? option->default_value
                                                        : sqrt(fabs(k.max));
    if (k.min > 0.0 && k.max / k.min >= MUCH) {
        k.scale = KNOB_LOG;
        if (!k.whole) {
            k.min = fmax(k.min, centre / BEYOND);
            k.max = fmin(k.max, centre * BEYOND);
        }
    } else if (!(k.min > 0.0) && !(k.min < 0.0)
               && (k.max >= MANY || k.max / centre >= MUCH)) {
        k.scale = KNOB_LOG_ZERO;
        k.even = centre;
        if (!k.whole)
            k.max = fmin(k.max, centre * BEYOND);
    }
    return k;
}

static double clamped(double value, double low, double high)
{
    return fmin(fmax(value, low), high);
}

double knob_position(const knob *k, double value)
{
    const double v = clamped(value, k->min, k->max);
    switch (k->scale) {
    case KNOB_LOG:
        return log(v / k->min) / log(k->max / k->min);
    case KNOB_LOG_ZERO:
        return asinh(v / k->even) / asinh(k->max / k->even);
    case KNOB_LINEAR:
        break;
    }
    return (v - k->min) / (k->max - k->min);
}

/* What a hand on a slider means. */
static double three_digits(double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.3g", value);
    return strtod(text, NULL);
}

double knob_value(const knob *k, double position)
{
    const double p = clamped(position, 0.0, 1.0);
    double value = k->min + p * (k->max - k->min);
    if (k->scale == KNOB_LOG)
        value = k->min * pow(k->max / k->min, p);
    else if (k->scale == KNOB_LOG_ZERO)
        value = k->even * sinh(p * asinh(k->max / k->even));
    value = k->whole ? round(value) : three_digits(value);
    return clamped(value, k->min, k->max);
}

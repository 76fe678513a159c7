/* SPDX-License-Identifier: MIT */
/* knob.h: how the numbers of the option table lie on a slider from 0 to 1. */
#ifndef VIEW_KNOB_H
#define VIEW_KNOB_H

#include "crevice/crevice.h"

#include <stdbool.h>

typedef enum knob_scale {
    KNOB_LINEAR,
    KNOB_LOG,     /* ranges above 0 that span much */
    KNOB_LOG_ZERO /* ranges that begin with 0 and span much: even near 0, then as LOG */
} knob_scale;

typedef struct knob {
    knob_scale scale;
    bool whole; /* values are whole numbers */
    double min,
        max;     /* of the slider; the option takes more where that is of little use */
    double even; /* LOG_ZERO: the value up to which steps are about even */
} knob;

/* The slider of a number. `usual`: the value that it is used around, such as the radius
 * that suits the view. */
knob knob_of(const crv_option *option, double usual);

/* Whether a slider is of use: the number of a frame or a seed is typed in. */
bool knob_is_slider(const crv_option *option);

/* Positions are clamped to [0, 1]. Values have three digits, or are whole or an end. */
double knob_position(const knob *k, double value);
double knob_value(const knob *k, double position);

#endif

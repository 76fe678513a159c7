/* SPDX-License-Identifier: MIT */
#ifndef CRV_CORE_OPTIONS_H
#define CRV_CORE_OPTIONS_H

#include "crevice/options.h"

/* Writes the member that the row describes; the value has been checked. */
void crv__options_put(crv_options *options, const crv_option *option, double value);

/* INVALID_ARGUMENT with a line that gives the range unless the value is inside. */
crv_status crv__option_check(const crv_option *option, double value,
                             const crv_logger *logger);

#endif

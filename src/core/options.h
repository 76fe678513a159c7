/* SPDX-License-Identifier: MIT */
#ifndef CRV_CORE_OPTIONS_H
#define CRV_CORE_OPTIONS_H

#include "crevice/options.h"

#include <stdbool.h>

/* Copies the host's options, of this or an earlier size, and checks them as
 * crv_options_check() does. */
crv_status crv__options_take(const crv_logger *logger, const crv_options *from,
                             crv_options *options);

/* Whether it is initialised, by struct_size. */
bool crv__options_known(const crv_options *options);

/* Whether the host's struct, perhaps of an earlier size, has the option's member. */
bool crv__options_have(const crv_options *options, const crv_option *option);

/* Writes the member that the row describes; the value has been checked, and the struct
 * has the member. */
void crv__options_put(crv_options *options, const crv_option *option, double value);

/* INVALID_ARGUMENT with a line that gives the range unless the value is inside. */
crv_status crv__option_check(const crv_option *option, double value,
                             const crv_logger *logger);

#endif

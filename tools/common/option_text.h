/* SPDX-License-Identifier: MIT */
/* option_text.h: options as text that the tool and the library read again. */
#ifndef TOOL_OPTION_TEXT_H
#define TOOL_OPTION_TEXT_H

#include "crevice/crevice.h"

enum { OPTION_TEXT_SIZE = 2048 };

/* One value, as crv_options_set() takes it. Returns out. */
const char *option_value_text(const crv_option *option, double value, char out[64]);

/* What it means, its values and its default: the method's, or `usual` if that is not 0.
 * Returns out. */
enum { OPTION_TOOLTIP_SIZE = 1024 };
const char *option_tooltip(const crv_option *option, const crv_method *method,
                           double usual, char out[OPTION_TOOLTIP_SIZE]);

/* A line "key=value" each: method, filter and every option that these read. */
const char *option_lines(const crv_options *o, char out[OPTION_TEXT_SIZE]);

/* Flags of the tool: " --method gtao --radius 0.5 ...": the radius, and what differs from
 * the method's defaults. */
const char *option_flags(const crv_options *o, char out[OPTION_TEXT_SIZE]);

#endif

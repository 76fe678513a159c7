/* SPDX-License-Identifier: MIT */
/* device.h: what the estimators run on, as the arguments of args_device choose. */
#ifndef TOOL_DEVICE_H
#define TOOL_DEVICE_H

#include "args.h"
#include "progress.h"

/* A context that tells r how far long estimates are, on a GPU by `run`, which must not
 * move. The caller destroys it. EXIT_USAGE after an error line if this machine lacks what
 * was asked for. */
int device_context(const common_settings *common, report *r, progress *run,
                   crv_context **out);

/* The same with the hooks of a description that crv_context_desc_init() began; the rest
 * of it is filled in. */
int device_context_in(const common_settings *common, crv_context_desc *desc, report *r,
                      crv_context **out);

/* Whether --device chooses the CPU, the only one to which --isa and --exact apply. */
bool device_is_cpu(const common_settings *common);

/* Writes the names of the CPU's instruction sets that are here, ", " between them. */
void device_list_isas(char *out, size_t size);

#endif

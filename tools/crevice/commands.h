/* SPDX-License-Identifier: MIT */
/* commands.h: the commands, one file each; main.c lists them. */
#ifndef TOOL_COMMANDS_H
#define TOOL_COMMANDS_H

#include "common/args.h"

extern const command command_render;
extern const command command_ao;
extern const command command_gbuffer;
extern const command command_reference;
extern const command command_compare;
extern const command command_methods;
extern const command command_devices;
extern const command command_bench;
extern const command command_tune;

#endif

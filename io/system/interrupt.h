/* SPDX-License-Identifier: MIT */
/* interrupt.h: signals that would end the tool wait until a file is whole or work is
 * saved, but not for long. */
#ifndef CREVICE_SYSTEM_INTERRUPT_H
#define CREVICE_SYSTEM_INTERRUPT_H

#include <stdbool.h>

/* Holds SIGINT, SIGTERM and SIGHUP, unless the caller of the tool ignores them, as nohup
 * does. A signal that comes is remembered; if it still waits after grace_s seconds, or
 * comes again, it ends the tool at once. Not nested. */
void interrupt_hold(unsigned grace_s);

/* Whether a signal waits: work that can be given up should be. */
bool interrupt_waits(void);

/* Whether one has waited for half a second: so should a file that is being written. */
bool interrupt_is_late(void);

/* Lets signals through again. One that waited takes its course now: usually this does not
 * return then. */
void interrupt_release(void);

#endif

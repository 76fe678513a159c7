/* SPDX-License-Identifier: MIT */
/* clock.h: time that passes, and what a processor does in it. */
#ifndef CREVICE_SYSTEM_CLOCK_H
#define CREVICE_SYSTEM_CLOCK_H

/* Seconds since some moment, never backwards; may be called in a signal's handler. */
double clock_seconds(void);
/* Processor's time of all threads of this process, in seconds. */
double clock_cpu_seconds(void);

/* A counter of the cycles that this process spends in its own code, of threads that start
 * later, too; -1 if the system gives none. */
int clock_cycles_open(void);
/* NAN if there is no counter. */
double clock_cycles_read(int counter);
void clock_cycles_close(int counter);

#endif

/* SPDX-License-Identifier: MIT */
/* monitor.h: threads, and what they share: a lock with a condition to wait for. */
#ifndef CREVICE_SYSTEM_MONITOR_H
#define CREVICE_SYSTEM_MONITOR_H

#include <stdbool.h>

typedef struct monitor monitor;

/* NULL: no memory. Free it when no thread uses it any more; NULL is fine. */
monitor *monitor_create(void);
void monitor_free(monitor *m);

/* Between these two only one thread runs. Not nested. */
void monitor_enter(monitor *m);
void monitor_leave(monitor *m);

/* Inside: leaves, waits for monitor_wake(), enters again. May return without a reason. */
void monitor_wait(monitor *m);
/* For so many seconds at most. */
void monitor_wait_for(monitor *m, double seconds);
/* Wakes one thread that waits. */
void monitor_wake(monitor *m);

/* Starts the monitor's thread, one at most; false if the system has none. */
bool monitor_start(monitor *m, void (*run)(void *user), void *user);
/* Waits until that thread has returned; without one, returns at once. */
void monitor_join(monitor *m);

#endif

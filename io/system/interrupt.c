/* SPDX-License-Identifier: MIT */
#include "interrupt.h"

#include <signal.h>
#include <stdatomic.h>
#include <unistd.h>

#include "clock.h"

#define LATE_SECONDS 0.5

static const int held[] = {SIGINT, SIGTERM, SIGHUP};
enum { HELD_COUNT = sizeof held / sizeof held[0] };

static struct sigaction former[HELD_COUNT], former_alarm;
static volatile sig_atomic_t grace;
/* The signal, 0: none. Every thread may ask; caught_at is written before it. */
static atomic_int caught;
static volatile double caught_at;

/* Everything that it calls may be called in a handler (POSIX, 2.4.3). */
static void end_now(int number)
{
    const int ending = caught != 0 ? caught : number;
    signal(ending, SIG_DFL);
    raise(ending);
}

static void on_signal(int number)
{
    if (caught != 0)
        end_now(number);
    caught_at = clock_seconds();
    caught = number;
    alarm((unsigned)grace);
}

void interrupt_hold(unsigned grace_s)
{
    struct sigaction hold = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    struct sigaction late = {.sa_handler = end_now};
    caught = 0;
    grace = (int)grace_s;
    sigemptyset(&hold.sa_mask);
    sigemptyset(&late.sa_mask);
    sigaction(SIGALRM, &late, &former_alarm);
    for (int i = 0; i < HELD_COUNT; i++) {
        sigaction(held[i], NULL, &former[i]);
        if (former[i].sa_handler != SIG_IGN)
            sigaction(held[i], &hold, NULL);
    }
}

bool interrupt_waits(void)
{
    return caught != 0;
}

bool interrupt_is_late(void)
{
    return caught != 0 && clock_seconds() - caught_at > LATE_SECONDS;
}

void interrupt_release(void)
{
    for (int i = 0; i < HELD_COUNT; i++)
        sigaction(held[i], &former[i], NULL);
    alarm(0);
    sigaction(SIGALRM, &former_alarm, NULL);
    if (caught != 0)
        raise(caught);
}

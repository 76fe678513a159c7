/* SPDX-License-Identifier: MIT */
#include "monitor.h"

#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>

struct monitor {
    pthread_mutex_t lock;
    pthread_cond_t wake;
    pthread_t thread;
    bool has_thread;
    void (*run)(void *user);
    void *user;
};

monitor *monitor_create(void)
{
    monitor *m = calloc(1, sizeof *m);
    if (!m)
        return NULL;
    pthread_mutex_init(&m->lock, NULL);
    pthread_cond_init(&m->wake, NULL);
    return m;
}

void monitor_free(monitor *m)
{
    if (!m)
        return;
    pthread_cond_destroy(&m->wake);
    pthread_mutex_destroy(&m->lock);
    free(m);
}

void monitor_enter(monitor *m)
{
    pthread_mutex_lock(&m->lock);
}

void monitor_leave(monitor *m)
{
    pthread_mutex_unlock(&m->lock);
}

void monitor_wait(monitor *m)
{
    pthread_cond_wait(&m->wake, &m->lock);
}

void monitor_wait_for(monitor *m, double seconds)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    const int64_t ns = until.tv_nsec + (int64_t)(seconds * 1e9);
    until.tv_sec += (time_t)(ns / 1000000000);
    until.tv_nsec = (long)(ns % 1000000000);
    pthread_cond_timedwait(&m->wake, &m->lock, &until);
}

void monitor_wake(monitor *m)
{
    pthread_cond_signal(&m->wake);
}

static void *run_thread(void *data)
{
    monitor *m = data;
    m->run(m->user);
    return NULL;
}

bool monitor_start(monitor *m, void (*run)(void *user), void *user)
{
    m->run = run;
    m->user = user;
    m->has_thread = pthread_create(&m->thread, NULL, run_thread, m) == 0;
    return m->has_thread;
}

void monitor_join(monitor *m)
{
    if (m->has_thread)
        pthread_join(m->thread, NULL);
    m->has_thread = false;
}

/* SPDX-License-Identifier: MIT */
/* process.h: other processes, and pipes to them. What fails sets errno. */
#ifndef CREVICE_SYSTEM_PROCESS_H
#define CREVICE_SYSTEM_PROCESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What is written to `to` is read from `from`; programs that are started have neither. */
typedef struct pipe_ends {
    int from, to;
} pipe_ends;

bool pipe_open(pipe_ends *ends);
void pipe_close(int end);
/* Reads what there is, up to `size` bytes, or waits for some: their number, 0 at the end
 * of the pipe, or -1. */
int64_t pipe_read(int from, void *bytes, size_t size);
/* Waits until there is something to read or the pipe ends: 1; 0 after `seconds`; -1 with
 * errno, EINTR after a signal. */
int pipe_wait(int from, double seconds);
/* Writes all bytes. Up to 512 of them stay together if several processes write. */
bool pipe_write(int to, const void *bytes, size_t size);

typedef struct process {
    intptr_t id;
} process;

/*
 * Runs work(user) in a copy of this process, which ends with the code that it returns,
 * and neither flushes nor frees. When this process ends, the copy is killed, or may
 * finish what it does if it holds signals (interrupt.h), where the system can do that.
 * No thread but the caller's is in the copy.
 */
bool process_start(process *child, bool may_finish, int (*work)(void *user), void *user);
void process_kill(process child);

typedef struct process_end {
    int code;
    int signal;      /* that ended it; 0: none did */
    bool was_killed; /* by somebody else, or by the system for lack of memory */
} process_end;

/* Waits until it ends. False with errno: it is not known how. */
bool process_wait(process child, process_end *end);
const char *process_signal_name(int signal);

/* For a child that reads what may do harm: signals end it, it writes no core, nothing of
 * what it prints is seen, its locale is "C", and it gets so many bytes of memory more
 * than it has; 0: as many as the machine has. Sanitizers reserve terabytes and have
 * something to say: of them only the rest is asked. */
void process_confine(uint64_t memory_bytes);

/* The folder of this program with a slash; "" if it cannot be known. */
void process_own_folder(char *out, size_t size);
/* Becomes the program of this path, or of this name on the PATH. Returns if there is
 * none. words: its name and arguments, then NULL. */
void process_become(const char *program, char *const *words);

#endif

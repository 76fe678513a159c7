/* SPDX-License-Identifier: MIT */
/* reference_run.h: a ray-traced reference from beginning to end: progress, checkpoints,
 * interrupts. */
#ifndef TOOL_REFERENCE_RUN_H
#define TOOL_REFERENCE_RUN_H

#include "common/args.h"
#include "reference.h"

typedef struct reference_run {
    reference *work;
    char *checkpoint; /* path; owned */
    bool is_saved;    /* the checkpoint on disk holds all that is done */
} reference_run;

/* Names the checkpoint of this output and refuses to overwrite one that is there unless
 * it is to be resumed. Returns an exit code. */
int reference_run_check(reference_run *run, const char *output, bool resume, report *r);

/* Resumes or writes the first checkpoint, finds out whether the disk holds what will be
 * written, then computes all pixels, with `rays` each at most. An interrupt leaves a
 * checkpoint behind and takes its course. Returns an exit code. */
int reference_run_all(reference_run *run, const char *output, bool resume, int32_t rays,
                      int32_t threads, report *r);

/* Keeps the finished work on disk, if the picture could not be written. */
void reference_run_keep(reference_run *run, report *r);

/* Removes the checkpoint, after the picture has been written. */
void reference_run_finish(reference_run *run);

#endif

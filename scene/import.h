/* SPDX-License-Identifier: MIT */
/*
 * import.h: what a model file holds, read in a child process: readers of forty formats
 * crash, hang and ask for all memory on files that are damaged. Nothing that the child
 * says is believed before it has been checked.
 */
#ifndef CREVICE_SCENE_IMPORT_H
#define CREVICE_SCENE_IMPORT_H

#include "mesh.h"
#include "scene.h"

/* What a reader finds. */
typedef struct import {
    mesh mesh;
    scene_camera *cameras; /* owned; finished by the parent, see finish() in load.c */
    size_t camera_count;
} import;

/* Adds a camera that looks from `eye` along -back; false: no memory. like: all but its
 * name, and eye, target and up of its view. */
bool import_add_camera(import *found, const char *name, const scene_camera *like,
                       vec3 eye, vec3 back, vec3 up);

void import_free(import *found);

/* Reads the file in a child process. Returns 0, or -1 after one error line, whatever
 * becomes of the child. limits NULL: the defaults. */
int import_file(const char *path, const scene_limits *limits, import *out,
                const crv_logger *log);

/* import_pipe.c: messages and the result through a pipe. */

/* A logger of the child that sends lines to this descriptor, *fd. */
crv_logger import_pipe_logger(int *fd);

/* Returns whether all of it could be written. */
bool import_pipe_send(int fd, const import *found);

typedef enum import_end {
    IMPORT_DONE,    /* a complete result */
    IMPORT_NOTHING, /* the pipe ended before one */
    IMPORT_TIMEOUT,
    IMPORT_DAMAGED, /* what came makes no sense */
    IMPORT_NO_MEMORY
} import_end;

/* How long the parent waits, by clock_seconds(). */
typedef struct import_wait {
    double start, timeout;
    const scene_limits *limits; /* whom to tell of it; NULL: nobody */
} import_wait;

/* Reads until the result is complete, the pipe ends or the time is over. Messages go to
 * log; *errors counts those of errors. */
import_end import_pipe_receive(int fd, const import_wait *wait, import *out, int *errors,
                               const crv_logger *log);

#endif

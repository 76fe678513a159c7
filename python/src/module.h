/* SPDX-License-Identifier: MIT */
/* What the files of the Python module share. Names follow Python's C API. */
#ifndef CREVICE_PYTHON_MODULE_H
#define CREVICE_PYTHON_MODULE_H

#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include <stdbool.h>

#include "crevice/crevice.h"

/* Lines that the library logged during a call. The logger runs without the interpreter's
 * lock, so lines are kept here and handed over afterwards. */
typedef struct messages {
    struct message {
        crv_log_level level;
        char *text;
    } list[16]; /* later lines are dropped */
    int count;
} messages;

/* A logger that appends to `to`. */
crv_logger messages_logger(messages *to);

/* Hands the lines over and empties the list: warnings to `warnings`, the rest to
 * `logging`, errors to an exception if status is not CRV_OK. Returns 0, or -1 with an
 * exception set: that of the signal handler if a signal ended the run. */
int messages_deliver(messages *lines, crv_status status);

/* Adds the exception types to the module; -1 with an exception. */
int errors_init(PyObject *module);

/* A context. Its lock is held during every call on it and on what was made with it, so
 * that Python's threads may share it; they take turns. */
typedef struct ContextObject {
    PyObject_HEAD crv_context *context;
    PyThread_type_lock lock;
    messages lines;
    double checked_s; /* when a run last looked for signals */
} ContextObject;

typedef struct GBufferObject {
    PyObject_HEAD ContextObject *owner;
    crv_gbuffer *gbuffer;
    crv_gbuffer_desc desc;
} GBufferObject;

typedef struct PlanObject {
    PyObject_HEAD ContextObject *owner;
    crv_plan *plan;
    crv_gbuffer_desc desc;
    crv_options options;
} PlanObject;

extern PyTypeObject ContextType, GBufferType, PlanType;

/* Takes the context's lock without the interpreter's; gives it back. */
void context_enter(ContextObject *context);
/* The same, and hands the lines over: 0, or -1 with an exception set. */
int context_leave(ContextObject *context, crv_status status);

/* An array that Python lent. */
typedef struct array {
    Py_buffer view;
    crv_texels texels;
} array;

/* Reads an array of rows x columns (x channels): 0, or -1 with an exception. Give it back
 * with array_release(). */
int array_read(array *a, PyObject *object, const char *name, int channels);
void array_release(array *a);

/* The array as floats. *owned is memory to be freed with PyMem_RawFree(), or NULL if the
 * array could be used as it is. Needs no interpreter lock. */
crv_status array_floats(const array *a, crv_const_image *out, float **owned,
                        const crv_logger *logger);

/* An array of floats to write to: 0, or -1 with an exception. */
int array_write(array *a, crv_image *image, PyObject *object, const char *name,
                int channels);

/* A camera from (projection, fx, fy, cx, cy, world_to_view[9]), and back. */
int camera_converter(PyObject *object, void *camera);
PyObject *camera_tuple(const crv_camera *camera);

/* The index of a word in a list that ends with NULL; -1 with an exception. */
int word_index(const char *word, const char *const *words, const char *what);

/* Options of a method by name (NULL: the default method) with values from a dict of
 * texts; -1 with an exception. */
int options_from(crv_options *options, const char *method, const char *preset,
                 PyObject *values);

/* Functions of the module that walk the registries and make cameras. */
extern PyMethodDef table_functions[];

#endif

/* SPDX-License-Identifier: MIT */
/* Lines of the library to warnings, logging and exceptions. */
#include "module.h"

#include <string.h>

static PyObject *error_types[CRV_ERROR_DEVICE + 1];

/* What a status is in Python: a subclass of crevice.Error and of a built-in type. */
static const struct {
    crv_status status;
    const char *name, *doc;
} ERRORS[] = {
    {CRV_ERROR_INVALID_ARGUMENT, "crevice.InvalidArgument",
     "A value, shape, range or order of calls is wrong."},
    {CRV_ERROR_OUT_OF_MEMORY, "crevice.OutOfMemory", "There is not enough memory."},
    {CRV_ERROR_UNSUPPORTED, "crevice.Unsupported",
     "Valid, but not by this build, method or device."},
    {CRV_ERROR_NOT_READY, "crevice.NotReady",
     "Called too early: camera or depth is missing."},
    {CRV_ERROR_DEVICE, "crevice.DeviceError", "The device or its driver failed."},
};

static PyObject *builtin_of(crv_status status)
{
    switch (status) {
    case CRV_ERROR_INVALID_ARGUMENT:
        return PyExc_ValueError;
    case CRV_ERROR_OUT_OF_MEMORY:
        return PyExc_MemoryError;
    case CRV_ERROR_UNSUPPORTED:
        return PyExc_NotImplementedError;
    default:
        return PyExc_RuntimeError;
    }
}

/* Adds an object to the module and keeps a reference of our own. */
static int add(PyObject *module, const char *name, PyObject *object)
{
    if (!object)
        return -1;
    Py_INCREF(object);
    if (PyModule_AddObject(module, name, object) == 0)
        return 0;
    Py_DECREF(object);
    return -1;
}

int errors_init(PyObject *module)
{
    PyObject *base = PyErr_NewExceptionWithDoc(
        "crevice.Error", "Base of what Crevice raises.", NULL, NULL);
    if (add(module, "Error", base))
        return -1;
    error_types[CRV_OK] = base;
    for (size_t i = 0; i < sizeof ERRORS / sizeof ERRORS[0]; i++) {
        const crv_status status = ERRORS[i].status;
        PyObject *bases = PyTuple_Pack(2, base, builtin_of(status));
        if (!bases)
            return -1;
        error_types[status] =
            PyErr_NewExceptionWithDoc(ERRORS[i].name, ERRORS[i].doc, bases, NULL);
        Py_DECREF(bases);
        if (add(module, strchr(ERRORS[i].name, '.') + 1, error_types[status]))
            return -1;
    }
    return 0;
}

static void keep_line(void *user, crv_log_level level, const char *line)
{
    messages *lines = user;
    const size_t size = strlen(line) + 1;
    char *text = lines->count < 16 ? PyMem_RawMalloc(size) : NULL;
    if (!text)
        return;
    memcpy(text, line, size);
    lines->list[lines->count++] = (struct message){.level = level, .text = text};
}

crv_logger messages_logger(messages *to)
{
    return (crv_logger){.fn = keep_line, .user = to};
}

static int log_info(const char *text)
{
    PyObject *logging = PyImport_ImportModule("logging");
    PyObject *logger =
        logging ? PyObject_CallMethod(logging, "getLogger", "s", "crevice") : NULL;
    PyObject *done =
        logger ? PyObject_CallMethod(logger, "info", "ss", "%s", text) : NULL;
    Py_XDECREF(done);
    Py_XDECREF(logger);
    Py_XDECREF(logging);
    return done ? 0 : -1;
}

/* After a signal its handler's exception is set, and what was logged does not count. */
int messages_deliver(messages *lines, crv_status status)
{
    messages taken = *lines;
    const char *reason = NULL;
    int result = status == CRV_ERROR_STOPPED ? -1 : 0;
    lines->count = 0;
    for (int i = 0; i < taken.count && status != CRV_ERROR_STOPPED; i++) {
        const struct message *m = &taken.list[i];
        if (m->level == CRV_LOG_ERROR)
            reason = m->text;
        else if (result == 0 && m->level == CRV_LOG_WARNING)
            result = PyErr_WarnEx(PyExc_UserWarning, m->text, 1);
        else if (result == 0)
            result = log_info(m->text);
    }
    if (status != CRV_OK && result == 0) {
        const bool known = status > 0 && status <= CRV_ERROR_DEVICE;
        PyErr_SetString(error_types[known ? status : 0],
                        reason ? reason : crv_status_string(status));
        result = -1;
    }
    for (int i = 0; i < taken.count; i++)
        PyMem_RawFree(taken.list[i].text);
    return result;
}

/* SPDX-License-Identifier: MIT */
/* crevice.Plan: one method with its options on G-buffers of one size. */
#include "module.h"

static PyObject *plan_new(PyTypeObject *type, PyObject *args, PyObject *kwargs)
{
    static char *names[] = {"gbuffer", "method", "preset", "options", NULL};
    GBufferObject *gbuffer;
    const char *method = NULL, *preset = "medium";
    PyObject *values = NULL;
    crv_options options;
    if (!PyArg_ParseTupleAndKeywords(args, kwargs, "O!|$zsO!:Plan", names, &GBufferType,
                                     &gbuffer, &method, &preset, &PyDict_Type, &values)
        || options_from(&options, method, preset, values))
        return NULL;
    PlanObject *p = (PlanObject *)type->tp_alloc(type, 0);
    if (!p)
        return NULL;
    Py_INCREF(gbuffer->owner);
    p->owner = gbuffer->owner;
    p->desc = gbuffer->desc;
    p->options = options;
    context_enter(p->owner);
    crv_status status;
    Py_BEGIN_ALLOW_THREADS status =
        crv_plan_create(p->owner->context, &options, &p->desc, &p->plan);
    Py_END_ALLOW_THREADS if (context_leave(p->owner, status) == 0) return (PyObject *)p;
    Py_DECREF(p);
    return NULL;
}

static void plan_dealloc(PyObject *self)
{
    PlanObject *p = (PlanObject *)self;
    if (p->plan) {
        context_enter(p->owner);
        crv_plan_destroy(p->plan);
        PyThread_release_lock(p->owner->lock);
    }
    Py_XDECREF(p->owner);
    Py_TYPE(self)->tp_free(self);
}

static PyObject *plan_run(PyObject *self, PyObject *args)
{
    PlanObject *p = (PlanObject *)self;
    GBufferObject *gbuffer;
    PyObject *object;
    array a;
    crv_image image;
    if (!PyArg_ParseTuple(args, "O!O:run", &GBufferType, &gbuffer, &object)
        || array_write(&a, &image, object, "out", 1))
        return NULL;
    context_enter(p->owner);
    crv_status status;
    Py_BEGIN_ALLOW_THREADS status = crv_plan_run(p->plan, gbuffer->gbuffer, &image);
    Py_END_ALLOW_THREADS array_release(&a);
    if (context_leave(p->owner, status))
        return NULL;
    Py_INCREF(object);
    return object;
}

static PyObject *plan_set_options(PyObject *self, PyObject *values)
{
    PlanObject *p = (PlanObject *)self;
    if (!PyDict_Check(values)) {
        PyErr_SetString(PyExc_TypeError, "set_options: a dict is needed");
        return NULL;
    }
    crv_options options = p->options;
    if (options_from(&options, NULL, NULL, values))
        return NULL;
    context_enter(p->owner);
    crv_status status;
    Py_BEGIN_ALLOW_THREADS status = crv_plan_set_options(p->plan, &options);
    Py_END_ALLOW_THREADS if (context_leave(p->owner, status)) return NULL;
    p->options = options;
    Py_RETURN_NONE;
}

static PyMethodDef plan_methods[] = {
    {"run", plan_run, METH_VARARGS,
     "run(gbuffer, out)\n\nWrites accessibility to a float32 array (rows, columns) of "
     "the\n"
     "size inside the guard band, and returns it: 1 open, 0 occluded, background 1.\n"
     "The interpreter's lock is released meanwhile."},
    {"set_options", plan_set_options, METH_O,
     "set_options(values)\n\nNew values of options, as texts by key. Unsupported if they "
     "take\na new plan."},
    {0}};

PyTypeObject PlanType = {
    PyVarObject_HEAD_INIT(NULL, 0).tp_name = "crevice.Plan",
    .tp_basicsize = sizeof(PlanObject),
    .tp_flags = Py_TPFLAGS_DEFAULT,
    .tp_doc = "Plan(gbuffer, *, method=None, preset='medium', options={})\n\n"
              "One method with its options and memory. It runs on every G-buffer of the\n"
              "same size and context. options: texts by key, as the tool takes them.",
    .tp_new = plan_new,
    .tp_dealloc = plan_dealloc,
    .tp_methods = plan_methods,
};

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
    Py_BEGIN_ALLOW_THREADS
    status = crv_plan_create(p->owner->context, &options, &p->desc, &p->plan);
    Py_END_ALLOW_THREADS
    if (context_leave(p->owner, status) == 0)
        return (PyObject *)p;
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

/* Runs the plan on arrays that are lent. */
static int run_result(const PlanObject *p, const GBufferObject *gbuffer,
                      const crv_result *result)
{
    context_enter(p->owner);
    crv_status status;
    Py_BEGIN_ALLOW_THREADS
    status = crv_plan_run_result(p->plan, gbuffer->gbuffer, result);
    Py_END_ALLOW_THREADS
    return context_leave(p->owner, status);
}

static PyObject *plan_run(PyObject *self, PyObject *args, PyObject *kwargs)
{
    static char *names[] = {"gbuffer", "out", "bent", NULL};
    PlanObject *p = (PlanObject *)self;
    GBufferObject *gbuffer;
    PyObject *out, *bent = Py_None;
    array a, b;
    crv_result result;
    crv_result_init(&result, sizeof result);
    if (!PyArg_ParseTupleAndKeywords(args, kwargs, "O!O|O:run", names, &GBufferType,
                                     &gbuffer, &out, &bent)
        || array_write(&a, &result.accessibility, out, "out", 1))
        return NULL;
    const bool with_bent = bent != Py_None;
    int failed = 0;
    if (with_bent)
        failed = array_write(&b, &result.bent_normal, bent, "bent", 3);
    if (!failed) {
        failed = run_result(p, gbuffer, &result);
        if (with_bent)
            array_release(&b);
    }
    array_release(&a);
    if (failed)
        return NULL;
    if (with_bent)
        return PyTuple_Pack(2, out, bent);
    Py_INCREF(out);
    return out;
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
    Py_BEGIN_ALLOW_THREADS
    status = crv_plan_set_options(p->plan, &options);
    Py_END_ALLOW_THREADS
    if (context_leave(p->owner, status))
        return NULL;
    p->options = options;
    Py_RETURN_NONE;
}

static PyMethodDef plan_methods[] = {
    {"run", (PyCFunction)(void (*)(void))plan_run, METH_VARARGS | METH_KEYWORDS,
     "run(gbuffer, out, bent=None)\n\nWrites accessibility to a float32 array (rows, "
     "columns) of\n"
     "the size inside the guard band, and returns it: 1 open, 0 occluded, background 1.\n"
     "bent: a float32 array (rows, columns, 3) for bent normals, view space, unit\n"
     "length, background 0; then it returns both. The plan needs the option\n"
     "bent_normal='on'. The interpreter's lock is released meanwhile."},
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

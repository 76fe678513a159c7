/* SPDX-License-Identifier: MIT */
/* crevice.Context: hooks, threads and instruction set. */
#include "module.h"

#include <math.h>
#include <string.h>
#include <time.h>

void context_enter(ContextObject *c)
{
    Py_BEGIN_ALLOW_THREADS
    PyThread_acquire_lock(c->lock, WAIT_LOCK);
    Py_END_ALLOW_THREADS
}

int context_leave(ContextObject *c, crv_status status)
{
    messages lines = c->lines;
    c->lines.count = 0;
    PyThread_release_lock(c->lock);
    return messages_deliver(&lines, status);
}

/* Seconds between two looks for signals: taking the interpreter's lock may mean to wait
 * for another thread. */
#define SIGNALS_S 0.05

static double now_s(void)
{
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Between pieces of a run, which holds no interpreter lock. Signals are handled by
 * Python's main thread alone; in others this finds none. An exception of the handler
 * (KeyboardInterrupt) stays set for the caller of the run. */
static int32_t handle_signals(void *user, int32_t done, int32_t total)
{
    (void)done, (void)total;
    ContextObject *c = user;
    const double now = now_s();
    if (fabs(now - c->checked_s) < SIGNALS_S)
        return 0;
    c->checked_s = now;
    const PyGILState_STATE state = PyGILState_Ensure();
    const int interrupted = PyErr_CheckSignals();
    PyGILState_Release(state);
    return interrupted;
}

/* The bit of a named instruction set; 0 for NULL, -1 with an exception. */
static int isa_bit(const char *name, uint32_t *mask)
{
    *mask = 0;
    if (!name)
        return 0;
    for (int i = 0; crv_isa_name((crv_isa)i); i++) {
        if (strcmp(crv_isa_name((crv_isa)i), name) == 0) {
            *mask = 1u << i;
            return 0;
        }
    }
    PyErr_Format(PyExc_ValueError, "isa: '%s' is not an instruction set", name);
    return -1;
}

static PyObject *context_new(PyTypeObject *type, PyObject *args, PyObject *kwargs)
{
    static const char *const DEVICES[] = {"cpu", "vulkan", NULL};
    static char *names[] = {"threads", "isa", "exact", "device", "device_index", NULL};
    int threads = 0, exact = 0, index = 0;
    const char *isa = NULL, *device = "cpu";
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    if (!PyArg_ParseTupleAndKeywords(args, kwargs, "|$izpsi:Context", names, &threads,
                                     &isa, &exact, &device, &index)
        || isa_bit(isa, &desc.isa_mask))
        return NULL;
    const int kind = word_index(device, DEVICES, "device");
    ContextObject *c = kind < 0 ? NULL : (ContextObject *)type->tp_alloc(type, 0);
    if (!c)
        return NULL;
    c->lock = PyThread_allocate_lock();
    desc.logger = messages_logger(&c->lines);
    desc.progress = (crv_progress){.fn = handle_signals, .user = c};
    desc.threads = threads;
    desc.exact = exact;
    desc.device = (crv_device)kind;
    desc.device_index = index;
    crv_status status = CRV_ERROR_OUT_OF_MEMORY;
    if (c->lock) {
        Py_BEGIN_ALLOW_THREADS
        status = crv_context_create(&desc, &c->context);
        Py_END_ALLOW_THREADS
    }
    if (messages_deliver(&c->lines, status) == 0)
        return (PyObject *)c;
    Py_DECREF(c);
    return NULL;
}

static void context_dealloc(PyObject *self)
{
    ContextObject *c = (ContextObject *)self;
    crv_context_destroy(c->context);
    if (c->lock)
        PyThread_free_lock(c->lock);
    Py_TYPE(self)->tp_free(self);
}

static PyObject *context_isa(PyObject *self, void *closure)
{
    (void)closure;
    return PyUnicode_FromString(
        crv_isa_name(crv_context_isa(((ContextObject *)self)->context)));
}

static PyGetSetDef context_members[] = {
    {"isa", context_isa, NULL, "The instruction set that plans use on the CPU.", NULL},
    {0}};

PyTypeObject ContextType = {
    PyVarObject_HEAD_INIT(NULL, 0).tp_name = "crevice.Context",
    .tp_basicsize = sizeof(ContextObject),
    .tp_flags = Py_TPFLAGS_DEFAULT,
    .tp_doc =
        "Context(*, threads=0, isa=None, exact=False, device='cpu', device_index=0)\n\n"
        "What computes. threads: 1 to 1024, 0 for all processors. isa: 'scalar', "
        "'sse4',\n"
        "'avx2', 'avx512' or 'neon', None for the fastest. exact: sample exactly where\n"
        "the plain code does. device: 'cpu' or 'vulkan'.\n\n"
        "Python's threads may share a context and what was made with it; calls take\n"
        "turns. Different contexts run at the same time. Raises crevice.Error.",
    .tp_new = context_new,
    .tp_dealloc = context_dealloc,
    .tp_getset = context_members,
};

/* SPDX-License-Identifier: MIT */
/* crevice.GBuffer: camera, depth layers, normals. */
#include "module.h"

#include <math.h>

static const char *const LAYER_KINDS[] = {"surfaces", "solid", NULL};
static const char *const SPACES[] = {"view", "world", NULL};
static PyObject *gbuffer_new(PyTypeObject *type, PyObject *args, PyObject *kwargs)
{
    static char *names[] = {"context",    "width", "height", "layers",
                            "layer_kind", "guard", "origin", NULL};
    ContextObject *owner;
    int width, height, layers = 1;
    const char *kind = "surfaces";
    crv_gbuffer_desc desc;
    crv_gbuffer_desc_init(&desc, sizeof desc, 1, 1);
    if (!PyArg_ParseTupleAndKeywords(
            args, kwargs, "O!ii|$is(iiii)(ii):GBuffer", names, &ContextType, &owner,
            &width, &height, &layers, &kind, &desc.guard_left, &desc.guard_top,
            &desc.guard_right, &desc.guard_bottom, &desc.origin_x, &desc.origin_y))
        return NULL;
    const int layer_kind = word_index(kind, LAYER_KINDS, "layer_kind");
    if (layer_kind < 0)
        return NULL;
    desc.width = width;
    desc.height = height;
    desc.layers = layers;
    desc.layer_kind = (crv_layers)layer_kind;
    GBufferObject *g = (GBufferObject *)type->tp_alloc(type, 0);
    if (!g)
        return NULL;
    Py_INCREF(owner);
    g->owner = owner;
    g->desc = desc;
    context_enter(owner);
    const crv_status status = crv_gbuffer_create(owner->context, &desc, &g->gbuffer);
    if (context_leave(owner, status) == 0)
        return (PyObject *)g;
    Py_DECREF(g);
    return NULL;
}

static void gbuffer_dealloc(PyObject *self)
{
    GBufferObject *g = (GBufferObject *)self;
    if (g->gbuffer) {
        context_enter(g->owner);
        crv_gbuffer_destroy(g->gbuffer);
        PyThread_release_lock(g->owner->lock);
    }
    Py_XDECREF(g->owner);
    Py_TYPE(self)->tp_free(self);
}

static PyObject *none_or_null(int failed)
{
    if (failed)
        return NULL;
    Py_RETURN_NONE;
}

static PyObject *set_camera(PyObject *self, PyObject *arg)
{
    GBufferObject *g = (GBufferObject *)self;
    crv_camera camera;
    if (!camera_converter(arg, &camera))
        return NULL;
    context_enter(g->owner);
    return none_or_null(
        context_leave(g->owner, crv_gbuffer_set_camera(g->gbuffer, &camera)));
}

static PyObject *set_depth(PyObject *self, PyObject *args, PyObject *kwargs)
{
    static char *names[] = {"depth", "layer",      "encoding", "near",
                            "far",   "background", NULL};
    GBufferObject *g = (GBufferObject *)self;
    PyObject *object;
    int layer = 0;
    const char *encoding = "planar";
    crv_depth_format format = crv_depth_format_planar();
    if (!PyArg_ParseTupleAndKeywords(args, kwargs, "O|$isfff:set_depth", names, &object,
                                     &layer, &encoding, &format.z_near, &format.z_far,
                                     &format.background))
        return NULL;
    const char *words[32] = {NULL};
    for (int i = 0; i < 31; i++)
        words[i] = crv_depth_encoding_name((crv_depth_encoding)i);
    const int kind = word_index(encoding, words, "encoding");
    array a;
    if (kind < 0 || array_read(&a, object, "depth", 1))
        return NULL;
    format.encoding = (crv_depth_encoding)kind;
    crv_const_image image;
    float *owned = NULL;
    context_enter(g->owner);
    crv_status status;
    Py_BEGIN_ALLOW_THREADS
    const crv_logger logger = messages_logger(&g->owner->lines);
    status = array_floats(&a, &image, &owned, &logger);
    if (status == CRV_OK)
        status = crv_gbuffer_set_depth(g->gbuffer, layer, &image, &format);
    PyMem_RawFree(owned);
    Py_END_ALLOW_THREADS
    array_release(&a);
    return none_or_null(context_leave(g->owner, status));
}

static PyObject *set_normals(PyObject *self, PyObject *args, PyObject *kwargs)
{
    static char *names[] = {"normals", "space", NULL};
    GBufferObject *g = (GBufferObject *)self;
    PyObject *object;
    const char *space = "view";
    if (!PyArg_ParseTupleAndKeywords(args, kwargs, "O|$s:set_normals", names, &object,
                                     &space))
        return NULL;
    const int kind = word_index(space, SPACES, "space");
    if (kind < 0)
        return NULL;
    if (object == Py_None) {
        context_enter(g->owner);
        return none_or_null(context_leave(
            g->owner, crv_gbuffer_set_normals(g->gbuffer, NULL, (crv_normal_space)kind)));
    }
    array a;
    if (array_read(&a, object, "normals", 3))
        return NULL;
    crv_const_image image;
    float *owned = NULL;
    context_enter(g->owner);
    crv_status status;
    Py_BEGIN_ALLOW_THREADS
    const crv_logger logger = messages_logger(&g->owner->lines);
    status = array_floats(&a, &image, &owned, &logger);
    if (status == CRV_OK)
        status = crv_gbuffer_set_normals(g->gbuffer, &image, (crv_normal_space)kind);
    PyMem_RawFree(owned);
    Py_END_ALLOW_THREADS
    array_release(&a);
    return none_or_null(context_leave(g->owner, status));
}

/* Writes what a getter gives to an array of the caller's. */
static PyObject *get(GBufferObject *g, PyObject *object, const char *name, int channels,
                     int layer)
{
    array a;
    crv_image image;
    if (array_write(&a, &image, object, name, channels))
        return NULL;
    context_enter(g->owner);
    crv_status status;
    Py_BEGIN_ALLOW_THREADS
    status = channels == 1 ? crv_gbuffer_get_depth(g->gbuffer, layer, &image)
                           : crv_gbuffer_get_normals(g->gbuffer, &image);
    Py_END_ALLOW_THREADS
    array_release(&a);
    return none_or_null(context_leave(g->owner, status));
}

static PyObject *get_depth(PyObject *self, PyObject *args)
{
    PyObject *object;
    int layer = 0;
    if (!PyArg_ParseTuple(args, "O|i:get_depth", &object, &layer))
        return NULL;
    return get((GBufferObject *)self, object, "depth", 1, layer);
}

static PyObject *get_normals(PyObject *self, PyObject *object)
{
    return get((GBufferObject *)self, object, "normals", 3, 0);
}

#define KEYWORDS(function) ((PyCFunction)(void (*)(void))(function))
static PyMethodDef gbuffer_methods[] = {
    {"set_camera", set_camera, METH_O,
     "set_camera(camera)\n\nBegins a frame; forgets depth and normals of the one "
     "before."},
    {"set_depth", KEYWORDS(set_depth), METH_VARARGS | METH_KEYWORDS,
     "set_depth(depth, *, layer=0, encoding='planar', near=0, far=0, background=inf)\n\n"
     "depth: (height, width). encoding: 'planar', 'radial', 'hardware', 'reversed',\n"
     "'disparity', 'normalised', 'normalised-reversed', 'gl' or 'logarithmic'. Planar\n"
     "depths that are NaN, infinite, zero or negative are background."},
    {"set_normals", KEYWORDS(set_normals), METH_VARARGS | METH_KEYWORDS,
     "set_normals(normals, *, space='view')\n\n"
     "normals: (height, width, 3), any length, or None to take them from depth."},
    {"get_depth", get_depth, METH_VARARGS,
     "get_depth(out, layer=0)\n\nWrites planar depth, background inf, to a float32 "
     "array."},
    {"get_normals", get_normals, METH_O,
     "get_normals(out)\n\nWrites unit view-space normals to a float32 array."},
    {0}};

PyTypeObject GBufferType = {
    PyVarObject_HEAD_INIT(NULL, 0).tp_name = "crevice.GBuffer",
    .tp_basicsize = sizeof(GBufferObject),
    .tp_flags = Py_TPFLAGS_DEFAULT,
    .tp_doc = "GBuffer(context, width, height, *, layers=1, layer_kind='surfaces', "
              "guard=(0, 0, 0, 0), origin=(0, 0))\n\n"
              "What an estimator sees: camera, depth layers, normals. Sizes in pixels,\n"
              "guard band (left, top, right, bottom) included. Filled anew for each "
              "frame.",
    .tp_new = gbuffer_new,
    .tp_dealloc = gbuffer_dealloc,
    .tp_methods = gbuffer_methods,
};

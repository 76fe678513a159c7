/* SPDX-License-Identifier: MIT */
/* Registries, options and cameras as plain Python values. */
#include "module.h"

#include <string.h>

int word_index(const char *word, const char *const *words, const char *what)
{
    for (int i = 0; words[i]; i++) {
        if (strcmp(words[i], word) == 0)
            return i;
    }
    PyObject *all = PyUnicode_FromString("");
    for (int i = 0; all && words[i]; i++)
        PyUnicode_AppendAndDel(&all,
                               PyUnicode_FromFormat("%s'%s'", i ? ", " : "", words[i]));
    if (all)
        PyErr_Format(PyExc_ValueError, "%s: '%s' is none of %U", what, word, all);
    Py_XDECREF(all);
    return -1;
}

int camera_converter(PyObject *object, void *out)
{
    crv_camera *c = out;
    float *m = c->world_to_view;
    int projection;
    *c = crv_camera_perspective(1, 1, 1);
    PyObject *tuple = PyObject_CallMethod(object, "_astuple", NULL);
    const int done =
        tuple
        && PyArg_ParseTuple(tuple, "iffff(fffffffff);camera", &projection, &c->fx_px,
                            &c->fy_px, &c->cx_px, &c->cy_px, m, m + 1, m + 2, m + 3,
                            m + 4, m + 5, m + 6, m + 7, m + 8);
    Py_XDECREF(tuple);
    if (done)
        c->projection = (crv_projection)projection;
    return done;
}

PyObject *camera_tuple(const crv_camera *c)
{
    const float *m = c->world_to_view;
    return Py_BuildValue("iffff(fffffffff)", (int)c->projection, c->fx_px, c->fy_px,
                         c->cx_px, c->cy_px, m[0], m[1], m[2], m[3], m[4], m[5], m[6],
                         m[7], m[8]);
}

static PyObject *camera_perspective(PyObject *module, PyObject *args)
{
    (void)module;
    int width, height;
    float vfov_rad;
    if (!PyArg_ParseTuple(args, "iif", &width, &height, &vfov_rad))
        return NULL;
    const crv_camera camera = crv_camera_perspective(width, height, vfov_rad);
    return camera_tuple(&camera);
}

static PyObject *camera_orthographic(PyObject *module, PyObject *args)
{
    (void)module;
    int width, height;
    float view_height;
    if (!PyArg_ParseTuple(args, "iif", &width, &height, &view_height))
        return NULL;
    const crv_camera camera = crv_camera_orthographic(width, height, view_height);
    return camera_tuple(&camera);
}

static PyObject *camera_look_at(PyObject *module, PyObject *args)
{
    (void)module;
    crv_camera camera;
    float eye[3], target[3], up[3];
    if (!PyArg_ParseTuple(args, "O&(fff)(fff)(fff)", camera_converter, &camera, eye,
                          eye + 1, eye + 2, target, target + 1, target + 2, up, up + 1,
                          up + 2))
        return NULL;
    if (crv_camera_look_at(&camera, eye, target, up) == CRV_OK)
        return camera_tuple(&camera);
    PyErr_SetString(PyExc_ValueError,
                    "look_at: eye equals target, or up is parallel to the view");
    return NULL;
}

static PyObject *keys_of(const char *const *keys)
{
    PyObject *list = PyList_New(0);
    for (; list && keys && *keys; keys++) {
        PyObject *key = PyUnicode_FromString(*keys);
        if (!key || PyList_Append(list, key))
            Py_CLEAR(list);
        Py_XDECREF(key);
    }
    return list;
}

/* A method's or filter's row: name, title, paper, hemisphere, keys; methods: whether they
 * give bent normals. */
static PyObject *methods(PyObject *module, PyObject *none)
{
    (void)module;
    (void)none;
    PyObject *list = PyList_New(0);
    for (int32_t i = 0; list && i < crv_method_count(); i++) {
        const crv_method *m = crv_method_at(i);
        const char *weighting =
            m->weighting == CRV_WEIGHTING_COSINE ? "cosine" : "uniform";
        PyObject *row =
            Py_BuildValue("ssssNN", m->name, m->title, m->paper, weighting,
                          keys_of(m->options), PyBool_FromLong(m->bent_normal));
        if (!row || PyList_Append(list, row))
            Py_CLEAR(list);
        Py_XDECREF(row);
    }
    return list;
}

static PyObject *filters(PyObject *module, PyObject *none)
{
    (void)module;
    (void)none;
    PyObject *list = PyList_New(0);
    for (int32_t i = 0; list && i < crv_filter_count(); i++) {
        const crv_filter *f = crv_filter_at(i);
        PyObject *row =
            Py_BuildValue("sssN", f->name, f->title, f->paper, keys_of(f->options));
        if (!row || PyList_Append(list, row))
            Py_CLEAR(list);
        Py_XDECREF(row);
    }
    return list;
}

static PyObject *option_row(const crv_option *o, double standard)
{
    static const char *const TYPES[] = {"float", "int", "bool", "choice"};
    return Py_BuildValue("sssdddNs", o->key, TYPES[o->type], o->unit, standard, o->min,
                         o->max, keys_of(o->choices), o->help);
}

/* Options that a method reads with its default filter, and their defaults for it. */
static PyObject *options(PyObject *module, PyObject *args)
{
    (void)module;
    const char *method = NULL;
    crv_options values;
    if (!PyArg_ParseTuple(args, "|z", &method)
        || options_from(&values, method, "medium", NULL))
        return NULL;
    PyObject *list = PyList_New(0);
    for (int32_t i = 0; list && i < crv_option_count(); i++) {
        const crv_option *o = crv_option_at(i);
        if (!crv_option_applies(o, values.method, values.filter))
            continue;
        PyObject *row = option_row(o, crv_options_get(&values, o));
        if (!row || PyList_Append(list, row))
            Py_CLEAR(list);
        Py_XDECREF(row);
    }
    return list;
}

static int set_preset(crv_options *out, const char *name)
{
    for (int i = 0; i < CRV_PRESET_COUNT; i++) {
        if (strcmp(crv_preset_name((crv_preset)i), name) == 0) {
            crv_options_preset(out, (crv_preset)i);
            return 0;
        }
    }
    PyErr_Format(PyExc_ValueError,
                 "preset: '%s' is none of 'low', 'medium', 'high', "
                 "'ultra', 'paper'",
                 name);
    return -1;
}

int options_from(crv_options *out, const char *method, const char *preset,
                 PyObject *values)
{
    messages lines = {.count = 0};
    const crv_logger logger = messages_logger(&lines);
    if (preset) { /* from the defaults; else on top of what is there */
        if (crv_options_init(out, sizeof *out, method) != CRV_OK) {
            crv_options_init(out, sizeof *out,
                             NULL); /* for the line that names another */
            return messages_deliver(&lines,
                                    crv_options_set(out, "method", method, &logger));
        }
        if (set_preset(out, preset))
            return -1;
    }
    PyObject *key, *value;
    Py_ssize_t at = 0;
    while (values && PyDict_Next(values, &at, &key, &value)) {
        const char *k = PyUnicode_AsUTF8(key), *v = k ? PyUnicode_AsUTF8(value) : NULL;
        if (!v || messages_deliver(&lines, crv_options_set(out, k, v, &logger)))
            return -1;
    }
    return 0;
}

static PyObject *version(PyObject *module, PyObject *none)
{
    (void)module;
    (void)none;
    return PyUnicode_FromString(crv_version());
}

PyMethodDef table_functions[] = {
    {"version", version, METH_NOARGS, NULL},
    {"methods", methods, METH_NOARGS, NULL},
    {"filters", filters, METH_NOARGS, NULL},
    {"options", options, METH_VARARGS, NULL},
    {"camera_perspective", camera_perspective, METH_VARARGS, NULL},
    {"camera_orthographic", camera_orthographic, METH_VARARGS, NULL},
    {"camera_look_at", camera_look_at, METH_VARARGS, NULL},
    {0}};

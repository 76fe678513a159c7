/* SPDX-License-Identifier: MIT */
/* crevice._crevice: the C part of the module `crevice` (crevice/__init__.py). */
#include "module.h"

static struct PyModuleDef definition = {
    PyModuleDef_HEAD_INIT,
    .m_name = "crevice._crevice",
    .m_doc = "The C part of crevice; use `import crevice`.",
    .m_size = -1,
    .m_methods = table_functions,
};

static int add_type(PyObject *module, const char *name, PyTypeObject *type)
{
    if (PyType_Ready(type))
        return -1;
    Py_INCREF(type);
    if (PyModule_AddObject(module, name, (PyObject *)type) == 0)
        return 0;
    Py_DECREF(type);
    return -1;
}

PyMODINIT_FUNC PyInit__crevice(void);

PyMODINIT_FUNC PyInit__crevice(void)
{
    PyObject *module = PyModule_Create(&definition);
    if (module && errors_init(module) == 0
        && add_type(module, "Context", &ContextType) == 0
        && add_type(module, "GBuffer", &GBufferType) == 0
        && add_type(module, "Plan", &PlanType) == 0)
        return module;
    Py_XDECREF(module);
    return NULL;
}

/* SPDX-License-Identifier: MIT */
/* Arrays of the buffer protocol as images, without a copy if they hold floats. */
#include "module.h"

#include <string.h>

/* The type of a buffer's elements; -1 if Crevice takes no such. */
static int texel_of(const char *format)
{
    static const char LETTERS[] = "fdeBHh";
    static const crv_texel TYPES[] = {CRV_TEXEL_FLOAT, CRV_TEXEL_DOUBLE, CRV_TEXEL_HALF,
                                      CRV_TEXEL_UINT8, CRV_TEXEL_UINT16, CRV_TEXEL_INT16};
    const char *f = format ? format : "B";
    if (*f == '@' || *f == '=' || *f == (PY_BIG_ENDIAN ? '>' : '<'))
        f++;
    const char *at = f[0] && !f[1] ? strchr(LETTERS, f[0]) : NULL;
    return at ? (int)TYPES[at - LETTERS] : -1;
}

/* Shape and strides of a lent array. */
static int describe(array *a, const char *name, int channels)
{
    const Py_buffer *v = &a->view;
    const int type = texel_of(v->format);
    if (type < 0) {
        PyErr_Format(PyExc_TypeError,
                     "%s: elements of type '%s'; it takes float16, float32, float64, "
                     "uint8, uint16 or int16 in the machine's byte order",
                     name, v->format ? v->format : "B");
        return -1;
    }
    const bool flat = v->ndim == 2 && channels == 1;
    if (!flat && !(v->ndim == 3 && v->shape[2] == channels)) {
        PyErr_Format(PyExc_ValueError, "%s: the shape is to be (rows, columns%s%s)", name,
                     channels == 1 ? "" : ", ", channels == 3 ? "3" : "");
        return -1;
    }
    if (v->shape[0] < 1 || v->shape[1] < 1 || v->shape[0] > CRV_MAX_SIZE
        || v->shape[1] > CRV_MAX_SIZE) {
        PyErr_Format(PyExc_ValueError, "%s: %zd x %zd; each side is 1 to %d", name,
                     v->shape[1], v->shape[0], CRV_MAX_SIZE);
        return -1;
    }
    a->texels = crv_texels_packed(v->buf, (crv_texel)type, (int32_t)v->shape[1],
                                  (int32_t)v->shape[0], channels);
    a->texels.row_stride = v->strides[0];
    a->texels.pixel_stride = v->strides[1];
    a->texels.channel_stride = flat ? v->itemsize : v->strides[2];
    return 0;
}

static int lend(array *a, PyObject *object, const char *name, int channels, int flags)
{
    if (PyObject_GetBuffer(object, &a->view, flags))
        return -1;
    if (describe(a, name, channels) == 0)
        return 0;
    PyBuffer_Release(&a->view);
    return -1;
}

int array_read(array *a, PyObject *object, const char *name, int channels)
{
    return lend(a, object, name, channels, PyBUF_RECORDS_RO);
}

void array_release(array *a)
{
    PyBuffer_Release(&a->view);
}

/* Whether the array is what the library takes without a conversion. */
static bool is_image(const crv_texels *t)
{
    const size_t bits = (size_t)t->data | (size_t)t->row_stride | (size_t)t->pixel_stride
                        | (size_t)t->channel_stride;
    return t->type == CRV_TEXEL_FLOAT && bits % sizeof(float) == 0;
}

crv_status array_floats(const array *a, crv_const_image *out, float **owned,
                        const crv_logger *logger)
{
    const crv_texels *t = &a->texels;
    *owned = NULL;
    if (is_image(t)) {
        *out = crv_const_image_packed(t->data, t->width, t->height, t->channels);
        out->row_stride = t->row_stride;
        out->pixel_stride = t->pixel_stride;
        out->channel_stride = t->channel_stride;
        return CRV_OK;
    }
    const size_t count = (size_t)t->width * (size_t)t->height * (size_t)t->channels;
    *owned = PyMem_RawMalloc(count * sizeof(float));
    if (!*owned)
        return CRV_ERROR_OUT_OF_MEMORY;
    const crv_image to = crv_image_packed(*owned, t->width, t->height, t->channels);
    *out = crv_image_const(to);
    return crv_image_convert(t, &to, logger);
}

int array_write(array *a, crv_image *image, PyObject *object, const char *name,
                int channels)
{
    if (lend(a, object, name, channels, PyBUF_RECORDS))
        return -1;
    const crv_texels *t = &a->texels;
    if (!is_image(t)) {
        PyErr_Format(PyExc_TypeError, "%s: an array of float32 is needed", name);
        PyBuffer_Release(&a->view);
        return -1;
    }
    *image = crv_image_packed(a->view.buf, t->width, t->height, channels);
    image->row_stride = t->row_stride;
    image->pixel_stride = t->pixel_stride;
    image->channel_stride = t->channel_stride;
    return 0;
}

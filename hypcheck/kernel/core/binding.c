/* hypcheck.kernel._compiled: the C functions of hypcheck.h for Python, over the buffer protocol, with the GIL released.

   Buffers are C-contiguous and of the native formats d (float64) and b (int8); whoever calls sees to that and to lengths
   that fit, and is told by ValueError where they do not. */

#define PY_SSIZE_T_CLEAN
#include <Python.h>

#define HYPCHECK_IMPLEMENTATION
#include "hypcheck.h"

static int filled(PyObject *object, Py_buffer *buffer, const char *format, int flags) {
    if (PyObject_GetBuffer(object, buffer, PyBUF_C_CONTIGUOUS | PyBUF_FORMAT | flags) != 0) return 0;
    if (buffer->format != NULL && strcmp(buffer->format, format) == 0) return 1;
    PyErr_Format(PyExc_ValueError, "a buffer of format %s is needed, not %s", format, buffer->format ? buffer->format : "B");
    PyBuffer_Release(buffer);
    return 0;
}

/* 7 or 10, the numbers in a row; 0, with an error set, for any other. */
static int width_of(const Py_buffer *rows, const Py_buffer *answers) {
    const Py_ssize_t column = (Py_ssize_t)sizeof(double) * answers->len;
    if (rows->len == 7 * column) return 7;
    if (rows->len == 10 * column) return 10;
    PyErr_SetString(PyExc_ValueError, "seven or ten numbers for each answer");
    return 0;
}

static int known_question(int question) {
    if (question >= HYPCHECK_POSITION && question <= HYPCHECK_CONTACT) return 1;
    PyErr_SetString(PyExc_ValueError, "a question is a number from 0 to 3");
    return 0;
}

static PyObject *py_ask(PyObject *self, PyObject *arguments) {
    PyObject *rows_object, *answers_object, *result = NULL;
    Py_buffer rows, answers;
    int question;
    (void)self;
    if (!PyArg_ParseTuple(arguments, "iOO", &question, &rows_object, &answers_object)) return NULL;
    if (!known_question(question) || !filled(rows_object, &rows, "d", 0)) return NULL;
    if (filled(answers_object, &answers, "b", PyBUF_WRITABLE)) {
        const int width = width_of(&rows, &answers);
        if (width) {
            size_t (*const ask)(int, size_t, const double *, int8_t *) = width == 7 ? hypcheck_ask : hypcheck_ask_tilted;
            size_t refused;
            Py_BEGIN_ALLOW_THREADS
            refused = ask(question, (size_t)answers.len, (const double *)rows.buf, (int8_t *)answers.buf);
            Py_END_ALLOW_THREADS
            result = PyLong_FromSize_t(refused);
        }
        PyBuffer_Release(&answers);
    }
    PyBuffer_Release(&rows);
    return result;
}

static PyObject *py_ask_scene(PyObject *self, PyObject *arguments) {
    PyObject *columns[3], *answers_object, *result = NULL;
    Py_buffer buffers[3], answers;
    double sizes[4], axis[3] = {0, 0, 1};
    int question, held = 0, fits = 1, k;
    (void)self;
    if (!PyArg_ParseTuple(arguments, "i(dddd)OOOO|(ddd)", &question, sizes, sizes + 1, sizes + 2, sizes + 3, columns,
                          columns + 1, columns + 2, &answers_object, axis, axis + 1, axis + 2))
        return NULL;
    if (!known_question(question)) return NULL;
    while (held < 3 && filled(columns[held], buffers + held, "d", 0)) held++;
    if (held == 3 && filled(answers_object, &answers, "b", PyBUF_WRITABLE)) {
        for (k = 0; k < 3; k++) fits = fits && buffers[k].len == (Py_ssize_t)sizeof(double) * answers.len;
        if (fits) {
            size_t refused;
            Py_BEGIN_ALLOW_THREADS
            refused = hypcheck_ask_tilted_scene(question, sizes, axis, (size_t)answers.len, (const double *)buffers[0].buf,
                                                (const double *)buffers[1].buf, (const double *)buffers[2].buf,
                                                (int8_t *)answers.buf);
            Py_END_ALLOW_THREADS
            result = PyLong_FromSize_t(refused);
        } else {
            PyErr_SetString(PyExc_ValueError, "as many x, y and z as answers");
        }
        PyBuffer_Release(&answers);
    }
    while (held) PyBuffer_Release(buffers + --held);
    return result;
}

static PyObject *py_passage(PyObject *self, PyObject *arguments) {
    PyObject *rows_object, *hits_object, *times_object = Py_None, *result = NULL;
    Py_buffer rows, hits, times = {0};
    (void)self;
    if (!PyArg_ParseTuple(arguments, "OO|O", &rows_object, &hits_object, &times_object)) return NULL;
    if (!filled(rows_object, &rows, "d", 0)) return NULL;
    if (filled(hits_object, &hits, "b", PyBUF_WRITABLE)) {
        const Py_ssize_t column = (Py_ssize_t)sizeof(double) * hits.len;
        const int timed = times_object != Py_None;
        if (!timed || filled(times_object, &times, "d", PyBUF_WRITABLE)) {
            if ((rows.len == 10 * column || rows.len == 13 * column) && (!timed || times.len == column)) {
                void (*const decide)(size_t, const double *, int8_t *, double *) =
                    rows.len == 10 * column ? hypcheck_passage : hypcheck_passage_tilted;
                Py_BEGIN_ALLOW_THREADS
                decide((size_t)hits.len, (const double *)rows.buf, (int8_t *)hits.buf, timed ? (double *)times.buf : NULL);
                Py_END_ALLOW_THREADS
                result = Py_NewRef(Py_None);
            } else {
                PyErr_SetString(PyExc_ValueError, "ten or thirteen numbers for each hit, and as many times as hits");
            }
            if (timed) PyBuffer_Release(&times);
        }
        PyBuffer_Release(&hits);
    }
    PyBuffer_Release(&rows);
    return result;
}

static PyObject *py_clearance(PyObject *self, PyObject *arguments) {
    PyObject *rows_object, *positions_object, *found_object, *result = NULL;
    Py_buffer rows, positions, found;
    (void)self;
    if (!PyArg_ParseTuple(arguments, "OOO", &rows_object, &positions_object, &found_object)) return NULL;
    if (!filled(rows_object, &rows, "d", 0)) return NULL;
    if (filled(positions_object, &positions, "b", PyBUF_WRITABLE)) {
        if (filled(found_object, &found, "d", PyBUF_WRITABLE)) {
            const Py_ssize_t count = positions.len;
            if (rows.len == 7 * (Py_ssize_t)sizeof(double) * count && found.len == (Py_ssize_t)sizeof(hypcheck_near) * count) {
                size_t refused;
                Py_BEGIN_ALLOW_THREADS
                refused = hypcheck_clearance((size_t)count, (const double *)rows.buf, (int8_t *)positions.buf, (hypcheck_near *)found.buf);
                Py_END_ALLOW_THREADS
                result = PyLong_FromSize_t(refused);
            } else {
                PyErr_SetString(PyExc_ValueError, "seven numbers and eleven for each position");
            }
            PyBuffer_Release(&found);
        }
        PyBuffer_Release(&positions);
    }
    PyBuffer_Release(&rows);
    return result;
}

/* What position calls where it has no answer: for numbers that are no floats, and for invalid rows. It answers, or raises
   with a sentence that names the number. */
static PyObject *slow_position = NULL;

/* The three floats of a tuple, a list or None, which is upright. Returns 0 for anything else. */
static int axis_of(PyObject *object, double axis[3]) {
    Py_ssize_t k;
    axis[0] = axis[1] = 0, axis[2] = 1;
    if (object == Py_None) return 1;
    if (!PyTuple_CheckExact(object) && !PyList_CheckExact(object)) return 0;
    if (PySequence_Fast_GET_SIZE(object) != 3) return 0;
    for (k = 0; k < 3; k++) {
        PyObject *const number = PySequence_Fast_GET_ITEM(object, k);
        if (!PyFloat_Check(number)) return 0;
        axis[k] = PyFloat_AS_DOUBLE(number);
    }
    return 1;
}

static PyObject *py_position(PyObject *self, PyObject *const *arguments, Py_ssize_t count, PyObject *keywords) {
    double row[10];
    Py_ssize_t k;
    int8_t answer = 127;
    (void)self;
    if (count != 7) {
        PyErr_Format(PyExc_TypeError, "position() takes 7 numbers: alpha, gamma, b, d, x, y, z (%zd given)", count);
        return NULL;
    }
    if (keywords != NULL && (PyTuple_GET_SIZE(keywords) != 1 ||
                             PyUnicode_CompareWithASCIIString(PyTuple_GET_ITEM(keywords, 0), "axis") != 0)) {
        PyErr_SetString(PyExc_TypeError, "position() takes one keyword: axis");
        return NULL;
    }
    for (k = 0; k < 7 && PyFloat_Check(arguments[k]); k++) row[k] = PyFloat_AS_DOUBLE(arguments[k]);
    if (k == 7 && keywords == NULL)
        answer = (int8_t)hypcheck_position(row[0], row[1], row[2], row[3], row[4], row[5], row[6]);
    else if (k == 7 && axis_of(arguments[7], row + 7))
        hypcheck_classify_tilted(1, row, &answer);
    if (answer != 127) return PyLong_FromLong(answer);
    if (slow_position == NULL) return PyLong_FromLong(127);
    return PyObject_Vectorcall(slow_position, arguments, (size_t)count, keywords);
}

static PyObject *py_set_slow_position(PyObject *self, PyObject *function) {
    PyObject *before = slow_position;
    (void)self;
    Py_INCREF(function);
    slow_position = function;
    Py_XDECREF(before);
    Py_RETURN_NONE;
}

static PyObject *py_level(PyObject *self, PyObject *unused) {
    (void)self, (void)unused;
    return PyUnicode_FromString(hypcheck_level());
}

static PyObject *py_use_level(PyObject *self, PyObject *name) {
    const char *text = PyUnicode_AsUTF8(name);
    (void)self;
    return text == NULL ? NULL : PyBool_FromLong(hypcheck_use_level(text));
}

static PyMethodDef functions[] = {
    {"ask", py_ask, METH_VARARGS, "ask(question, rows, answers) -> the number of invalid rows, which are answered 127"},
    {"ask_scene", py_ask_scene, METH_VARARGS, "ask_scene(question, sizes, x, y, z, answers, axis=upright) -> as ask"},
    {"passage", py_passage, METH_VARARGS, "passage(rows, hits, times=None): rows of ways; a hit is 1, 0, 2 undecided, 127 invalid"},
    {"clearance", py_clearance, METH_VARARGS, "clearance(rows, positions, found) -> the number of invalid rows; eleven numbers a row"},
    {"position", (PyCFunction)(void (*)(void))py_position, METH_FASTCALL | METH_KEYWORDS,
     "position(alpha, gamma, b, d, x, y, z, *, axis=None) -> int"},
    {"set_slow_position", py_set_slow_position, METH_O, "set_slow_position(function): what position calls where it has no answer"},
    {"level", py_level, METH_NOARGS, "level() -> the name of the instruction set in use"},
    {"use_level", py_use_level, METH_O, "use_level(name) -> whether this machine and build have it"},
    {NULL, NULL, 0, NULL},
};

static struct PyModuleDef module = {
    PyModuleDef_HEAD_INIT, "_compiled", "The compiled kernel; see core/hypcheck.h.", 0, functions, NULL, NULL, NULL, NULL,
};

PyMODINIT_FUNC PyInit__compiled(void) { return PyModuleDef_Init(&module); }

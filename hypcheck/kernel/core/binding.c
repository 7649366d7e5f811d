/* hypcheck.kernel._compiled: the C functions of hypcheck.h for Python, over the buffer protocol, with the GIL released.

   Buffers must be C-contiguous, of the native formats d (float64) and b (int8), and of lengths that fit; a call with
   other buffers raises ValueError. */

#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include <stdlib.h>

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

#include "columns.h"

/* The answers that were kept, as bytes. */
static void spread(const hc_signs *kept, size_t count, int8_t *answers) {
    const size_t whole = count / HC_BLOCK;
    int8_t last[HC_BLOCK];
    hc_level()->spread_all(answers, kept, whole);
    if (count % HC_BLOCK == 0) return;
    hc_level()->spread_all(last, kept + whole, 1);
    memcpy(answers + HC_BLOCK * whole, last, count % HC_BLOCK);
}

#include "at_once.h"

/* Calls for one scene: with `keep`, positions go as bits to a buffer of two 64-bit words for each 64 rows, until all rows
   are known to be valid and `spread` writes them. Columns are as in columns.h. */
static PyObject *asked_scene(PyObject *arguments, int keep) {
    PyObject *columns[3], *answers_object, *result = NULL;
    Py_buffer answers;
    taken these;
    order call;
    nothing_said(&call);
    take_nothing(&these);
    call.is_scene = 1;
    if (!PyArg_ParseTuple(arguments, "i(dddd)OOOO|(ddd)", &call.question, call.sizes, call.sizes + 1, call.sizes + 2, call.sizes + 3,
                          columns, columns + 1, columns + 2, &answers_object, these.axis, these.axis + 1, these.axis + 2))
        return NULL;
    if (!known_question(call.question) || !filled(answers_object, &answers, "b", PyBUF_WRITABLE)) return NULL;
    if (take_center(&these, columns, 3)) {
        const size_t count = these.arrays ? (size_t)these.count : (size_t)answers.len;
        const size_t wanted = keep ? hc_blocks(count) * sizeof(hc_signs) : count;
        const int aligned = !keep || (uintptr_t)answers.buf % sizeof(uint64_t) == 0;
        if (aligned && (size_t)answers.len == wanted) {
            size_t refused;
            these.count = (Py_ssize_t)count;
            Py_BEGIN_ALLOW_THREADS
            refused = scene_answers(&these, &call, (int8_t *)answers.buf, keep ? (hc_signs *)answers.buf : NULL);
            Py_END_ALLOW_THREADS
            if (!these.odd) result = PyLong_FromSize_t(refused);
        }
    }
    if (result == NULL && !PyErr_Occurred()) PyErr_SetString(PyExc_ValueError, "columns as columns.h takes them, as many x, y and z as answers");
    give_back(&these);
    PyBuffer_Release(&answers);
    return result;
}

static PyObject *py_ask_scene(PyObject *self, PyObject *arguments) {
    (void)self;
    return asked_scene(arguments, 0);
}

static PyObject *py_keep_scene(PyObject *self, PyObject *arguments) {
    (void)self;
    return asked_scene(arguments, 1);
}

static PyObject *py_spread(PyObject *self, PyObject *arguments) {
    PyObject *kept_object, *answers_object, *result = NULL;
    Py_buffer kept, answers;
    (void)self;
    if (!PyArg_ParseTuple(arguments, "OO", &kept_object, &answers_object) || !filled(kept_object, &kept, "b", 0)) return NULL;
    if (filled(answers_object, &answers, "b", PyBUF_WRITABLE)) {
        if ((size_t)kept.len == hc_blocks((size_t)answers.len) * sizeof(hc_signs)) {
            Py_BEGIN_ALLOW_THREADS
            spread((const hc_signs *)kept.buf, (size_t)answers.len, (int8_t *)answers.buf);
            Py_END_ALLOW_THREADS
            result = Py_NewRef(Py_None);
        } else {
            PyErr_SetString(PyExc_ValueError, "two words for each 64 answers");
        }
        PyBuffer_Release(&answers);
    }
    PyBuffer_Release(&kept);
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
            const Py_ssize_t width = rows.len == 10 * column ? 10 : rows.len == 13 * column ? 13 : 16;
            if (rows.len == width * column && (!timed || times.len == column)) {
                Py_BEGIN_ALLOW_THREADS
                hypcheck_passage_columns((size_t)hits.len, (size_t)width, (const double *)rows.buf, (int8_t *)hits.buf,
                                         timed ? (double *)times.buf : NULL);
                Py_END_ALLOW_THREADS
                result = Py_NewRef(Py_None);
            } else {
                PyErr_SetString(PyExc_ValueError, "ten, thirteen or sixteen numbers for each hit, and as many times as hits");
            }
            if (timed) PyBuffer_Release(&times);
        }
        PyBuffer_Release(&hits);
    }
    PyBuffer_Release(&rows);
    return result;
}

static PyObject *py_classify_ended(PyObject *self, PyObject *arguments) {
    PyObject *rows_object, *positions_object, *result = NULL;
    Py_buffer rows, positions;
    (void)self;
    if (!PyArg_ParseTuple(arguments, "OO", &rows_object, &positions_object) || !filled(rows_object, &rows, "d", 0)) return NULL;
    if (filled(positions_object, &positions, "b", PyBUF_WRITABLE)) {
        if (rows.len == 13 * (Py_ssize_t)sizeof(double) * positions.len) {
            Py_BEGIN_ALLOW_THREADS
            hypcheck_classify_ended((size_t)positions.len, (const double *)rows.buf, (int8_t *)positions.buf);
            Py_END_ALLOW_THREADS
            result = Py_NewRef(Py_None);
        } else {
            PyErr_SetString(PyExc_ValueError, "thirteen numbers for each position");
        }
        PyBuffer_Release(&positions);
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

/* None, which is upright, or three numbers. */
static int axis_of(PyObject *object, double axis[3]) {
    int k;
    axis[0] = axis[1] = 0, axis[2] = 1;
    if (object == Py_None) return 1;
    if (!is_list(object) || PySequence_Fast_GET_SIZE(object) != 3) return 0;
    for (k = 0; k < 3; k++)
        if (!number_of(PySequence_Fast_GET_ITEM(object, k), axis + k)) return 0;
    return 1;
}

static PyObject *py_position(PyObject *self, PyObject *const *arguments, Py_ssize_t count, PyObject *keywords) {
    double row[10];
    int fits = count == 7, k;
    int8_t answer = 127;
    (void)self;
    if (count != 7 && slow_position == NULL) {
        PyErr_Format(PyExc_TypeError, "position() takes 7 numbers: alpha, gamma, b, d, x, y, z (%zd given)", count);
        return NULL;
    }
    if (keywords != NULL) fits = fits && PyTuple_GET_SIZE(keywords) == 1 && named(PyTuple_GET_ITEM(keywords, 0), "axis");
    for (k = 0; k < 7 && fits; k++) fits = number_of(arguments[k], row + k);
    if (fits && keywords == NULL) answer = (int8_t)hc_position_of(row);
    else if (fits && axis_of(arguments[7], row + 7)) hypcheck_classify_tilted(1, row, &answer);
    if (answer != 127) return PyLong_FromLong(answer);
    if (slow_position == NULL) return PyLong_FromLong(127);
    return PyObject_Vectorcall(slow_position, arguments, (size_t)count, keywords);
}

static PyObject *py_set_slow_position(PyObject *self, PyObject *function);

static PyObject *py_prepare(PyObject *self, PyObject *arguments) {
    PyObject *columns[3];
    Py_buffer buffers[3];
    double sizes[4], axis[3];
    hypcheck_scene scene;
    PyObject *result = NULL;
    int held = 0;
    (void)self;
    if (!PyArg_ParseTuple(arguments, "(dddd)(ddd)OOO", sizes, sizes + 1, sizes + 2, sizes + 3, axis, axis + 1, axis + 2,
                          columns, columns + 1, columns + 2))
        return NULL;
    while (held < 3 && filled(columns[held], buffers + held, "d", 0)) held++;
    if (held == 3) {
        if (buffers[0].len == buffers[1].len && buffers[0].len == buffers[2].len) {
            hypcheck_prepare(&scene, sizes, axis, (size_t)buffers[0].len / sizeof(double), (const double *)buffers[0].buf,
                             (const double *)buffers[1].buf, (const double *)buffers[2].buf);
            result = PyBytes_FromStringAndSize((const char *)&scene, (Py_ssize_t)sizeof scene);
        } else {
            PyErr_SetString(PyExc_ValueError, "as many x as y and z");
        }
    }
    while (held) PyBuffer_Release(buffers + --held);
    return result;
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

static PyObject *py_set_slow_calls(PyObject *self, PyObject *arguments);

static PyMethodDef functions[] = {
    {"ask", py_ask, METH_VARARGS, "ask(question, rows, answers) -> the number of invalid rows, which are answered 127"},
    {"ask_scene", py_ask_scene, METH_VARARGS, "ask_scene(question, sizes, x, y, z, answers, axis=upright) -> as ask"},
    {"keep_scene", py_keep_scene, METH_VARARGS, "keep_scene(0, sizes, x, y, z, kept, axis=upright) -> as ask; see spread"},
    {"spread", py_spread, METH_VARARGS, "spread(kept, answers): write the answers that keep_scene kept"},
    {"prepare", py_prepare, METH_VARARGS, "prepare(sizes, axis, x, y, z) -> the bytes of a hypcheck_scene"},
    {"use_arrays", py_use_arrays, METH_VARARGS, "use_arrays(ndarray, empty, dtype('int8'), rows, scalars): what calls take, make, and leave to threads; scalars are 77"},
    {"classify", (PyCFunction)(void (*)(void))py_classify, METH_FASTCALL | METH_KEYWORDS, NULL},
    {"classify_scene", (PyCFunction)(void (*)(void))py_classify_scene, METH_FASTCALL | METH_KEYWORDS, NULL},
    {"set_slow_calls", py_set_slow_calls, METH_VARARGS, "set_slow_calls(classify, classify_scene, Prepared): what these call for any other call"},
    {"take", (PyCFunction)(void (*)(void))py_take, METH_FASTCALL, "take(sizes, x, y, z, out or None): take the arrays, do nothing"},
    {"nothing", (PyCFunction)(void (*)(void))py_nothing, METH_FASTCALL | METH_KEYWORDS, "nothing(...): be called, do nothing"},
    {"passage", py_passage, METH_VARARGS, "passage(rows, hits, times=None): rows of sweeps; a hit is 1, 0, 2 undecided, 127 invalid"},
    {"classify_ended", py_classify_ended, METH_VARARGS, "classify_ended(rows, positions): rows of 13; 2 undecided, 127 invalid"},
    {"clearance", py_clearance, METH_VARARGS, "clearance(rows, positions, found) -> the number of invalid rows; eleven numbers a row"},
    {"position", (PyCFunction)(void (*)(void))py_position, METH_FASTCALL | METH_KEYWORDS,
     NULL},
    {"set_slow_position", py_set_slow_position, METH_O, "set_slow_position(function): what position calls where it has no answer"},
    {"level", py_level, METH_NOARGS, "level() -> the name of the instruction set in use"},
    {"use_level", py_use_level, METH_O, "use_level(name) -> whether this machine and build have it"},
    {NULL, NULL, 0, NULL},
};

/* The functions that Python has for all calls, which give theirs here their descriptions. */
typedef PyObject *(*call)(PyObject *, PyObject *const *, Py_ssize_t, PyObject *);
static const struct {
    call function;
    const char *signature;
} described[3] = {
    {py_classify, "classify(*pairs, axis=None, z_min=-1e999, z_max=1e999, solid=False, margin=0.0, out=None, on_invalid='raise', "
                  "question='position', threads=None, **columns)\n--\n\n"},
    {py_classify_scene, "classify_scene(sizes, x, y=None, z=None, out=None, *, axis=None, z_min=-1e999, z_max=1e999, "
                        "solid=False, margin=0.0, on_invalid='raise', "
                        "question='position', threads=None)\n--\n\n"},
    {py_position, "position(*pairs, axis=None, z_min=-1e999, z_max=1e999, solid=False, margin=0.0, **columns)\n--\n\n"},
};

static void describe(int which, PyObject *function) {
    static char texts[3][8192];
    PyObject *const description = PyObject_GetAttrString(function, "__doc__");
    const char *const text = description == NULL || description == Py_None ? "" : PyUnicode_AsUTF8(description);
    PyMethodDef *each = functions;
    PyOS_snprintf(texts[which], sizeof texts[which], "%s%s", described[which].signature, text == NULL ? "" : text);
    Py_XDECREF(description);
    PyErr_Clear();
    while (each->ml_meth != (PyCFunction)(void (*)(void))described[which].function) each++;
    each->ml_doc = texts[which];
}

static PyObject *py_set_slow_calls(PyObject *self, PyObject *arguments) {
    PyObject *calls[2], *type;
    int k;
    (void)self;
    if (!PyArg_ParseTuple(arguments, "OOO", calls, calls + 1, &type)) return NULL;
    Py_XSETREF(prepared_type, Py_NewRef(type));
    for (k = 0; k < 2; k++) {
        describe(k, calls[k]);
        Py_XSETREF(slow_calls[k], Py_NewRef(calls[k]));
    }
    Py_RETURN_NONE;
}

static PyObject *py_set_slow_position(PyObject *self, PyObject *function) {
    (void)self;
    describe(2, function);
    Py_XSETREF(slow_position, Py_NewRef(function));
    Py_RETURN_NONE;
}

static struct PyModuleDef module = {
    PyModuleDef_HEAD_INIT, "_compiled", "The compiled kernel; see core/hypcheck.h.", 0, functions, NULL, NULL, NULL, NULL,
};

PyMODINIT_FUNC PyInit__compiled(void) { return PyModuleDef_Init(&module); }

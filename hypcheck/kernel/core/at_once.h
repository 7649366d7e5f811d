/* Ordinary calls of classify_scene and classify, with no step in Python.

   They take exactly numpy's arrays, which lie in memory as C wants them, and answer; or they answer nothing (None), change
   nothing, and leave the call to Python, which converts what can be converted and says what is wrong with the rest.
   Part of binding.c, which includes it once. */

static PyObject *prepared_type = NULL; /* hypcheck.Prepared */
static PyObject *array_type = NULL, *new_array = NULL, *answer_type = NULL; /* numpy.ndarray, empty, dtype("int8") */
static Py_ssize_t for_one_thread = 0; /* rows that one thread answers where the caller does not ask for one */

enum { FEW = 1024, FREE_FROM = 256 }; /* rows held on the stack; rows for which the interpreter is set free meanwhile */

static PyObject *py_use_arrays(PyObject *self, PyObject *arguments) {
    PyObject *type, *make, *answers;
    (void)self;
    if (!PyArg_ParseTuple(arguments, "OOOn", &type, &make, &answers, &for_one_thread)) return NULL;
    Py_XSETREF(array_type, Py_NewRef(type));
    Py_XSETREF(new_array, Py_NewRef(make));
    Py_XSETREF(answer_type, Py_NewRef(answers));
    Py_RETURN_NONE;
}

/* The memory of an array of that format and of so many dimensions, each row behind the other; 0 for anything else. */
static int lent(PyObject *object, Py_buffer *buffer, const char *format, size_t size, int dimensions, int flags) {
    if ((PyObject *)Py_TYPE(object) != array_type) return 0;
    if (PyObject_GetBuffer(object, buffer, PyBUF_C_CONTIGUOUS | PyBUF_FORMAT | flags) != 0) {
        PyErr_Clear();
        return 0;
    }
    if (buffer->ndim == dimensions && strcmp(buffer->format, format) == 0 && (uintptr_t)buffer->buf % size == 0) return 1;
    PyBuffer_Release(buffer);
    return 0;
}

static int apart(const Py_buffer *one, const Py_buffer *other) {
    const uintptr_t start = (uintptr_t)one->buf, begin = (uintptr_t)other->buf;
    return start + (uintptr_t)one->len <= begin || begin + (uintptr_t)other->len <= start;
}

/* The arguments of a call: columns of a scene, a number standing for a whole one, or rows; and where answers go. */
typedef struct {
    Py_buffer inputs[3], out;
    int lends[3], has_out, width; /* 7 or 10 numbers in a row; 0 for a scene */
    double axis[3], numbers[3], room[3][FEW];
    const double *columns[3];
    Py_ssize_t count;
} taken;

static void give_back(taken *these) {
    int k;
    for (k = 0; k < 3; k++)
        if (these->lends[k]) PyBuffer_Release(these->inputs + k);
    if (these->has_out) PyBuffer_Release(&these->out);
}

static int take_out(taken *these, PyObject *out) {
    int k;
    if (out == Py_None) return 1;
    if (!(these->has_out = lent(out, &these->out, "b", 1, 1, PyBUF_WRITABLE)) || these->out.len != these->count) return 0;
    for (k = 0; k < 3; k++)
        if (these->lends[k] && !apart(&these->out, these->inputs + k)) return 0;
    return 1;
}

static int take_scene(taken *these, PyObject *const *columns, PyObject *out) {
    int k, i, arrays = 0;
    these->lends[0] = these->lends[1] = these->lends[2] = these->has_out = these->width = 0;
    these->count = 1;
    for (k = 0; k < 3; k++) {
        if (PyFloat_Check(columns[k])) {
            these->numbers[k] = PyFloat_AS_DOUBLE(columns[k]);
            continue;
        }
        if (!(these->lends[k] = lent(columns[k], these->inputs + k, "d", sizeof(double), 1, 0))) return 0;
        if (arrays++ && these->inputs[k].shape[0] != these->count) return 0;
        these->count = these->inputs[k].shape[0];
        these->columns[k] = (const double *)these->inputs[k].buf;
    }
    for (k = 0; k < 3; k++) {
        if (these->lends[k]) continue;
        if (these->count > FEW) return 0;
        for (i = 0; i < these->count; i++) these->room[k][i] = these->numbers[k];
        these->columns[k] = these->room[k];
    }
    return take_out(these, out);
}

static int take_rows(taken *these, PyObject *rows, PyObject *out) {
    these->lends[1] = these->lends[2] = these->has_out = 0;
    if (!(these->lends[0] = lent(rows, these->inputs, "d", sizeof(double), 2, 0))) return 0;
    these->count = these->inputs[0].shape[0];
    these->width = (int)these->inputs[0].shape[1];
    these->columns[0] = (const double *)these->inputs[0].buf;
    return (these->width == 7 || these->width == 10) && take_out(these, out);
}

/* Four floats, or a hypcheck.Prepared, which has the bytes of a hypcheck_scene; 0 for anything else, and for sizes that are
   not valid. */
static int scene_of(PyObject *object, hypcheck_scene *scene, double sizes[4], int *prepared) {
    double row[7] = {0};
    Py_ssize_t k;
    *prepared = (PyObject *)Py_TYPE(object) == prepared_type;
    if (*prepared) {
        PyObject *const kept = PyObject_GetAttrString(object, "kept");
        const int fits = kept != NULL && PyBytes_CheckExact(kept) && PyBytes_GET_SIZE(kept) == (Py_ssize_t)sizeof *scene;
        if (fits) memcpy(scene, PyBytes_AS_STRING(kept), sizeof *scene);
        if (kept == NULL) PyErr_Clear();
        Py_XDECREF(kept);
        return fits;
    }
    if (!(PyTuple_CheckExact(object) || PyList_CheckExact(object)) || PySequence_Fast_GET_SIZE(object) != 4) return 0;
    for (k = 0; k < 4; k++) {
        PyObject *const number = PySequence_Fast_GET_ITEM(object, k);
        if (!PyFloat_Check(number)) return 0;
        row[k] = sizes[k] = PyFloat_AS_DOUBLE(number);
    }
    return hc_valid(row);
}

static size_t decided(const taken *these, const hypcheck_scene *scene, const double sizes[4], int8_t *answers) {
    const double *const *const at = these->columns;
    const size_t count = (size_t)these->count;
    if (these->width == 7) return hypcheck_ask(HYPCHECK_POSITION, count, at[0], answers);
    if (these->width == 10) return hypcheck_ask_tilted(HYPCHECK_POSITION, count, at[0], answers);
    if (scene != NULL) return hypcheck_ask_prepared(HYPCHECK_POSITION, scene, count, at[0], at[1], at[2], answers);
    return hypcheck_ask_tilted_scene(HYPCHECK_POSITION, sizes, these->axis, count, at[0], at[1], at[2], answers);
}

/* Fills `out`, or nothing of it. Returns the number of invalid rows, or 1 where memory is missing: Python then tries.
   Until all rows are known to be valid their answers are kept elsewhere; those of a scene as bits, for there to write and
   read a byte a row would take a tenth of the time. */
static size_t filled_whole(const taken *these, const hypcheck_scene *scene, const double sizes[4]) {
    const double *const *const at = these->columns;
    const size_t count = (size_t)these->count;
    const int bits = these->width == 0 && count > FEW;
    int8_t few[FEW], *const out = (int8_t *)these->out.buf;
    void *const kept = count <= FEW ? few : malloc(bits ? hc_blocks(count) * sizeof(hc_signs) : count);
    hypcheck_scene own;
    hc_prepared made;
    size_t refused;
    if (kept == NULL) return 1;
    if (bits) {
        if (scene == NULL) hypcheck_prepare(&own, sizes, these->axis, count, at[0], at[1], at[2]);
        memcpy(&made, scene != NULL ? scene : &own, sizeof made);
        refused = made.valid ? hc_ask_kept(HYPCHECK_POSITION, &made, count, at[0], at[1], at[2], NULL, kept) : count;
        if (refused == 0) spread(kept, count, out);
    } else {
        refused = decided(these, scene, sizes, kept);
        if (refused == 0) memcpy(out, kept, count);
    }
    if (kept != few) free(kept);
    return refused;
}

static PyObject *new_answers(Py_ssize_t count) {
    PyObject *arguments[2] = {PyLong_FromSsize_t(count), answer_type}, *made;
    if (arguments[0] == NULL) return NULL;
    made = PyObject_Vectorcall(new_array, arguments, 2, NULL);
    Py_DECREF(arguments[0]);
    return made;
}

/* The answers of a call whose arguments are taken: `out`, a new array, or None where a row is invalid. */
static PyObject *answered(taken *these, PyObject *out, const hypcheck_scene *scene, const double sizes[4]) {
    PyObject *answers = out == Py_None ? new_answers(these->count) : Py_NewRef(out);
    PyThreadState *state = NULL;
    size_t refused;
    if (answers == NULL) return NULL;
    if (out == Py_None && !(these->has_out = lent(answers, &these->out, "b", 1, 1, PyBUF_WRITABLE))) {
        Py_DECREF(answers);
        Py_RETURN_NONE;
    }
    if (these->count >= FREE_FROM) state = PyEval_SaveThread();
    refused = out == Py_None ? decided(these, scene, sizes, (int8_t *)these->out.buf) : filled_whole(these, scene, sizes);
    if (state != NULL) PyEval_RestoreThread(state);
    if (refused == 0) return answers;
    Py_DECREF(answers);
    Py_RETURN_NONE;
}

static PyObject *answered_or_given_back(taken *these, int took, PyObject *threads, PyObject *out,
                                        const hypcheck_scene *scene, const double sizes[4]) {
    const Py_ssize_t most = threads == Py_None ? for_one_thread : PY_SSIZE_T_MAX;
    PyObject *result = took && these->count > 0 && these->count <= most ? answered(these, out, scene, sizes) : Py_NewRef(Py_None);
    give_back(these);
    return result;
}

/* The functions in Python that take any call, of classify and of classify_scene. */
static PyObject *slow_calls[2] = {NULL, NULL};

/* Where `out`, `threads` and, if there may be one, `axis` of a call are said; 0 for a call with another option. */
static int ordinary(PyObject *const *arguments, Py_ssize_t count, PyObject *keywords, Py_ssize_t inputs, PyObject **out,
                    PyObject **threads, PyObject **axis) {
    const Py_ssize_t named = keywords == NULL ? 0 : PyTuple_GET_SIZE(keywords);
    Py_ssize_t k;
    *out = *threads = Py_None;
    if (axis != NULL) *axis = Py_None;
    if (count < inputs || count > inputs + 1) return 0;
    if (count > inputs) *out = arguments[inputs];
    for (k = 0; k < named; k++) {
        PyObject *const name = PyTuple_GET_ITEM(keywords, k);
        if (PyUnicode_CompareWithASCIIString(name, "out") == 0 && count == inputs) *out = arguments[count + k];
        else if (PyUnicode_CompareWithASCIIString(name, "threads") == 0) *threads = arguments[count + k];
        else if (axis != NULL && PyUnicode_CompareWithASCIIString(name, "axis") == 0) *axis = arguments[count + k];
        else return 0;
    }
    return *threads == Py_None || (PyLong_CheckExact(*threads) && PyLong_AsSsize_t(*threads) == 1);
}

static PyObject *or_slowly(PyObject *answers, int which, PyObject *const *arguments, Py_ssize_t count, PyObject *keywords) {
    if (answers != Py_None || slow_calls[which] == NULL) return answers;
    Py_DECREF(answers);
    return PyObject_Vectorcall(slow_calls[which], arguments, (size_t)count, keywords);
}

static PyObject *scene_at_once(PyObject *const *arguments, PyObject *out, PyObject *threads, PyObject *axis) {
    hypcheck_scene scene;
    double sizes[4];
    taken these;
    int prepared, took;
    if (!scene_of(arguments[0], &scene, sizes, &prepared) || (prepared && axis != Py_None)) Py_RETURN_NONE;
    if (!axis_of(axis, these.axis)) Py_RETURN_NONE;
    took = take_scene(&these, arguments + 1, out);
    return answered_or_given_back(&these, took, threads, out, prepared ? &scene : NULL, sizes);
}

static PyObject *rows_at_once(PyObject *const *arguments, PyObject *out, PyObject *threads) {
    taken these;
    const int took = take_rows(&these, arguments[0], out);
    return answered_or_given_back(&these, took, threads, out, NULL, NULL);
}

static PyObject *py_classify(PyObject *self, PyObject *const *arguments, Py_ssize_t count, PyObject *keywords) {
    PyObject *out, *threads, *answers = Py_None;
    (void)self;
    if (!ordinary(arguments, count, keywords, 1, &out, &threads, NULL) || count > 1) Py_INCREF(answers);
    else answers = rows_at_once(arguments, out, threads);
    return or_slowly(answers, 0, arguments, count, keywords);
}

static PyObject *py_classify_scene(PyObject *self, PyObject *const *arguments, Py_ssize_t count, PyObject *keywords) {
    PyObject *out, *threads, *axis, *answers = Py_None;
    (void)self;
    if (!ordinary(arguments, count, keywords, 4, &out, &threads, &axis)) Py_INCREF(answers);
    else answers = scene_at_once(arguments, out, threads, axis);
    return or_slowly(answers, 1, arguments, count, keywords);
}

/* What a call cannot do without, for the benchmark: to take the arrays and give them back; and to be called at all. */
static PyObject *py_take(PyObject *self, PyObject *const *arguments, Py_ssize_t count) {
    taken these;
    (void)self;
    if (count != 5) {
        PyErr_SetString(PyExc_TypeError, "five arguments are needed");
        return NULL;
    }
    if (!take_scene(&these, arguments + 1, arguments[4])) PyErr_SetString(PyExc_ValueError, "these are no ordinary arrays");
    give_back(&these);
    if (PyErr_Occurred()) return NULL;
    Py_RETURN_NONE;
}

static PyObject *py_nothing(PyObject *self, PyObject *const *arguments, Py_ssize_t count, PyObject *keywords) {
    (void)self, (void)arguments, (void)count, (void)keywords;
    Py_RETURN_NONE;
}

/* Ordinary calls of classify, classify_scene and position, with no step in Python.

   They take what columns.h takes, and answer; or they answer nothing (None), change nothing, and leave the call to Python,
   which converts what can be converted and says what is wrong with the rest. Part of binding.c, which includes it once. */

static PyObject *prepared_type = NULL; /* hypcheck.Prepared */
static PyObject *new_array = NULL, *answer_type = NULL; /* numpy.empty, dtype("int8") */
static Py_ssize_t for_one_thread = 0; /* rows that one thread answers where the caller does not ask for one */

enum { FREE_FROM = 256 }; /* rows for which the interpreter is set free meanwhile */

/* A call that may be answered here: its question, whether invalid rows are marked, and its scene if it was prepared. */
typedef struct {
    PyObject *out, *threads, *axis;
    int question, marked, prepared, is_scene;
    double sizes[4];
    hypcheck_scene scene;
} order;

/* numpy's scalars have the number behind their head: that is tried, and they are left to Python where it is otherwise. */
static int use_scalars(PyObject *samples) {
    Py_ssize_t k;
    scalar_count = 0;
    for (k = 0; k < PyTuple_GET_SIZE(samples) && scalar_count < MOST_SCALARS; k++) {
        PyObject *const sample = PyTuple_GET_ITEM(samples, k);
        Py_buffer view;
        double number = 0;
        if (PyObject_GetBuffer(sample, &view, PyBUF_FORMAT) != 0) return 0;
        if (view.format[0] != '\0' && view.format[1] == '\0') {
            scalars[scalar_count].type = Py_TYPE(Py_NewRef(sample));
            scalars[scalar_count++].format = view.format[0];
            if (!number_of(sample, &number) || number != 77) scalar_count--;
        }
        PyBuffer_Release(&view);
    }
    return 1;
}

static PyObject *py_use_arrays(PyObject *self, PyObject *arguments) {
    PyObject *type, *make, *answers, *samples;
    (void)self;
    if (!PyArg_ParseTuple(arguments, "OOOnO!", &type, &make, &answers, &for_one_thread, &PyTuple_Type, &samples)) return NULL;
    Py_XSETREF(array_type, Py_NewRef(type));
    Py_XSETREF(new_array, Py_NewRef(make));
    Py_XSETREF(answer_type, Py_NewRef(answers));
    if (!use_scalars(samples)) return NULL;
    Py_RETURN_NONE;
}

/* Where answers go: a contiguous array of bytes of numpy, as long as the rows are many. */
static int take_out(taken *these, PyObject *out) {
    Py_buffer *const buffer = &these->out;
    if ((PyObject *)Py_TYPE(out) != array_type) return 0;
    if (PyObject_GetBuffer(out, buffer, PyBUF_C_CONTIGUOUS | PyBUF_FORMAT | PyBUF_WRITABLE) != 0) {
        PyErr_Clear();
        return 0;
    }
    these->has_out = 1;
    return buffer->ndim == 1 && strcmp(buffer->format, "b") == 0 && buffer->len == these->count;
}

/* A centre, (n, 3) or one point, or three columns. */
static int take_center(taken *these, PyObject *const *center, Py_ssize_t count) {
    int k;
    if (count == 1) return take_table(these, center[0], these->columns + 4, 3) == 3;
    for (k = 0; k < 3; k++)
        if (!take_column(these, center[k], these->columns + 4 + k)) return 0;
    return 1;
}

/* Four numbers, or a hypcheck.Prepared, which has the bytes of a hypcheck_scene; 0 for anything else. */
static int take_sizes(taken *these, PyObject *object, order *call) {
    call->prepared = (PyObject *)Py_TYPE(object) == prepared_type;
    if (call->prepared) {
        PyObject *const kept = PyObject_GetAttrString(object, "kept");
        const int fits = kept != NULL && PyBytes_CheckExact(kept) && PyBytes_GET_SIZE(kept) == (Py_ssize_t)sizeof call->scene;
        if (fits) memcpy(&call->scene, PyBytes_AS_STRING(kept), sizeof call->scene);
        if (kept == NULL) PyErr_Clear();
        Py_XDECREF(kept);
        return fits && call->axis == Py_None;
    }
    return take_table(these, object, these->columns, 4) == 4 && !these->arrays;
}

/* Notes whether all rows are of the same sizes; 0 where these are not valid, which Python says. */
static int note_scene(const taken *these, order *call) {
    double row[7] = {0};
    int k;
    call->is_scene = !these->has_axis;
    for (k = 0; k < 4 && !call->prepared; k++) {
        if (these->columns[k].format) return call->is_scene = 0, 1;
        row[k] = call->sizes[k] = these->columns[k].number;
    }
    return call->prepared || hc_valid(row);
}

static void sample_center(const taken *these, size_t wanted, double *const into[3]) {
    const Py_ssize_t step = these->count / (Py_ssize_t)wanted;
    int k;
    for (k = 0; k < 3; k++) {
        column thinned = these->columns[4 + k];
        thinned.stride *= step;
        gathered(&thinned, 0, wanted, into[k]);
    }
}

/* Answers of a scene, written or kept as bits: each time the next centres are converted, so few that they stay in the
   nearest cache, and that memory is read meanwhile. */
static size_t scene_in_parts(taken *these, order *call, int8_t *answers, hc_signs *kept) {
    const size_t count = (size_t)these->count;
    double room[3 * PART], *const at[3] = {room, room + PART, room + 2 * PART};
    hc_prepared made;
    hc_upright_parts upright;
    hc_tilted_parts tilted;
    size_t refused = 0, start;
    if (!call->prepared) {
        sample_center(these, 63, at);
        hypcheck_prepare(&call->scene, call->sizes, these->axis, 63, at[0], at[1], at[2]);
    }
    memcpy(&made, &call->scene, sizeof made);
    if (!made.valid) return kept != NULL ? count : hc_refuse_all(count, answers);
    if (made.upright) hc_begin_upright(&upright, call->question, made.probe, made.lines ? &made.of.upright : NULL, count, answers, kept);
    else hc_begin_tilted(&tilted, call->question, made.probe, made.planes ? &made.of.tilted : NULL, count, answers, kept);
    upright.fetch = tilted.fetch = 0;
    for (start = 0; start < count; start += PART) {
        const size_t some = count - start < PART ? count - start : PART;
        these->odd |= gathered_center(these->columns + 4, start, some, at);
        refused += made.upright ? hc_upright_part(&upright, start, some, at[0], at[1], at[2])
                                : hc_tilted_part(&tilted, start, some, at[0], at[1], at[2]);
    }
    return refused + (made.upright ? hc_end_upright(&upright) : hc_end_tilted(&tilted));
}

static size_t scene_answers(taken *these, order *call, int8_t *answers, hc_signs *kept) {
    const size_t count = (size_t)these->count;
    const column *const center = these->columns + 4;
    const double *x = (const double *)(const void *)center[0].at, *y = (const double *)(const void *)center[1].at;
    const double *z = (const double *)(const void *)center[2].at;
    double few[3 * FEW], *const at[3] = {few, few + FEW, few + 2 * FEW};
    hc_prepared made;
    if (!(lies_plain(center) && lies_plain(center + 1) && lies_plain(center + 2))) {
        if (count > FEW) return scene_in_parts(these, call, answers, kept);
        these->odd |= gathered_center(center, 0, count, at);
        x = at[0], y = at[1], z = at[2];
    }
    if (call->prepared && kept == NULL) return hypcheck_ask_prepared(call->question, &call->scene, count, x, y, z, answers);
    if (kept == NULL) return hypcheck_ask_tilted_scene(call->question, call->sizes, these->axis, count, x, y, z, answers);
    if (!call->prepared) hypcheck_prepare(&call->scene, call->sizes, these->axis, count, x, y, z);
    memcpy(&made, &call->scene, sizeof made);
    return made.valid ? hc_ask_kept(call->question, &made, count, x, y, z, NULL, kept) : count;
}

/* The answers about a row of ten columns: it waits with those that are upright, or with those that are tilted. */
static size_t row_waits(const hc_level_functions *level, int question, double numbers[MOST_COLUMNS][HC_BLOCK], int i, size_t place,
                        hc_waiting *upright, hc_tilted_waiting *tilted, int8_t *answers) {
    double row[10];
    int k;
    for (k = 0; k < 10; k++) row[k] = numbers[k][i];
    if (hc_is_upright(row) && hc_has_direction(row + 7)) {
        for (k = 0; k < 7; k++) upright->columns[k * HC_BLOCK + upright->count] = row[k];
        upright->places[upright->count++] = place;
        return upright->count == HC_BLOCK ? hc_settle(level, question, upright, answers) : 0;
    }
    hc_scale_axis(row + 7);
    for (k = 0; k < 10; k++) tilted->columns[k * HC_BLOCK + tilted->count] = row[k];
    tilted->places[tilted->count++] = place;
    return tilted->count == HC_BLOCK ? hc_tilted_settle(level, question, tilted, answers) : 0;
}

/* Answers of rows whose numbers lie in columns of their own: seven, or ten. */
static size_t rows_by_columns(taken *these, int question, int8_t *answers) {
    const hc_level_functions *const level = hc_level();
    const int width = these->has_axis ? 10 : 7;
    const size_t count = (size_t)these->count;
    double numbers[MOST_COLUMNS][HC_BLOCK];
    hc_waiting upright;
    hc_tilted_waiting tilted;
    size_t refused = 0, start, i;
    int k;
    memset(&upright, 0, sizeof upright);
    memset(&tilted, 0, sizeof tilted);
    for (start = 0; start < count; start += HC_BLOCK) {
        const size_t some = count - start < HC_BLOCK ? count - start : HC_BLOCK;
        for (k = 0; k < width; k++)
            these->odd |= gathered(these->columns + k, start, some, width == 7 ? upright.columns + k * HC_BLOCK : numbers[k]);
        for (i = 0; i < some && width == 7; i++) upright.places[upright.count++] = start + i;
        for (i = 0; i < some && width == 10; i++)
            refused += row_waits(level, question, numbers, (int)i, start + i, &upright, &tilted, answers);
        if (width == 7) refused += hc_settle(level, question, &upright, answers);
    }
    refused += hc_settle(level, question, &upright, answers);
    return refused + hc_tilted_settle(level, question, &tilted, answers);
}

/* Rows as C takes them: one behind the other. */
static int lie_behind_each_other(const taken *these, int width) {
    int k, plain = these->columns[0].format == 'd' && these->columns[0].stride == width * (Py_ssize_t)sizeof(double);
    for (k = 1; k < width; k++)
        plain = plain && these->columns[k].format == 'd' && these->columns[k].stride == these->columns[0].stride &&
                these->columns[k].at == these->columns[k - 1].at + sizeof(double);
    return plain && (uintptr_t)these->columns[0].at % sizeof(double) == 0;
}

static size_t row_answers(taken *these, int question, int8_t *answers) {
    const int is_tilted = these->axis[0] != 0 || these->axis[1] != 0 || !(these->axis[2] != 0 && these->axis[2] - these->axis[2] == 0);
    const double *const rows = (const double *)(const void *)these->columns[0].at;
    int k;
    if (!these->has_axis && is_tilted) { /* one for all rows */
        for (k = 0; k < 3; k++) these->columns[7 + k].format = 0, these->columns[7 + k].number = these->axis[k];
        these->has_axis = 1;
    }
    if (lie_behind_each_other(these, these->has_axis ? 10 : 7))
        return (these->has_axis ? hypcheck_ask_tilted : hypcheck_ask)(question, (size_t)these->count, rows, answers);
    return rows_by_columns(these, question, answers);
}

static size_t decided(taken *these, order *call, int8_t *answers) {
    return call->is_scene ? scene_answers(these, call, answers, NULL) : row_answers(these, call->question, answers);
}

/* Fills `out`, or nothing of it. Returns the number of invalid rows. Until all rows are known to be valid their answers are
   kept elsewhere; positions of a scene as bits, for there to write and read a byte a row would take a tenth of the time. */
static size_t filled_whole(taken *these, order *call) {
    const size_t count = (size_t)these->count;
    const int bits = call->is_scene && count > FEW && call->question == HYPCHECK_POSITION && !call->marked;
    int8_t few[FEW], *const out = (int8_t *)these->out.buf;
    void *const kept = count <= FEW ? few : malloc(bits ? hc_blocks(count) * sizeof(hc_signs) : count);
    size_t refused;
    these->odd |= kept == NULL;
    if (kept == NULL) return 0;
    refused = bits ? scene_answers(these, call, NULL, kept) : decided(these, call, kept);
    if (!these->odd && bits && refused == 0) spread(kept, count, out);
    else if (!these->odd && !bits && (refused == 0 || call->marked)) memcpy(out, kept, count);
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

/* The answers of a call whose arguments are taken: `out`, a new array, or None where Python has to answer. */
static PyObject *answered(taken *these, order *call) {
    PyObject *answers = call->out == Py_None ? new_answers(these->count) : Py_NewRef(call->out);
    PyThreadState *state = NULL;
    size_t refused;
    if (answers == NULL) return NULL;
    if (!take_out(these, answers)) {
        Py_DECREF(answers);
        Py_RETURN_NONE;
    }
    if (these->count >= FREE_FROM) state = PyEval_SaveThread();
    refused = call->out == Py_None ? decided(these, call, (int8_t *)these->out.buf) : filled_whole(these, call);
    if (state != NULL) PyEval_RestoreThread(state);
    if (!these->odd && (refused == 0 || call->marked)) return answers;
    Py_DECREF(answers);
    Py_RETURN_NONE;
}

/* The answer about a single row, a number. */
static PyObject *one_answered(taken *these, order *call) {
    int8_t answer = 127;
    size_t refused;
    if (call->out != Py_None) Py_RETURN_NONE;
    refused = decided(these, call, &answer);
    if (these->odd || (refused && !call->marked)) Py_RETURN_NONE;
    return PyLong_FromLong(answer);
}

/* Answers a call whose arguments were taken, if they were, and gives them back. */
static PyObject *answered_or_given_back(taken *these, order *call, int took, int always_array) {
    const Py_ssize_t most = call->threads == Py_None ? for_one_thread : PY_SSIZE_T_MAX;
    PyObject *result;
    if (!took || these->count == 0 || these->count > most) result = Py_NewRef(Py_None);
    else if (these->arrays || always_array) result = answered(these, call);
    else result = one_answered(these, call);
    give_back(these);
    return result;
}

/* The functions in Python that take any call, of classify and of classify_scene. */
static PyObject *slow_calls[2] = {NULL, NULL};

static int named(PyObject *name, const char *text) { return PyUnicode_CompareWithASCIIString(name, text) == 0; }

/* What a call says by name; 0 where Python has to look at it. `out` may have been said by position. */
static int options_of(PyObject *const *values, PyObject *keywords, order *call) {
    static const char *const questions[4] = {"position", "exterior", "interior", "contact"};
    const Py_ssize_t count = keywords == NULL ? 0 : PyTuple_GET_SIZE(keywords);
    double threads;
    Py_ssize_t k;
    for (k = 0; k < count; k++) {
        PyObject *const name = PyTuple_GET_ITEM(keywords, k), *const value = values[k];
        if (named(name, "out") && call->out == Py_None) call->out = value;
        else if (named(name, "threads")) call->threads = value;
        else if (named(name, "axis")) call->axis = value;
        else if (named(name, "on_invalid") && PyUnicode_Check(value) && (named(value, "flag") || named(value, "raise"))) call->marked = named(value, "flag");
        else if (named(name, "question") && PyUnicode_Check(value)) {
            for (call->question = 0; call->question < 4 && !named(value, questions[call->question]); call->question++) {}
            if (call->question == 4) return 0;
        } else return 0;
    }
    return call->threads == Py_None || (PyLong_CheckExact(call->threads) && number_of(call->threads, &threads) && threads == 1);
}

static void nothing_said(order *call) {
    call->out = call->threads = call->axis = Py_None;
    call->question = HYPCHECK_POSITION;
    call->marked = call->prepared = call->is_scene = 0;
}

static PyObject *or_slowly(PyObject *answers, int which, PyObject *const *arguments, Py_ssize_t count, PyObject *keywords) {
    if (answers != Py_None || slow_calls[which] == NULL) return answers;
    Py_DECREF(answers);
    return PyObject_Vectorcall(slow_calls[which], arguments, (size_t)count, keywords);
}

/* The arguments by position: rows; sizes and points, or three columns; four sizes and either. */
static int take_arguments(taken *these, order *call, PyObject *const *arguments, Py_ssize_t count) {
    Py_ssize_t k;
    int width, took;
    if (count == 1) {
        width = take_table(these, arguments[0], these->columns, MOST_COLUMNS);
        these->has_axis = width == 10;
        return (width == 7 || width == 10) && call->axis == Py_None;
    }
    if (count == 2 || count == 4) {
        took = take_sizes(these, arguments[0], call) && take_center(these, arguments + 1, count - 1);
    } else {
        for (took = 1, k = 0; k < 4 && took; k++) took = take_column(these, arguments[k], these->columns + k);
        took = took && take_center(these, arguments + 4, count - 4);
    }
    return took && take_axis(these, call->axis) && note_scene(these, call);
}

static PyObject *py_classify(PyObject *self, PyObject *const *arguments, Py_ssize_t count, PyObject *keywords) {
    PyObject *answers = Py_NewRef(Py_None);
    order call;
    taken these;
    (void)self;
    nothing_said(&call);
    if ((count == 1 || count == 2 || count == 4 || count == 5 || count == 7) && options_of(arguments + count, keywords, &call)) {
        take_nothing(&these);
        Py_DECREF(answers);
        answers = answered_or_given_back(&these, &call, take_arguments(&these, &call, arguments, count), 0);
    }
    return or_slowly(answers, 0, arguments, count, keywords);
}

static PyObject *py_classify_scene(PyObject *self, PyObject *const *arguments, Py_ssize_t count, PyObject *keywords) {
    PyObject *answers = Py_NewRef(Py_None);
    order call;
    taken these;
    (void)self;
    nothing_said(&call);
    if (count == 5) call.out = arguments[4];
    if ((count == 2 || count == 4 || count == 5) && options_of(arguments + count, keywords, &call)) {
        take_nothing(&these);
        Py_DECREF(answers);
        answers = answered_or_given_back(&these, &call, take_arguments(&these, &call, arguments, count == 5 ? 4 : count), 1);
    }
    return or_slowly(answers, 1, arguments, count, keywords);
}

/* What a call cannot do without, for the benchmark: to take the arrays and give them back; and to be called at all. */
static PyObject *py_take(PyObject *self, PyObject *const *arguments, Py_ssize_t count) {
    taken these;
    int took;
    (void)self;
    if (count != 5) {
        PyErr_SetString(PyExc_TypeError, "five arguments are needed");
        return NULL;
    }
    take_nothing(&these);
    took = take_center(&these, arguments + 1, 3) && (arguments[4] == Py_None || take_out(&these, arguments[4]));
    if (!took) PyErr_SetString(PyExc_ValueError, "these are no ordinary arrays");
    give_back(&these);
    if (PyErr_Occurred()) return NULL;
    Py_RETURN_NONE;
}

static PyObject *py_nothing(PyObject *self, PyObject *const *arguments, Py_ssize_t count, PyObject *keywords) {
    (void)self, (void)arguments, (void)count, (void)keywords;
    Py_RETURN_NONE;
}

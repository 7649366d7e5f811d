/* Columns of numbers wherever they lie: numpy's arrays of any strides and of most types, lists, and single numbers, as
   doubles of the same values. Part of binding.c, which includes it once.

   What is not converted here, or not exactly, is left to Python: texts, masked arrays, integers beyond 2^53, and subnormal
   float32, of which a thread that flushes them would make 0. */

static PyObject *array_type = NULL; /* numpy.ndarray */

enum { FEW = 1024, PART = 128, FETCHED_AHEAD = 6144, MOST_COLUMNS = 10, MOST_SCALARS = 12 };

typedef struct {
    const char *at;    /* the first number */
    Py_ssize_t stride; /* bytes from one to the next */
    char format;       /* as Python's struct has it; 0: `number` stands for every row */
    double number;
} column;

/* numpy's scalars, once it is there: a number of that format lies behind the head of the object. */
static struct {
    PyTypeObject *type;
    char format;
} scalars[MOST_SCALARS];
static int scalar_count = 0;

static const int64_t exact_up_to = (int64_t)1 << 53;

#define GATHER(type, is_odd) \
    for (i = 0; i < count; i++) { \
        type value; \
        memcpy(&value, at + (Py_ssize_t)i * stride, sizeof value); \
        odd |= is_odd; \
        into[i] = (double)value; \
    } \
    return odd

/* Whether the bits of a float32 are those of a subnormal number. */
static int is_subnormal(uint32_t bits) { return (uint32_t)((bits << 1) - 1) < 0xffffffu; }

static int gathered_singles(const char *at, Py_ssize_t stride, size_t count, double *into) {
    int odd = 0;
    size_t i;
    for (i = 0; i < count; i++) {
        uint32_t bits;
        float value;
        memcpy(&bits, at + (Py_ssize_t)i * stride, sizeof bits);
        memcpy(&value, &bits, sizeof value);
        odd |= is_subnormal(bits);
        into[i] = (double)value;
    }
    return odd;
}

#if HC_X86
/* The same for numbers that lie side by side, eight at a time. */
__attribute__((target("avx2"))) static int gathered_singles_avx2(const char *at, size_t count, double *into) {
    const __m256i bias = _mm256_set1_epi32((int)0x80000001u), limit = _mm256_set1_epi32((int)0x80ffffffu);
    __m256i odd = _mm256_setzero_si256();
    size_t i;
    for (i = 0; i + 8 <= count; i += 8) {
        const __m256 values = _mm256_loadu_ps((const float *)(const void *)(at + 4 * i));
        const __m256i shifted = _mm256_slli_epi32(_mm256_castps_si256(values), 1);
        odd = _mm256_or_si256(odd, _mm256_cmpgt_epi32(limit, _mm256_sub_epi32(shifted, bias))); /* signed < for unsigned */
        _mm256_storeu_pd(into + i, _mm256_cvtps_pd(_mm256_castps256_ps128(values)));
        _mm256_storeu_pd(into + i + 4, _mm256_cvtps_pd(_mm256_extractf128_ps(values, 1)));
    }
    return (_mm256_testz_si256(odd, odd) == 0) | gathered_singles(at + 4 * i, 4, count - i, into + i);
}

__attribute__((target("avx2"))) static void gathered_doubles_avx2(const char *at, Py_ssize_t stride, size_t count, double *into) {
    size_t i;
    for (i = 0; i + 4 <= count; i += 4) {
        const char *const from = at + (Py_ssize_t)i * stride;
        const __m128d low = _mm_loadh_pd(_mm_load_sd((const double *)(const void *)from), (const double *)(const void *)(from + stride));
        const __m128d high = _mm_loadh_pd(_mm_load_sd((const double *)(const void *)(from + 2 * stride)), (const double *)(const void *)(from + 3 * stride));
        _mm256_storeu_pd(into + i, _mm256_insertf128_pd(_mm256_castpd128_pd256(low), high, 1));
    }
    for (; i < count; i++) memcpy(into + i, at + (Py_ssize_t)i * stride, sizeof *into);
}

/* Four points x, y, z, one behind the other, as three columns. */
__attribute__((target("avx2"))) static inline void four_points(const double *from, double *x, double *y, double *z) {
    const __m256d a = _mm256_loadu_pd(from), b = _mm256_loadu_pd(from + 4), c = _mm256_loadu_pd(from + 8);
    const __m256d xs = _mm256_blend_pd(_mm256_blend_pd(a, b, 4), c, 2), ys = _mm256_blend_pd(_mm256_blend_pd(b, a, 2), c, 4);
    const __m256d zs = _mm256_blend_pd(_mm256_blend_pd(c, a, 4), b, 2);
    _mm256_storeu_pd(x, _mm256_permute4x64_pd(xs, 0x6c)); /* x0 x3 x2 x1 */
    _mm256_storeu_pd(y, _mm256_permute4x64_pd(ys, 0xb1)); /* y1 y0 y3 y2 */
    _mm256_storeu_pd(z, _mm256_permute4x64_pd(zs, 0xc6)); /* z2 z1 z0 z3 */
}

__attribute__((target("avx2"))) static void gathered_points_avx2(const char *at, size_t count, double *x, double *y, double *z) {
    size_t i;
    for (i = 0; i + 8 <= count; i += 8) {
        const double *const from = (const double *)(const void *)(at + 24 * i);
        int line;
        for (line = 0; line < 3; line++) __builtin_prefetch((const char *)from + FETCHED_AHEAD + 64 * line);
        four_points(from, x + i, y + i, z + i);
        four_points(from + 12, x + i + 4, y + i + 4, z + i + 4);
    }
    for (; i < count; i++) {
        memcpy(x + i, at + 24 * i, sizeof *x);
        memcpy(y + i, at + 24 * i + 8, sizeof *y);
        memcpy(z + i, at + 24 * i + 16, sizeof *z);
    }
}
#endif

static int has_avx2(void) { return HC_X86 && hc_level() - hc_levels >= 2; }

/* Numbers `start` to `start` + `count` of a column. Returns whether one was not converted exactly. */
static int gathered(const column *from, size_t start, size_t count, double *into) {
    const Py_ssize_t stride = from->stride;
    const char *const at = from->format ? from->at + (Py_ssize_t)start * stride : NULL;
    int odd = 0;
    size_t i;
    switch (from->format) {
    case 0:
        for (i = 0; i < count; i++) into[i] = from->number;
        return 0;
    case 'd':
        if (stride == (Py_ssize_t)sizeof(double)) return memcpy(into, at, count * sizeof *into), 0;
#if HC_X86
        if (has_avx2()) return gathered_doubles_avx2(at, stride, count, into), 0;
#endif
        GATHER(double, 0);
    case 'f':
#if HC_X86
        if (has_avx2() && stride == (Py_ssize_t)sizeof(float)) return gathered_singles_avx2(at, count, into);
#endif
        return gathered_singles(at, stride, count, into);
    case 'b': GATHER(signed char, 0);
    case 'B': GATHER(unsigned char, 0);
    case 'h': GATHER(short, 0);
    case 'H': GATHER(unsigned short, 0);
    case 'i': GATHER(int, 0);
    case 'I': GATHER(unsigned, 0);
    case 'l': GATHER(long, (value > exact_up_to) | (value < -exact_up_to));
    case 'L': GATHER(unsigned long, value > (uint64_t)exact_up_to);
    case 'q': GATHER(long long, (value > exact_up_to) | (value < -exact_up_to));
    case 'Q': GATHER(unsigned long long, value > (uint64_t)exact_up_to);
    default: return 1;
    }
}

static int gathered_center(const column center[3], size_t start, size_t count, double *const into[3]) {
#if HC_X86
    const column *const x = center, *const y = center + 1, *const z = center + 2;
    if (has_avx2() && x->format == 'd' && y->format == 'd' && z->format == 'd' && x->stride == 24 && y->stride == 24 &&
        z->stride == 24 && y->at == x->at + 8 && z->at == x->at + 16)
        return gathered_points_avx2(x->at + 24 * start, count, into[0], into[1], into[2]), 0;
#endif
    return gathered(center, start, count, into[0]) | gathered(center + 1, start, count, into[1]) |
           gathered(center + 2, start, count, into[2]);
}

/* Whether C can read the column where it lies. */
static int lies_plain(const column *from) {
    return from->format == 'd' && from->stride == (Py_ssize_t)sizeof(double) && (uintptr_t)from->at % sizeof(double) == 0;
}

/* A number of Python or of numpy, or 0 for anything else: true and false are none. */
static int number_of(PyObject *object, double *number) {
    int k;
    if (PyFloat_Check(object)) {
        *number = PyFloat_AS_DOUBLE(object);
        return 1;
    }
    if (PyLong_Check(object) && !PyBool_Check(object)) {
        int beyond;
        const long long value = PyLong_AsLongLongAndOverflow(object, &beyond);
        *number = (double)value;
        return !beyond && value <= exact_up_to && value >= -exact_up_to;
    }
    for (k = 0; k < scalar_count; k++)
        if (Py_TYPE(object) == scalars[k].type) {
            const column one = {(const char *)object + sizeof(PyObject), 0, scalars[k].format, 0};
            return !gathered(&one, 0, 1, number);
        }
    return 0;
}

/* What a call lends: columns of sizes, of a centre, and perhaps of an axis, and where answers go. */
typedef struct {
    Py_buffer inputs[8], out;
    int held, has_out, has_axis, arrays; /* `arrays`: something stands for more than one row */
    column columns[MOST_COLUMNS];
    double axis[3]; /* of all rows, where there is no column of it */
    Py_ssize_t count;
    int odd; /* a number was not converted exactly, or memory is missing: Python has to answer */
    int used;
    double room[3 * FEW]; /* numbers of lists */
} taken;

static void take_nothing(taken *these) {
    these->held = these->has_out = these->has_axis = these->arrays = these->odd = these->used = 0;
    these->axis[0] = these->axis[1] = 0, these->axis[2] = 1;
    these->count = 1;
}

static void give_back(taken *these) {
    while (these->held) PyBuffer_Release(these->inputs + --these->held);
    if (these->has_out) PyBuffer_Release(&these->out);
    these->has_out = 0;
}

/* The format of one native number, or 0. What is not aligned has another letter before it. */
static char format_of(const Py_buffer *buffer) {
    const char *const format = buffer->format, *const letter = format[0] == '=' && strchr("df", format[1]) ? format + 1 : format;
    return letter[0] != '\0' && letter[1] == '\0' ? letter[0] : '\0';
}

/* The memory of an array of numpy; 0 for anything else. It is given back with the others. */
static Py_buffer *lent(taken *these, PyObject *object) {
    Py_buffer *const buffer = these->inputs + these->held;
    if ((PyObject *)Py_TYPE(object) != array_type || these->held == 8) return NULL;
    if (PyObject_GetBuffer(object, buffer, PyBUF_STRIDES | PyBUF_FORMAT) != 0) {
        PyErr_Clear();
        return NULL;
    }
    these->held++;
    return format_of(buffer) ? buffer : NULL;
}

/* Notes that something stands for so many rows; 0 where something else stands for another number. */
static int of_rows(taken *these, Py_ssize_t count) {
    const int fits = !these->arrays || these->count == count;
    these->arrays = 1;
    these->count = count;
    return fits;
}

static int is_list(PyObject *object) { return PyList_CheckExact(object) || PyTuple_CheckExact(object); }

static int take_number(PyObject *object, column *into) {
    into->format = 0;
    return number_of(object, &into->number);
}

static int take_number_at(column *from) {
    const int odd = gathered(from, 0, 1, &from->number);
    from->format = 0;
    return !odd;
}

/* Numbers of a list into the room, from `step` to `step`; 0 where there is no room, or one is none. */
static int take_list(taken *these, PyObject *list, column *into) {
    const Py_ssize_t count = PySequence_Fast_GET_SIZE(list);
    Py_ssize_t i;
    double *const room = these->room + these->used;
    if (these->used + count > 3 * FEW) return 0;
    for (i = 0; i < count; i++)
        if (!number_of(PySequence_Fast_GET_ITEM(list, i), room + i)) return 0;
    these->used += (int)count;
    into->at = (const char *)room;
    into->stride = sizeof *room;
    into->format = 'd';
    return 1;
}

/* A number, an array (n,) or a list of n numbers. */
static int take_column(taken *these, PyObject *object, column *into) {
    Py_buffer *buffer;
    if (take_number(object, into)) return 1;
    if (is_list(object)) return take_list(these, object, into) && of_rows(these, PySequence_Fast_GET_SIZE(object));
    if ((buffer = lent(these, object)) == NULL || buffer->ndim > 1) return 0;
    into->at = buffer->buf;
    into->stride = buffer->ndim ? buffer->strides[0] : 0;
    into->format = format_of(buffer);
    return buffer->ndim ? of_rows(these, buffer->shape[0]) : take_number_at(into);
}

/* The rows of a list of lists, all as long as the first. */
static int take_lists(taken *these, PyObject *lists, column *into, int most) {
    const Py_ssize_t count = PySequence_Fast_GET_SIZE(lists);
    column row = {NULL, 0, 0, 0};
    Py_ssize_t i;
    int width = 0, k;
    for (i = 0; i < count; i++) {
        PyObject *const list = PySequence_Fast_GET_ITEM(lists, i);
        if (!is_list(list) || (i > 0 && PySequence_Fast_GET_SIZE(list) != width)) return 0;
        if (PySequence_Fast_GET_SIZE(list) > most) return 0;
        width = (int)PySequence_Fast_GET_SIZE(list);
        if (!take_list(these, list, &row)) return 0;
        for (k = 0; i == 0 && k < width; k++) into[k] = row, into[k].at = row.at + k * (Py_ssize_t)sizeof(double);
    }
    for (k = 0; k < width; k++) into[k].stride = width * (Py_ssize_t)sizeof(double);
    return of_rows(these, count) ? width : 0;
}

/* An array (n, w), or one row (w,), as w columns; also as lists. Returns w; 0 for anything else, and for more than `most`. */
static int take_table(taken *these, PyObject *object, column *into, int most) {
    Py_buffer *buffer;
    int width, k;
    if (is_list(object)) {
        const Py_ssize_t length = PySequence_Fast_GET_SIZE(object);
        if (length == 0) return 0;
        if (is_list(PySequence_Fast_GET_ITEM(object, 0))) return take_lists(these, object, into, most);
        for (k = 0; k < length && length <= most; k++)
            if (!take_number(PySequence_Fast_GET_ITEM(object, k), into + k)) return 0;
        return length <= most ? (int)length : 0;
    }
    if ((buffer = lent(these, object)) == NULL || buffer->ndim < 1 || buffer->ndim > 2) return 0;
    if (buffer->shape[buffer->ndim - 1] > most) return 0;
    width = (int)buffer->shape[buffer->ndim - 1];
    for (k = 0; k < width; k++) {
        into[k].at = (const char *)buffer->buf + k * buffer->strides[buffer->ndim - 1];
        into[k].stride = buffer->ndim == 2 ? buffer->strides[0] : 0;
        into[k].format = format_of(buffer);
        if (buffer->ndim == 1 && !take_number_at(into + k)) return 0;
    }
    return buffer->ndim == 1 || of_rows(these, buffer->shape[0]) ? width : 0;
}

/* None, which is upright, three numbers, or an array (n, 3): an axis for each row. */
static int take_axis(taken *these, PyObject *axis) {
    int k;
    if (axis == Py_None) return 1;
    if (take_table(these, axis, these->columns + 7, 3) != 3) return 0;
    these->has_axis = these->columns[7].format != 0;
    for (k = 0; k < 3; k++) these->axis[k] = these->columns[7 + k].number; /* where there are no columns */
    return 1;
}

/* hypcheck.implementations._calls: what the worker needs of C to call a library and to see what the call left behind.

   It knows nothing of the question: code under test that finds it in its process learns no answer from it. */

#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include <signal.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>
#if defined(__x86_64__) || defined(__i386__)
#include <xmmintrin.h>
#endif

typedef void (*classifier)(size_t, const double *, int8_t *);

static void nothing(size_t n, const double *rows, int8_t *answers) { (void)n, (void)rows, (void)answers; }

/* Calls the function at an address about one row at a time. Through ctypes a call takes ten times as long as the work of
   many a library, and wanders by more than that; here it takes a nanosecond. */
static PyObject *py_each(PyObject *self, PyObject *arguments) {
    unsigned long long address, rows, answers;
    Py_ssize_t width, n, repeat;
    (void)self;
    if (!PyArg_ParseTuple(arguments, "KKnKnn", &address, &rows, &width, &answers, &n, &repeat)) return NULL;
    classifier volatile function = address == 0 ? nothing : (classifier)(uintptr_t)address;
    Py_BEGIN_ALLOW_THREADS
    for (Py_ssize_t turn = 0; turn < repeat; turn++)
        for (Py_ssize_t k = 0; k < n; k++)
            function(1, (const double *)(uintptr_t)rows + width * k, (int8_t *)(uintptr_t)answers + k);
    Py_END_ALLOW_THREADS
    Py_RETURN_NONE;
}

/* The control words of floating point: of SSE and of the x87 unit, or FPCR and 0; 0 and 0 where they are not known. */
static PyObject *py_control(PyObject *self, PyObject *unused) {
    unsigned long long first = 0;
    unsigned short second = 0;
    (void)self, (void)unused;
#if defined(__x86_64__) || defined(__i386__)
    first = _mm_getcsr() & 0xFFC0; /* the rest are flags of what happened */
    __asm__ volatile("fnstcw %0" : "=m"(second));
#elif defined(__aarch64__)
    __asm__ volatile("mrs %0, fpcr" : "=r"(first));
#endif
    return Py_BuildValue("KH", first, second);
}

static PyObject *py_set_control(PyObject *self, PyObject *arguments) {
    unsigned long long first;
    unsigned short second;
    (void)self;
    if (!PyArg_ParseTuple(arguments, "KH", &first, &second)) return NULL;
#if defined(__x86_64__) || defined(__i386__)
    _mm_setcsr((unsigned)first); /* and no flag is left that would raise an exception */
    __asm__ volatile("fnclex; fldcw %0" : : "m"(second));
#elif defined(__aarch64__)
    __asm__ volatile("msr fpcr, %0" : : "r"(first));
#endif
    Py_RETURN_NONE;
}

#ifndef NSIG
#define NSIG 32
#endif

/* The address of the handler of each signal. */
static PyObject *py_handlers(PyObject *self, PyObject *unused) {
    uintptr_t handlers[NSIG] = {0};
    (void)self, (void)unused;
#ifndef _WIN32
    for (int number = 1; number < NSIG; number++) {
        struct sigaction found;
        if (sigaction(number, NULL, &found) != 0) continue;
        handlers[number] = found.sa_flags & SA_SIGINFO ? (uintptr_t)found.sa_sigaction : (uintptr_t)found.sa_handler;
    }
#endif
    return PyBytes_FromStringAndSize((const char *)handlers, sizeof handlers);
}

#ifndef _WIN32
enum { MOST = 1024, WIDTH = 96 };
static struct {
    uintptr_t start, end;
    char text[WIDTH];
} watched[MOST];
static int watched_count;
static struct sigaction before_segv, before_bus;

/* Say in which memory the fault is, and let the handler that was there before have it. */
static void name_fault(int number, siginfo_t *fault, void *context) {
    const uintptr_t place = (uintptr_t)fault->si_addr;
    (void)context;
    for (int i = watched_count - 1; i >= 0; i--) { /* the last one first: memory that was given back may be used again */
        if (place < watched[i].start || place >= watched[i].end) continue;
        if (write(2, watched[i].text, strnlen(watched[i].text, WIDTH)) < 0) break;
        break;
    }
    sigaction(number, number == SIGSEGV ? &before_segv : &before_bus, NULL);
}
#endif

/* watch(start, end, text): a fault in that memory is reported on standard error. */
static PyObject *py_watch(PyObject *self, PyObject *arguments) {
    unsigned long long start, end;
    const char *text;
    (void)self;
    if (!PyArg_ParseTuple(arguments, "KKs", &start, &end, &text)) return NULL;
#ifndef _WIN32
    if (watched_count == 0) {
        struct sigaction named = {.sa_sigaction = name_fault, .sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER};
        sigaction(SIGSEGV, &named, &before_segv);
        sigaction(SIGBUS, &named, &before_bus);
    }
    int place = 0;
    while (place < watched_count && watched[place].start != start) place++;
    if (place < MOST) {
        watched[place].start = (uintptr_t)start;
        watched[place].end = (uintptr_t)end;
        PyOS_snprintf(watched[place].text, WIDTH, "%s\n", text);
        if (place == watched_count) watched_count++;
    }
#endif
    Py_RETURN_NONE;
}

static PyMethodDef functions[] = {
    {"each", py_each, METH_VARARGS, "each(address, rows, width, answers, n, repeat): a call a row; address 0 does nothing"},
    {"control", py_control, METH_NOARGS, "control() -> the two control words of floating point"},
    {"set_control", py_set_control, METH_VARARGS, "set_control(first, second)"},
    {"handlers", py_handlers, METH_NOARGS, "handlers() -> the addresses of all signal handlers"},
    {"watch", py_watch, METH_VARARGS, "watch(start, end, text): say so where a fault is in that memory"},
    {NULL, NULL, 0, NULL},
};

static struct PyModuleDef module = {
    PyModuleDef_HEAD_INIT, "_calls", "Calls of a library, and what they leave behind.", 0, functions, NULL, NULL, NULL, NULL,
};

PyMODINIT_FUNC PyInit__calls(void) { return PyModuleDef_Init(&module); }

/* Whether two arrays share memory, by where they begin and end: what interleaves counts as shared. */
#include "sinew_module.h"

typedef struct {
  uintptr_t begin, end;
} Extent;

static int read_extent(PyObject* array, Extent* extent) {
  Py_buffer buffer;
  if (PyObject_GetBuffer(array, &buffer, PyBUF_STRIDES) < 0) return -1;
  *extent = (Extent){(uintptr_t)buffer.buf, (uintptr_t)buffer.buf + (uintptr_t)buffer.itemsize};
  for (int i = 0; i < buffer.ndim; ++i) {
    const Py_ssize_t last = (buffer.shape[i] - 1) * buffer.strides[i];
    if (buffer.shape[i] == 0) extent->end = extent->begin; /* of nothing */
    if (buffer.shape[i] == 0) break;
    *(last < 0 ? &extent->begin : &extent->end) += (uintptr_t)last;
  }
  PyBuffer_Release(&buffer);
  return 0;
}

PyObject* arrays_overlap(PyObject* module, PyObject* const* args, Py_ssize_t count) {
  (void)module;
  Extent a, b;
  if (count != 2) return PyErr_Format(PyExc_TypeError, "overlap(a, b)");
  if (read_extent(args[0], &a) < 0 || read_extent(args[1], &b) < 0) return NULL;
  return PyBool_FromLong(a.begin < a.end && b.begin < b.end && a.begin < b.end && b.begin < a.end);
}

/* A prepared question put to one row of numbers, and what it answers: numbers, read when they are asked for.
 */
#include <string.h>

#include "sinew_module.h"

PyTypeObject* row_type;
static PyObject* to_array; /* a list of numbers as users want it */

/* Of numbers as most have them. 0, or 1 where `value` is none, or columns: Python looks at it then. */
static int read_number(PyObject* value, double* number) {
  if (PyFloat_Check(value)) {
    *number = PyFloat_AsDouble(value);
    return 0;
  }
  if (!PyLong_Check(value) || PyBool_Check(value)) return 1;
  *number = PyLong_AsDouble(value);
  if (!PyErr_Occurred()) return 0;
  PyErr_Clear();
  return 1;
}

static int read_list(PyObject* list, const Py_ssize_t* shape, Py_ssize_t rank, double* numbers) {
  if (rank == 0) return read_number(list, numbers);
  const int is_list = PyList_Check(list);
  if (!is_list && !PyTuple_Check(list)) return 1;
  const Py_ssize_t size = shape[0], stride = rank > 1 ? shape[1] : 1;
  if ((is_list ? PyList_Size(list) : PyTuple_Size(list)) != size) return 1;
  for (Py_ssize_t i = 0; i < size; ++i) {
    PyObject* item = is_list ? PyList_GetItem(list, i) : PyTuple_GetItem(list, i);
    if (!item || read_list(item, shape + 1, rank - 1, numbers + i * stride) != 0) return 1;
  }
  return 0;
}

static int read_vector(PyObject* array, const Field* field, double* numbers) {
  Py_buffer buffer;
  if (field->rank != 1 || is_made_in_python(array) || !PyObject_CheckBuffer(array)) return 1;
  if (PyObject_GetBuffer(array, &buffer, PyBUF_STRIDES | PyBUF_FORMAT) < 0) {
    PyErr_Clear();
    return 1;
  }
  const int is_vector =
      buffer.ndim == 1 && buffer.shape[0] == field->count && buffer.format && strcmp(buffer.format, "d") == 0;
  for (Py_ssize_t i = 0; is_vector && i < field->count; ++i)
    memcpy(&numbers[i], (const char*)buffer.buf + i * buffer.strides[0], sizeof(double));
  PyBuffer_Release(&buffer);
  return !is_vector;
}

/* The numbers of one row from the arguments of a call. 1 where they are something else. */
static int read_row(const Question* self, PyObject* args, PyObject* keywords, double* numbers) {
  const Py_ssize_t places = PyTuple_Size(args), names = keywords ? PyDict_Size(keywords) : 0;
  if (places + names != self->inputs_count) return 1;
  for (Py_ssize_t i = 0; i < self->inputs_count; ++i) {
    const Field* field = &self->in[i];
    PyObject* value = i < places ? PyTuple_GetItem(args, i) : PyDict_GetItem(keywords, field->name);
    if (!value || (read_list(value, field->shape, field->rank, numbers) != 0 &&
                   read_vector(value, field, numbers) != 0))
      return 1;
    numbers += field->count;
  }
  return 0;
}

typedef struct {
  sinew_input* in;
  sinew_output* out;
} Places;

/* Where the row's numbers lie, field by field. */
static Places places_of(Row* row) {
  const Question* question = row->question;
  const size_t in = sizeof(sinew_input) * (size_t)(question->inputs_count + 1);
  char* memory = PyMem_Malloc(in + sizeof(sinew_output) * (size_t)(question->outputs_count + 1));
  Places places = {(sinew_input*)(void*)memory, (sinew_output*)(void*)(memory + in)};
  if (!memory) return (Places){NULL, NULL};
  double* numbers = row->numbers;
  for (Py_ssize_t i = 0; i < question->inputs_count; numbers += question->in[i++].count)
    places.in[i] = (sinew_input){numbers, 0, sizeof(double)};
  for (Py_ssize_t o = 0; o < question->outputs_count; numbers += question->out[o++].count)
    places.out[o] = (sinew_output){numbers, 0, sizeof(double)};
  return places;
}

enum { bad_input = 9 };

static int run_row(Question* self, Row* row) {
  const Places places = places_of(row);
  Kept* kept = places.in ? take_batch(self) : (Kept*)(void*)PyErr_NoMemory();
  for (int again = 1; kept && again && !PyErr_Occurred();) {
    Interrupt interrupt;
    char* error = NULL;
    uint8_t status = 255;
    int32_t code;
    begin_interruptible(&interrupt, kept->batch);
    Py_BEGIN_ALLOW_THREADS code = sinew_run(kept->batch, 1, places.in, places.out, &status, 1, &error);
    Py_END_ALLOW_THREADS again = end_interruptible(&interrupt) && PyErr_CheckSignals() == 0;
    row->status = status;
    if (PyErr_Occurred() || again) {
    } else if (code == SINEW_NO_MEMORY)
      PyErr_NoMemory();
    else if (code == SINEW_FAILED)
      PyErr_SetString(PyExc_RuntimeError, error ? error : "an error of the library");
    else if (code != SINEW_OK || status == bad_input)
      raise_text(error);
    sinew_free(error);
  }
  if (kept) kept->is_busy = 0;
  PyMem_Free(places.in);
  return PyErr_Occurred() ? -1 : 0;
}

static Row* new_row(Question* question) {
  PyTypeObject* type = (PyTypeObject*)question->row_type;
  Row* row = (Row*)((allocfunc)PyType_GetSlot(type, Py_tp_alloc))(
      type, question->in_numbers + question->out_numbers);
  if (row) row->question = (Question*)Py_NewRef((PyObject*)question);
  return row;
}

PyObject* call_question(PyObject* object, PyObject* args, PyObject* keywords) {
  Question* self = (Question*)object;
  Row* row = new_row(self);
  if (!row) return NULL;
  if (read_row(self, args, keywords, row->numbers) == 0) {
    if (run_row(self, row) == 0) return (PyObject*)row;
    Py_DECREF(row);
    return NULL;
  }
  Py_DECREF(row);
  PyObject* named = keywords ? Py_NewRef(keywords) : PyDict_New();
  PyObject* columns = named ? PyObject_CallMethod(object, "_columns", "OO", args, named) : NULL;
  Py_XDECREF(named);
  return columns;
}

static void free_row(PyObject* self) {
  PyTypeObject* type = Py_TYPE(self);
  Py_XDECREF((PyObject*)((Row*)self)->question);
  ((freefunc)PyType_GetSlot(type, Py_tp_free))(self);
  Py_DECREF(type);
}

static PyObject* list_of(const double* numbers, const Py_ssize_t* shape, Py_ssize_t rank) {
  if (rank == 0) return PyFloat_FromDouble(*numbers);
  const Py_ssize_t size = shape[0], stride = rank > 1 ? shape[1] : 1;
  PyObject* list = PyList_New(size);
  for (Py_ssize_t i = 0; list && i < size; ++i) {
    PyObject* item = list_of(numbers + i * stride, shape + 1, rank - 1);
    if (!item || PyList_SetItem(list, i, item) < 0) {
      Py_DECREF(list);
      return NULL;
    }
  }
  return list;
}

static PyObject* get_row(PyObject* object, PyObject* name) {
  Row* self = (Row*)object;
  PyObject* place = self->question ? PyDict_GetItemWithError(self->question->outputs, name) : NULL;
  if (!place) return PyErr_Occurred() ? NULL : PyObject_GenericGetAttr(object, name);
  const Py_ssize_t index = PyLong_AsSsize_t(place);
  const double* numbers = self->numbers + self->question->in_numbers;
  for (Py_ssize_t o = 0; o < index; ++o) numbers += self->question->out[o].count;
  PyObject* value = list_of(numbers, self->question->out[index].shape, self->question->out[index].rank);
  if (!value || self->question->out[index].rank == 0) return value;
  PyObject* array = PyObject_CallFunctionObjArgs(to_array, value, NULL);
  Py_DECREF(value);
  return array;
}

static PyObject* row_code(PyObject* self, void* nothing) {
  (void)nothing;
  return PyLong_FromLong(((Row*)self)->status);
}

static PyObject* row_ok(PyObject* self, void* nothing) {
  (void)nothing;
  return PyBool_FromLong(((Row*)self)->status == 7);
}

static PyObject* row_question(PyObject* self, void* nothing) {
  (void)nothing;
  PyObject* question = (PyObject*)((Row*)self)->question;
  return Py_NewRef(question ? question : Py_None);
}

/* What went in, by name, as lists. */
static PyObject* row_inputs(PyObject* object, PyObject* nothing) {
  (void)nothing;
  Row* self = (Row*)object;
  PyObject* all = PyDict_New();
  const double* numbers = self->numbers;
  for (Py_ssize_t i = 0; all && self->question && i < self->question->inputs_count; ++i) {
    const Field* field = &self->question->in[i];
    PyObject* value = list_of(numbers, field->shape, field->rank);
    if (!value || PyDict_SetItem(all, field->name, value) < 0) {
      Py_DECREF(all);
      all = NULL;
    }
    Py_XDECREF(value);
    numbers += field->count;
  }
  return all;
}

static size_t bytes_of(const Question* question) {
  return sizeof(double) * (size_t)(question->in_numbers + question->out_numbers);
}

/* Status and numbers, for another process. */
static PyObject* row_state(PyObject* object, PyObject* nothing) {
  (void)nothing;
  const Row* self = (Row*)object;
  PyObject* status = PyLong_FromLong(self->status);
  const size_t size = self->question ? bytes_of(self->question) : 0;
  PyObject* numbers = PyBytes_FromStringAndSize((const char*)self->numbers, (Py_ssize_t)size);
  PyObject* state = status && numbers ? PyTuple_Pack(2, status, numbers) : NULL;
  Py_XDECREF(status);
  Py_XDECREF(numbers);
  return state;
}

PyObject* restore_row(PyObject* object, PyObject* args) {
  Question* self = (Question*)object;
  int status;
  const char* numbers;
  Py_ssize_t size;
  if (!PyArg_ParseTuple(args, "iy#:_row", &status, &numbers, &size)) return NULL;
  if ((size_t)size != bytes_of(self)) return PyErr_Format(PyExc_ValueError, "a row of another question");
  Row* row = new_row(self);
  if (!row) return NULL;
  row->status = status;
  memcpy(row->numbers, numbers, (size_t)size);
  return (PyObject*)row;
}

int prepare_rows(void) {
  PyObject* arrays = PyImport_ImportModule("sinew._arrays");
  to_array = arrays ? PyObject_GetAttrString(arrays, "to_array") : NULL;
  Py_XDECREF(arrays);
  return to_array ? 0 : -1;
}

static PyMethodDef row_methods[] = {{"_inputs", row_inputs, METH_NOARGS, NULL},
                                    {"_state", row_state, METH_NOARGS, NULL},
                                    {NULL, NULL, 0, NULL}};
static PyGetSetDef row_fields[] = {{"ok", row_ok, NULL, "Whether the row is solved.", NULL},
                                   {"_code", row_code, NULL, NULL, NULL},
                                   {"_question", row_question, NULL, NULL, NULL},
                                   {NULL, NULL, NULL, NULL, NULL}};
static PyType_Slot row_slots[] = {{Py_tp_dealloc, free_row},
                                  {Py_tp_getattro, get_row},
                                  {Py_tp_methods, row_methods},
                                  {Py_tp_getset, row_fields},
                                  {0, NULL}};
PyType_Spec row_spec = {"sinew._sinew.Row", sizeof(Row), sizeof(double),
                        Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_DISALLOW_INSTANTIATION,
                        row_slots};

/* A question prepared for rows of numbers. Columns are read and written where they lie. */
#include <string.h>

#include "sinew_module.h"

PyTypeObject* question_type;

static sinew_batch* prepare(const Question* self) {
  char* text = NULL;
  Py_ssize_t size = 0;
  if (PyBytes_AsStringAndSize(self->text, &text, &size) < 0) return NULL;
  sinew_batch* batch = NULL;
  char* error = NULL;
  int32_t code;
  Py_BEGIN_ALLOW_THREADS code =
      sinew_prepare(((Handle*)self->handle)->robot, text, (size_t)size, &batch, &error);
  Py_END_ALLOW_THREADS if (code == SINEW_NO_MEMORY) PyErr_NoMemory();
  else if (code == SINEW_FAILED)
      PyErr_SetString(PyExc_RuntimeError, error ? error : "an error of the library");
  else if (code != SINEW_OK) raise_text(error);
  sinew_free(error);
  return batch;
}

/* One for this call alone, since a stop ends all that runs in a batch: as many are kept as calls that ran at
 * once. */
Kept* take_batch(Question* self) {
  Kept* kept = self->kept;
  while (kept && kept->is_busy) kept = kept->next;
  if (!kept) {
    kept = PyMem_Calloc(1, sizeof(Kept));
    if (!kept) return (Kept*)(void*)PyErr_NoMemory();
    kept->next = self->kept;
    self->kept = kept;
  }
  kept->is_busy = 1;
  if (!kept->batch && !(kept->batch = prepare(self))) kept->is_busy = 0;
  return kept->batch ? kept : NULL;
}

static int read_field(PyObject* item, Field* field) {
  PyObject* shape = PyDict_GetItemString(item, "shape");
  field->name = PyDict_GetItemString(item, "name"); /* borrowed until all is well */
  if (!field->name || !shape || !PyList_Check(shape) || PyList_Size(shape) > 2) {
    PyErr_SetString(PyExc_RuntimeError, "this library is another version than its Python module");
    return -1;
  }
  field->rank = PyList_Size(shape);
  field->count = 1;
  for (Py_ssize_t i = 0; i < field->rank; ++i) {
    field->shape[i] = PyLong_AsSsize_t(PyList_GetItem(shape, i));
    field->count *= field->shape[i];
  }
  if (PyErr_Occurred()) return -1;
  Py_INCREF(field->name);
  return 0;
}

static void free_fields(Field* fields) {
  for (Field* field = fields; field && field->name; ++field) Py_DECREF(field->name);
  PyMem_Free(fields);
}

/* The fields of a list of `layout`; ended by one without a name. */
static Field* read_fields(PyObject* layout, const char* key, Py_ssize_t* count, Py_ssize_t* numbers) {
  PyObject* list = PyDict_GetItemString(layout, key);
  *count = list ? PyList_Size(list) : -1;
  Field* fields = *count < 0 ? NULL : PyMem_Calloc((size_t)*count + 1, sizeof(Field));
  if (!fields && !PyErr_Occurred()) PyErr_NoMemory();
  for (Py_ssize_t i = 0; fields && i < *count; ++i) {
    if (read_field(PyList_GetItem(list, i), &fields[i]) < 0) {
      fields[i].name = NULL;
      free_fields(fields);
      return NULL;
    }
    *numbers += fields[i].count;
  }
  return fields;
}

static int read_layout(Question* self, sinew_batch* batch) {
  char* text = sinew_fields(batch);
  PyObject* json = text ? PyImport_ImportModule("json") : PyErr_NoMemory();
  self->layout = json ? PyObject_CallMethod(json, "loads", "s", text) : NULL;
  Py_XDECREF(json);
  sinew_free(text);
  self->outputs = self->layout ? PyDict_New() : NULL;
  if (!self->outputs) return -1;
  self->in = read_fields(self->layout, "inputs", &self->inputs_count, &self->in_numbers);
  self->out =
      self->in ? read_fields(self->layout, "outputs", &self->outputs_count, &self->out_numbers) : NULL;
  for (Py_ssize_t i = 0; self->out && i < self->outputs_count; ++i) {
    PyObject* index = PyLong_FromSsize_t(i);
    const int failed = !index || PyDict_SetItem(self->outputs, self->out[i].name, index) < 0;
    Py_XDECREF(index);
    if (failed) return -1;
  }
  return self->out ? 0 : -1;
}

/* Question(handle, query, fields, row_type): `fields` with "$name" where columns go. */
static PyObject* new_question(PyTypeObject* type, PyObject* args, PyObject* keywords) {
  PyObject *handle, *query, *fields, *rows;
  if (keywords && PyDict_Size(keywords) > 0)
    return PyErr_Format(PyExc_TypeError, "Question takes no keywords");
  if (!PyArg_ParseTuple(args, "O!OO!O!:Question", handle_type, &handle, &query, &PyDict_Type, &fields,
                        &PyType_Type, &rows))
    return NULL;
  if (!PyType_IsSubtype((PyTypeObject*)rows, row_type))
    return PyErr_Format(PyExc_TypeError, "rows are of type Row");
  Text text = {NULL, 0, 0};
  const int code = encode_question(&text, query, fields, NULL);
  PyObject* bytes = code == 0 ? PyBytes_FromStringAndSize(text.data, (Py_ssize_t)text.size) : NULL;
  free_text(&text);
  if (!bytes) return NULL;
  const allocfunc allocate = (allocfunc)PyType_GetSlot(type, Py_tp_alloc);
  Question* self = (Question*)allocate(type, 0);
  if (!self) {
    Py_DECREF(bytes);
    return NULL;
  }
  self->text = bytes;
  self->handle = Py_NewRef(handle);
  self->row_type = Py_NewRef(rows);
  Kept* first = take_batch(self);
  if (first) first->is_busy = 0;
  if (!first || read_layout(self, first->batch) < 0) {
    Py_DECREF(self);
    return NULL;
  }
  return (PyObject*)self;
}

static void free_question(PyObject* object) {
  Question* self = (Question*)object;
  PyTypeObject* type = Py_TYPE(object);
  for (Kept *kept = self->kept, *next; kept; kept = next) {
    next = kept->next;
    sinew_release(kept->batch);
    PyMem_Free(kept);
  }
  free_fields(self->in);
  free_fields(self->out);
  Py_XDECREF(self->handle);
  Py_XDECREF(self->text);
  Py_XDECREF(self->layout);
  Py_XDECREF(self->row_type);
  Py_XDECREF(self->outputs);
  ((freefunc)PyType_GetSlot(type, Py_tp_free))(object);
  Py_DECREF(type);
}

/* What a buffer lacks to be this field's column of so many rows; NULL where it is one. */
static const char* misfit(const Py_buffer* buffer, const Field* field, size_t rows) {
  const char* format = buffer->format ? buffer->format : "B";
  if (strchr("@=<", *format) && *format) ++format;
  if (strcmp(format, "d") != 0 || buffer->itemsize != sizeof(double))
    return "its numbers are no native doubles";
  if (buffer->ndim != field->rank + 1 || (size_t)buffer->shape[0] != rows) return "it has another shape";
  if ((uintptr_t)buffer->buf % sizeof(double) != 0) return "its numbers are not aligned";
  for (int i = 0; i < buffer->ndim; ++i) {
    if (i > 0 && buffer->shape[i] != field->shape[i - 1]) return "it has another shape";
    if (buffer->strides[i] % (Py_ssize_t)sizeof(double) != 0) return "its numbers are not aligned";
  }
  if (field->rank == 2 && buffer->strides[1] != buffer->shape[2] * buffer->strides[2])
    return "the numbers of a row are not evenly spaced";
  return NULL;
}

/* A column of the question: its buffer is to be released where this gives 0. -1 with an exception. */
static int read_column(PyObject* array, const Field* field, size_t rows, int flags, Py_buffer* buffer,
                       sinew_output* column) {
  if (PyObject_GetBuffer(array, buffer, flags) < 0) return -1;
  const char* lacks = misfit(buffer, field, rows);
  if (lacks) {
    PyBuffer_Release(buffer);
    raise_input_error("wrong_array", field->name, "%U: the array cannot be used where it lies: %s.",
                      field->name, lacks);
    return -1;
  }
  column->data = buffer->buf;
  column->stride = rows > 0 ? buffer->strides[0] : 0;
  column->step = field->rank > 0 ? buffer->strides[field->rank] : (ptrdiff_t)sizeof(double);
  return 0;
}

typedef struct {
  Py_buffer* buffers; /* of inputs, then of outputs; `columns` alike */
  sinew_output* columns;
  sinew_input* inputs;
  Py_ssize_t held;
  Py_buffer statuses;
  size_t rows;
} Columns;

static void release_columns(Columns* all) {
  for (Py_ssize_t i = 0; i < all->held; ++i) PyBuffer_Release(&all->buffers[i]);
  if (all->statuses.obj) PyBuffer_Release(&all->statuses);
  PyMem_Free(all->buffers);
  PyMem_Free(all->columns);
  PyMem_Free(all->inputs);
}

static int hold_list(Columns* all, PyObject* list, const Field* fields, Py_ssize_t count, int flags) {
  if (!PyList_Check(list) || PyList_Size(list) != count) {
    PyErr_Format(PyExc_TypeError, "a list of %zd arrays is needed", count);
    return -1;
  }
  for (Py_ssize_t i = 0; i < count; ++i, ++all->held)
    if (read_column(PyList_GetItem(list, i), &fields[i], all->rows, flags, &all->buffers[all->held],
                    &all->columns[all->held]) < 0)
      return -1;
  return 0;
}

static int hold_columns(Columns* all, const Question* self, PyObject* const* args) {
  const size_t count = (size_t)(self->inputs_count + self->outputs_count);
  all->buffers = PyMem_Calloc(count + 1, sizeof(Py_buffer));
  all->columns = PyMem_Calloc(count + 1, sizeof(sinew_output));
  all->inputs = PyMem_Calloc(count + 1, sizeof(sinew_input));
  if (!all->buffers || !all->columns || !all->inputs) {
    PyErr_NoMemory();
    return -1;
  }
  if (hold_list(all, args[1], self->in, self->inputs_count, PyBUF_STRIDES | PyBUF_FORMAT) < 0 ||
      hold_list(all, args[2], self->out, self->outputs_count, PyBUF_STRIDES | PyBUF_FORMAT | PyBUF_WRITABLE) <
          0 ||
      PyObject_GetBuffer(args[3], &all->statuses, PyBUF_WRITABLE) < 0)
    return -1;
  for (Py_ssize_t i = 0; i < self->inputs_count; ++i)
    all->inputs[i] = (sinew_input){all->columns[i].data, all->columns[i].stride, all->columns[i].step};
  if (all->statuses.len == (Py_ssize_t)all->rows) return 0;
  PyErr_SetString(PyExc_ValueError, "statuses are bytes, one a row");
  return -1;
}

/* run(rows, inputs, outputs, statuses, threads) -> what the library says of the rows, or None. */
static PyObject* question_run(PyObject* object, PyObject* const* args, Py_ssize_t count) {
  Question* self = (Question*)object;
  if (count != 5) return PyErr_Format(PyExc_TypeError, "run(rows, inputs, outputs, statuses, threads)");
  Columns all = {.rows = PyLong_AsSize_t(args[0])};
  const long threads = PyErr_Occurred() ? 0 : PyLong_AsLong(args[4]);
  Kept* kept = NULL;
  if (!PyErr_Occurred() && hold_columns(&all, self, args) == 0) kept = take_batch(self);
  PyObject* result = NULL;
  while (kept && !result && !PyErr_Occurred()) {
    Interrupt interrupt;
    char* error = NULL;
    int32_t code;
    begin_interruptible(&interrupt, kept->batch);
    Py_BEGIN_ALLOW_THREADS code =
        sinew_run(kept->batch, all.rows, all.inputs, all.columns + self->inputs_count, all.statuses.buf,
                  (int32_t)threads, &error);
    Py_END_ALLOW_THREADS const int again =
        end_interruptible(&interrupt) && PyErr_CheckSignals() == 0; /* the handler wants us to go on */
    if (PyErr_Occurred() || again) {
    } else if (code == SINEW_NO_MEMORY)
      PyErr_NoMemory();
    else if (code == SINEW_FAILED)
      PyErr_SetString(PyExc_RuntimeError, error ? error : "an error of the library");
    else if (code != SINEW_OK)
      raise_text(error);
    else
      result = error ? PyUnicode_FromString(error) : Py_NewRef(Py_None);
    sinew_free(error);
  }
  if (kept) kept->is_busy = 0;
  release_columns(&all);
  return result;
}

static PyObject* question_stop(PyObject* object, PyObject* nothing) {
  (void)nothing;
  Question* self = (Question*)object;
  for (const Kept* kept = self->kept; kept; kept = kept->next)
    if (kept->batch && kept->is_busy) sinew_stop(kept->batch);
  return Py_NewRef(Py_None);
}

static PyObject* question_layout(PyObject* self, void* nothing) {
  (void)nothing;
  return Py_NewRef(((Question*)self)->layout);
}

static PyMethodDef question_methods[] = {
    {"run", (PyCFunction)(void (*)(void))question_run, METH_FASTCALL,
     "run(rows, inputs, outputs, statuses, threads)"},
    {"_row", restore_row, METH_VARARGS, NULL},
    {"stop", question_stop, METH_NOARGS,
     "Ends what other threads compute by this question; rows not yet computed are `stopped`."},
    {NULL, NULL, 0, NULL}};
static PyGetSetDef question_fields[] = {
    {"layout", question_layout, NULL, "Columns that go in and come out.", NULL},
    {NULL, NULL, NULL, NULL, NULL}};
static PyType_Slot question_slots[] = {{Py_tp_new, new_question},       {Py_tp_dealloc, free_question},
                                       {Py_tp_call, call_question},     {Py_tp_methods, question_methods},
                                       {Py_tp_getset, question_fields}, {0, NULL}};
PyType_Spec question_spec = {"sinew._sinew.Question", sizeof(Question), 0,
                             Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE, question_slots};

/* Robots that are open, and sessions: what one thread asks with. */
#include <string.h>

#include "sinew_module.h"

PyTypeObject *handle_type, *session_type;

/* Text of UTF-8, str or bytes; borrowed from the object. NULL with an exception. */
static const char* utf8_of(PyObject* text, Py_ssize_t* size) {
  if (PyUnicode_Check(text)) return PyUnicode_AsUTF8AndSize(text, size);
  char* bytes = NULL;
  return PyBytes_AsStringAndSize(text, &bytes, size) < 0 ? NULL : bytes;
}

/* open(source, kind): kind 0 a file or a name, 1 a text. */
PyObject* open_robot(PyObject* module, PyObject* const* args, Py_ssize_t count) {
  (void)module;
  if (count != 2) return PyErr_Format(PyExc_TypeError, "open(source, kind)");
  const long kind = PyLong_AsLong(args[1]);
  if (kind == -1 && PyErr_Occurred()) return NULL;
  Py_ssize_t size = 0;
  const char* source = utf8_of(args[0], &size);
  if (!source) return NULL;
  if (kind == SINEW_FILE && memchr(source, '\0', (size_t)size))
    return raise_input_error("file_missing", args[0], "%R: a path has no zero bytes; check the path.",
                             args[0]);
  sinew_robot* robot = NULL;
  char* error = NULL;
  int32_t code;
  Py_BEGIN_ALLOW_THREADS code = sinew_open(source, (size_t)size, (int32_t)kind, &robot, &error);
  Py_END_ALLOW_THREADS if (code != SINEW_OK) {
    if (code == SINEW_NO_MEMORY)
      PyErr_NoMemory();
    else if (code == SINEW_FAILED)
      PyErr_SetString(PyExc_RuntimeError, error ? error : "an error of the library");
    else
      raise_text(error);
    sinew_free(error);
    return NULL;
  }
  Handle* handle = PyObject_New(Handle, handle_type);
  if (!handle)
    sinew_release(robot);
  else
    handle->robot = robot;
  return (PyObject*)handle;
}

static void free_handle(PyObject* self) {
  PyTypeObject* type = Py_TYPE(self);
  sinew_release(((Handle*)self)->robot);
  PyObject_Free(self);
  Py_DECREF(type);
}

typedef struct {
  PyObject_HEAD sinew_session* session;
  int is_busy;
} Session;

static PyObject* new_session(PyObject* self, PyObject* nothing) {
  (void)nothing;
  Session* session = PyObject_New(Session, session_type);
  if (!session) return NULL;
  session->is_busy = 0;
  session->session = sinew_session_new(((Handle*)self)->robot);
  if (session->session) return (PyObject*)session;
  Py_DECREF(session);
  return PyErr_NoMemory();
}

static void free_session(PyObject* self) {
  PyTypeObject* type = Py_TYPE(self);
  sinew_release(((Session*)self)->session);
  PyObject_Free(self);
  Py_DECREF(type);
}

/* The answer, of sinew_free; NULL with an exception. */
static char* answer_of(Session* self, const char* question, size_t size, size_t* length) {
  for (;;) {
    Interrupt interrupt;
    char* answer;
    self->is_busy = 1;
    begin_interruptible(&interrupt, self->session);
    Py_BEGIN_ALLOW_THREADS answer = sinew_ask(self->session, question, size, length);
    Py_END_ALLOW_THREADS const int is_interrupted = end_interruptible(&interrupt);
    self->is_busy = 0;
    if (!answer) PyErr_NoMemory();
    if (!answer || !is_interrupted) return answer;
    sinew_free(answer);
    if (PyErr_CheckSignals() < 0) return NULL; /* else the handler wants us to go on: once more */
  }
}

static PyObject* ask_bytes(Session* self, const char* question, size_t size) {
  size_t length = 0;
  char* answer = answer_of(self, question, size, &length);
  PyObject* text = answer ? PyUnicode_DecodeUTF8(answer, (Py_ssize_t)length, "replace") : NULL;
  sinew_free(answer);
  return text;
}

static int is_free(Session* self) {
  if (!self->is_busy) return 1;
  PyErr_SetString(PyExc_RuntimeError, "a session answers one question at a time: one a thread");
  return 0;
}

/* ask(query, fields, ranks) -> (question, answer), or None where an array of the fields holds columns. */
static PyObject* session_ask(PyObject* self, PyObject* const* args, Py_ssize_t count) {
  if (count != 3 || !PyDict_Check(args[1]) || !PyDict_Check(args[2]))
    return PyErr_Format(PyExc_TypeError, "ask(query, fields, ranks)");
  Text text = {NULL, 0, 0};
  const int code = encode_question(&text, args[0], args[1], args[2]);
  PyObject* both = NULL;
  if (code == 1) both = Py_NewRef(Py_None);
  if (code == 0 && is_free((Session*)self)) { /* looked at late: converting a field runs code of others */
    PyObject* answer = ask_bytes((Session*)self, text.data, text.size);
    PyObject* question = answer ? PyUnicode_DecodeUTF8(text.data, (Py_ssize_t)text.size, NULL) : NULL;
    both = question ? PyTuple_Pack(2, question, answer) : NULL;
    Py_XDECREF(question);
    Py_XDECREF(answer);
  }
  free_text(&text);
  return both;
}

static PyObject* session_ask_text(PyObject* self, PyObject* question) {
  Py_ssize_t size = 0;
  const char* bytes = utf8_of(question, &size);
  return bytes && is_free((Session*)self) ? ask_bytes((Session*)self, bytes, (size_t)size) : NULL;
}

static PyObject* session_stop(PyObject* self, PyObject* nothing) {
  (void)nothing;
  sinew_stop(((Session*)self)->session);
  return Py_NewRef(Py_None);
}

/* What is asked goes on: the library answers this at once, whichever thread asks. */
static PyObject* session_progress(PyObject* self, PyObject* nothing) {
  (void)nothing;
  static const char question[] = "{\"query\": \"progress\"}";
  size_t length = 0;
  char* answer;
  Py_BEGIN_ALLOW_THREADS answer =
      sinew_ask(((Session*)self)->session, question, sizeof question - 1, &length);
  Py_END_ALLOW_THREADS if (!answer) return PyErr_NoMemory();
  PyObject* text = PyUnicode_DecodeUTF8(answer, (Py_ssize_t)length, "replace");
  sinew_free(answer);
  return text;
}

static PyObject* session_is_busy(PyObject* self, void* nothing) {
  (void)nothing;
  return PyBool_FromLong(((Session*)self)->is_busy);
}

static PyMethodDef handle_methods[] = {{"session", new_session, METH_NOARGS, "A session to ask with."},
                                       {NULL, NULL, 0, NULL}};
static PyType_Slot handle_slots[] = {
    {Py_tp_dealloc, free_handle}, {Py_tp_methods, handle_methods}, {0, NULL}};
PyType_Spec handle_spec = {"sinew._sinew.Handle", sizeof(Handle), 0,
                           Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION, handle_slots};

static PyMethodDef session_methods[] = {
    {"ask", (PyCFunction)(void (*)(void))session_ask, METH_FASTCALL, "ask(query, fields, ranks)"},
    {"ask_text", session_ask_text, METH_O, "ask_text(question): both are JSON"},
    {"stop", session_stop, METH_NOARGS, "Stops what another thread asks."},
    {"progress", session_progress, METH_NOARGS, "How far what another thread asks is: JSON."},
    {NULL, NULL, 0, NULL}};
static PyGetSetDef session_fields[] = {{"is_busy", session_is_busy, NULL, NULL, NULL},
                                       {NULL, NULL, NULL, NULL, NULL}};
static PyType_Slot session_slots[] = {{Py_tp_dealloc, free_session},
                                      {Py_tp_methods, session_methods},
                                      {Py_tp_getset, session_fields},
                                      {0, NULL}};
PyType_Spec session_spec = {"sinew._sinew.Session", sizeof(Session), 0,
                            Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION, session_slots};

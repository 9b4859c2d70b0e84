/* Bad input becomes sinew.InputError, which Python defines: sinew/_errors.py. */
#include <stdarg.h>

#include "sinew_module.h"

static PyObject* input_error;    /* the class: InputError(message, code, where) */
static PyObject* input_error_of; /* makes one of a text of the library */

int prepare_errors(void) {
  PyObject* errors = PyImport_ImportModule("sinew._errors");
  if (!errors) return -1;
  input_error = PyObject_GetAttrString(errors, "InputError");
  input_error_of = PyObject_GetAttrString(errors, "from_text");
  Py_DECREF(errors);
  return input_error && input_error_of ? 0 : -1;
}

PyObject* raise_input_error(const char* code, PyObject* where, const char* format, ...) {
  va_list values;
  va_start(values, format);
  PyObject* message = PyUnicode_FromFormatV(format, values);
  va_end(values);
  PyObject* error = message ? PyObject_CallFunction(input_error, "OsO", message, code, where) : NULL;
  Py_XDECREF(message);
  if (error) PyErr_SetObject(input_error, error);
  Py_XDECREF(error);
  return NULL;
}

PyObject* raise_text(const char* text) {
  PyObject* error = PyObject_CallFunction(input_error_of, "s", text ? text : "not enough memory");
  if (error) PyErr_SetObject((PyObject*)Py_TYPE(error), error);
  Py_XDECREF(error);
  return NULL;
}

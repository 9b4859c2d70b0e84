/* What the files of the extension share. The extension holds the C interface for Python and no more: texts go
 * in and out, columns stay where they are. What answers mean is said in Python, sinew/answer.py and its
 * neighbours.
 *
 * Limited API of Python 3.11: one binary for every later Python. The extension is loaded by one interpreter.
 */
#ifndef SINEW_PYTHON_MODULE_H
#define SINEW_PYTHON_MODULE_H

#ifndef Py_LIMITED_API
#define Py_LIMITED_API 0x030B0000
#endif
#define PY_SSIZE_T_CLEAN
#include <Python.h>
#include <signal.h>
#include <stdint.h>

#include "sinew.h"

/* errors.c: exceptions of bad input, sinew.InputError. All set an exception and return NULL. */
int prepare_errors(void);
PyObject* raise_input_error(const char* code, PyObject* where, const char* format, ...);
PyObject* raise_text(const char* text); /* as the library wrote it: lines, or JSON */

/* encode.c: a question's fields as JSON. */
typedef struct Text {
  char* data;
  size_t size, room;
} Text;
/* 0, or -1 with an exception; 1 where an array has more dimensions than its field: it holds columns. `ranks`,
 * a dict of dimensions by name (1 where a name is not in it), may be NULL: then every array is one value. */
int encode_question(Text* text, PyObject* query, PyObject* fields, PyObject* ranks);
void free_text(Text* text);
/* Whether an object may have attributes of its own, such as a unit or a mask: its type was made in Python.
 * NumPy's arrays and numbers, memoryview and array.array are not such. */
int is_made_in_python(PyObject* value);

/* robot.c: a robot that is open, and sessions. */
typedef struct {
  PyObject_HEAD sinew_robot* robot;
} Handle;
extern PyType_Spec handle_spec, session_spec;
extern PyTypeObject *handle_type, *session_type;
PyObject* open_robot(PyObject* module, PyObject* const* args, Py_ssize_t count);

/* question.c: a prepared question; row.c: what it answers of one row. */
typedef struct {
  PyObject* name;
  Py_ssize_t rank, shape[2], count; /* count: numbers in a row */
} Field;
typedef struct Kept {
  sinew_batch* batch;
  int is_busy;
  struct Kept* next;
} Kept;
typedef struct {
  PyObject_HEAD PyObject *handle, *text, *layout, *row_type, *outputs; /* outputs: index by name */
  Kept* kept;
  Field *in, *out;
  Py_ssize_t inputs_count, outputs_count, in_numbers, out_numbers;
} Question;
typedef struct {
  PyObject_VAR_HEAD Question* question;
  int status;
  double numbers[]; /* what went in, what came out */
} Row;
extern PyType_Spec question_spec, row_spec;
extern PyTypeObject *question_type, *row_type;
Kept* take_batch(Question* question); /* busy then; NULL with an exception */
int prepare_rows(void);               /* row.c, as the next */
PyObject* call_question(PyObject* self, PyObject* args, PyObject* keywords);
PyObject* restore_row(PyObject* self, PyObject* args); /* of what Row._state gives */

/* overlap.c */
PyObject* arrays_overlap(PyObject* module, PyObject* const* args, Py_ssize_t count);

/* interrupt.c: Ctrl-C while the library computes. Without effect but in Python's main thread. */
typedef struct {
  int is_active;
  struct sigaction previous;
} Interrupt;
int prepare_interrupts(void);
void begin_interruptible(Interrupt* interrupt, void* session_or_batch);
int end_interruptible(Interrupt* interrupt); /* whether it was interrupted: then PyErr_CheckSignals */

#endif

/* A question's fields as JSON, from what Python's users have: numbers, texts, lists, dicts, arrays, answers.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sinew_module.h"

enum { deepest = 64 }; /* of the library, docs/protocol.md: too_deep */

/* Where a value stands: keys and indices from the outermost. */
typedef struct Place {
  const struct Place* outer;
  PyObject* key; /* NULL: an index */
  Py_ssize_t index;
  int depth;
} Place;

typedef struct {
  Text* text;
  PyObject* ranks;
} Encoder;

static int encode(Encoder* encoder, PyObject* value, const Place* place);

static int add(Text* text, const char* bytes, size_t size) {
  if (text->room - text->size < size) {
    const size_t room = 2 * text->room + size + 256;
    char* data = PyMem_Realloc(text->data, room);
    if (!data) {
      PyErr_NoMemory();
      return -1;
    }
    text->data = data;
    text->room = room;
  }
  memcpy(text->data + text->size, bytes, size);
  text->size += size;
  return 0;
}

void free_text(Text* text) {
  PyMem_Free(text->data);
  *text = (Text){NULL, 0, 0};
}

static PyObject* path_of(const Place* place) {
  if (!place) return PyUnicode_FromString("");
  PyObject* outer = path_of(place->outer);
  if (!outer) return NULL;
  const int is_first = PyUnicode_GetLength(outer) == 0;
  const int is_text = place->key && PyUnicode_Check(place->key) && PyUnicode_AsUTF8AndSize(place->key, NULL);
  PyErr_Clear();
  PyObject* path = !place->key ? PyUnicode_FromFormat("%U[%zd]", outer, place->index)
                   : is_text   ? PyUnicode_FromFormat(is_first ? "%U%U" : "%U.%U", outer, place->key)
                               : PyUnicode_FromFormat(is_first ? "%U%A" : "%U.%A", outer, place->key);
  Py_DECREF(outer);
  return path;
}

/* Sets InputError at this place; `sentence` has one %U for it, and may have a %s or %R. */
static int refuse(const Place* place, const char* code, const char* sentence, const void* value) {
  PyObject* path = path_of(place);
  if (path) raise_input_error(code, path, sentence, path, value);
  Py_XDECREF(path);
  return -1;
}

static int add_string(Text* text, PyObject* string, const Place* place) {
  Py_ssize_t size = 0;
  const char* bytes = PyUnicode_AsUTF8AndSize(string, &size);
  if (!bytes) {
    if (!PyErr_ExceptionMatches(PyExc_UnicodeError)) return -1;
    PyErr_Clear();
    return refuse(place, "not_utf8", "%U: %A has half of a surrogate pair; give text of whole characters.",
                  string);
  }
  if (add(text, "\"", 1) < 0) return -1;
  for (Py_ssize_t i = 0, begin = 0; i <= size; ++i) {
    const unsigned char c = i < size ? (unsigned char)bytes[i] : '"';
    if (c >= 0x20 && c != '"' && c != '\\') continue;
    if (add(text, bytes + begin, (size_t)(i - begin)) < 0) return -1;
    begin = i + 1;
    char escape[8];
    if (i < size && add(text, escape, (size_t)snprintf(escape, sizeof escape, "\\u%04x", c)) < 0) return -1;
  }
  return add(text, "\"", 1);
}

static int add_double(Text* text, double value, const Place* place) {
  if (isnan(value)) return refuse(place, "not_a_number", "%U is NaN; give a number.", NULL);
  if (isinf(value)) return refuse(place, "not_a_number", "%U is infinite; give a finite number.", NULL);
  char* digits = PyOS_double_to_string(value, 'r', 0, 0, NULL);
  if (!digits) return -1;
  const int added = add(text, digits, strlen(digits));
  PyMem_Free(digits);
  return added;
}

static int add_integer(Text* text, PyObject* value) {
  int overflow = 0;
  const long long number = PyLong_AsLongLongAndOverflow(value, &overflow);
  char digits[32];
  if (!overflow) return add(text, digits, (size_t)snprintf(digits, sizeof digits, "%lld", number));
  PyObject* string = PyObject_Str(value); /* the library says that it is too large */
  Py_ssize_t size = 0;
  const char* bytes = string ? PyUnicode_AsUTF8AndSize(string, &size) : NULL;
  const int added = bytes ? add(text, bytes, (size_t)size) : -1;
  Py_XDECREF(string);
  return added;
}

static int add_list(Encoder* encoder, PyObject* list, const Place* place) {
  PyObject* items = PySequence_List(list); /* a copy: what converts an item may change the list */
  if (!items || add(encoder->text, "[", 1) < 0) goto failed;
  for (Py_ssize_t i = 0; i < PyList_Size(items); ++i) {
    const Place here = {place, NULL, i, place->depth + 1};
    if (i > 0 && add(encoder->text, ",", 1) < 0) goto failed;
    const int code = encode(encoder, PyList_GetItem(items, i), &here);
    if (code == 0) continue;
    Py_DECREF(items);
    return code;
  }
  Py_DECREF(items);
  return add(encoder->text, "]", 1);
failed:
  Py_XDECREF(items);
  return -1;
}

/* `from_` is `from`: keywords of Python take an underscore behind them. */
static int add_key(Text* text, PyObject* key, const Place* place) {
  if (!PyUnicode_Check(key)) return refuse(place, "wrong_type", "%U: the name %R is no text.", key);
  if (add_string(text, key, place) < 0) return -1;
  if (!place->outer && text->data[text->size - 2] == '_') {
    text->size -= 2;
    return add(text, "\":", 2);
  }
  return add(text, ":", 1);
}

static int add_members(Encoder* encoder, PyObject* dict, const Place* outer, int depth, int is_first) {
  PyObject* items = PyDict_Items(dict);
  if (!items) return -1;
  int code = 0;
  for (Py_ssize_t i = 0; code == 0 && i < PyList_Size(items); ++i) {
    PyObject* key = PyTuple_GetItem(PyList_GetItem(items, i), 0);
    PyObject* value = PyTuple_GetItem(PyList_GetItem(items, i), 1);
    const Place here = {outer, key, 0, depth + 1};
    if (value == Py_None && !outer) continue; /* a keyword that was not given */
    if (!is_first) code = add(encoder->text, ",", 1);
    is_first = 0;
    if (code == 0) code = add_key(encoder->text, key, &here);
    if (code == 0) code = encode(encoder, value, &here);
  }
  Py_DECREF(items);
  return code;
}

static int add_dict(Encoder* encoder, PyObject* dict, const Place* place) {
  if (add(encoder->text, "{", 1) < 0) return -1;
  const int code = add_members(encoder, dict, place, place->depth, 1);
  return code ? code : add(encoder->text, "}", 1);
}

/* How many dimensions the field at this place has. */
static long rank_at(const Encoder* encoder, const Place* place) {
  while (place && !place->key) place = place->outer;
  PyObject* rank = place ? PyDict_GetItem(encoder->ranks, place->key) : NULL; /* borrowed; NULL: not there */
  return rank ? PyLong_AsLong(rank) : 1;
}

static int refuse_type(PyObject* value, const Place* place) {
  PyErr_Clear();
  PyObject* name = PyType_GetName(Py_TYPE(value));
  if (name)
    refuse(place, "wrong_type", "%U is of type %U; give numbers, texts, lists, dicts or arrays.", name);
  Py_XDECREF(name);
  return -1;
}

int is_made_in_python(PyObject* value) {
  return !(PyType_GetFlags(Py_TYPE(value)) & Py_TPFLAGS_IMMUTABLETYPE);
}

static int has(PyObject* value, const char* name) {
  PyObject* found = PyObject_GetAttrString(value, name);
  PyErr_Clear();
  Py_XDECREF(found);
  return found != NULL;
}

static int has_unit(PyObject* value) {
  return is_made_in_python(value) && (has(value, "units") || has(value, "unit")) && !has(value, "to_dict");
}

/* A number of a type that has no lists, such as NumPy's long double; NULL of a complex one. */
static PyObject* to_float(PyObject* number) {
  PyObject* imaginary = PyObject_GetAttrString(number, "imag");
  PyErr_Clear();
  const int is_complex = imaginary && PyObject_IsTrue(imaginary) != 0;
  Py_XDECREF(imaginary);
  PyObject* found = is_complex || !PyNumber_Check(number) ? NULL : PyNumber_Float(number);
  if (!found && PyErr_Occurred() && PyErr_ExceptionMatches(PyExc_TypeError)) PyErr_Clear();
  return found;
}

/* Arrays, NumPy's numbers, answers: what gives lists, dicts and numbers by a method. */
static int add_converted(Encoder* encoder, PyObject* value, const Place* place) {
  PyObject* plain = NULL;
  PyObject* dimensions = encoder->ranks ? PyObject_GetAttrString(value, "ndim") : NULL;
  if (dimensions && PyLong_Check(dimensions) && PyLong_AsLong(dimensions) > rank_at(encoder, place)) {
    Py_DECREF(dimensions);
    return 1;
  }
  Py_XDECREF(dimensions);
  PyErr_Clear();
  if (has_unit(value))
    return refuse(place, "wrong_array",
                  "%U has a unit of its own, which would be lost: convert it to SI and leave the unit out.",
                  NULL);
  for (const char* const* name = (const char* const[]){"tolist", "to_dict", NULL}; *name && !plain; ++name) {
    PyObject* method = PyObject_GetAttrString(value, *name);
    PyErr_Clear();
    plain = method ? PyObject_CallNoArgs(method) : NULL;
    Py_XDECREF(method);
    if (method && !plain) return -1;
  }
  if (!plain && PySequence_Check(value) && !PyBytes_Check(value)) plain = PySequence_List(value);
  if (plain && Py_TYPE(plain) == Py_TYPE(value)) {
    Py_DECREF(plain);
    plain = NULL;
  }
  if (!plain && !PyErr_Occurred()) plain = to_float(value);
  if (!plain)
    return PyErr_Occurred() && !PyErr_ExceptionMatches(PyExc_TypeError) ? -1 : refuse_type(value, place);
  const Place here = {place->outer, place->key, place->index, place->depth + 1};
  const int code = encode(encoder, plain, &here);
  Py_DECREF(plain);
  return code;
}

static int encode(Encoder* encoder, PyObject* value, const Place* place) {
  Text* text = encoder->text;
  if (PyFloat_Check(value)) return add_double(text, PyFloat_AsDouble(value), place);
  if (PyUnicode_Check(value)) return add_string(text, value, place);
  if (value == Py_None) return add(text, "null", 4);
  if (value == Py_True) return add(text, "true", 4);
  if (value == Py_False) return add(text, "false", 5);
  if (PyLong_Check(value)) return add_integer(text, value);
  if (place->depth > deepest)
    return refuse(NULL, "too_deep", "query%U: more than 64 levels of lists and dicts.", NULL);
  if (PyList_Check(value) || PyTuple_Check(value)) return add_list(encoder, value, place);
  if (PyDict_Check(value)) return add_dict(encoder, value, place);
  return add_converted(encoder, value, place);
}

int encode_question(Text* text, PyObject* query, PyObject* fields, PyObject* ranks) {
  Encoder encoder = {text, ranks};
  PyObject* name = PyUnicode_FromString("query");
  const Place place = {NULL, name, 0, 1};
  int code = !name || add(text, "{\"query\":", 9) < 0 ? -1 : encode(&encoder, query, &place);
  Py_XDECREF(name);
  if (code == 0) code = add_members(&encoder, fields, NULL, 0, 0);
  return code ? code : add(text, "}", 1);
}

/* sinew._sinew: what of the module is C. */
#include "sinew_module.h"

static PyObject* module_abi(PyObject* module, PyObject* nothing) {
  (void)module, (void)nothing;
  return PyLong_FromLong(sinew_abi());
}

static PyMethodDef functions[] = {
    {"open", (PyCFunction)(void (*)(void))open_robot, METH_FASTCALL,
     "open(source, kind): 0 a file or a name, 1 a text"},
    {"overlap", (PyCFunction)(void (*)(void))arrays_overlap, METH_FASTCALL,
     "overlap(a, b): whether the memory of one begins before that of the other ends"},
    {"abi", module_abi, METH_NOARGS, "Number of the C interface of the library."},
    {NULL, NULL, 0, NULL}};

static struct PyModuleDef definition = {.m_base = PyModuleDef_HEAD_INIT,
                                        .m_name = "sinew._sinew",
                                        .m_doc = "The C interface of sinew.",
                                        .m_size = -1,
                                        .m_methods = functions};

static int add_type(PyObject* module, PyType_Spec* spec, PyTypeObject** type) {
  *type = (PyTypeObject*)PyType_FromModuleAndSpec(module, spec, NULL);
  return *type ? PyModule_AddType(module, *type) : -1;
}

PyMODINIT_FUNC PyInit__sinew(void) {
  if (sinew_abi() < SINEW_ABI)
    return PyErr_Format(PyExc_ImportError,
                        "the library is older than its Python module: install sinew again");
  PyObject* module = PyModule_Create(&definition);
  if (!module) return NULL;
  if (prepare_errors() == 0 && prepare_rows() == 0 && prepare_interrupts() == 0 &&
      add_type(module, &handle_spec, &handle_type) == 0 &&
      add_type(module, &session_spec, &session_type) == 0 && add_type(module, &row_spec, &row_type) == 0 &&
      add_type(module, &question_spec, &question_type) == 0 &&
      PyModule_AddStringConstant(module, "version", SINEW_PYTHON_VERSION) == 0)
    return module;
  Py_DECREF(module);
  return NULL;
}

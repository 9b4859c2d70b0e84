# The Python module: python.<name> runs tests/python/<name>_test.py, with the module of the build tree. Debian's own
# Python has NumPy and mypy: SYSTEM_PYTHON, of tools.cmake.
if(NOT TARGET sinew_python)
  return()
endif()
file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/python/*_test.py)
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME_WE)
  string(REGEX REPLACE "_test$" "" name ${name})
  add_test(NAME python.${name} COMMAND ${SYSTEM_PYTHON} -B -W error ${file})
  set_tests_properties(python.${name} PROPERTIES LABELS python TIMEOUT 300 ENVIRONMENT "PYTHONPATH=${CMAKE_BINARY_DIR}/python"
    ENVIRONMENT_MODIFICATION "PATH=path_list_prepend:$<TARGET_FILE_DIR:sinew_command>")
endforeach()

# Every example prints what its last comment says.
file(GLOB examples CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/python/*.py)
foreach(source IN LISTS examples)
  cmake_path(GET source STEM name)
  add_test(NAME example.py.${name} COMMAND ${SYSTEM_PYTHON} -B ${tools_dir}/example.py ${source} ${SYSTEM_PYTHON} -B -W error ${source})
  set_tests_properties(example.py.${name} PROPERTIES LABELS python TIMEOUT 60 ENVIRONMENT "PYTHONPATH=${CMAKE_BINARY_DIR}/python")
endforeach()

# Every notebook runs in Jupyter; docs.site shows what it wrote.
file(GLOB notebooks CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/notebooks/*.ipynb)
foreach(notebook IN LISTS notebooks)
  cmake_path(GET notebook STEM name)
  add_test(NAME notebook.${name} COMMAND ${SYSTEM_PYTHON} -B ${tools_dir}/notebook.py ${PROJECT_BINARY_DIR}/notebooks ${notebook})
  set_tests_properties(notebook.${name} PROPERTIES LABELS python TIMEOUT 120 SKIP_RETURN_CODE 77 FIXTURES_SETUP notebooks
                       ENVIRONMENT "PYTHONPATH=${CMAKE_BINARY_DIR}/python")
endforeach()
set_tests_properties(docs.site PROPERTIES FIXTURES_REQUIRED notebooks ENVIRONMENT "PYTHONPATH=${CMAKE_BINARY_DIR}/python")

# The reference of the module says shapes, units and errors.
add_test(NAME docs.python COMMAND ${SYSTEM_PYTHON} -B ${tools_dir}/python_reference.py)
set_tests_properties(docs.python PROPERTIES LABELS python TIMEOUT 60 ENVIRONMENT "PYTHONPATH=${CMAKE_BINARY_DIR}/python")

# It is built anew, from objects that ccache has.
add_test(NAME python.wheel COMMAND ${CMAKE_CURRENT_LIST_DIR}/python/wheel.sh ${PROJECT_SOURCE_DIR}
  ${CMAKE_CURRENT_BINARY_DIR}/wheel ${SYSTEM_PYTHON})
set_tests_properties(python.wheel PROPERTIES LABELS python TIMEOUT 1500 PROCESSORS 2 COST 800)

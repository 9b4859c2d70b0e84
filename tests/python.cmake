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

# It is built anew, from objects that ccache has.
add_test(NAME python.wheel COMMAND ${CMAKE_CURRENT_LIST_DIR}/python/wheel.sh ${PROJECT_SOURCE_DIR}
  ${CMAKE_CURRENT_BINARY_DIR}/wheel ${SYSTEM_PYTHON})
set_tests_properties(python.wheel PROPERTIES LABELS python TIMEOUT 1500 PROCESSORS 2 COST 800)

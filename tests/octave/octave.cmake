# The module of Octave, in Octave. Included by tests/CMakeLists.txt.
find_program(OCTAVE octave-cli)
mark_as_advanced(OCTAVE)
if(NOT TARGET sinew_mex OR NOT TARGET sinew_command OR NOT OCTAVE)
  return()
endif()
set(octave_dir ${CMAKE_CURRENT_LIST_DIR})
foreach(name answers arrays attacks interrupt leaks page progress values)
  add_test(NAME octave.${name} COMMAND ${OCTAVE} --no-gui --quiet --no-history --no-init-file --no-site-file
    --path ${PROJECT_BINARY_DIR}/octave --path ${octave_dir} ${octave_dir}/${name}_test.m)
  set_tests_properties(octave.${name} PROPERTIES TIMEOUT 300 ENVIRONMENT
    "SINEW_COMMAND=$<TARGET_FILE:sinew_command>;SINEW_ROBOTS=${PROJECT_SOURCE_DIR}/robots;SINEW_DOCS=${PROJECT_SOURCE_DIR}/docs;SINEW_INCLUDE=${PROJECT_SOURCE_DIR}/include;SINEW_LIBRARY=$<TARGET_FILE_DIR:sinew>")
endforeach()

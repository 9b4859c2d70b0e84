# The module of Octave, where it is wanted and mkoctfile is found. Instrumented code cannot be loaded into a program
# that is not.
if(SINEW_OCTAVE STREQUAL "AUTO" AND (SINEW_SANITIZE OR NOT SINEW_BUILD_TESTS))
  return()
endif()
if(SINEW_OCTAVE)
  find_program(MKOCTFILE mkoctfile)
  mark_as_advanced(MKOCTFILE)
  if(MKOCTFILE)
    execute_process(COMMAND ${MKOCTFILE} -p OCTINCLUDEDIR OUTPUT_VARIABLE SINEW_OCTAVE_INCLUDE
                    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    add_subdirectory(octave)
  elseif(NOT SINEW_OCTAVE STREQUAL "AUTO")
    message(FATAL_ERROR "The module of Octave needs mkoctfile; on Debian: apt-get install octave octave-dev")
  endif()
endif()

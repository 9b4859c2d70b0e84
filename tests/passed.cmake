# What other compilers, simulators and synthesis make of some files does not change while they do not: a test of that
# writes down the hashes of all it looks at when it passes, and passes at once when it finds them again. With
# SINEW_TEST_THOROUGH=1 it looks anew.

# sinew_passed_before(RECORD FILE|TEXT...): returns from the script that calls it if this is what passed.
macro(sinew_passed_before record)
  set(sinew_looks_at "")
  foreach(input ${ARGN})
    if(EXISTS "${input}" AND NOT IS_DIRECTORY "${input}")
      file(SHA256 "${input}" hash)
    else()
      string(SHA256 hash "${input}")
    endif()
    string(APPEND sinew_looks_at "${hash}\n")
  endforeach()
  set(sinew_record ${record})
  if(EXISTS ${record} AND NOT "$ENV{SINEW_TEST_THOROUGH}")
    file(READ ${record} passed)
    if(passed STREQUAL sinew_looks_at)
      message(STATUS "the same files as when it last passed")
      return()
    endif()
  endif()
  file(REMOVE ${record})
endmacro()

# sinew_passes(): to be called at the end.
macro(sinew_passes)
  file(WRITE ${sinew_record} "${sinew_looks_at}")
endmacro()

# Runs a test program, unless all that it looks at is as it was when it last passed.
#   cmake -D PROGRAM= -D RECORD= -D INPUTS=file;file -P unless_passed.cmake
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/passed.cmake)
sinew_passed_before(${RECORD} ${INPUTS})
execute_process(COMMAND ${PROGRAM} COMMAND_ERROR_IS_FATAL ANY)
sinew_passes()

# Yosys finds as many multipliers in a robot's core as docs/theory/controller.md counts, on both families.
#   cmake -D SINEW= -D ROBOT= -D SOURCE= -D MULTIPLIERS= -P cells.cmake
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${SOURCE}/tools/fpga_cells.sh ${SINEW} ${ROBOT} OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
message(STATUS "${said}")
foreach(family Spartan-6 ECP5)
  if(NOT said MATCHES "${family}[ 0-9]* ${MULTIPLIERS}\n")
    message(FATAL_ERROR "not ${MULTIPLIERS} multipliers of a ${family}")
  endif()
endforeach()

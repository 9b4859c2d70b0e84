# A robot's core and table, exported, against each other: lint, then tests/fpga/core_test.cpp.
#   cmake -D SINEW= -D ROBOT= -D SOURCE= -D WORK= -D LAUNCHER= -D VERILATOR= -P core.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
execute_process(COMMAND ${SINEW} export ${ROBOT} --to verilog -o ${WORK} --quiet COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${SINEW} export ${ROBOT} --to c-header -o ${WORK}/robot_table.h --quiet COMMAND_ERROR_IS_FATAL ANY)
file(GLOB core ${WORK}/*_core.v)
cmake_path(GET core STEM name)
execute_process(COMMAND ${VERILATOR} --version OUTPUT_VARIABLE version COMMAND_ERROR_IS_FATAL ANY)
file(GLOB exported ${WORK}/*)
file(GLOB kernel ${SOURCE}/kernel/include/sinew/kernel/*.h)
include(${CMAKE_CURRENT_LIST_DIR}/../passed.cmake)
sinew_passed_before(${WORK}.passed ${exported} ${kernel} ${SOURCE}/tests/fpga/core_test.cpp "${version}" ${CMAKE_CURRENT_LIST_FILE})

# Bits that rounding drops are not used, and all modules of a core are in one file.
execute_process(COMMAND ${VERILATOR} --lint-only -Wall -Wno-UNUSED -Wno-DECLFILENAME --top-module ${name} ${core}
                COMMAND_ERROR_IS_FATAL ANY)
# It runs for a fraction of a second: what takes time is compiling.
execute_process(
  COMMAND ${VERILATOR} --cc --exe --build --prefix Vcore --top-module ${name} -Mdir ${WORK}/build
          -CFLAGS "-I${WORK} -I${SOURCE}/kernel/include"
          -MAKEFLAGS "OBJCACHE=${LAUNCHER} OPT_FAST=-O1 OPT_SLOW=-O0 OPT_GLOBAL=-O0"
          ${core} ${SOURCE}/tests/fpga/core_test.cpp
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/build/Vcore 100000 COMMAND_ERROR_IS_FATAL ANY)
sinew_passes()

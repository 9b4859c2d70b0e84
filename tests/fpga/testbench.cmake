# A robot's exported testbench with its core, or with NETLIST=ON with what Yosys makes of the core for a Spartan-6.
#   cmake -D SINEW= -D ROBOT= -D WORK= -D LAUNCHER= -D VERILATOR= [-D YOSYS= -D NETLIST=ON] -P testbench.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
execute_process(COMMAND ${SINEW} export ${ROBOT} --to verilog -o ${WORK} --quiet COMMAND_ERROR_IS_FATAL ANY)
file(GLOB core ${WORK}/*_core.v)
cmake_path(GET core STEM name)
execute_process(COMMAND ${VERILATOR} --version OUTPUT_VARIABLE version COMMAND_ERROR_IS_FATAL ANY)
if(NETLIST)
  execute_process(COMMAND ${YOSYS} --version OUTPUT_VARIABLE yosys_version COMMAND_ERROR_IS_FATAL ANY)
endif()
file(GLOB exported ${WORK}/*)
include(${CMAKE_CURRENT_LIST_DIR}/../passed.cmake)
sinew_passed_before(${WORK}.passed ${exported} "${version}" "${yosys_version}" ${CMAKE_CURRENT_LIST_FILE})

set(design ${core})
set(flags "")
if(NETLIST)
  set(design ${WORK}/netlist.v)
  execute_process(COMMAND ${YOSYS} -q -p "read_verilog ${core}; synth_xilinx -flatten -noiopad -family xc6s -top ${name}; \
write_verilog -noattr ${design}" ERROR_QUIET COMMAND_ERROR_IS_FATAL ANY)
  cmake_path(GET YOSYS PARENT_PATH bin)
  list(APPEND design ${bin}/../share/yosys/xilinx/cells_sim.v)
  set(flags -Wno-fatal -Wno-lint --x-initial 0 --output-split 0)  # cells are written for other simulators
endif()
execute_process(
  COMMAND ${VERILATOR} --cc --exe --main --timing --build ${flags} --top-module ${name}_tb -Mdir ${WORK}/build
          -MAKEFLAGS "OBJCACHE=${LAUNCHER} OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0" ${WORK}/${name}_tb.v ${design}
  OUTPUT_QUIET ERROR_FILE ${WORK}/log RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  file(READ ${WORK}/log log)
  message(FATAL_ERROR "${log}")
endif()
execute_process(COMMAND ${WORK}/build/V${name}_tb OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
message(STATUS "${said}")
if(NOT said MATCHES "PASSED" OR said MATCHES "FAILED")
  message(FATAL_ERROR "the testbench does not pass")
endif()
sinew_passes()

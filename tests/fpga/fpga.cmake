# Cores of `sinew export --to verilog`: against the kernel, by their own testbenches, and what Yosys makes of them. Included
# by tests/CMakeLists.txt. docs/theory/controller.md says what is compared.
find_program(VERILATOR verilator)
find_program(YOSYS yosys)
mark_as_advanced(VERILATOR YOSYS)
set(fpga_tests ${CMAKE_CURRENT_LIST_DIR})

# sinew_fpga_test(NAME SCRIPT ROBOT SECONDS [-D ...]): SCRIPT.cmake for a robot of robots/ or a file below tests/data.
function(sinew_fpga_test name script robot seconds)
  set(file ${PROJECT_SOURCE_DIR}/robots/${robot}.yaml)
  if(NOT EXISTS ${file})
    set(file ${PROJECT_SOURCE_DIR}/tests/data/fpga/${robot}.yaml)
  endif()
  add_test(NAME fpga.${name}.${robot} COMMAND ${CMAKE_COMMAND} ${ARGN}
    -D SINEW=$<TARGET_FILE:sinew_command> -D ROBOT=${file} -D SOURCE=${PROJECT_SOURCE_DIR}
    -D WORK=${CMAKE_CURRENT_BINARY_DIR}/fpga/${name}/${robot} -D LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}
    -D VERILATOR=${VERILATOR} -D YOSYS=${YOSYS} -P ${fpga_tests}/${script}.cmake)
  set_tests_properties(fpga.${name}.${robot} PROPERTIES LABELS fpga TIMEOUT ${seconds})
endfunction()

if(SINEW_SANITIZE)
  # What simulators and Yosys find does not depend on sanitizers.
elseif(VERILATOR)
  foreach(robot nottingham-tpcj nottingham-neutral four-tendon-neutral unlike-sections)
    sinew_fpga_test(core core ${robot} 120)
  endforeach()
  sinew_fpga_test(testbench testbench unlike-sections 120)
else()
  message(STATUS "Cores for FPGAs are not compared with the kernel: that needs Debian's verilator")
endif()
if(YOSYS AND NOT SINEW_SANITIZE)
  if(VERILATOR)
    sinew_fpga_test(netlist testbench nottingham-tpcj 300 -D NETLIST=ON)
  endif()
  sinew_fpga_test(cells cells nottingham-tpcj 120 -D MULTIPLIERS=18)
elseif(NOT SINEW_SANITIZE)
  message(STATUS "Cores for FPGAs are not synthesised: that needs Debian's yosys")
endif()

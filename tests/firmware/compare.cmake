# The same bits everywhere: the program of firmware/compare prints the same text on this machine, on an ATmega2560 and on
# two Cortex-M, for each robot; and the instructions that kernels take on the latter. Included by tests/CMakeLists.txt.
find_program(ARM_CXX arm-none-eabi-g++)
find_program(QEMU_ARM qemu-system-arm)
mark_as_advanced(ARM_CXX QEMU_ARM)

set(compare_tests ${CMAKE_CURRENT_LIST_DIR})
set(compare_sources ${PROJECT_SOURCE_DIR}/firmware/compare)
set(compare_dir ${CMAKE_CURRENT_BINARY_DIR}/compare)
file(GLOB compare_files CONFIGURE_DEPENDS ${compare_sources}/*.h ${compare_sources}/*.ld
     ${PROJECT_SOURCE_DIR}/kernel/include/sinew/kernel/*.h)

# Targets as cross compilers and simulators know them. Sums of products in float are not fused: else they are others.
set(cross_flags -std=c++14 -O2 -ffp-contract=off -Wall -Wextra -Werror -fno-exceptions -fno-rtti -fno-threadsafe-statics
    -ffunction-sections -fdata-sections -Wl,--gc-sections)
set(arm_flags ${cross_flags} -mthumb -ffreestanding -nostdlib -T ${compare_sources}/cortex_m.ld)
set(arm_run ${QEMU_ARM} -display none -serial none -monitor none -chardev stdio,id=out
    -semihosting-config enable=on,target=native,chardev=out)
set(compare_targets "")
if(SINEW_SANITIZE)
  # What other machines do does not depend on sanitizers of this one.
elseif(ARM_CXX AND QEMU_ARM)
  list(APPEND compare_targets cortex-m0 cortex-m4f)
  set(compile_cortex-m0 ${ARM_CXX} ${arm_flags} -mcpu=cortex-m0)
  set(compile_cortex-m4f ${ARM_CXX} ${arm_flags} -mcpu=cortex-m4 -mfloat-abi=hard -mfpu=fpv4-sp-d16)
  foreach(target cortex-m0 cortex-m4f)
    set(port_${target} ${compare_sources}/arm.cpp)
    set(libraries_${target} -lgcc)
  endforeach()
  set(run_cortex-m0 ${arm_run} -M microbit -kernel)
  set(run_cortex-m4f ${arm_run} -M mps2-an386 -kernel)
else()
  message(STATUS "Kernels are not compared with a Cortex-M: that needs Debian's gcc-arm-none-eabi and qemu-system-arm")
endif()
if(TARGET sinew_simulate AND NOT SINEW_SANITIZE)
  list(APPEND compare_targets atmega2560)
  set(compile_atmega2560 ${AVR_CXX} ${cross_flags} -mmcu=atmega2560)
  set(port_atmega2560 ${compare_sources}/avr.cpp)
  set(run_atmega2560 $<TARGET_FILE:sinew_simulate> --cycles 1000000000000)
endif()

# sinew_cross(PROGRAM TARGET ROBOT SOURCE [DEFINITION...]): compare/ROBOT/PROGRAM for that target.
function(sinew_cross program target robot source)
  set(elf ${compare_dir}/${robot}/${program})
  add_custom_command(OUTPUT ${elf}
    COMMAND ${compile_${target}} ${ARGN} -I ${PROJECT_SOURCE_DIR}/kernel/include -I ${compare_sources}
            -I ${compare_dir}/${robot} ${compare_sources}/${source} ${port_${target}} ${libraries_${target}} -o ${elf}
    DEPENDS ${compare_files} ${compare_sources}/${source} ${port_${target}} ${compare_dir}/${robot}/robot_table.h
    COMMENT "Building ${program} of ${robot}" VERBATIM)
  add_custom_target(compare_${robot}_${program} ALL DEPENDS ${elf})
  add_dependencies(compare_${robot}_${program} compare_${robot}_table)
endfunction()

# sinew_compare(ROBOT FILE INPUTS): a test for each target, of so many inputs.
function(sinew_compare robot file inputs)
  set(table ${compare_dir}/${robot}/robot_table.h)
  add_custom_command(OUTPUT ${table}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${compare_dir}/${robot}
    COMMAND sinew_command export ${file} --to c-header -o ${table} --quiet
    DEPENDS sinew_command ${file} COMMENT "Exporting ${robot}" VERBATIM)
  add_custom_target(compare_${robot}_table DEPENDS ${table})
  set(definitions_all -DSINEW_INPUTS=${inputs})
  set(definitions_few ${definitions_all} -DSINEW_DEAR_EVERY=50)
  foreach(share all few)
    add_executable(compare_${robot}_${share} ${compare_sources}/main.cpp ${compare_sources}/host.cpp)
    target_include_directories(compare_${robot}_${share} PRIVATE ${compare_sources} ${compare_dir}/${robot})
    target_compile_definitions(compare_${robot}_${share} PRIVATE ${definitions_${share}})
    target_link_libraries(compare_${robot}_${share} PRIVATE sinew::kernel sinew_options)
    set_target_properties(compare_${robot}_${share} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${compare_dir}/${robot})
    add_dependencies(compare_${robot}_${share} compare_${robot}_table)
  endforeach()
  # Alone, for sanitizers: integers that overflow are what makes machines differ.
  add_test(NAME firmware.compare.${robot}.host COMMAND compare_${robot}_all)
  set_tests_properties(firmware.compare.${robot}.host PROPERTIES LABELS firmware TIMEOUT 120)
  foreach(target IN LISTS compare_targets)
    # An ATmega2560 takes most of its time for a few kernels: these have one input of 50.
    set(share all)
    if(target STREQUAL "atmega2560")
      set(share few)
    endif()
    sinew_cross(${target}.elf ${target} ${robot} main.cpp ${definitions_${share}})
    add_test(NAME firmware.compare.${robot}.${target} COMMAND ${CMAKE_COMMAND}
      -D HERE=$<TARGET_FILE:compare_${robot}_${share}> "-D THERE=${run_${target}};${compare_dir}/${robot}/${target}.elf"
      -P ${compare_tests}/same_text.cmake)
    set_tests_properties(firmware.compare.${robot}.${target} PROPERTIES LABELS firmware TIMEOUT 600)
  endforeach()
endfunction()

# Compiled into the programs: SINEW_TEST_THOROUGH, of tests/support/thorough.hpp, is that of when CMake runs here.
set(many_inputs 20000)
if("$ENV{SINEW_TEST_THOROUGH}")
  set(many_inputs 100000)
endif()
sinew_compare(nottingham-tpcj ${PROJECT_SOURCE_DIR}/robots/nottingham-tpcj.yaml ${many_inputs})
sinew_compare(four-tendon-neutral ${PROJECT_SOURCE_DIR}/robots/four-tendon-neutral.yaml 10000)
sinew_compare(unlike-sections ${compare_tests}/../data/firmware/unlike-sections.yaml 10000)

# Instructions of kernels, as arm-none-eabi-g++ 12.2.1 compiles them; these may fuse products and sums.
function(sinew_count target)
  sinew_cross(count_${target}.elf ${target} nottingham-tpcj count.cpp -ffp-contract=fast)
  add_test(NAME firmware.instructions.${target} COMMAND ${CMAKE_COMMAND} -D COMPILER=${ARM_CXX}
    "-D RUN=${run_${target}};${compare_dir}/nottingham-tpcj/count_${target}.elf;-icount;shift=0" "-D KNOWN=${ARGN}"
    -P ${compare_tests}/instructions.cmake)
  set_tests_properties(firmware.instructions.${target} PROPERTIES LABELS firmware TIMEOUT 60)
endfunction()
if("cortex-m0" IN_LIST compare_targets)
  sinew_count(cortex-m0 int16_changes 235 int16_exact 1290 q15_16_changes 1729 q15_16_exact 5557
              float_changes 5414 float_exact 14040)
  sinew_count(cortex-m4f int16_changes 169 int16_exact 835 q15_16_changes 179 q15_16_exact 1307
              float_changes 128 float_exact 284)
endif()

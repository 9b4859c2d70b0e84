# Builds and runs the consumer against sinew.  cmake -D MODE=install|subdirectory -D SOURCE= -D BUILD= -D WORK=
#   -D JOBS= -D PYTHON= -D COMPILER= -D LAUNCHER= -D BUILD_TYPE= -D FLAGS= -D WARNINGS_AS_ERRORS= -P packaging.cmake
#   install       what is built in BUILD, installed and found with find_package
#   subdirectory  sinew's sources inside the consumer's project
cmake_minimum_required(VERSION 3.25)
set(prefix ${WORK}/prefix)
# Where sources of sinew are compiled once more: beside BUILD, since ccache takes paths relative to the folder that it runs
# in, and finds what was compiled in BUILD only from a folder as deep.
set(again ${BUILD}-packaging-${MODE})
set(consumer_build ${WORK}/consumer)
if(MODE STREQUAL "subdirectory")
  set(consumer_build ${again})
endif()
set(consumer ${CMAKE_CURRENT_LIST_DIR}/consumer)
# The consumer is quick to build, with assertions on, where the library's own build has them off. Sources of sinew are
# compiled exactly as in BUILD: with ccache that is not done again.
set(flags -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_BUILD_TYPE=Debug -D CMAKE_CXX_FLAGS_DEBUG=-O0)
set(sinew_flags -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
  -D CMAKE_BUILD_TYPE=${BUILD_TYPE} -D CMAKE_CXX_FLAGS=${FLAGS} -D SINEW_WARNINGS_AS_ERRORS=${WARNINGS_AS_ERRORS})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# The prefix starts empty: a header that is no longer installed must not be found. Built objects are kept.
file(REMOVE_RECURSE ${prefix})

if(MODE STREQUAL "install")
  run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
endif()

file(REMOVE ${consumer_build}/CMakeCache.txt)
if(MODE STREQUAL "subdirectory")
  run(${CMAKE_COMMAND} -S ${consumer} -B ${consumer_build} ${sinew_flags} -D SINEW_SOURCE=${SOURCE})
else()
  run(${CMAKE_COMMAND} -S ${consumer} -B ${consumer_build} ${flags} -D CMAKE_PREFIX_PATH=${prefix}
      -D CMAKE_FIND_PACKAGE_NO_PACKAGE_REGISTRY=ON)
  file(STRINGS ${consumer_build}/CMakeCache.txt found REGEX "^sinew_DIR:")
  if(NOT found MATCHES "=${prefix}/")
    message(FATAL_ERROR "the consumer found another sinew: ${found}")
  endif()
endif()
if(EXISTS ${prefix}/include/sinew/plan/insertion.hpp AND NOT MODE STREQUAL "subdirectory")
  file(STRINGS ${consumer_build}/CMakeCache.txt has_plan REGEX "^fcl_DIR:PATH=/")
  if(NOT has_plan)
    message(FATAL_ERROR "sinew::plan is installed and was not found")
  endif()
endif()
run(${CMAKE_COMMAND} --build ${consumer_build} --parallel ${JOBS})
run(${consumer_build}/consumer)
if(NOT MODE STREQUAL "subdirectory")
  execute_process(COMMAND ${consumer_build}/consumer_study WORKING_DIRECTORY ${consumer_build} COMMAND_ERROR_IS_FATAL ANY)
endif()

if(EXISTS ${consumer_build}/consumer_plan)
  run(${consumer_build}/consumer_plan)
endif()
if(EXISTS ${consumer_build}/consumer_avx512)
  set(has_avx512 TRUE)
  file(STRINGS /proc/cpuinfo cpu REGEX "^flags" LIMIT_COUNT 1)
  foreach(feature avx512f avx512vl avx512bw avx512dq avx512cd)
    if(NOT cpu MATCHES " ${feature}( |$)")
      set(has_avx512 FALSE)
    endif()
  endforeach()
  if(has_avx512)
    run(${consumer_build}/consumer_avx512)
    message(STATUS "the consumer ran with AVX-512 too")
  else()
    message(STATUS "the consumer with AVX-512 was built but not run: this processor has none")
  endif()
endif()

if(MODE STREQUAL "install" AND EXISTS ${prefix}/bin/sinew)
  run(${prefix}/bin/sinew --version)
  run(${prefix}/bin/sinew sweep --list)  # of the second program
  foreach(text man/man1/sinew.1 bash-completion/completions/sinew zsh/site-functions/_sinew fish/vendor_completions.d/sinew.fish)
    if(NOT EXISTS ${prefix}/share/${text})
      message(FATAL_ERROR "share/${text} is not installed")
    endif()
  endforeach()
  foreach(page README.md CITATION.cff docs/tour.md docs/images/page.png)
    file(GLOB installed ${prefix}/share/doc/*/${page})
    if(NOT installed)
      message(FATAL_ERROR "${page} is not installed")
    endif()
  endforeach()
endif()

execute_process(COMMAND nm --dynamic --defined-only ${consumer_build}/libconsumer_plugin.so
                OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
if(NOT symbols MATCHES "consumer_version" OR symbols MATCHES "5sinew")
  message(FATAL_ERROR "a plugin that links the static library exports:\n${symbols}")
endif()

file(GLOB_RECURSE library ${prefix}/*/libsinew.so)
if(library)
  run(${consumer_build}/consumer_shared)
  run(${PYTHON} ${CMAKE_CURRENT_LIST_DIR}/exports.py ${library} ${prefix}/include)
  # A program in C needs a compiler of C and -lsinew.
  cmake_path(GET library PARENT_PATH folder)
  run(cc -std=c11 -Wall -Wextra -Wpedantic -Werror -I${prefix}/include ${CMAKE_CURRENT_LIST_DIR}/consumer/program.c -o ${consumer_build}/program
      -L${folder} -lsinew -Wl,-rpath,${folder})
  run(${consumer_build}/program)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${consumer} -B ${consumer_build}-of-both ${flags} -D CMAKE_PREFIX_PATH=${prefix} -D CONSUMER_OF_BOTH=ON
                  RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE said)
  if(result EQUAL 0 OR NOT said MATCHES "SINEW_LIBRARY")
    message(FATAL_ERROR "a program that links both libraries is not refused: ${said}")
  endif()
elseif(MODE STREQUAL "install")
  message(FATAL_ERROR "libsinew.so is not installed")
endif()

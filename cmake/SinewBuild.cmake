# Compile options shared by every target of this project; nothing here reaches a consumer.
add_library(sinew_options INTERFACE)
target_compile_features(sinew_options INTERFACE cxx_std_20)
# What belongs to the project may include what is not installed.
target_include_directories(sinew_options INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_compile_options(sinew_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wdouble-promotion -Wold-style-cast
  -Wnon-virtual-dtor -Wimplicit-fallthrough
  # No fast-math: NaN must stay visible. These two only drop errno and trap bookkeeping, never a rounding.
  -fno-math-errno -fno-trapping-math
  # Public functions are inlined into their callers within the library although they are visible.
  -fno-semantic-interposition
  # a*b+c is rounded the same way on every machine
  -ffp-contract=off
  # clang's warns of long double, too, where a test wants more digits
  $<$<CXX_COMPILER_ID:Clang>:-Wno-double-promotion>)
if(SINEW_WARNINGS_AS_ERRORS)
  target_compile_options(sinew_options INTERFACE -Werror)
endif()
if(SINEW_SANITIZE)
  # Without the checks of every pointer, which AddressSanitizer and Eigen make too.
  target_compile_options(sinew_options INTERFACE
    -fsanitize=${SINEW_SANITIZE} -fno-sanitize=null,alignment,object-size,pointer-overflow,vptr
    -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(sinew_options INTERFACE -fsanitize=${SINEW_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID MATCHES Clang AND SINEW_SANITIZE MATCHES "(address|thread)")
    string(TOUPPER ${CMAKE_MATCH_1} sanitizer)
    target_compile_definitions(sinew_options INTERFACE __SANITIZE_${sanitizer}__)  # as gcc does
  endif()
endif()

# -O2 in Release: measured as fast as -O3 on these kernels and quicker to build. Only where nobody chose otherwise,
# and only in this folder: the cache would carry it to a project that has sinew as a subdirectory.
if(CMAKE_CXX_FLAGS_RELEASE STREQUAL "-O3 -DNDEBUG")
  set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
endif()
# GCC gives memory back often, which takes it a tenth of its time. Where each job may have three gigabytes it need not.
cmake_host_system_information(RESULT SINEW_MEMORY QUERY TOTAL_PHYSICAL_MEMORY)
cmake_host_system_information(RESULT SINEW_CORES QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR SINEW_MEMORY_A_JOB "${SINEW_MEMORY} / ${SINEW_CORES}")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND SINEW_MEMORY_A_JOB GREATER 3000)
  target_compile_options(sinew_options INTERFACE "SHELL:--param ggc-min-heapsize=1048576")
endif()
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

# sinew_link_quickly(): the quickest linker there is, for targets that come after. Tests and benchmarks link the library
# into half a hundred programs after each change, and GNU's ld takes three times as long.
macro(sinew_link_quickly)
  find_program(LLD ld.lld)
  find_program(GOLD ld.gold)
  mark_as_advanced(LLD GOLD)
  if(CMAKE_CXX_COMPILER_ID MATCHES "^(GNU|Clang)$" AND LLD)
    add_link_options(-fuse-ld=lld)
  elseif(CMAKE_CXX_COMPILER_ID MATCHES "^(GNU|Clang)$" AND GOLD)
    add_link_options(-fuse-ld=gold)
  endif()
endmacro()

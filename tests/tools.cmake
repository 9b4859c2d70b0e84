# Checks of the tree itself: layers, equations, headers, packaging. Included by tests/CMakeLists.txt.
find_package(Python3 COMPONENTS Interpreter REQUIRED)
# Debian's own Python: for that one its packages are installed, and another may come first on the path.
find_program(SYSTEM_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(NOT SYSTEM_PYTHON)
  set(SYSTEM_PYTHON ${Python3_EXECUTABLE} CACHE FILEPATH "Python with Debian's packages" FORCE)
endif()
set(packaging_dir ${CMAKE_CURRENT_LIST_DIR}/packaging)
set(tools_dir ${PROJECT_SOURCE_DIR}/tools)

add_test(NAME tools.layers COMMAND Python3::Interpreter ${tools_dir}/layers.py)
add_test(NAME tools.equations COMMAND Python3::Interpreter ${tools_dir}/equations.py --check)
add_test(NAME tools.selftest COMMAND Python3::Interpreter ${packaging_dir}/tools_test.py)
set_tests_properties(tools.layers tools.equations tools.selftest PROPERTIES LABELS tools TIMEOUT 60)

# The README and the pages show what happens.
if(TARGET sinew_command AND TARGET example_01_first_answer)
  set(languages $<$<TARGET_EXISTS:sinew_python>:--python$<SEMICOLON>${SYSTEM_PYTHON}>
                $<$<TARGET_EXISTS:sinew_mex>:--octave$<SEMICOLON>${OCTAVE}>)
  add_test(NAME readme COMMAND Python3::Interpreter ${tools_dir}/readme.py --command $<TARGET_FILE_DIR:sinew_command> ${languages}
    --examples ${PROJECT_SOURCE_DIR}/examples/cpp --programs $<TARGET_FILE_DIR:example_01_first_answer>
    README.md docs/tour.md docs/cpp.md docs/robot-files.md docs/protocol.md docs/identify.md docs/arm-models.md
    COMMAND_EXPAND_LISTS WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  add_test(NAME tools.facts COMMAND Python3::Interpreter ${tools_dir}/facts.py $<TARGET_FILE:sinew_command>)
  add_test(NAME tools.fields COMMAND Python3::Interpreter ${tools_dir}/fields.py $<TARGET_FILE:sinew_command> --check)
  set_tests_properties(tools.facts tools.fields PROPERTIES LABELS tools TIMEOUT 60)
  set_tests_properties(readme PROPERTIES LABELS tools TIMEOUT 120
                       ENVIRONMENT "PYTHONPATH=${CMAKE_BINARY_DIR}/python;OCTAVE_PATH=${CMAKE_BINARY_DIR}/octave")
endif()

# Every example prints what its last comment says.
file(GLOB examples CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/cpp/*.cpp)
foreach(source IN LISTS examples)
  cmake_path(GET source STEM name)
  if(TARGET example_${name})
    add_test(NAME example.${name} COMMAND Python3::Interpreter ${tools_dir}/example.py ${source} $<TARGET_FILE:example_${name}>)
    set_tests_properties(example.${name} PROPERTIES LABELS tools TIMEOUT 60)
  endif()
endforeach()

# The kernel's headers need no standard library.
find_program(CLANGXX NAMES clang++)
set(kernel_compilers ${CMAKE_CXX_COMPILER})
if(CLANGXX AND NOT CLANGXX STREQUAL CMAKE_CXX_COMPILER)
  list(APPEND kernel_compilers ${CLANGXX})
endif()
add_test(NAME headers.kernel COMMAND ${CMAKE_COMMAND}
  -D HEADERS=${PROJECT_SOURCE_DIR}/kernel/include "-D COMPILERS=${kernel_compilers}"
  -D WORK=${CMAKE_CURRENT_BINARY_DIR}/kernel_headers -P ${packaging_dir}/kernel_headers.cmake)
set_tests_properties(headers.kernel PROPERTIES LABELS tools TIMEOUT 120)

# The rest takes its time, and what it finds does not depend on sanitizers.
if(SINEW_SANITIZE)
  return()
endif()

# The schema of robot files and the reader judge alike.
if(TARGET sinew_command)
  add_executable(schema_judge ${CMAKE_CURRENT_LIST_DIR}/schema/judge.cpp)
  target_link_libraries(schema_judge PRIVATE sinew sinew_options)
  add_test(NAME schema.robot COMMAND ${SYSTEM_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/schema/schema_test.py
    $<TARGET_FILE:sinew_command> $<TARGET_FILE:schema_judge>)
  set_tests_properties(schema.robot PROPERTIES LABELS tools TIMEOUT 300)
  add_executable(schema_study_judge ${CMAKE_CURRENT_LIST_DIR}/schema/study_judge.cpp)
  target_link_libraries(schema_study_judge PRIVATE sinew_study sinew_options)
  add_test(NAME schema.study COMMAND ${SYSTEM_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/schema/study_schema_test.py
    $<TARGET_FILE:sinew_command> $<TARGET_FILE:schema_study_judge>)
  set_tests_properties(schema.study PROPERTIES LABELS tools TIMEOUT 300)
  add_test(NAME schema.query COMMAND ${SYSTEM_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/schema/query_schema_test.py
    $<TARGET_FILE:sinew_command>)
  set_tests_properties(schema.query PROPERTIES LABELS tools TIMEOUT 120)
endif()

# The reference of the C++ and C interface, and the site of all pages, are made without a warning.
add_test(NAME docs.api COMMAND Python3::Interpreter ${tools_dir}/reference.py ${PROJECT_BINARY_DIR}/api)
add_test(NAME docs.site COMMAND Python3::Interpreter ${tools_dir}/site.py ${PROJECT_BINARY_DIR}/site ${PROJECT_BINARY_DIR}/notebooks)
set_tests_properties(docs.api docs.site PROPERTIES LABELS tools TIMEOUT 180 SKIP_RETURN_CODE 77)

# Every public header compiles alone.
find_package(Eigen3 REQUIRED NO_MODULE)
get_target_property(eigen_include Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
add_test(NAME headers.public COMMAND Python3::Interpreter ${tools_dir}/headers.py ${CMAKE_CXX_COMPILER}
  ${CMAKE_CURRENT_BINARY_DIR}/headers ${eigen_include})
set_tests_properties(headers.public PROPERTIES LABELS tools TIMEOUT 600 PROCESSORS 2 COST 900)  # begins early

# A user's project, with sinew installed and as a subdirectory.
foreach(mode install subdirectory)
  add_test(NAME packaging.${mode} COMMAND ${CMAKE_COMMAND}
    -D MODE=${mode} -D SOURCE=${PROJECT_SOURCE_DIR} -D BUILD=${PROJECT_BINARY_DIR}
    -D WORK=${CMAKE_CURRENT_BINARY_DIR}/packaging/${mode} -D JOBS=2 -D PYTHON=${SYSTEM_PYTHON}
    -D COMPILER=${CMAKE_CXX_COMPILER} -D LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER} -D BUILD_TYPE=${CMAKE_BUILD_TYPE}
    -D "FLAGS=${CMAKE_CXX_FLAGS}" -D WARNINGS_AS_ERRORS=${SINEW_WARNINGS_AS_ERRORS}
    -P ${packaging_dir}/packaging.cmake)
  set_tests_properties(packaging.${mode} PROPERTIES LABELS packaging TIMEOUT 1500 PROCESSORS 2 COST 800)
endforeach()
set_tests_properties(packaging.install PROPERTIES PROCESSORS 1)

# A stranger's way, from the installation to a figure and a program of one's own.
if(TARGET sinew_command)
  add_test(NAME packaging.stranger COMMAND ${packaging_dir}/stranger.sh ${PROJECT_BINARY_DIR}
    ${CMAKE_CURRENT_BINARY_DIR}/packaging/stranger ${CMAKE_CXX_COMPILER})
  set_tests_properties(packaging.stranger PROPERTIES LABELS packaging TIMEOUT 300)
endif()

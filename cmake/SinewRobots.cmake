# Robot and study files go into the libraries as text: robots/*.yaml and studies/*.yaml, so that `sinew forward 3-rfr`
# works from any folder, and examples/robots/*.yaml, which `sinew new` prints.
function(sinew_robot_rows folder result)
  file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.yaml)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${files})
  set(rows "")
  foreach(file IN LISTS files)
    get_filename_component(robot ${file} NAME_WE)
    file(READ ${file} text)
    string(APPEND rows "    {\"${robot}\", R\"sinew(${text})sinew\"},\n")
  endforeach()
  set(${result} "${rows}" PARENT_SCOPE)
endfunction()

sinew_robot_rows(studies study_rows)
sinew_robot_rows(robots robot_rows)
sinew_robot_rows(examples/robots template_rows)
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/builtin_robots.cpp @ONLY CONTENT
[[// Generated from robots/*.yaml and examples/robots/*.yaml.
#include "io/builtin.hpp"

namespace sinew::inline v0 {

std::span<const BuiltinRobot> builtin_robots() {
  static constexpr BuiltinRobot robots[] = {
@robot_rows@  };
  return robots;
}

std::span<const BuiltinRobot> robot_templates() {
  static constexpr BuiltinRobot robots[] = {
@template_rows@  };
  return robots;
}

}  // namespace sinew::inline v0
]])

file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/builtin_studies.cpp @ONLY CONTENT
[[// Generated from studies/*.yaml.
#include "study/builtin.hpp"

namespace sinew::inline v0 {

std::span<const BuiltinFile> builtin_studies() {
  static constexpr BuiltinFile studies[] = {
@study_rows@  };
  return studies;
}

}  // namespace sinew::inline v0
]])

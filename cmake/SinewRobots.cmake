# robots/*.yaml go into the library as text, so that `sinew forward 3-rfr` works from any folder.
file(GLOB robot_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/robots/*.yaml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${robot_files})
set(robot_rows "")
foreach(file IN LISTS robot_files)
  get_filename_component(robot ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND robot_rows "    {\"${robot}\", R\"sinew(${text})sinew\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/builtin_robots.cpp @ONLY CONTENT
[[// Generated from robots/*.yaml.
#include "io/builtin.hpp"

namespace sinew::inline v0 {

std::span<const BuiltinRobot> builtin_robots() {
  static constexpr BuiltinRobot robots[] = {
@robot_rows@  };
  return robots;
}

}  // namespace sinew::inline v0
]])

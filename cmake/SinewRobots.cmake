# Robot and study files go into the libraries as text: robots/*.yaml and studies/*.yaml, so that `sinew forward 3-rfr`
# works from any folder, and examples/robots/*.yaml and examples/scenes/wall.yaml, which `sinew new` prints.
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

# The program of firmware/cycles and the kernel's headers, under the names by which they include one another.
set(firmware_rows "")
file(GLOB firmware_files CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/firmware/cycles/*.h
     ${PROJECT_SOURCE_DIR}/firmware/cycles/*.cpp ${PROJECT_SOURCE_DIR}/kernel/include/sinew/kernel/*.h)
foreach(file IN LISTS firmware_files)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${file})
  string(REGEX REPLACE "^(firmware/cycles|kernel/include)/" "" name ${file})
  file(READ ${PROJECT_SOURCE_DIR}/${file} text)
  string(APPEND firmware_rows "    {\"${name}\", R\"sinew(${text})sinew\"},\n")
endforeach()

# Numbers of others that `sinew reproduce truth` is judged by.
file(GLOB files RELATIVE ${PROJECT_SOURCE_DIR}/data CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/data/*/*.csv)
foreach(file IN LISTS files)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/data/${file})
  file(READ ${PROJECT_SOURCE_DIR}/data/${file} text)
  string(APPEND data_rows "    {\"${file}\", R\"sinew(${text})sinew\"},\n")
endforeach()

sinew_robot_rows(studies study_rows)
sinew_robot_rows(robots robot_rows)
sinew_robot_rows(examples/robots template_rows)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/scenes/wall.yaml)
file(READ ${PROJECT_SOURCE_DIR}/examples/scenes/wall.yaml scene_text)
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/builtin_robots.cpp @ONLY CONTENT
[[// Generated from robots/*.yaml and examples.
#include "io/robots/builtin.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::inline v1 {

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

std::string_view scene_template() { return R"sinew(@scene_text@)sinew"; }

}  // namespace sinew::inline v1
]])

file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/builtin_studies.cpp @ONLY CONTENT
[[// Generated from studies/*.yaml, data, firmware/cycles and kernel/include.
#include "study/builtin.hpp"

namespace sinew::inline v1 {

std::span<const BuiltinFile> builtin_studies() {
  static constexpr BuiltinFile studies[] = {
@study_rows@  };
  return studies;
}

std::string_view builtin_data(std::string_view name) {
  static constexpr BuiltinFile tables[] = {
@data_rows@  };
  for (const BuiltinFile& table : tables)
    if (table.name == name) return table.text;
  return {};
}

std::span<const BuiltinFile> builtin_firmware() {
  static constexpr BuiltinFile files[] = {
@firmware_rows@  };
  return files;
}

}  // namespace sinew::inline v1
]])

/// @file measured_arms.hpp
/// Recordings of two arms, data/measured/, and the arms as their files have them.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "paths.hpp"
#include "sinew/analysis/identify.hpp"
#include "sinew/io/table.hpp"
#include "sinew/robot.hpp"

namespace sinew::test {

struct Recording {
  MeasuredRows rows;
  std::vector<bool> single_pulls;  ///< rows where one tendon is drawn in and the others are paid out
};

inline Recording recording(const std::string& name) {
  const auto table = read_csv(std::string(source_folder) + "/data/measured/" + name + ".csv");
  if (!table) throw std::runtime_error(to_string(table.error()));
  Recording read;
  const std::vector<Column>& columns = table->columns;  // time, block, single_pull, nine tendons, x, y, z
  for (std::size_t k = 0; k < table->row_count(); ++k) {
    read.rows.time.push_back(columns[0].values[k]);
    read.rows.blocks.push_back(static_cast<int>(columns[1].values[k]));
    read.single_pulls.push_back(columns[2].values[k] == 1);
    for (std::size_t i = 3; i < 12; ++i) read.rows.pulls.push_back(1e-3 * columns[i].values[k]);
    for (std::size_t i = 12; i < 15; ++i) read.rows.markers.push_back(1e-3 * columns[i].values[k]);
  }
  return read;
}

/// As its file has it, the marker 8 mm beyond the tip, tendons soft at first.
inline MeasuredArm measured_arm(const std::string& name) {
  MeasuredArm arm;
  arm.arm = *load(name)->arm();
  arm.marker.place = {0, 0, 0.008};
  arm.drive.toe.assign(arm.arm.tendons.size(), 2e-3);
  return arm;
}

/// What these recordings can tell.
inline constexpr const char* measured_names =
    "sections.bending,sections.angle,sections.compliance,sections.curvature,tendons.offset,tendons.toe,"
    "gravity,marker,base,tilt.x,tilt.y,lag";

}  // namespace sinew::test

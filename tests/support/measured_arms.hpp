/// @file measured_arms.hpp
/// Recordings of two arms, data/measured/, and the arms as their files have them.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "paths.hpp"
#include "sinew/analysis/identify.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "sinew/robot.hpp"

namespace sinew::test {

struct Recording {
  MeasuredRows rows;
  std::vector<std::string> labels;  ///< of each row, its block's
};

/// Rows of one pattern are a block.
inline Recording recording(const std::string& name) {
  const std::string path = std::string(source_folder) + "/data/measured/" + name + ".csv";
  const auto table = read_csv(path);
  if (!table) throw std::runtime_error(to_string(table.error()));
  auto rows = read_measured_rows(*table, *load(name)->arm(), path);
  if (!rows) throw std::runtime_error(to_string(rows.error()));
  std::vector<std::string> labels;
  for (const std::string& comment : table->comments)
    if (comment.starts_with("block ")) labels.push_back(comment.substr(comment.find(": ") + 2));
  Recording read{std::move(*rows), {}};
  for (const int block : read.rows.blocks) read.labels.push_back(labels.at(static_cast<std::size_t>(block)));
  return read;
}

/// As its file has it: the marker 8 mm beyond the tip, tendons soft at first.
inline MeasuredArm measured_arm(const std::string& name) { return measured(*load(name)->arm()); }

/// What these recordings can tell.
inline constexpr const char* measured_names =
    "sections.bending,sections.angle,sections.compliance,sections.curvature,tendons.offset,tendons.toe,"
    "gravity,marker,base,tilt.x,tilt.y,lag";

}  // namespace sinew::test

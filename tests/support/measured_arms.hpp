/// @file measured_arms.hpp
/// Recordings of two arms, data/measured/, and the arms as their files have them.
#pragma once
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "paths.hpp"
#include "sinew/analysis/identify.hpp"
#include "sinew/robot.hpp"

namespace sinew::test {

struct Recording {
  MeasuredRows rows;
  std::vector<std::string> labels;
};

/// Rows of one pattern are a block.
inline Recording recording(const std::string& name) {
  std::ifstream file(std::string(source_folder) + "/data/measured/" + name + ".csv");
  if (!file) throw std::runtime_error("missing data/measured/" + name + ".csv");
  Recording read;
  std::map<std::string, int> blocks;
  std::string line, cell;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    while (std::getline(cells, cell, ',')) row.push_back(cell);
    std::string label = row[1].substr(0, row[1].find("_hold"));
    read.rows.time.push_back(std::stod(row[0]));
    for (std::size_t i = 2; i < 11; ++i) read.rows.pulls.push_back(1e-3 * std::stod(row[i]));
    for (std::size_t i = 11; i < 14; ++i) read.rows.markers.push_back(1e-3 * std::stod(row[i]));
    read.rows.blocks.push_back(blocks.emplace(label, static_cast<int>(blocks.size())).first->second);
    read.labels.push_back(std::move(label));
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

/// @file posture_table.hpp
/// Postures of serial robots in tables: a row a posture, with a column `stage[m]` and two for each section,
/// `S0_beta_1[rad]`, `S0_beta_2[rad]`, ... of twin pivots, `S0_theta[rad]`, `S0_phi[rad]`, ... of neutral
/// backbones.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "sinew/io/table.hpp"
#include "sinew/kinematics/trajectory.hpp"

namespace sinew::inline v1 {

/// Names of a section's two angles, as `forward` takes them.
std::array<std::string, 2> bend_names(const Section& section, std::size_t number);

/// The angles themselves: of a neutral backbone how far it bends and where to.
std::array<double, 2> bend_angles(const Section& section, const Bend& bend);

/// The postures in a table, whatever else it has. Codes: `missing_column`, `no_rows`, `not_a_number`,
/// `wrong_dimension` (a unit of something else).
/// @param file names the table in errors
Expected<std::vector<SerialPosture>> read_postures(const Table& table, const SerialRobot& robot,
                                                   const std::string& file);

}  // namespace sinew::inline v1

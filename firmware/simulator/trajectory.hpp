/// @file trajectory.hpp
/// Poses over time from a CSV file, for the robot whose table the program was built with.
#pragma once

#include <filesystem>
#include <vector>

#include "protocol/arm.h"

namespace sinew::firmware {

struct Trajectory {
  struct Row {
    double time = 0;  ///< [s]
    Pose pose;        ///< bends, and the stage in counts
    /// Of all tendons and the stage, where the file has them.
    std::vector<std::int32_t> counts;
  };
  std::vector<Row> rows;
  bool has_counts = false, has_stage_counts = false;
};

/// Columns `time[s]`, `S0_beta_1[rad]`, `S0_beta_2[rad]`, `S1_beta_1[rad]`, ..., or for a neutral backbone
/// `S0_theta[rad]`, `S0_phi[rad]`; `stage_counts` and, of section 0 tendon 1, `S0_counts_1` may be there;
/// others are ignored. Lines that begin with `#` are comments. Throws std::runtime_error with line and
/// reason.
Trajectory read_trajectory(const std::filesystem::path& path);

}  // namespace sinew::firmware

/// @file driven.hpp
/// What a motor's counts become on their way to a tendon.
#pragma once
#include <vector>

#include "sinew/analysis/identify.hpp"

namespace sinew::inline v1::identification {

/// What the motors' counts become: after play and lag, and by what these change it.
struct Driven {
  std::vector<double> pulled, by_lag, by_play;  ///< rows × tendons

  Driven(const MeasuredRows& rows, int tendons, const TendonDrive& drive);
};

}  // namespace sinew::inline v1::identification

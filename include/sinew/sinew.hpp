/// @file sinew.hpp
/// Everything one needs to load a robot and put questions to it. The parts sinew::study and sinew::plan have
/// headers of their own: sinew/study/sweep.hpp, sinew/plan/insertion.hpp.
#pragma once
#include "sinew/batch.hpp"    // IWYU pragma: export
#include "sinew/robot.hpp"    // IWYU pragma: export
#include "sinew/session.hpp"  // IWYU pragma: export
#include "sinew/solve.hpp"    // IWYU pragma: export
#include "sinew/units.hpp"    // IWYU pragma: export

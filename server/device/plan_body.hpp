/// @file plan_body.hpp
/// A plan as a client sends it. What is wrong is told with its place; whether the arm can go there is the
/// panel's business.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "panel/plan.hpp"

namespace sinew::server::device {

struct PlanBody {
  std::string lease, robot;       ///< robot: the handle of its file
  std::optional<DrivePlan> plan;  ///< none: the one that is loaded is dropped
};

struct PlanBodyError {
  std::string code, where, message;
};

/// `{"lease", "robot", "name", "steps": [{"bends": [[b1, b2], ...], "stage": m}, ...], "clearance": [m,
/// ...]}`, or with neither name nor steps, or with `"steps": null`.
tl::expected<PlanBody, PlanBodyError> read_plan(const nlohmann::json& body);

}  // namespace sinew::server::device

/// @file progress.hpp
/// How far a question is, as the C interface and the server tell it.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>

#include "sinew/session.hpp"

namespace sinew::inline v1 {

/// `{"query": "progress", "busy", "part", "steps", "error"}`: without the last three before the first step.
inline nlohmann::ordered_json progress_json(bool is_busy, const std::optional<QuestionProgress>& so_far) {
  nlohmann::ordered_json json{{"query", "progress"}, {"busy", is_busy}};
  if (!so_far) return json;
  json["part"] = so_far->part;
  json["steps"] = so_far->steps;
  json["error"] = so_far->error;
  return json;
}

}  // namespace sinew::inline v1

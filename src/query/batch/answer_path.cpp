#include "query/batch/answer_path.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace sinew::inline v1 {

AnswerPath::AnswerPath(std::string_view path) {
  constexpr std::string_view count = ".count";
  if (path.ends_with(count)) {
    counts_ = true;
    path.remove_suffix(count.size());
  }
  while (!path.empty()) {
    if (path.front() == '.') path.remove_prefix(1);
    if (path.starts_with('[')) {
      const std::size_t end = std::min(path.find(']'), path.size());
      std::size_t index = 0;
      std::from_chars(path.data() + 1, path.data() + end, index);
      steps_.emplace_back(index);
      path.remove_prefix(std::min(end + 1, path.size()));
    } else {
      const std::size_t end = std::min(path.find_first_of(".["), path.size());
      steps_.emplace_back(std::string(path.substr(0, end)));
      path.remove_prefix(end);
    }
  }
}

const AnswerPath::Json* AnswerPath::find(const Json& answer) const {
  const Json* node = &answer;
  for (const auto& step : steps_) {
    if (const auto* key = std::get_if<std::string>(&step)) {
      if (!node->is_object()) return nullptr;
      const auto found = node->find(*key);
      if (found == node->end()) return nullptr;
      node = &*found;
    } else {
      const std::size_t index = std::get<std::size_t>(step);
      if (!node->is_array() || index >= node->size()) return nullptr;
      node = &(*node)[index];
    }
  }
  return node;
}

std::optional<double> AnswerPath::number(const Json& answer) const {
  const Json* node = find(answer);
  if (!node) return {};
  if (counts_) return node->is_array() ? std::optional<double>(node->size()) : std::nullopt;
  if (node->is_boolean()) return node->get<bool>() ? 1 : 0;
  if (node->is_number()) return node->get<double>();
  return {};
}

std::string_view unit_of_answer(std::string_view path) {
  // the last word of the path that has a unit, without its indices
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 32> units{{
      {"x", "m"},
      {"y", "m"},
      {"z", "m"},
      {"phi", "rad"},
      {"tilt", "rad"},
      {"azimuth", "rad"},
      {"torsion", "rad"},
      {"position", "m"},
      {"curvature", "1/m"},
      {"curvature_0", "1/m"},
      {"chord", "m"},
      {"tendon_lengths", "m"},
      {"base_tangent", "rad"},
      {"joint_angles", "rad"},
      {"length", "m"},
      {"force", "N"},
      {"force_0", "N"},
      {"moment", "N m"},
      {"moment_0", "N m"},
      {"tip", "m"},
      {"tip_angle", "rad"},
      {"energy", "J"},
      {"potential", "J"},
      {"slide", "m"},
      {"carriage", "m"},
      {"hinge_angle", "rad"},
      {"tensions", "N"},
      {"chord_force", "N"},
      {"changes", "m"},
      {"slack", "m"},
      {"margin", "m"},
      {"over_tension", "m"},
  }};
  if (path.ends_with(".count") || path.starts_with("indices.") || path.starts_with("type_2.screw")) return {};
  const std::size_t dot = path.rfind('.');
  std::string_view last = path.substr(dot == std::string_view::npos ? 0 : dot + 1);
  const bool has_index = last.find('[') != std::string_view::npos;
  last = last.substr(0, last.find('['));
  if (last == "base_tangent" && has_index) return {};  // in space a unit vector
  if (last == "configuration") return "rad";
  const auto found = std::ranges::find(units, last, [](const auto& unit) { return unit.first; });
  return found == units.end() ? std::string_view() : found->second;
}

}  // namespace sinew::inline v1

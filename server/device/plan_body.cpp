#include "plan_body.hpp"

#include <fmt/format.h>

#include <utility>

namespace sinew::server::device {
namespace {

using Json = nlohmann::json;
template <class T>
using Read = tl::expected<T, PlanBodyError>;

constexpr std::size_t longest_name = 100;  // [bytes]

auto wrong(std::string_view code, std::string where, std::string_view message) {
  return tl::unexpected(PlanBodyError{std::string(code), std::move(where), std::string(message)});
}

const Json& part(const Json& object, const char* key) {
  static const Json none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

std::string string_in(const Json& body, const char* key) {
  const Json& value = part(body, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

/// It stands in the log, a line of which it must not break.
Read<std::string> read_name(const Json& body) {
  std::string name = string_in(body, "name");
  if (name.empty() || name.size() > longest_name)
    return wrong("missing_key", "name", R"(give the plan a "name" of 1 to 100 bytes)");
  for (char& c : name)
    if (static_cast<unsigned char>(c) < ' ' || c == '"' || c == '\x7f') c = ' ';
  return name;
}

Read<Posture> read_step(const Json& json, std::size_t k) {
  const std::string where = fmt::format("steps[{}]", k);
  if (!json.is_object()) return wrong("not_an_object", where, R"(a step is {"bends": [...], "stage": m})");
  const Json &bends = part(json, "bends"), &stage = part(json, "stage");
  if (!bends.is_array())
    return wrong("missing_key", where, R"(give "bends", [[b1, b2], ...] of each section)");
  if (!stage.is_number()) return wrong("missing_key", where, R"(give "stage", a number of metres)");
  Posture step{{}, stage.get<double>()};
  for (const Json& pair : bends) {
    if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number() || !pair[1].is_number())
      return wrong("not_a_number", fmt::format("{}.bends[{}]", where, step.bends.size()),
                   "a bend is two numbers [rad]");
    step.bends.emplace_back(pair[0].get<double>(), pair[1].get<double>());
  }
  return step;
}

Read<std::vector<double>> read_clearance(const Json& json) {
  std::vector<double> values;
  if (json.is_null()) return values;
  if (!json.is_array())
    return wrong("not_a_list", "clearance", "clearance is a list, a number of metres a step");
  for (const Json& value : json) {
    if (!value.is_number())
      return wrong("not_a_number", fmt::format("clearance[{}]", values.size()), "give a number of metres");
    values.push_back(value.get<double>());
  }
  if (values.empty())
    return wrong("not_a_list", "clearance", "an empty list: leave it out where it is not known");
  return values;
}

Read<DrivePlan> read_steps(const Json& body) {
  const Json& steps = part(body, "steps");
  if (!steps.is_array())
    return wrong("missing_key", "steps",
                 R"(give "steps", a list; to drop the plan neither "steps" nor "name")");
  if (steps.size() > max_steps)
    return wrong("too_large", "steps", fmt::format("{} steps; at most {}", steps.size(), max_steps));
  auto name = read_name(body);
  if (!name) return tl::unexpected(name.error());
  DrivePlan plan{std::move(*name), {}, {}};
  for (std::size_t k = 0; k < steps.size(); ++k) {
    auto step = read_step(steps[k], k);
    if (!step) return tl::unexpected(step.error());
    plan.steps.push_back(std::move(*step));
  }
  auto clearance = read_clearance(part(body, "clearance"));
  if (!clearance) return tl::unexpected(clearance.error());
  plan.clearance = std::move(*clearance);
  return plan;
}

}  // namespace

Read<PlanBody> read_plan(const Json& body) {
  PlanBody read{string_in(body, "lease"), string_in(body, "robot"), {}};
  const bool is_dropped = body.contains("steps") ? body["steps"].is_null() : !body.contains("name");
  if (is_dropped) return read;
  auto plan = read_steps(body);
  if (!plan) return tl::unexpected(plan.error());
  read.plan = std::move(*plan);
  return read;
}

}  // namespace sinew::server::device

#include "plans.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "plan/plan_table.hpp"
#include "robots.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/plan/insertion.hpp"
#include "sinew/study/study.hpp"

namespace sinew::server {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json json_of(const Vec3<double>& v) { return {v[0], v[1], v[2]}; }

std::string_view name_of(InsertionVerdict verdict) {
  switch (verdict) {
    case InsertionVerdict::clear:
      return "clear";
    case InsertionVerdict::clear_if_taut:
      return "clear_if_taut";
    case InsertionVerdict::touches:
      break;
  }
  return "touches";
}

Json json_of(const InsertionScene& scene) {
  const SE3<double>& base = scene.base;
  const Vec3<double>& v = base.R.v;
  Json json{{"name", scene.name},
            {"base", {{"position", json_of(base.p)}, {"quaternion", {base.R.w, v[0], v[1], v[2]}}}},
            {"axis", json_of(scene.axis)},
            {"stage_limit", scene.stage_limit}};
  json["port"] = nullptr;
  if (scene.port)
    json["port"] = {{"position", json_of(scene.port->position)}, {"radius", scene.port->radius}};
  const InsertionTarget& target = scene.target;
  json["target"] = {{"tip", json_of(target.tip)}, {"direction", nullptr}, {"tolerance", target.tolerance}};
  if (target.direction) json["target"]["direction"] = json_of(*target.direction);
  json["margins"] = {{"clearance", scene.clearance}, {"model", scene.model_error}};
  json["solids"] = Json::array();
  for (const Mesh& mesh : scene.solids)
    json["solids"].push_back(
        {{"name", mesh.name}, {"vertices", mesh.vertices.size()}, {"triangles", mesh.triangles.size()}});
  return json;
}

/// What the first of the two numbers of each section is.
Json angle_names(const InsertionScene& scene) {
  Json names = Json::array();
  for (const Section& section : scene.robot.sections) names.push_back(section.is_twin() ? "beta_1" : "theta");
  return names;
}

Json json_of(const InsertionScene& scene, const std::vector<InsertionStep>& steps) {
  Json list = Json::array();
  for (const InsertionStep& step : steps) {
    Json row{{"stage", step.stage}, {"configuration", plan_angles(scene, step)}, {"limit", nullptr}};
    if (const std::string limit = exceeded_limit(scene, step); !limit.empty()) row["limit"] = limit;
    list.push_back(std::move(row));
  }
  return list;
}

Json json_of(const InsertionCheck& check) {
  Json steps = Json::array();
  for (const CheckedStep& step : check.steps) {
    Json row{{"clearance", step.spot.distance}, {"verdict", name_of(step.verdict)}};
    if (step.spot.solid >= 0)
      row.update({{"section", step.spot.section},
                  {"solid", step.spot.solid},
                  {"on_robot", json_of(step.spot.on_robot)},
                  {"on_solid", json_of(step.spot.on_solid)}});
    steps.push_back(std::move(row));
  }
  return {{"verdict", name_of(check.verdict)},
          {"clearance", check.clearance},
          {"worst", check.worst},
          {"allowed_share", check.allowed_share},
          {"off", {{"tendons", check.off.tendons}, {"sag", check.off.sag}, {"model", check.off.model}}},
          {"reach", InsertionCheckOptions{}.reach},
          {"steps", std::move(steps)}};
}

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

/// Corners of all solids as floats, then the corners of all triangles as numbers of these.
std::string bytes_of(const std::vector<Mesh>& solids) {
  std::string bytes;
  for (const Mesh& mesh : solids)
    for (const Vec3<double>& vertex : mesh.vertices)
      for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(vertex[k]));
  std::uint32_t first = 0;
  for (const Mesh& mesh : solids) {
    for (const auto& triangle : mesh.triangles)
      for (const int corner : triangle) append(bytes, first + static_cast<std::uint32_t>(corner));
    first += static_cast<std::uint32_t>(mesh.vertices.size());
  }
  return bytes;
}

/// The text of the robot of a scene: one that ships, or a file beside the scene.
Expected<std::string> robot_text(const InsertionScene& scene, const fs::path& file) {
  const auto known = builtin_robot_names();
  if (std::ranges::find(known, scene.robot_name) != known.end()) return read_robot_text(scene.robot_name);
  return read_robot_text((file.parent_path() / scene.robot_name).string());
}

struct Plan {
  std::string handle;
  std::vector<InsertionStep> steps;
  Json told;   ///< all that is known without the check
  Json check;  ///< null until it is done
};

Reply unknown_plan() {
  return refused(404, "unknown_plan", "plan",
                 "no plan has this handle; GET /api/plans lists those there are");
}

}  // namespace

struct Plans::State {
  const Plan* find(std::string_view handle) const {
    const auto found = std::ranges::find(plans, handle, &Plan::handle);
    return found == plans.end() ? nullptr : &*found;
  }
  void check();

  InsertionScene scene;
  std::string robot;  // its text
  std::shared_ptr<const std::string> meshes;
  std::vector<Plan> plans;
  std::atomic<bool> is_stopped = false;
  std::mutex mutex;  // of the checks
  std::jthread checker;
};

void Plans::State::check() {
  for (Plan& plan : plans) {
    InsertionCheckOptions options;
    options.threads = std::max(1U, std::thread::hardware_concurrency() / 2);
    options.stop = StopToken(is_stopped);
    Json json;
    try {
      const InsertionCheck check = check_insertion(scene, plan.steps, options);
      if (check.is_stopped) return;
      json = json_of(check);
    } catch (const std::exception& error) {  // of FCL, or of memory: the other plans and the server go on
      std::fprintf(stderr, "sinew serve: the check of a plan failed: %s\n", error.what());
      continue;
    }
    const std::lock_guard lock(mutex);
    plan.check = std::move(json);
  }
}

Plans::Plans() : state_(std::make_unique<State>()) {}
Plans::~Plans() { stop(); }

Expected<void> Plans::read(const std::string& scene, const std::vector<std::string>& files) {
  if (files.empty()) return {};
  auto loaded = load_scene(scene);
  if (!loaded) return tl::unexpected(loaded.error());
  state_->scene = std::move(*loaded);
  auto robot = robot_text(state_->scene, scene);
  if (!robot) return tl::unexpected(robot.error());
  state_->robot = std::move(*robot);
  state_->meshes = std::make_shared<const std::string>(bytes_of(state_->scene.solids));
  const Json told = json_of(state_->scene);
  for (const std::string& file : files) {
    const auto table = read_result(file);
    if (!table) return tl::unexpected(table.error());
    auto steps = plan_steps(*table, state_->scene, file);
    if (!steps) return tl::unexpected(steps.error());
    Json all{{"name", fs::path(file).stem().string()},        {"files", {{"scene", scene}, {"plan", file}}},
             {"robot", {{"name", state_->scene.robot_name}}}, {"scene", told},
             {"angles", angle_names(state_->scene)},          {"steps", json_of(state_->scene, *steps)}};
    std::string handle =
        handle_of(handle_of(text_of(all)) + handle_of(state_->robot) + handle_of(*state_->meshes));
    if (state_->find(handle)) continue;  // the same file twice
    state_->plans.push_back({std::move(handle), std::move(*steps), std::move(all), {}});
  }
  state_->checker = std::jthread([state = state_.get()] { state->check(); });
  return {};
}

Reply Plans::list() const {
  Json rows = Json::array();
  for (const Plan& plan : state_->plans)
    rows.push_back({{"plan", plan.handle},
                    {"name", plan.told["name"]},
                    {"scene", state_->scene.name},
                    {"robot", state_->scene.robot_name},
                    {"steps", plan.steps.size()}});
  return {200, text_of({{"plans", rows}, {"is_built", true}})};
}

Reply Plans::plan(std::string_view handle, const HandleOf& handle_of) const {
  const Plan* plan = state_->find(handle);
  if (!plan) return unknown_plan();
  Json json = plan->told;
  json["robot"]["robot"] = handle_of(state_->robot);
  json["robot"]["text"] = state_->robot;
  const std::lock_guard lock(state_->mutex);
  json["check"] = plan->check;
  return {200, text_of(json)};
}

Reply Plans::meshes(std::string_view handle) const {
  if (!state_->find(handle)) return unknown_plan();
  return {200, {}, "application/octet-stream", state_->meshes};
}

void Plans::stop() { state_->is_stopped = true; }

}  // namespace sinew::server

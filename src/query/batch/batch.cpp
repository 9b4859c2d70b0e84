#include "sinew/query/batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <thread>
#include <vector>

#include "io/quantity.hpp"
#include "query/batch/answer_path.hpp"
#include "query/batch/placeholders.hpp"
#include "query/batch/sampler.hpp"
#include "query/tree_session.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {
namespace {

/// Where a number stands: `pose.position[2]`.
void collect(const Node& node, const std::string& path,
             std::vector<std::pair<std::string, std::string>>& found) {
  if (node.kind == Node::Kind::string && node.text.starts_with('$')) {
    const std::string name = node.text.substr(1);
    if (std::ranges::find(found, name, &std::pair<std::string, std::string>::first) == found.end())
      found.emplace_back(name, path);
  }
  for (std::size_t i = 0; i < node.items.size(); ++i)
    collect(node.items[i], fmt::format("{}[{}]", path, i), found);
  for (const Member& member : node.members)
    collect(member.value, path.empty() ? member.key : path + '.' + member.key, found);
}

/// Of a place of a question or an answer; of inputs it is the robot's.
std::string unit_of_place(const Robot& robot, std::string_view path) {
  if (path.starts_with("inputs[") && !robot.serial()) {
    const auto inputs = inputs_of(robot);
    const auto index = static_cast<std::size_t>(std::atoi(path.data() + 7));
    return index < inputs.size() ? std::string(unit(inputs[index].kind.dimension)) : std::string();
  }
  if (path.starts_with("wrench[") || path.starts_with("until.wrench[")) {
    const int index = std::atoi(path.data() + path.rfind('[') + 1);
    return index < (robot.planar() ? 2 : 3) ? "N" : "N m";
  }
  return std::string(unit_of_answer(path));
}

/// What people ask a question for.
std::vector<std::pair<std::string, std::string>> usual_outputs(const Robot& robot, std::string_view query) {
  std::vector<std::pair<std::string, std::string>> usual;
  const auto add_pose = [&](const std::string& place) {
    constexpr std::string_view axes[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i)
      usual.emplace_back(axes[i], robot.planar() ? fmt::format("{}.{}", place, i == 2 ? "phi" : axes[i])
                                                 : fmt::format("{}.position[{}]", place, i));
    if (robot.planar()) usual.back().first = "phi";
    for (int i = 0; i < 4 && !robot.planar(); ++i)
      usual.emplace_back(fmt::format("e{}", i), fmt::format("{}.quaternion[{}]", place, i));
  };
  if (const SerialRobot* serial = robot.serial()) {
    add_pose("tip");
    for (std::size_t m = 0; m < serial->sections.size(); ++m)
      for (int i = 0; i < serial->sections[m].tendons; ++i)
        usual.emplace_back(fmt::format("changes_{}_{}", m, i), fmt::format("changes[{}][{}]", m, i));
  } else if (query == "velocity") {
    if (!has_rods(robot)) usual.emplace_back("determinant", "determinant");
    for (const char* index : {"position", "rotation"})
      usual.emplace_back(index, fmt::format("indices.{}", index));
  } else if (query == "inverse") {
    for (int k = 0; k < input_count(robot); ++k)
      usual.emplace_back(fmt::format("inputs_{}", k), fmt::format("inputs[{}]", k));
  } else {
    add_pose("pose");
  }
  return usual;
}

/// What a thread computes a chunk in.
struct Memory {
  std::vector<double> inputs, outputs;
  std::vector<SampleStatus> statuses;
};

std::uint8_t status_of(SampleStatus status) {
  if (status == not_computed) return static_cast<std::uint8_t>(Status::stopped);
  if (status == refused) return static_cast<std::uint8_t>(Status::bad_input);
  if (status == failed_inside) return Batch::failed;
  return status;
}

}  // namespace

struct Batch::State {
  BatchQuestion question;
  std::vector<Column> inputs, outputs;
  SamplerKind kind;
};

Batch::Batch(std::shared_ptr<const State> state) : state_(std::move(state)) {}

Expected<Batch> Batch::prepare(const Document& robot, const Document& asked) {
  const auto read = read_robot(robot);
  if (!read) return tl::unexpected(read.error());
  State state{
      {.robot = robot, .query = {"query", {}}, .inputs = {}, .outputs = {}, .is_path = false}, {}, {}, {}};
  Errors errors;
  Reader reader(asked, errors);
  if (!reader.is(Node::Kind::map))
    return failure("wrong_type", "query", "give the fields of a query as a map");
  if (const auto path = reader.optional("path"))
    state.question.is_path = path->choice({"continue", "anew"}) == "continue";
  std::vector<std::pair<std::string, std::string>> outputs;
  if (const auto named = reader.optional("outputs"))
    for (auto& [name, place] : named->members()) outputs.emplace_back(name, place.text());
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  state.question.query.root.kind = Node::Kind::map;
  for (const Member& field : asked.root.members)
    if (field.key != "path" && field.key != "outputs") state.question.query.root.members.push_back(field);
  std::vector<std::pair<std::string, std::string>> inputs;
  collect(state.question.query.root, "", inputs);
  if (inputs.empty())
    return failure("no_inputs", "query", "no column goes in: write texts like \"$x\" where its numbers go");
  for (const auto& [name, place] : inputs) {
    state.question.inputs.push_back(name);
    state.inputs.push_back({name, unit_of_place(*read, place)});
  }
  const Node* query = state.question.query.root.find("query");
  if (outputs.empty())
    outputs = usual_outputs(*read, query ? std::string_view(query->text) : std::string_view());
  for (const auto& [name, place] : outputs) {
    state.question.outputs.push_back(place);
    state.outputs.push_back({name, unit_of_place(*read, place)});
  }
  state.kind = choose_sampler(state.question);
  return Batch(std::make_shared<const State>(std::move(state)));
}

std::span<const Batch::Column> Batch::inputs() const { return state_->inputs; }
std::span<const Batch::Column> Batch::outputs() const { return state_->outputs; }
std::string_view Batch::method() const { return state_->kind.name; }

void Batch::run(std::size_t rows, std::span<const Strided<const double>> inputs,
                std::span<const Strided<double>> outputs, std::span<std::uint8_t> statuses,
                const Options& options) const {
  if (inputs.size() != state_->inputs.size() || outputs.size() != state_->outputs.size() ||
      (!statuses.empty() && statuses.size() != rows) || rows == 0)
    return;
  const std::size_t size = chunk_size(state_->kind, rows), chunks = (rows + size - 1) / size;
  const std::atomic<bool> never{false};
  const std::atomic<bool>& stop = options.stop ? *options.stop : never;
  std::atomic<std::size_t> next{0}, done{0};
  const auto compute = [&](const Sampler& sample, std::size_t first, std::size_t count, Memory& memory) {
    memory.inputs.resize(inputs.size() * count);
    memory.outputs.assign(outputs.size() * count, not_a_number);
    memory.statuses.assign(count, not_computed);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      for (std::size_t k = 0; k < count; ++k) memory.inputs[i * count + k] = inputs[i][first + k];
    if (!stop) sample({count, memory.inputs, memory.outputs, memory.statuses, &done, &stop});
    for (std::size_t o = 0; o < outputs.size(); ++o)
      for (std::size_t k = 0; k < count; ++k) outputs[o][first + k] = memory.outputs[o * count + k];
    for (std::size_t k = 0; k < count && !statuses.empty(); ++k)
      statuses[first + k] = status_of(memory.statuses[k]);
  };
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t wanted =
      std::min(options.threads > 0 ? static_cast<std::size_t>(options.threads) : cores, chunks);
  std::vector<std::exception_ptr> thrown(wanted);
  const auto work = [&](std::size_t thread) {
    try {
      const Sampler sample = state_->kind.make();
      Memory memory;
      for (std::size_t c = next++; c < chunks; c = next++)
        compute(sample, c * size, std::min(size, rows - c * size), memory);
    } catch (...) {
      thrown[thread] = std::current_exception();
      next = chunks;
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t t = 1; t < wanted; ++t) others.emplace_back(work, t);
    work(0);
  }
  for (const std::exception_ptr& one : thrown)
    if (one) std::rethrow_exception(one);
}

std::string Batch::answer(std::span<const double> inputs) const {
  Document query = state_->question.query;
  for (const Placeholder& place : placeholders(query.root, state_->question.inputs))
    if (*place.input < inputs.size()) put(*place.node, inputs[*place.input]);
  auto session = TreeSession::open(state_->question.robot);
  return session ? session->answer(query).json() : std::string();
}

}  // namespace sinew::inline v1

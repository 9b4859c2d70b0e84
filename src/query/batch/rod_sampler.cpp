/// Forward kinematics of robots on rods, for questions that vary the inputs and ask for the pose.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "query/batch/row_places.hpp"
#include "query/rods/rod_question.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::array<std::string_view, 8> paths{
    "pose.position[0]",   "pose.position[1]",   "pose.position[2]",   "pose.quaternion[0]",
    "pose.quaternion[1]", "pose.quaternion[2]", "pose.quaternion[3]", "residual"};
constexpr std::size_t residual = 7;

struct AskedRods {
  Robot robot;
  std::vector<RowNumber> inputs;
  SpatialWrench wrench;
  RowStart start;
  std::vector<std::size_t> outputs = {};  ///< which of the paths

  std::size_t first_input() const { return static_cast<std::size_t>(inputs.front().input); }
};

class RodSampler {
 public:
  explicit RodSampler(std::shared_ptr<const AskedRods> asked) : shared_(std::move(asked)), work_(robot_) {}

  void operator()(const SampleBlock& block) {
    poses_.resize(block.count);
    statuses_.resize(block.count);
    residuals_.resize(block.count);
    work_.stop = StopToken(*block.stop);
    equilibrium_batch(robot_, rows_of(block), asked_.wrench, poses_, statuses_, work_, true, residuals_,
                      asked_.start);
    for (std::size_t k = 0; k < block.count; ++k) put(block, k);
    *block.done += block.count;
  }

 private:
  /// A query would not take others.
  bool has_numbers(const SampleBlock& block, std::size_t k) const {
    return std::ranges::all_of(asked_.inputs,
                               [&](const RowNumber& entry) { return entry.is_taken(entry.at(block, k)); });
  }
  /// As they lie in memory where the inputs of a row do, one after the other.
  Numbers rows_of(const SampleBlock& block) {
    const std::size_t inputs = asked_.inputs.size();
    if (is_in_rows(block)) return {&block.inputs[asked_.first_input()][block.first], block.count * inputs};
    rows_.resize(block.count * inputs);
    for (std::size_t k = 0; k < block.count; ++k)
      for (std::size_t i = 0; i < inputs; ++i) rows_[k * inputs + i] = asked_.inputs[i].at(block, k);
    return rows_;
  }
  bool is_in_rows(const SampleBlock& block) const {
    const auto stride = static_cast<std::ptrdiff_t>(asked_.inputs.size() * sizeof(double));
    for (std::size_t i = 0; i < asked_.inputs.size(); ++i) {
      if (asked_.inputs[i].input < 0) return false;
      const auto& column = block.inputs[static_cast<std::size_t>(asked_.inputs[i].input)];
      if (column.stride != stride || column.data != block.inputs[asked_.first_input()].data + i) return false;
    }
    return true;
  }

  void put(const SampleBlock& block, std::size_t k) {
    const SpatialPose& pose = poses_[k];
    const bool is_solved = statuses_[k] == Status::converged || statuses_[k] == Status::unstable;
    for (std::size_t o = 0; o < asked_.outputs.size(); ++o) {
      const std::size_t which = asked_.outputs[o];
      block.output(o, k) = !is_solved          ? not_a_number
                           : which == residual ? residuals_[k]
                           : which < 3         ? pose.position[static_cast<Eigen::Index>(which)]
                                               : pose.quaternion[which - 3];
    }
    block.statuses[k] = has_numbers(block, k) ? sample_status(statuses_[k]) : refused;
  }

  std::shared_ptr<const AskedRods> shared_;
  const AskedRods& asked_ = *shared_;
  const Robot& robot_ = asked_.robot;
  Workspace work_;
  std::vector<double> rows_, residuals_;
  std::vector<SpatialPose> poses_;
  std::vector<Status> statuses_;
};

}  // namespace

SamplerKind plan_rods(Context& context, const RowPlaces& rows) {
  if (context.ask != Ask::forward || !has_equilibrium_batch(context.robot)) return {};
  RodQuestion question(context);
  question.read();
  const EquilibriumOptions& options = question.at.options;
  const bool is_plain = question.is_read() && !context.max_iterations && !question.names_start &&
                        !options.gravity && !question.until && !question.wants_all &&
                        question.wanted.words == usual_of(context.ask);
  if (!is_plain || !rows.are_within({"inputs"})) return {};
  AskedRods asked{.robot = context.robot,
                  .inputs = rows.numbers("inputs", question.at.inputs),
                  .wrench = options.wrench,
                  .start = rows.is_path() ? RowStart::row_before : RowStart::home};
  for (const std::string& output : rows.outputs()) {
    const auto path = std::ranges::find(paths, output);
    if (path == paths.end()) return {};
    asked.outputs.push_back(static_cast<std::size_t>(path - paths.begin()));
  }
  return sampler_kind<RodSampler>("rods in lanes", {1024, 8192}, std::move(asked));
}

}  // namespace sinew::inline v1

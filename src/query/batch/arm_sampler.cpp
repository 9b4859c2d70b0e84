/// Equilibria of arms under load, for questions that vary what holds the tendons and the wrench at the tip:
/// rows without their questions and answers, and without making the arm's rods anew for every chunk. On a
/// path each row begins where the one before it ended, if that was solved; else, and where rows begin anew,
/// at the straight arm, as a chunk's first row does.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>

#include "kinematics/arms/arm_lanes.hpp"
#include "query/arms/arm_question.hpp"
#include "query/batch/row_places.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {
namespace {

/// A number of an arm's state.
struct ArmOutput {
  enum Of { position, quaternion, tensions, changes, slack, potential, residual, resolution, iterations } of;
  std::size_t number = 0;  ///< of the tendon among all, or of the place's or quaternion's numbers
};

struct AskedArm {
  Arm arm;
  ArmOptions options;
  ArmLoad load;  ///< what is the same in all rows
  bool is_path;
  std::vector<TendonHeld> held = {};    ///< of every tendon
  std::vector<RowNumber> tendons = {};  ///< what they are held at
  std::vector<RowNumber> wrench = {};
  std::vector<ArmOutput> outputs = {};
};

std::optional<ArmOutput> output_of(const std::string& path, const Arm& arm) {
  const std::array<std::pair<const char*, ArmOutput::Of>, 4> single{{{"potential", ArmOutput::potential},
                                                                     {"residual", ArmOutput::residual},
                                                                     {"resolution", ArmOutput::resolution},
                                                                     {"iterations", ArmOutput::iterations}}};
  for (const auto& [name, of] : single)
    if (path == name) return ArmOutput{of};
  const auto indices = [&](const char* form, unsigned* first, unsigned* second) {
    int end = 0;
    const bool found = second ? std::sscanf(path.c_str(), form, first, second, &end) == 2
                              : std::sscanf(path.c_str(), form, first, &end) == 1;
    return found && static_cast<std::size_t>(end) == path.size();
  };
  unsigned a = 0, b = 0;
  if (indices("tip.position[%u]%n", &a, nullptr) && a < 3) return ArmOutput{ArmOutput::position, a};
  if (indices("tip.quaternion[%u]%n", &a, nullptr) && a < 4) return ArmOutput{ArmOutput::quaternion, a};
  const auto counts = tendon_counts(arm);
  const std::array<std::pair<const char*, ArmOutput::Of>, 3> lists{
      {{"tensions[%u][%u]%n", ArmOutput::tensions},
       {"changes[%u][%u]%n", ArmOutput::changes},
       {"slack[%u][%u]%n", ArmOutput::slack}}};
  for (const auto& [form, of] : lists) {
    if (!indices(form, &a, &b)) continue;
    if (a >= counts.size() || b >= counts[a]) return {};
    std::size_t number = b;
    for (unsigned m = 0; m < a; ++m) number += counts[m];
    return ArmOutput{of, number};
  }
  return {};
}

/// Rows of a path that follow one another, each stretch in a lane.
constexpr std::size_t path_stretch = 32;
/// Fewer rows, or stretches, than this are quicker one after the other.
constexpr std::size_t least_in_lanes = 4;

bool fits_lanes(const AskedArm& asked) {
  const ArmLoad& load = asked.load;
  const auto is_none = [](std::span<const double> values) {
    return std::ranges::all_of(values, [](double x) { return x == 0; });
  };
  return ArmLanes::fits(asked.arm, asked.options) && load.points.empty() && !load.gravity &&
         is_none(load.following) && is_none(load.along) && is_none(load.following_along) &&
         std::ranges::all_of(asked.held, [](TendonHeld held) { return held == TendonHeld::tension; });
}

class ArmSampler {
 public:
  explicit ArmSampler(std::shared_ptr<const AskedArm> asked)
      : asked_(std::move(asked)),
        work_(asked_->arm),
        commands_(asked_->arm.tendons.size()),
        load_(asked_->load) {
    if (fits_lanes(*asked_)) lanes_ = std::make_unique<ArmLanes>(asked_->arm, asked_->options);
  }

  void operator()(const SampleBlock& block) {
    if (lanes_ && block.count > (least_in_lanes - 1) * (asked_->is_path ? path_stretch : 1)) {
      in_lanes(block);
      return;
    }
    work_.stop = StopToken(*block.stop);
    bool follows = false;
    for (std::size_t k = 0; k < block.count && !*block.stop; ++k, ++*block.done) {
      clear(block, k);
      try {
        if (!take(block, k, commands_, load_)) {
          block.statuses[k] = refused;
          follows = false;
          continue;
        }
        const ArmState& state = solve(follows);
        tell(block, k, state);
        follows = asked_->is_path && state.report.ok();
      } catch (const std::exception&) {
        block.statuses[k] = failed_inside;
        follows = false;
      }
    }
  }

 private:
  void in_lanes(const SampleBlock& block) {
    for (std::size_t k = 0; k < block.count; ++k) {
      clear(block, k);
      block.statuses[k] = not_computed;
    }
    try {
      lanes_->solve(
          block.count, asked_->is_path ? path_stretch : 1,
          [&](std::size_t k, std::span<TendonCommand> commands, ArmLoad& load) {
            return take(block, k, commands, load);
          },
          [&](std::size_t k, const ArmState* state) {
            if (state)
              tell(block, k, *state);
            else
              block.statuses[k] = refused;
            ++*block.done;
          },
          StopToken(*block.stop));
    } catch (const std::exception&) {
      for (std::size_t k = 0; k < block.count; ++k)
        if (block.statuses[k] == not_computed) block.statuses[k] = failed_inside;
      lanes_ = std::make_unique<ArmLanes>(asked_->arm, asked_->options);
    }
  }

  void clear(const SampleBlock& block, std::size_t k) const {
    for (std::size_t o = 0; o < asked_->outputs.size(); ++o) block.output(o, k) = not_a_number;
  }
  void tell(const SampleBlock& block, std::size_t k, const ArmState& state) const {
    const Status status = state.report.status;
    if (status != Status::bad_input && status != Status::unsupported) put(block, k, state);
    block.statuses[k] = status == Status::unsupported ? not_supported : sample_status(status);
  }

  /// The numbers of a row; false where a query would not take them.
  bool take(const SampleBlock& block, std::size_t k, std::span<TendonCommand> commands, ArmLoad& load) const {
    bool is_taken = true;
    const auto number = [&](const RowNumber& entry) {
      const double value = entry.at(block, k);
      is_taken = is_taken && entry.is_taken(value);
      return value;
    };
    for (std::size_t i = 0; i < commands.size(); ++i)
      commands[i] = {asked_->held[i], number(asked_->tendons[i])};
    for (std::size_t i = 0; i < 6; ++i) load.wrench[i] = number(asked_->wrench[i]);
    return is_taken;
  }

  /// Where the row before it leads to nothing that holds, from the straight arm.
  const ArmState& solve(bool follows) {
    ArmOptions options = asked_->options;
    options.from_last = follows;
    const ArmState& state = arm_forward(asked_->arm, commands_, load_, options, work_);
    if (!follows || state.report.ok() || state.report.status == Status::stopped) return state;
    options.from_last = false;
    return arm_forward(asked_->arm, commands_, load_, options, work_);
  }

  void put(const SampleBlock& block, std::size_t k, const ArmState& state) const {
    const SpatialPose tip = spatial_pose(state.tip);
    for (std::size_t o = 0; o < asked_->outputs.size(); ++o) {
      const auto [of, i] = asked_->outputs[o];
      const auto value = [&, of = of, i = i] {
        switch (of) {
          case ArmOutput::position:
            return tip.position[static_cast<Eigen::Index>(i)];
          case ArmOutput::quaternion:
            return tip.quaternion[i];
          case ArmOutput::tensions:
            return state.tensions[i];
          case ArmOutput::changes:
            return state.changes[i];
          case ArmOutput::slack:
            return state.slack[i];
          case ArmOutput::potential:
            return state.energy;
          case ArmOutput::residual:
            return state.report.residual;
          case ArmOutput::resolution:
            return state.resolution > 0 ? state.resolution : not_a_number;
          case ArmOutput::iterations:
            return static_cast<double>(state.report.iterations);
        }
        return not_a_number;
      }();
      block.output(o, k) = std::isfinite(value) ? value : not_a_number;
    }
  }

  std::shared_ptr<const AskedArm> asked_;
  ArmWorkspace work_;
  std::vector<TendonCommand> commands_;
  ArmLoad load_;
  std::unique_ptr<ArmLanes> lanes_;  ///< if the question fits them
};

}  // namespace

SamplerKind plan_arms(Context& of_robot, const RowPlaces& rows) {
  if (of_robot.ask != Ask::forward) return {};
  ArmQuestion<Arm> question(of_robot);
  question.read();
  const bool is_plain = question.is_read() && !question.query.has("start") && !question.until &&
                        !question.wants_all && question.words == usual_of(question.ask);
  if (!is_plain || !rows.are_within({"tensions", "changes", "wrench"})) return {};
  AskedArm asked{.arm = question.robot,
                 .options = question.options.arm,
                 .load = question.load,
                 .is_path = rows.is_path()};
  std::vector<std::size_t> next(question.robot.sections.size());
  for (std::size_t i = 0; i < question.commands.size(); ++i) {
    const auto& [held, value] = question.commands[i];
    const auto section = static_cast<std::size_t>(question.robot.tendons[i].section());
    const std::string_view list = held == TendonHeld::tension ? "tensions" : "changes";
    asked.held.push_back(held);
    asked.tendons.push_back(
        rows.number(joined(joined(list, section), next[section]++), value, range_of(held)));
  }
  asked.wrench = rows.numbers("wrench", question.load.wrench);
  for (const std::string& output : rows.outputs()) {
    const auto found = output_of(output, asked.arm);
    if (!found) return {};
    asked.outputs.push_back(*found);
  }
  if (!fits_lanes(asked)) return sampler_kind<ArmSampler>("arms row by row", {32, 512}, std::move(asked));
  const std::size_t least = asked.is_path ? 2048 : 256;
  return sampler_kind<ArmSampler>("arms in lanes", {least, 4096}, std::move(asked));
}

}  // namespace sinew::inline v1

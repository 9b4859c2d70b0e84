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

#include "io/arm_file.hpp"
#include "query/batch/query_entries.hpp"
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
  std::vector<TendonHeld> held;     ///< of every tendon
  std::vector<QueryEntry> tendons;  ///< what they are held at; none given: 0
  std::array<QueryEntry, 6> wrench{};
  ArmOptions options = {};
  bool is_path = false;
  std::vector<ArmOutput> outputs;
};

std::vector<std::size_t> counts_of(const Arm& arm) {
  std::vector<std::size_t> counts(arm.sections.size());
  for (const ArmTendon& tendon : arm.tendons) ++counts[static_cast<std::size_t>(tendon.section())];
  return counts;
}

/// `tensions` or `changes`, lists of sections; what is left out or null is not given.
std::optional<std::vector<std::optional<QueryEntry>>> per_tendon(const Node& list,
                                                                 const BatchQuestion& question,
                                                                 const Arm& arm) {
  const auto counts = counts_of(arm);
  if (list.kind != Node::Kind::list || list.items.size() > counts.size()) return {};
  std::vector<std::optional<QueryEntry>> values;
  for (std::size_t m = 0; m < counts.size(); ++m) {
    const Node* section = m < list.items.size() ? &list.items[m] : nullptr;
    if (section && section->kind == Node::Kind::null) section = nullptr;
    if (section && (section->kind != Node::Kind::list || section->items.size() != counts[m])) return {};
    for (std::size_t i = 0; i < counts[m]; ++i) {
      values.emplace_back();
      if (!section || section->items[i].kind == Node::Kind::null) continue;
      values.back() = query_entry(section->items[i], question);
      if (!values.back()) return {};
    }
  }
  return values;
}

bool read_tendons(const BatchQuestion& question, const Node* tensions, const Node* changes, AskedArm& asked) {
  const std::size_t count = asked.arm.tendons.size();
  asked.held.assign(count, changes && !tensions ? TendonHeld::change : TendonHeld::tension);
  asked.tendons.assign(count, {});
  std::vector<bool> given(count);
  const auto take = [&](const Node* list, TendonHeld held) {
    if (!list) return true;
    const auto values = per_tendon(*list, question, asked.arm);
    if (!values) return false;
    for (std::size_t i = 0; i < count; ++i) {
      if (!(*values)[i]) continue;
      if (given[i]) return false;  // the query says so
      given[i] = true;
      asked.held[i] = held;
      asked.tendons[i] = *(*values)[i];
    }
    return true;
  };
  return take(tensions, TendonHeld::tension) && take(changes, TendonHeld::change);
}

std::optional<ArmModel> model_of(std::string_view word) {
  if (word == "rod") return ArmModel::rod;
  if (word == "subsegment_rod") return ArmModel::subsegment_rod;
  if (word == "subsegment_cc") return ArmModel::subsegment_cc;
  if (word == "cc") return ArmModel::cc;
  if (word == "prb") return ArmModel::prb;
  return {};
}

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
  const auto counts = counts_of(arm);
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

/// What such a question asks, if it is one: its numbers are those that a query would take.
std::optional<AskedArm> asked_of_arm(const BatchQuestion& question) {
  if (!is_arm(question.robot)) return {};
  auto arm = read_arm(question.robot);
  if (!arm) return {};
  AskedArm asked{.arm = std::move(*arm), .held = {}, .tendons = {}, .outputs = {}};
  asked.is_path = question.is_path;
  const Node *tensions = nullptr, *changes = nullptr;
  const auto number = [&](const Node& node) {
    const auto entry = query_entry(node, question);
    return entry && entry->input < 0 ? std::optional(entry->value) : std::nullopt;
  };
  for (const Member& field : question.query.root.members) {
    const std::string_view key = field.key;
    const Node& value = field.value;
    if (key == "query") {
      if (value.text != "forward") return {};
    } else if (key == "tensions") {
      tensions = &value;
    } else if (key == "changes") {
      changes = &value;
    } else if (key == "wrench") {
      const auto entries = query_entries(value, question);
      if (!entries || entries->size() != 6) return {};
      std::copy(entries->begin(), entries->end(), asked.wrench.begin());
    } else if (key == "model") {
      const auto model = model_of(value.text);
      if (value.kind != Node::Kind::string || !model) return {};
      asked.options.model = *model;
    } else if (key == "accuracy") {
      const auto given = number(value);
      if (!given || !(*given >= 0 && *given <= 1)) return {};
      asked.options.accuracy = *given;
    } else {
      return {};
    }
  }
  if (!read_tendons(question, tensions, changes, asked)) return {};
  for (const std::string& output : question.outputs) {
    const auto found = output_of(output, asked.arm);
    if (!found) return {};
    asked.outputs.push_back(*found);
  }
  return asked;
}

class ArmSampler {
 public:
  explicit ArmSampler(std::shared_ptr<const AskedArm> asked)
      : asked_(std::move(asked)),
        work_(asked_->arm),
        commands_(asked_->arm.tendons.size()) {}

  void operator()(const SampleBlock& block) {
    work_.stop = StopToken(*block.stop);
    bool follows = false;
    for (std::size_t k = 0; k < block.count && !*block.stop; ++k, ++*block.done) {
      for (std::size_t o = 0; o < asked_->outputs.size(); ++o) block.output(o, k) = not_a_number;
      try {
        if (!take(block, k)) {
          block.statuses[k] = refused;
          follows = false;
          continue;
        }
        const ArmState& state = solve(follows);
        const Status status = state.report.status;
        if (status != Status::bad_input && status != Status::unsupported) put(block, k, state);
        block.statuses[k] = status == Status::unsupported ? not_supported : sample_status(status);
        follows = asked_->is_path && status == Status::converged;
      } catch (const std::exception&) {
        block.statuses[k] = failed_inside;
        follows = false;
      }
    }
  }

 private:
  /// The numbers of a row; false where a query would not take them.
  bool take(const SampleBlock& block, std::size_t k) {
    constexpr double most = 1e9;
    for (std::size_t i = 0; i < commands_.size(); ++i) {
      const double value = asked_->tendons[i].at(block, k);
      if (!(value >= (asked_->held[i] == TendonHeld::tension ? 0 : -most) && value <= most)) return false;
      commands_[i] = {asked_->held[i], value};
    }
    for (std::size_t i = 0; i < 6; ++i) {
      load_.wrench[i] = asked_->wrench[i].at(block, k);
      if (!std::isfinite(load_.wrench[i])) return false;
    }
    return true;
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

  void put(const SampleBlock& block, std::size_t k, const ArmState& state) {
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
};

}  // namespace

SamplerKind arm_sampler(const BatchQuestion& question) {
  auto asked = asked_of_arm(question);
  if (!asked) return {};
  const auto shared = std::make_shared<const AskedArm>(std::move(*asked));
  return {.name = "arms row by row", .chunks = {32, 512}, .make = [shared]() -> Sampler {
            return [sampler = std::make_shared<ArmSampler>(shared)](const SampleBlock& block) {
              (*sampler)(block);
            };
          }};
}

}  // namespace sinew::inline v1

/// Configurations of serial robots, for questions that vary them: tendon changes in lanes, ends of sections
/// one by one.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <variant>

#include "query/batch/row_places.hpp"
#include "query/serial/serial.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {
namespace {

/// A number of the pose of a section's end: x, y, z, and of the quaternion w, x, y, z.
struct EndNumber {
  std::size_t section, number;
};
using SerialOutput = std::variant<std::size_t, EndNumber>;  ///< or of the change of a tendon, among all

struct AskedSections {
  SerialRobot robot;
  kernel::Model model;
  std::vector<std::array<RowNumber, 2>> configuration =
      {};  ///< of all sections; those not given are straight
  std::vector<SerialOutput> outputs = {};

  bool has_ends() const {
    return std::ranges::any_of(outputs, [](const auto& o) { return std::holds_alternative<EndNumber>(o); });
  }
};

/// The two numbers that a path has in the places of %u.
std::optional<std::array<unsigned, 2>> indices_in(const std::string& path, const std::string& form) {
  std::array<unsigned, 2> found = {};
  int end = 0;
  if (std::sscanf(path.c_str(), (form + "%n").c_str(), &found[0], &found[1], &end) != 2 ||
      static_cast<std::size_t>(end) != path.size())
    return {};
  return found;
}

/// `changes[2][0]` as the number of the tendon among all.
std::optional<std::size_t> tendon_of(const std::string& path, const SerialRobot& robot) {
  const auto found = indices_in(path, "changes[%u][%u]");
  if (!found) return {};
  const auto [section, tendon] = *found;
  if (section >= robot.sections.size() || tendon >= static_cast<unsigned>(robot.sections[section].tendons))
    return {};
  std::size_t first = 0;
  for (unsigned m = 0; m < section; ++m) first += static_cast<std::size_t>(robot.sections[m].tendons);
  return first + tendon;
}

/// `sections[1].position[0]`, or of the tip, the last of them: `tip.position[0]`.
std::optional<EndNumber> end_number_of(const std::string& path, const SerialRobot& robot) {
  const std::size_t last = robot.sections.size() - 1;
  const std::string_view tip = "tip.";
  const std::string of_section =
      path.starts_with(tip) ? fmt::format("sections[{}].{}", last, path.substr(tip.size())) : path;
  if (const auto found = indices_in(of_section, "sections[%u].position[%u]");
      found && (*found)[0] <= last && (*found)[1] < 3)
    return EndNumber{(*found)[0], (*found)[1]};
  if (const auto found = indices_in(of_section, "sections[%u].quaternion[%u]");
      found && (*found)[0] <= last && (*found)[1] < 4)
    return EndNumber{(*found)[0], 3 + (*found)[1]};
  return {};
}

class SerialSampler {
 public:
  explicit SerialSampler(std::shared_ptr<const AskedSections> asked)
      : asked_(std::move(asked)),
        has_ends_(asked_->has_ends()),
        work_(asked_->robot) {}

  void operator()(const SampleBlock& block) {
    const std::size_t sections = asked_->robot.sections.size(), n = block.count;
    bends_.resize(2 * sections * n);
    changes_.resize(work_.changes.size() * n);
    is_taken_.assign(n, true);
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t m = 0; m < sections; ++m) {
        const auto& [first, second] = asked_->configuration[m];
        const std::array<double, 2> angles{first.at(block, k), second.at(block, k)};
        is_taken_[k] = is_taken_[k] && first.is_taken(angles[0]) && second.is_taken(angles[1]);
        work_.bends[m] = bend_of(asked_->robot.sections[m], angles);
        for (std::size_t c = 0; c < 2; ++c)
          bends_[(2 * m + c) * n + k] = work_.bends[m][static_cast<Eigen::Index>(c)];
      }
      block.statuses[k] =
          is_taken_[k] ? sample_status(check_limits(asked_->robot, work_.bends, work_.extensions).status)
                       : refused;
      if (has_ends_) put_ends(block, k);
    }
    tendon_changes_batch(bends_, asked_->model, changes_, work_);
    for (std::size_t o = 0; o < asked_->outputs.size(); ++o)
      if (const auto* tendon = std::get_if<std::size_t>(&asked_->outputs[o]))
        for (std::size_t k = 0; k < n; ++k)
          block.output(o, k) = is_taken_[k] ? changes_[*tendon * n + k] : not_a_number;
    *block.done += n;
  }

 private:
  /// Of the bends in the workspace.
  void put_ends(const SampleBlock& block, std::size_t k) {
    section_ends(work_.bends, work_);
    for (std::size_t o = 0; o < asked_->outputs.size(); ++o) {
      const auto* end = std::get_if<EndNumber>(&asked_->outputs[o]);
      if (!end) continue;
      const SpatialPose pose = spatial_pose(work_.ends[end->section]);
      block.output(o, k) = !is_taken_[k]     ? not_a_number
                           : end->number < 3 ? pose.position[static_cast<Eigen::Index>(end->number)]
                                             : pose.quaternion[end->number - 3];
    }
  }

  std::shared_ptr<const AskedSections> asked_;
  bool has_ends_;
  SerialWorkspace work_;
  std::vector<double> bends_, changes_;
  std::vector<bool> is_taken_;  ///< by a query
};

}  // namespace

SamplerKind plan_sections(Context& of_robot, const RowPlaces& rows) {
  SerialQuestion question(of_robot);
  const auto is_extensible = std::ranges::any_of(question.robot.sections, &Section::is_extensible);
  if (question.ask != Ask::forward || is_extensible) return {};
  question.read();
  const bool is_plain = question.is_read() && !question.max_iterations && !question.shape.changes &&
                        question.pay_out.empty() && question.wanted.words == usual_of(question.ask);
  if (!is_plain || !rows.are_within({"configuration"})) return {};
  AskedSections asked{.robot = question.robot, .model = question.model};
  for (std::size_t m = 0; m < question.shape.given.size(); ++m) {
    const auto section = rows.numbers(joined("configuration", m), question.shape.given[m], bend_range);
    asked.configuration.push_back({section[0], section[1]});
  }
  asked.configuration.resize(question.robot.sections.size());
  for (const std::string& output : rows.outputs()) {
    if (const auto tendon = tendon_of(output, asked.robot))
      asked.outputs.emplace_back(*tendon);
    else if (const auto end = end_number_of(output, asked.robot))
      asked.outputs.emplace_back(*end);
    else
      return {};
  }
  const bool has_ends = asked.has_ends();
  return sampler_kind<SerialSampler>(has_ends ? "ends of sections" : "tendons in lanes", {2048, 16384},
                                     std::move(asked));
}

}  // namespace sinew::inline v1

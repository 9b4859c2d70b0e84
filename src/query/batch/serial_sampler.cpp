/// Configurations of serial robots, for questions that vary them: tendon changes in lanes, ends of sections
/// one by one.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <variant>

#include "io/arm_file.hpp"
#include "io/serial_file.hpp"
#include "query/batch/query_entries.hpp"
#include "query/serial.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::inline v1 {
namespace {

/// A number of the pose of a section's end: x, y, z, and of the quaternion w, x, y, z.
struct EndNumber {
  std::size_t section, number;
};
using SerialOutput = std::variant<std::size_t, EndNumber>;  ///< or of the change of a tendon, among all

struct AskedSections {
  SerialRobot robot;
  std::vector<std::array<QueryEntry, 2>> configuration;  ///< of all sections; those not given are straight
  kernel::Model model = kernel::Model::exact;
  std::vector<SerialOutput> outputs;

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

bool read_configuration(const Node& list, const BatchQuestion& question, AskedSections& asked) {
  if (list.kind != Node::Kind::list || list.items.size() > asked.robot.sections.size()) return false;
  for (const Node& section : list.items) {
    const auto entries = query_entries(section, question);
    if (!entries || entries->size() != 2) return false;
    asked.configuration.push_back({(*entries)[0], (*entries)[1]});
  }
  asked.configuration.resize(asked.robot.sections.size());
  return true;
}

/// The question's robot; of arms those that are asked as one.
std::optional<SerialRobot> serial_robot(const BatchQuestion& question) {
  if (!is_serial(question.robot) && !is_arm(question.robot)) return {};
  auto robot = read_robot(question.robot);
  const Node* model = question.query.root.find("model");
  if (robot && robot->arm() && model && (model->text == "pcc" || model->text == "lsk"))
    robot = robot->as(Model::cc);
  return robot && robot->serial() ? std::optional(*robot->serial()) : std::nullopt;
}

std::optional<AskedSections> asked_of_sections(const BatchQuestion& question) {
  auto robot = serial_robot(question);
  if (!robot || std::ranges::any_of(robot->sections, &Section::is_extensible)) return {};
  AskedSections asked{.robot = std::move(*robot), .configuration = {}, .outputs = {}};
  for (const Member& field : question.query.root.members) {
    if (field.key == "query") {
      if (field.value.text != "forward") return {};
    } else if (field.key == "configuration") {
      if (!read_configuration(field.value, question, asked)) return {};
    } else if (field.key == "model") {
      asked.model = field.value.text == "lsk" ? kernel::Model::linear : kernel::Model::exact;
    } else {
      return {};
    }
  }
  for (const std::string& output : question.outputs) {
    if (const auto tendon = tendon_of(output, asked.robot))
      asked.outputs.emplace_back(*tendon);
    else if (const auto end = end_number_of(output, asked.robot))
      asked.outputs.emplace_back(*end);
    else
      return {};
  }
  return asked.configuration.empty() ? std::nullopt : std::optional(std::move(asked));
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
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t m = 0; m < sections; ++m) {
        const auto& [first, second] = asked_->configuration[m];
        work_.bends[m] = bend_of(asked_->robot.sections[m], {first.at(block, k), second.at(block, k)});
        for (std::size_t c = 0; c < 2; ++c)
          bends_[(2 * m + c) * n + k] = work_.bends[m][static_cast<Eigen::Index>(c)];
      }
      block.statuses[k] = sample_status(check_limits(asked_->robot, work_.bends, work_.extensions).status);
      if (has_ends_) put_ends(block, k);
    }
    tendon_changes_batch(bends_, asked_->model, changes_, work_);
    for (std::size_t o = 0; o < asked_->outputs.size(); ++o)
      if (const auto* tendon = std::get_if<std::size_t>(&asked_->outputs[o]))
        for (std::size_t k = 0; k < n; ++k) block.output(o, k) = changes_[*tendon * n + k];
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
      block.output(o, k) = end->number < 3 ? pose.position[static_cast<Eigen::Index>(end->number)]
                                           : pose.quaternion[end->number - 3];
    }
  }

  std::shared_ptr<const AskedSections> asked_;
  bool has_ends_;
  SerialWorkspace work_;
  std::vector<double> bends_, changes_;
};

}  // namespace

SamplerKind serial_sampler(const BatchQuestion& question) {
  auto asked = asked_of_sections(question);
  if (!asked) return {};
  const auto shared = std::make_shared<const AskedSections>(std::move(*asked));
  return {.name = shared->has_ends() ? "ends of sections" : "tendons in lanes",
          .chunks = {2048, 16384},
          .make = [shared]() -> Sampler {
            return [sampler = std::make_shared<SerialSampler>(shared)](const SampleBlock& block) {
              (*sampler)(block);
            };
          }};
}

}  // namespace sinew::inline v1

/// Tendon changes of serial robots in lanes, for studies that vary the configuration.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "query/serial.hpp"
#include "sinew/io/serial_file.hpp"
#include "study/samplers/query_entries.hpp"

namespace sinew::inline v0 {
namespace {

struct SerialStudy {
  SerialRobot robot;
  std::vector<std::array<QueryEntry, 2>> configuration;  ///< of all sections; those not given are straight
  kernel::Model model = kernel::Model::exact;
  std::vector<std::size_t> outputs;  ///< which tendon
};

/// `changes[2][0]` as the number of the tendon among all.
std::optional<std::size_t> tendon_of(const std::string& path, const SerialRobot& robot) {
  unsigned section = 0, tendon = 0;
  int end = 0;
  if (std::sscanf(path.c_str(), "changes[%u][%u]%n", &section, &tendon, &end) != 2 ||
      static_cast<std::size_t>(end) != path.size() || section >= robot.sections.size() ||
      tendon >= static_cast<unsigned>(robot.sections[section].tendons))
    return {};
  std::size_t first = 0;
  for (unsigned m = 0; m < section; ++m) first += static_cast<std::size_t>(robot.sections[m].tendons);
  return first + tendon;
}

bool read_configuration(const Node& list, const Study& study, SerialStudy& asked) {
  if (list.kind != Node::Kind::list || list.items.size() > asked.robot.sections.size()) return false;
  for (const Node& section : list.items) {
    const auto entries = query_entries(section, study);
    if (!entries || entries->size() != 2) return false;
    asked.configuration.push_back({(*entries)[0], (*entries)[1]});
  }
  asked.configuration.resize(asked.robot.sections.size());
  return true;
}

std::optional<SerialStudy> serial_study(const Study& study) {
  if (!is_serial(study.robot_document)) return {};
  auto robot = read_serial_robot(study.robot_document);
  if (!robot || std::ranges::any_of(robot->sections, &Section::is_extensible)) return {};
  SerialStudy asked{.robot = std::move(*robot), .configuration = {}, .outputs = {}};
  for (const Member& field : study.query.root.members) {
    if (field.key == "query") {
      if (field.value.text != "forward") return {};
    } else if (field.key == "configuration") {
      if (!read_configuration(field.value, study, asked)) return {};
    } else if (field.key == "model") {
      asked.model = field.value.text == "lsk" ? kernel::Model::linear : kernel::Model::exact;
    } else {
      return {};
    }
  }
  for (const StudyOutput& output : study.outputs) {
    const auto tendon = tendon_of(output.path, asked.robot);
    if (!tendon) return {};
    asked.outputs.push_back(*tendon);
  }
  return asked.configuration.empty() ? std::nullopt : std::optional(std::move(asked));
}

class SerialSampler {
 public:
  explicit SerialSampler(std::shared_ptr<const SerialStudy> asked)
      : asked_(std::move(asked)),
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
      block.statuses[k] =
          static_cast<SampleStatus>(check_limits(asked_->robot, work_.bends, work_.extensions).status);
    }
    tendon_changes_batch(bends_, asked_->model, changes_, work_);
    for (std::size_t o = 0; o < asked_->outputs.size(); ++o)
      std::copy_n(changes_.begin() + static_cast<std::ptrdiff_t>(asked_->outputs[o] * n), n,
                  block.outputs.begin() + static_cast<std::ptrdiff_t>(o * n));
    *block.done += n;
  }

 private:
  std::shared_ptr<const SerialStudy> asked_;
  SerialWorkspace work_;
  std::vector<double> bends_, changes_;
};

}  // namespace

SamplerKind serial_sampler(const Study& study) {
  auto asked = serial_study(study);
  if (!asked) return {};
  const auto shared = std::make_shared<const SerialStudy>(std::move(*asked));
  return {.name = "tendons in lanes", .chunk = chunk_size(study, 2048, 16384), .make = [shared]() -> Sampler {
            return [sampler = std::make_shared<SerialSampler>(shared)](const SampleBlock& block) {
              (*sampler)(block);
            };
          }};
}

}  // namespace sinew::inline v0

#include "study/sweep/plan.hpp"

#include <fmt/format.h>
#include <sha2.h>

#include <array>

namespace sinew::inline v1 {
namespace {

Digest sha256(std::span<const std::string> texts) {
  SHA2_CTX context;
  SHA256Init(&context);
  for (const std::string& text : texts) {
    const std::uint64_t size = text.size();  // else two texts could move their border
    SHA256Update(&context, reinterpret_cast<const std::uint8_t*>(&size), sizeof size);
    SHA256Update(&context, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  }
  Digest digest{};
  SHA256Final(digest.data(), &context);
  return digest;
}

std::string sha256_of(const std::string& text) {
  std::array<char, SHA256_DIGEST_STRING_LENGTH> digits{};
  SHA256Data(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), digits.data());
  return digits.data();
}

/// What a tree says, for telling sweeps apart.
void write_tree(const Node& node, std::string& text) {
  text += fmt::format("({} {} {}", static_cast<int>(node.kind), node.text.size(), node.text);
  for (const Node& item : node.items) write_tree(item, text);
  for (const Member& member : node.members) {
    text += fmt::format("{} {}", member.key.size(), member.key);
    write_tree(member.value, text);
  }
  text += ')';
}

/// `0 rod, 1 cc`
std::string numbered(std::span<const std::string> words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    text += fmt::format("{}{} {}", k == 0 ? "" : ", ", k, words[k]);
  return text;
}

}  // namespace

BatchQuestion question_of(const Study& study) {
  BatchQuestion question{study.robot_document, study.query, study.variable_names(), {}, study.is_path};
  for (const StudyAxis& axis : study.axes) question.words.push_back(axis.words);
  for (const StudyOutput& output : study.outputs) question.outputs.push_back(output.path);
  return question;
}

SweepPlan::SweepPlan(const Study& study)
    : study_(study),
      kind_(choose_sampler(question_of(study))),
      chunks_(study.samples, study.reductions.empty() ? row_of(study) : study.reduced_samples(),
              row_of(study), chunk_size(kind_, study.samples)) {}

std::string hexadecimal(const Digest& digest) {
  std::string text;
  for (const std::uint8_t byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

Digest SweepPlan::key() const {
  std::string robot;  // with what --set changes
  write_tree(study_.robot_document.root, robot);
  return sha256(std::array<std::string, 6>{
      version(), std::string(instruction_set_in_use()), study_.text, robot, study_.list_text,
      fmt::format("{} {}", kind_.name, chunk_size(kind_, study_.samples))});
}

ResultLayout SweepPlan::layout(const SweepOptions& options) const {
  ResultLayout layout{.title = study_.title, .axes = {}, .columns = {}, .provenance = {}};
  layout.is_grid = study_.sampling == Study::Sampling::grid;
  layout.has_status = !reduces();
  layout.compression = options.compression;
  layout.rows = study_.samples / study_.reduced_samples();
  const std::size_t kept = study_.axes.size() - study_.reduced_axes;
  for (std::size_t a = 0; a < kept; ++a) {
    const StudyAxis& axis = study_.axes[a];
    layout.axes.push_back({axis.name, axis.unit, layout.is_grid ? axis.values : std::vector<double>{}});
  }
  for (const StudyReduction& reduction : study_.reductions)
    layout.columns.push_back({reduction.name, reduction.kind == StudyReduction::Kind::part
                                                  ? ""
                                                  : study_.outputs[reduction.output].unit});
  for (std::size_t c = study_.axes.size(); !reduces() && c < study_.column_count(); ++c)
    layout.columns.push_back({study_.column_name(c), study_.column_unit(c)});
  layout.provenance = provenance(options);
  return layout;
}

std::vector<Fact> SweepPlan::provenance(const SweepOptions& options) const {
  std::vector<Fact> facts{{"sinew_version", version()},
                          {"command", options.command},
                          {"instruction_set", std::string(instruction_set_in_use())},
                          {"key", hexadecimal(key())},
                          {"study_sha256", sha256_of(study_.text)},
                          {"robot", study_.robot},
                          {"robot_sha256", sha256_of(study_.robot_text)}};
  if (!study_.list_text.empty()) facts.push_back({"list_sha256", sha256_of(study_.list_text)});
  for (const StudyAxis& axis : study_.axes)
    if (!axis.words.empty()) facts.push_back({axis.name, numbered(axis.words)});
  facts.push_back({"study", study_.text});
  facts.push_back({"robot_file", study_.robot_text});
  return facts;
}

}  // namespace sinew::inline v1

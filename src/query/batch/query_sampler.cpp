/// Samples by queries, one after the other.
#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>

#include "query/batch/answer_path.hpp"
#include "query/batch/placeholders.hpp"
#include "query/batch/row_places.hpp"
#include "query/batch/sampler.hpp"
#include "query/fields/answer_places.hpp"
#include "query/tree_session.hpp"
#include "query/wants.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::inline v1 {
namespace {

/// The question without what is usual of it and goes to no column: of chains, legs and what simpler models
/// make of them are a quarter of its time.
Document narrowed(const BatchQuestion& question, TreeSession& session) {
  const auto ask = ask_of(question.query.root.find("query")->text);
  const Wants named = named_wants(question.query.root);
  const auto robot = read_robot(question.robot);
  if (!ask || !robot || !(named & usual_wants).is_empty()) return question.query;
  const AnswerPlaces places(as_asked(question.robot, *robot, question.query.root), *ask);
  const auto is_without_legs = [&](std::string_view output) {
    return places.is_told(output, named | Wants{Want::pose});
  };
  if (!std::ranges::all_of(question.outputs, is_without_legs)) return question.query;
  BatchQuestion narrow = question;
  add_want(narrow.query.root, Want::pose);
  return session.errors_of(RowPlaces(narrow).trial()).empty() ? narrow.query : question.query;
}

class QuerySampler {
 public:
  explicit QuerySampler(std::shared_ptr<const BatchQuestion> question)
      : question_(std::move(question)),
        opened_(TreeSession::open(question_->robot).value()),
        query_(narrowed(*question_, opened_)),
        places_(placeholders(query_.root, question_->inputs)) {
    for (const std::string& output : question_->outputs) paths_.emplace_back(output);
  }

  void operator()(const SampleBlock& block) {
    // anew for each block: what was solved before must not show in the last digits
    TreeSession session = opened_.anew();
    session.stop_on(StopToken(*block.stop));
    last_.reset();
    for (std::size_t k = 0; k < block.count && !*block.stop; ++k, ++*block.done) {
      for (const Placeholder& place : places_)
        put(*place.node, block.input(*place.input, k), words(*place.input));
      block.statuses[k] = sample(session, block, k);
    }
  }

 private:
  std::span<const std::string> words(std::size_t input) const {
    return input < question_->words.size() ? question_->words[input] : std::span<const std::string>();
  }

  SampleStatus sample(TreeSession& session, const SampleBlock& block, std::size_t k) {
    for (std::size_t o = 0; o < paths_.size(); ++o) block.output(o, k) = not_a_number;
    try {
      const bool continues = last_.has_value();
      Value answer = session.answer(query_, question_->is_path ? &last_ : nullptr);
      if (continues && !last_) answer = session.answer(query_, &last_);  // lost on the way: anew
      if (continues && last_ && status_of(answer) == unstable) settle(session, answer);
      if (answer.contains("error")) return refused;
      for (std::size_t o = 0; o < paths_.size(); ++o)
        if (const auto value = paths_[o].number(answer)) block.output(o, k) = *value;
      return status_of(answer);
    } catch (const std::exception&) {
      last_.reset();
      return failed_inside;
    }
  }

  /// A path that leads to what does not hold by itself has missed a fold: home may lead to what does.
  void settle(TreeSession& session, Value& answer) {
    std::optional<AnyPose> from_home;
    Value other = session.answer(query_, &from_home);
    if (!from_home || status_of(other) != converged) return;
    answer = std::move(other);
    last_ = from_home;
  }

  static SampleStatus status_of(const Value& answer) {
    const std::string_view text = answer.text_at("status");
    if (text.empty()) return converged;  // a question that is always answered
    if (text == to_string(Status::stopped)) return not_computed;
    if (text == to_string(Status::bad_input)) return refused;
    for (SampleStatus s = 0; s < sample_statuses; ++s)
      if (name_of(s) == text) return s;
    return failed_inside;
  }

  std::shared_ptr<const BatchQuestion> question_;
  TreeSession opened_;
  Document query_;
  std::vector<Placeholder> places_;
  std::vector<AnswerPath> paths_;
  std::optional<AnyPose> last_;
};

}  // namespace

SamplerKind query_sampler(const BatchQuestion& question) {
  const auto shared = std::make_shared<const BatchQuestion>(question);
  return {.name = "query by query", .chunks = {16, 256}, .make = [shared]() -> Sampler {
            // std::function copies what it holds
            return [sampler = std::make_shared<QuerySampler>(shared)](const SampleBlock& block) {
              (*sampler)(block);
            };
          }};
}

std::string_view name_of(SampleStatus status) {
  if (status == refused) return "refused";
  if (status == failed_inside) return "failed";
  if (status == left_out) return "left_out";
  if (status == not_supported) return to_string(Status::unsupported);
  return to_string(static_cast<Status>(status));
}

}  // namespace sinew::inline v1

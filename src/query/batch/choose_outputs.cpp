#include "query/batch/choose_outputs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "query/batch/answer_path.hpp"
#include "query/fields/answer_places.hpp"
#include "query/fields/fields.hpp"
#include "sinew/robot/arm_legs.hpp"
#include "sinew/robot/assembly.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {
namespace {

/// Of what tendon pairs hold: of each leg both tendons, under the names that studies and Octave give them.
BatchOutputs usual_tendons(const Robot& robot) {
  BatchOutputs usual;
  for (int i = 0; i < leg_count(robot); ++i)
    for (const char* field : {"tendon_lengths", "tensions"})
      usual.emplace_back(fmt::format("legs_{}_{}", i, field), fmt::format("legs[{}].{}", i, field));
  return usual;
}

BatchOutputs usual_solution(const Robot& robot, std::string_view query) {
  if (query == "inverse")
    return robot.model() == Model::prb ? usual_tendons(robot) : BatchOutputs{{"inputs", "inputs"}};
  if (query == "velocity") {
    BatchOutputs usual{{"position_index", "indices.position"}, {"rotation_index", "indices.rotation"}};
    if (!has_rods(robot)) usual.insert(usual.begin(), {"determinant", "determinant"});
    return usual;
  }
  if (robot.planar()) return {{"x", "pose.x"}, {"y", "pose.y"}, {"phi", "pose.phi"}};
  return {{"position", "pose.position"}, {"quaternion", "pose.quaternion"}};
}

class OutputChooser {
 public:
  OutputChooser(const Robot& robot, Ask ask, const FieldLayouts& layouts, Node& query)
      : robot_(robot),
        ask_(ask),
        places_(robot, ask),
        layouts_(layouts),
        query_(query) {}

  BatchOutputs unnamed() {
    const Node* all = query_.find("all");
    if (all && all->kind == Node::Kind::boolean && all->boolean)
      errors_.push_back({"no_effect", "all",
                         "rows have more and fewer solutions, which are no column; name outputs, such as "
                         "count, or ask such rows one by one"});
    BatchOutputs outputs = usual_outputs(robot_, word_of(ask_));
    BatchOutputs last;
    if (outputs.back().first == "residual") {
      last.push_back(std::move(outputs.back()));
      outputs.pop_back();
    }
    const Wants named = named_wants(query_);
    for (std::size_t k = 0; k < find_field("want")->words.size(); ++k)
      if (named.has(static_cast<Want>(k))) add_given(static_cast<Want>(k), outputs);
    outputs.insert(outputs.end(), last.begin(), last.end());
    return outputs;
  }

  /// Notes what is wrong, and adds the words of `want` that outputs go with.
  void check(const BatchOutputs& outputs) {
    const Wants wanted = places_.wanted(named_wants(query_));
    Wants added, used;
    for (const auto& output : outputs) {
      const std::string& place = output.second;
      const auto found = places_.find(place);
      const auto refuse = [&](std::string why) {
        errors_.push_back({"unknown_path", "outputs." + output.first, std::move(why)});
      };
      if (!found) {
        refuse(found.error());
        continue;
      }
      const AnswerWord& root = *found->root;
      const AnswerWord& last = *found->last;
      for (const AnswerWord* word : {&root, &last})
        if (!has_what_it_goes_with(*word, query_)) {
          refuse(fmt::format("{} goes with {}; add that to the question", place, word->with));
          break;
        }
      if (last.is_value())
        if (std::string why = layouts_.why_no_column(place); !why.empty()) refuse(std::move(why));
      used = used | gives(root);
      if (root.want && !root.is_always && !(wanted | added).has(*root.want))
        added = added | Wants{*root.want};
    }
    if (errors_.empty()) refuse_useless(used);
    if (!errors_.empty()) return;
    for (std::size_t k = 0; k < find_field("want")->words.size(); ++k)
      if (added.has(static_cast<Want>(k))) add_want(query_, static_cast<Want>(k));
  }

  Errors errors() { return std::move(errors_); }

 private:
  /// Words of `want` that a place is told by.
  static Wants gives(const AnswerWord& root) {
    if (!root.want) return {};
    if (root.name() == "lines") return {Want::lines, Want::shape};
    if (root.name() == "buckling_margin") return {Want::stability, Want::margins};
    return {*root.want};
  }

  /// Words of `want` that change no output. Pose and legs are there by themselves; where rates have no unique
  /// answer, which `velocity` and `sensitivity` look at, the status says so.
  void refuse_useless(Wants used) {
    const Wants idle =
        named_wants(query_) - used - Wants{Want::pose, Want::legs, Want::velocity, Want::sensitivity};
    for (std::size_t k = 0; k < find_field("want")->words.size(); ++k) {
      const auto want = static_cast<Want>(k);
      if (!idle.has(want)) continue;
      const std::string_view word = find_field("want")->words[k];
      const std::vector<std::string> places = places_.given_by(want, query_);
      errors_.push_back({"no_effect", "want",
                         fmt::format("no output is of what {} answers; name one{}, or leave the word out",
                                     word, places.empty() ? "" : ", such as " + places.front())});
    }
  }

  void add_given(Want want, BatchOutputs& outputs) {
    bool is_told = false;
    for (const std::string& place : places_.given_by(want, query_)) {
      if (!layouts_.why_no_column(place).empty()) continue;
      is_told = true;
      if (std::ranges::find(outputs, place, [](const auto& output) { return output.second; }) ==
          outputs.end())
        outputs.emplace_back(name_of_place(place), place);
    }
    if (is_told || want == Want::pose || want == Want::legs) return;
    const std::string_view word = find_field("want")->words[static_cast<std::size_t>(want)];
    errors_.push_back({"no_effect", "want",
                       fmt::format("what {} answers is as long as it is, which is no column; name outputs, "
                                   "such as one number of its lists, or ask such rows one by one",
                                   word)});
  }

  const Robot& robot_;
  Ask ask_;
  AnswerPlaces places_;
  const FieldLayouts& layouts_;
  Node& query_;
  Errors errors_;
};

}  // namespace

BatchOutputs usual_outputs(const Robot& robot, std::string_view query) {
  if (query == "diagram") return {{"margin", "margin"}, {"over_tension", "over_tension"}};
  if (query == "identify") return {{"rms", "errors.fitted.rms"}, {"noise", "noise"}};
  const std::pair<std::string, std::string> residual{"residual", "residual"};
  if (robot.serial()) {
    if (query == "velocity") return {{"J", "J"}, {"K", "K"}};
    BatchOutputs usual{
        {"position", "tip.position"}, {"quaternion", "tip.quaternion"}, {"changes", "changes"}};
    if (query == "inverse") {
      usual.emplace_back("configuration", "configuration");
      usual.push_back(residual);
    }
    return usual;
  }
  BatchOutputs usual;
  if (const ArmLegs* legs = robot.arm_legs()) {
    if (legs->is_planar)
      usual = {{"x", "pose.x"}, {"y", "pose.y"}, {"phi", "pose.phi"}};
    else
      usual = {{"position", "pose.position"}, {"quaternion", "pose.quaternion"}};
    usual.insert(usual.end(), {{"tensions", "tensions"}, {"changes", "changes"}});
    if (query == "statics") usual.emplace_back("wrench", "wrench");
  } else if (robot.arm()) {
    usual = {{"position", "tip.position"},
             {"quaternion", "tip.quaternion"},
             {"tensions", "tensions"},
             {"changes", "changes"}};
    if (query == "statics") usual.emplace_back("wrench", "wrench");
    if (query == "track") {
      for (const char* name : {"end_tensions", "motor_work", "friction_loss"}) usual.emplace_back(name, name);
      return usual;
    }
  } else {
    usual = usual_solution(robot, query);
  }
  usual.push_back(residual);
  return usual;
}

Errors choose_outputs(const Robot& robot, const FieldLayouts& layouts, BatchOutputs& outputs,
                      BatchQuestion& question) {
  const Ask ask = ask_of(question.query.root.find("query")->text).value();
  if (ask == Ask::describe) return {};
  OutputChooser chooser(robot, ask, layouts, question.query.root);
  if (outputs.empty()) outputs = chooser.unnamed();
  chooser.check(outputs);
  return chooser.errors();
}

}  // namespace sinew::inline v1

/// A question with names in it as fields, and as the single numbers that samplers know.
#include <fmt/format.h>

#include <algorithm>

#include "io/document/quantity.hpp"
#include "io/document/reader.hpp"
#include "query/batch/answer_path.hpp"
#include "query/batch/batch_state.hpp"
#include "query/batch/choose_outputs.hpp"
#include "query/batch/field_units.hpp"
#include "query/batch/row_places.hpp"
#include "query/fields/fields.hpp"
#include "query/tree_session.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/robot/arm_legs.hpp"
#include "sinew/robot/assembly.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {
namespace {

std::string_view word(const Node& query, std::string_view key) {
  const Node* found = query.find(key);
  return found ? std::string_view(found->text) : std::string_view();
}

}  // namespace

Robot as_asked(const Document& document, const Robot& robot, const Node& query) {
  Robot asked = robot;
  if (const Node* settings = query.find("set")) {
    std::vector<Member> constants;
    for (const Member& one : settings->members)
      if (!one.value.text.starts_with('$')) constants.push_back(one);
    const auto changed = with(document, constants);
    if (const auto other = changed ? read_robot(*changed) : tl::unexpected(changed.error())) asked = *other;
  }
  const std::string_view model = word(query, "model");
  if (asked.arm() && (model == "pcc" || model == "lsk" || word(query, "query") == "diagram"))
    if (const auto sections = asked.as(Model::cc)) asked = *sections;
  const bool is_on_chains = model == "prb" || (word(query, "query") == "statics" && !bears_load(asked));
  if (is_on_chains && asked.model() == Model::cc)
    if (const auto chains = asked.as(Model::prb)) asked = *chains;
  return asked;
}

namespace {

/// Texts for single numbers, `$name[1]`, in place of one for a list.
Node single_numbers(const std::string& text, const FieldLayout& layout) {
  Node list;
  list.kind = Node::Kind::list;
  std::size_t next = 0;
  const auto fill = [&](Node& one, std::size_t count) {
    one.kind = Node::Kind::list;
    for (std::size_t i = 0; i < count; ++i, ++next)
      one.items.push_back(make_node(std::string_view(text + layout.suffix(next))));
  };
  if (layout.lists.empty()) fill(list, layout.size());
  for (const std::size_t count : layout.lists) fill(list.items.emplace_back(), count);
  return list;
}

/// A name in a question.
struct Named {
  std::string name, place;
  FieldLayout layout;
};

/// Finds names, and puts single numbers in place of lists.
class NameReader {
 public:
  NameReader(const Robot& robot, const FieldLayouts& layouts, const FieldUnits& units, Errors& errors)
      : robot_(robot),
        layouts_(layouts),
        units_(units),
        errors_(errors) {}

  std::vector<Named> read(Node& query) {
    read(query, "");
    return std::move(found_);
  }

 private:
  void read(Node& node, const std::string& place) {
    if (is_name(node)) return read_name(node, place);
    for (std::size_t i = 0; i < node.items.size(); ++i) read(node.items[i], joined(place, i));
    for (Member& member : node.members) read(member.value, joined(place, member.key));
  }

  void read_name(Node& node, const std::string& place) {
    const std::string name = node.text.substr(1);
    const FieldLayout layout = layouts_.input(place);
    const auto before = std::ranges::find(found_, name, &Named::name);
    if (name.empty())
      errors_.push_back({"missing_key", place,
                         fmt::format("{} = \"$\" has no name; write one after it, like \"$x\"", place)});
    else if (const std::string why = why_no_name(place); !why.empty())
      errors_.push_back({"wrong_type", place, why});
    else if (place == "id")
      errors_.push_back(
          {"no_effect", place, "id is repeated in single answers; rows have none, leave it out"});
    else if (before == found_.end())
      found_.push_back({name, place, layout});
    else
      compare(*before, place, layout);
    if (!layout.shape.empty()) node = single_numbers(node.text, layout);
  }

  /// A name stands for numbers: what is made of maps and texts has names in it.
  std::string why_no_name(std::string_view place) const {
    const auto* field = find_field(place);
    using Shape = FieldShape;
    if (!field) return {};
    if (field->shape == Shape::pose && !is_held_by_three())
      return fmt::format("a pose is a map; give names in it, {}",
                         layouts_.input("position").size() == 2
                             ? R"({"x": "$x", "y": "$y", "phi": "$phi"})"
                             : R"({"position": "$position", "quaternion": "$quaternion"})");
    if (field->shape == Shape::pose || field->shape == Shape::independent)
      return R"(of this robot give "independent": {"z": "$z", "e1": "$e1", "e2": "$e2"})";
    for (const Shape shape : {Shape::places, Shape::target, Shape::growing_load, Shape::settings,
                              Shape::point_loads, Shape::path_points, Shape::measured_rows})
      if (field->shape == shape) return "it is made of several fields; give names in these";
    return {};
  }

  /// Of such a robot z, e1 and e2 are asked for: few whole poses are.
  bool is_held_by_three() const {
    const bool has_legs = !robot_.serial() && !robot_.arm() && !robot_.arm_legs();
    return has_legs && !robot_.planar() && input_count(robot_) == 3;
  }

  /// The same name at two places: the same numbers.
  void compare(const Named& before, const std::string& place, const FieldLayout& layout) {
    const auto say = [&](const std::string& here, const std::string& there) {
      errors_.push_back({"ambiguous", place,
                         fmt::format("{} = \"${}\" stands for {} here and for {} at {}; give two names",
                                     place, before.name, here, there, before.place)});
    };
    if (before.layout.shape != layout.shape)
      return say(numbers(layout.size()), fmt::format("{}", before.layout.size()));
    const std::string here = units_.input({}, place, layout).unit,
                      there = units_.input({}, before.place, layout).unit;
    if (here != there && !here.empty() && !there.empty()) say(here, there);
  }
  static std::string numbers(std::size_t count) {
    return fmt::format("{} number{}", count, count == 1 ? "" : "s");
  }

  const Robot& robot_;
  const FieldLayouts& layouts_;
  const FieldUnits& units_;
  Errors& errors_;
  std::vector<Named> found_;
};

/// The fields of a batch that are not its query's.
struct Told {
  bool is_path = false;
  BatchOutputs outputs;
};
Told read_told(const Document& asked, Errors& errors) {
  Told told;
  Reader reader(asked, errors);
  if (!reader.is(Node::Kind::map)) {
    reader.fail("wrong_type", "give the fields of a query as a map");
    return told;
  }
  if (const auto path = reader.optional("path"))
    told.is_path = path->choice({"continue", "anew"}) == "continue";
  if (const auto named = reader.optional("outputs"))
    for (auto& [name, place] : named->members()) {
      told.outputs.emplace_back(name, place.text());
      if (place.is(Node::Kind::string) && !AnswerPath::is_path(told.outputs.back().second))
        place.refuse("unknown_path", "give a place in the answer, like pose.position[2]");
    }
  return told;
}

/// Numbers for the names in `set`, of a robot that stays one: its own values, as far as its file has them. It
/// is noted where there is no such place. Whether all of `set` is kept: what the number would break is left
/// out.
bool put_own_numbers(Node& settings, const Document& robot, Errors& errors) {
  bool is_whole = true;
  std::vector<Member> kept;
  for (Member& one : settings.members) {
    const Node* own = is_name(one.value) ? at(robot.root, one.key) : nullptr;
    if (own) one.value = *own;
    if (!is_name(one.value)) {
      kept.push_back(one);
      continue;
    }
    put_some_numbers(one.value);
    auto changed = with(robot, {&one, 1});
    const auto other = changed ? read_robot(*changed) : tl::unexpected(std::move(changed.error()));
    if (other) {
      kept.push_back(one);
      continue;
    }
    is_whole = false;
    for (const Error& error : other.error())
      if (error.code == "unknown_key" || error.code == "unknown_path") errors.push_back(error);
  }
  settings.members = std::move(kept);
  return is_whole;
}

/// What is wrong with every row, whatever its numbers are: fields that are unknown or of no effect, lists of
/// a wrong length, names in place of words. Numbers that are out of range are the rows' to tell, and so is
/// that the robot has no answer: that is a status.
/// @param has_answers whether the robot has answers to it
Errors errors_of_all_rows(const Document& robot, const Node& query, bool& has_answers) {
  const std::vector<std::string> places = places_of_names(query);
  Document trial{"query", query};
  Errors errors;
  Node* settings = trial.root.find("set");
  const bool is_whole =
      !settings || settings->kind != Node::Kind::map || put_own_numbers(*settings, robot, errors);
  if (!errors.empty()) return errors;
  put_some_numbers(trial.root);
  auto session = TreeSession::open(robot);
  errors = session ? session->errors_of(trial) : session.error();
  const auto is_lacking = [](const Error& error) { return error.code == "not_available"; };
  has_answers = std::ranges::none_of(errors, is_lacking);
  if (std::ranges::all_of(errors, is_lacking) || (!is_whole && !has_answers)) return {};
  const bool chooses_section = std::ranges::find(places, "section") != places.end();
  std::erase_if(errors, [&](const Error& error) {
    const auto is = [&](std::string_view code) { return error.code == code; };
    if (!is_whole && is("no_effect")) return true;           // what is set may change that
    if (chooses_section && is("wrong_length")) return true;  // as many as there are sections up to it
    const bool is_of_numbers =
        is("out_of_range") || is("not_whole") || is("no_direction") || is("no_rotation");
    return is_of_numbers && is_at_or_around(error.where, places);
  });
  return errors;
}

Node query_of(const Node& asked) {
  Node query;
  query.kind = Node::Kind::map;
  for (const Member& field : asked.members)
    if (field.key != "path" && field.key != "outputs") query.members.push_back(field);
  return query;
}

}  // namespace

Expected<Batch> Batch::prepare(const Document& document, const Document& asked) {
  const auto robot = read_robot(document);
  if (!robot) return tl::unexpected(robot.error());
  Errors errors;
  Told told = read_told(asked, errors);
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  auto state = std::make_shared<State>();
  BatchQuestion& question = state->question;
  question = {document, {"query", query_of(asked.root)}, {}, {}, told.is_path};
  const Robot as_it_is = as_asked(document, *robot, question.query.root);
  const std::string kind(word(question.query.root, "query"));
  const FieldLayouts layouts(as_it_is, kind);
  const FieldUnits units(as_it_is, question.query.root);
  for (const auto& [name, place, layout] :
       NameReader(as_it_is, layouts, units, errors).read(question.query.root)) {
    state->inputs.push_back(units.input(name, place, layout));
    for (std::size_t i = 0; i < layout.size(); ++i) {
      question.inputs.push_back(name + layout.suffix(i));
      if (std::ranges::count(question.inputs, question.inputs.back()) > 1)
        errors.push_back(
            {"ambiguous", place,
             "\"$" + question.inputs.back() + "\" is a name and a number of a list; give another"});
    }
  }
  bool has_answers = false;
  if (errors.empty()) errors = errors_of_all_rows(document, question.query.root, has_answers);
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  if (state->inputs.empty())
    return failure("no_inputs", "query", "nothing goes in: write texts like \"$x\" where its numbers go");
  if (has_answers)
    errors = choose_outputs(as_it_is, layouts, told.outputs, question);
  else if (told.outputs.empty())
    told.outputs = usual_outputs(as_it_is, kind);
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  for (auto& [name, place] : told.outputs) {
    const FieldLayout layout = layouts.output(place);
    state->outputs.push_back(units.output(name, place, layout));
    for (std::size_t i = 0; i < layout.size(); ++i) question.outputs.push_back(place + layout.suffix(i));
  }
  state->kind = choose_sampler(question);
  return Batch(std::move(state));
}

}  // namespace sinew::inline v1

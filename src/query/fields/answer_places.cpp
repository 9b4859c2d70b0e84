#include "query/fields/answer_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "query/fields/fields.hpp"
#include "sinew/robot/arm_legs.hpp"
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v1 {
namespace {
namespace answer_places {

using namespace answer_bits;

constexpr unsigned groups[] = {of_all | of_arms | of_arm_legs, in_plane | in_space,
                               on_tendons | on_rails | on_rods, may_move | may_not,
                               asking({Ask::forward, Ask::inverse, Ask::velocity, Ask::shape, Ask::statics,
                                       Ask::track, Ask::diagram, Ask::identify, Ask::describe})};

constexpr bool is_of(unsigned word, unsigned robot) {
  return std::ranges::all_of(groups, [&](unsigned group) {
    return (word & group) == 0 || (robot & group) == 0 || (word & robot & group) != 0;
  });
}

unsigned bits_of(const Robot& robot) {
  if (robot.serial()) return of_serial | in_space;
  if (robot.arm()) return of_arms | in_space;
  if (const ArmLegs* legs = robot.arm_legs()) return of_arm_legs | (legs->is_planar ? in_plane : in_space);
  const unsigned space = robot.planar() ? in_plane : in_space;
  if (has_rods(robot)) return of_rods | space;
  return (robot.model() == Model::prb ? unsigned{of_chains} : unsigned{of_kinematic}) | space;
}

/// What each leg is, by its inputs; one that shares those of another is like the one before it.
std::vector<unsigned> bits_of_legs(const Robot& robot) {
  if (const ArmLegs* legs = robot.arm_legs()) return std::vector<unsigned>(legs->legs.size());
  if (robot.serial() || robot.arm()) return {};
  std::vector<unsigned> legs(static_cast<std::size_t>(leg_count(robot)));
  for (const InputOfLeg& input : inputs_of(robot)) {
    unsigned& bits = legs[static_cast<std::size_t>(input.leg)];
    if (input.name == "slide") bits |= on_rails | may_move;
    if (input.name == "length") bits |= on_rods;
    if (input.name == "theta") bits |= may_move;
    if (input.name == "tendon_1") bits |= on_tendons;
  }
  for (std::size_t i = 1; i < legs.size(); ++i)
    if (legs[i] == 0) legs[i] = legs[i - 1];
  for (unsigned& bits : legs)
    if ((bits & may_move) == 0) bits |= may_not;
  return legs;
}

/// A name of a place, with the indices after it.
struct Step {
  std::string_view name;
  std::vector<std::size_t> indices;
};
std::vector<Step> steps_of(std::string_view place) {
  std::vector<Step> steps;
  while (!place.empty()) {
    std::string_view part = place.substr(0, place.find('.'));
    place.remove_prefix(std::min(part.size() + 1, place.size()));
    Step step{part.substr(0, part.find('[')), {}};
    for (std::size_t open = part.find('['); open < part.size(); open = part.find('[', open + 1)) {
      std::size_t index = 0;
      std::from_chars(part.data() + open + 1, part.data() + part.size(), index);
      step.indices.push_back(index);
    }
    steps.push_back(std::move(step));
  }
  return steps;
}

std::string joined_place(std::string_view before, std::string_view name) {
  return before.empty() ? std::string(name) : fmt::format("{}.{}", before, name);
}

/// A place that has this name as its last one, or whose spelling is close.
std::string_view hint_of(std::string_view written, std::span<const std::string> places) {
  const auto ends = std::ranges::find_if(places, [&](std::string_view place) {
    return place.ends_with(written) && place.size() > written.size() &&
           place[place.size() - written.size() - 1] == '.';
  });
  if (ends != places.end()) return *ends;
  const std::vector<std::string_view> all(places.begin(), places.end());
  return closest(written, all);
}

}  // namespace answer_places
}  // namespace

using answer_places::joined_place;

bool has_what_it_goes_with(const AnswerWord& word, const Node& query) {
  if (word.with.empty()) return true;
  const Node* field = query.find(word.with);
  return field && field->kind != Node::Kind::null && (field->kind != Node::Kind::boolean || field->boolean);
}

AnswerPlaces::AnswerPlaces(const Robot& robot, Ask ask)
    : bits_(answer_places::bits_of(robot) | answer_bits::asking({ask})),
      legs_(answer_places::bits_of_legs(robot)),
      ask_(ask) {}

AnswerPlaces::AnswerPlaces(Ask ask) : bits_(answer_bits::asking({ask})), ask_(ask) {}

Wants AnswerPlaces::wanted(Wants named) const {
  return wanted_of((bits_ & of_rods) != 0 ? usual_of_rods(ask_) : usual_of(ask_), named);
}

/// Whether its answers can be told to have it.
bool AnswerPlaces::is_given(const AnswerWord& word) const {
  if (!word.want || word.is_always || wanted({}).has(*word.want)) return true;
  const unsigned mechanics = (bits_ & answer_bits::of_arm_legs) != 0 ? unsigned{of_arms} : bits_;
  return (find_field("want")->uses.of(ask_) & mechanics & (of_all | of_arms)) != 0;
}

std::vector<const AnswerWord*> AnswerPlaces::words(AnswerGroup group, std::ptrdiff_t leg) const {
  const unsigned own = leg >= 0 && leg < std::ssize(legs_) ? legs_[static_cast<std::size_t>(leg)] : 0;
  std::vector<const AnswerWord*> found;
  for (const AnswerWord& word : group)
    if (answer_places::is_of(word.of, bits_ | own) && is_given(word)) found.push_back(&word);
  return found;
}

std::string AnswerPlaces::no_such(std::string_view place, std::string_view before, AnswerGroup group,
                                  std::ptrdiff_t leg) const {
  std::vector<std::string> names, all;
  const auto add = [](std::vector<std::string>& to, std::string name) {
    if (std::ranges::find(to, name) == to.end()) to.push_back(std::move(name));
  };
  const auto collect = [&](const auto& self, AnswerGroup at, const std::string& prefix, std::ptrdiff_t own,
                           int depth) -> void {
    for (const AnswerWord* word : words(at, own)) {
      std::string name = joined_place(prefix, word->name());
      if (word->field.shape == AnswerShape::maps) name += "[0]";
      if (depth == 0) add(names, std::string(word->name()));
      if (word->below.count == 0)
        add(all, name);
      else if (depth < 2)
        self(self, word->below, name, word->name() == "legs" ? 0 : own, depth + 1);
    }
  };
  collect(collect, group, std::string(before), leg, 0);
  const std::string_view hint = answer_places::hint_of(place, all);
  constexpr std::size_t most = 40;
  return fmt::format("no answer to {} has {} by this robot and model{} There {}: {}{}.", word_of(ask_),
                     in_quotes(place),
                     hint.empty() ? "." : fmt::format("; did you mean {}?", in_quotes(hint)),
                     before.empty() ? "are" : fmt::format("are in {}", before),
                     fmt::join(std::span(names).first(std::min(names.size(), most)), ", "),
                     names.size() > most ? ", ..." : "");
}

tl::expected<AnswerPlaces::Found, std::string> AnswerPlaces::find(std::string_view place) const {
  constexpr std::string_view count = ".count";
  const bool counts = place.ends_with(count);
  const std::vector<answer_places::Step> steps =
      answer_places::steps_of(counts ? place.substr(0, place.size() - count.size()) : place);
  Found found{};
  AnswerGroup group = answer_words();
  std::string before;
  std::ptrdiff_t leg = -1;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const auto& [name, indices] = steps[k];
    const auto known = words(group, leg);
    const auto at = std::ranges::find(known, name, [](const AnswerWord* word) { return word->name(); });
    if (at == known.end()) return tl::unexpected(no_such(place, before, group, leg));
    const AnswerWord& word = **at;
    if (k == 0) found.root = &word;
    const bool is_last = k + 1 == steps.size();
    before = joined_place(before, name);
    if (word.below.count == 0 && !is_last) return tl::unexpected(no_such(place, before, {}, leg));
    if (word.field.shape == AnswerShape::map && (is_last || !indices.empty()))
      return tl::unexpected(fmt::format("{} is no number; name one of its fields, such as {}.{}", before,
                                        before, words(word.below, leg).front()->name()));
    if (word.field.shape == AnswerShape::maps && indices.size() != 1 &&
        !(is_last && counts && indices.empty()))
      return tl::unexpected(fmt::format("{} is a list; name one of them, such as {}[0].{}", before, before,
                                        words(word.below, name == "legs" ? 0 : leg).front()->name()));
    if (word.field.shape == AnswerShape::maps && is_last && !counts)
      return tl::unexpected(fmt::format("{}[{}] is no number; name one of its fields, such as {}[{}].{}",
                                        before, indices[0], before, indices[0],
                                        words(word.below, name == "legs" ? 0 : leg).front()->name()));
    if (const std::size_t depth = depth_of(word.field.shape); indices.size() < depth && is_last && !counts) {
      const std::string here =
          indices.empty() ? before : fmt::format("{}[{}]", before, fmt::join(indices, "]["));
      std::string number = here;
      for (std::size_t index = indices.size(); index < depth; ++index) number += "[0]";
      return tl::unexpected(
          fmt::format("{} is as long as it is, which is no column; name one of its numbers, such as {}, or "
                      "{}.count, or ask "
                      "such rows one by one",
                      here, number, here));
    }
    if (name == "legs" && !indices.empty()) {
      leg = static_cast<std::ptrdiff_t>(indices[0]);
      if (indices[0] >= legs_.size())
        return tl::unexpected(
            fmt::format("there is no {}[{}]; give a leg from 0 to {}", before, indices[0], legs_.size() - 1));
    }
    if (!indices.empty()) before += fmt::format("[{}]", fmt::join(indices, "]["));
    found.last = &word;
    group = word.below;
  }
  return found;
}

const AnswerField* AnswerPlaces::field(std::string_view place) const {
  const std::vector<answer_places::Step> steps = answer_places::steps_of(place);
  const auto search = [&](const auto& self, AnswerGroup group, std::size_t k,
                          unsigned own) -> const AnswerField* {
    for (const AnswerWord& word : group) {
      if (word.name() != steps[k].name || !answer_places::is_of(word.of, bits_ | own)) continue;
      if (k + 1 == steps.size()) return word.below.count == 0 ? &word.field : nullptr;
      const std::vector<std::size_t>& indices = steps[k].indices;
      const bool is_leg = word.name() == "legs" && !indices.empty() && indices[0] < legs_.size();
      if (const auto* found = self(self, word.below, k + 1, is_leg ? legs_[indices[0]] : own)) return found;
    }
    return nullptr;
  };
  return steps.empty() ? nullptr : search(search, answer_words(), 0, 0);
}

std::string_view AnswerPlaces::unit(std::string_view place) const {
  const AnswerField* found = field(place);
  const bool has_one = found && found->unit.find(", ") == std::string_view::npos;
  const bool is_of_unit_vector = found && found->shape == AnswerShape::direction && place.ends_with(']');
  return has_one && !is_of_unit_vector ? found->unit : std::string_view();
}

bool AnswerPlaces::is_told(std::string_view place, Wants named) const {
  const auto found = find(place);
  if (!found) return false;
  const AnswerWord& root = *found->root;
  return !root.want || root.is_always || wanted(named).has(*root.want);
}

std::vector<std::string> AnswerPlaces::given_by(Want want, const Node& query) const {
  std::vector<std::string> places;
  const auto collect = [&](const auto& self, AnswerGroup group, const std::string& before,
                           std::ptrdiff_t leg) -> void {
    for (const AnswerWord* word : words(group, leg)) {
      if (before.empty() && word->want != want) continue;
      if (word->is_rare || !has_what_it_goes_with(*word, query)) continue;
      const std::string place = joined_place(before, word->name());
      if (word->is_value()) places.push_back(place);
      if (word->field.shape == AnswerShape::map) self(self, word->below, place, leg);
      if (word->field.shape == AnswerShape::maps && word->name() == "legs")
        for (std::size_t i = 0; i < legs_.size(); ++i)
          self(self, word->below, fmt::format("{}[{}]", place, i), static_cast<std::ptrdiff_t>(i));
    }
  };
  collect(collect, answer_words(), "", -1);
  return places;
}

}  // namespace sinew::inline v1

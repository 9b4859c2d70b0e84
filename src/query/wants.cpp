#include "query/wants.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/document/reader.hpp"
#include "query/fields/fields.hpp"
#include "query/handlers.hpp"

namespace sinew::inline v1 {
namespace {

/// In the order of `Want`.
std::span<const std::string_view> want_names() {
  static const std::span<const std::string_view> words = find_field("want")->words;
  return words;
}

std::string names_of(Wants wants) {
  std::vector<std::string_view> known;
  for (std::size_t k = 0; k < want_names().size(); ++k)
    if (wants.has(static_cast<Want>(k))) known.push_back(want_names()[k]);
  return fmt::format("{}", fmt::join(known, ", "));
}

}  // namespace

Wants named_wants(const Node& query) {
  Wants named;
  const Node* list = query.find("want");
  const auto& words = want_names();
  if (list)
    for (const Node& item : list->items)
      if (const auto word = std::ranges::find(words, item.text); word != words.end())
        named = named | Wants{static_cast<Want>(word - words.begin())};
  return named;
}

void add_want(Node& query, Want want) {
  Node* list = query.find("want");
  if (!list || list->kind != Node::Kind::list) {
    std::erase_if(query.members, [](const Member& field) { return field.key == "want"; });
    query.members.push_back({.key = "want", .value = {}});
    list = &query.members.back().value;
    list->kind = Node::Kind::list;
  }
  list->items.push_back(make_node(want_names()[static_cast<std::size_t>(want)]));
}

Wants read_wants(Question& question) {
  return read_wants(question, usual_of(question.ask), question.handlers.wants);
}

Wants read_wants(Question& question, Wants usual, Wants known) {
  const auto list = question.query.optional("want");
  if (!list) return usual;
  Wants named;
  for (const Reader& word : list->items()) {
    if (word.is(Node::Kind::string) &&
        word.node()->text == "modes") {  // of the protocol, not of this version
      word.refuse("not_available",
                  "modes of vibration are of no robot in this version; all: true answers every "
                  "assembly mode");
      continue;
    }
    const auto want = static_cast<Want>(word.choice_index(want_names()));
    if (word.is(Node::Kind::string) && !known.has(want))
      word.refuse("not_available", fmt::format("this robot, by this model, answers {}", names_of(known)));
    named = named | Wants{want};
  }
  return wanted_of(usual, named);
}

void refuse_without(Question& question, Wants wants, Want word, std::initializer_list<const char*> fields) {
  if (wants.has(word)) return;
  for (const char* field : fields)
    if (const auto given = question.query.optional(field))
      given->fail("no_effect", fmt::format("goes with want: [{}]; add it, or remove this",
                                           want_names()[static_cast<std::size_t>(word)]));
}

int read_samples(Question& question, Wants wants, int usual, int most) {
  refuse_without(question, wants, Want::shape, {"samples"});
  if (!wants.has(Want::shape)) return usual;
  const auto samples = question.query.optional("samples");
  return samples ? samples->integer(Range::between(2, most)) : usual;
}

}  // namespace sinew::inline v1

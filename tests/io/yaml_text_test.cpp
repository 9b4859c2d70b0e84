/// Documents written as YAML are read back as they were.
#include "io/document/yaml_text.hpp"

#include <gtest/gtest.h>

#include "io/document/parse.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::test {
namespace yaml_text_test {

bool is_same(const Node& one, const Node& other) {
  if (one.kind != other.kind || one.boolean != other.boolean || one.number != other.number ||
      one.text != other.text || one.items.size() != other.items.size() ||
      one.members.size() != other.members.size())
    return false;
  for (std::size_t k = 0; k < one.items.size(); ++k)
    if (!is_same(one.items[k], other.items[k])) return false;
  for (std::size_t k = 0; k < one.members.size(); ++k)
    if (one.members[k].key != other.members[k].key || !is_same(one.members[k].value, other.members[k].value))
      return false;
  return true;
}

void expect_same(const Node& root, const std::string& source) {
  const std::string text = yaml_text(root);
  const auto again = parse_yaml(text, source);
  ASSERT_TRUE(again) << source << ": " << again.error().front().message << '\n' << text;
  EXPECT_TRUE(is_same(again->root, root)) << source << '\n' << text;
}

TEST(YamlText, AllRobotsAreReadBack) {
  for (const std::string_view name : builtin_robot_names())
    expect_same(read_robot_file(std::string(name)).value().root, std::string(name));
}

TEST(YamlText, OddValuesAreReadBack) {
  const auto document = parse_yaml(R"(- "123"
- "true"
- ""
- "a: b, [c] # {d}"
- 'it''s "quoted" \ and'
- "line\nbreak\ttab"
- -.5
- +1e-3
- [[], {}, null, ~, true, false]
- {"a b": 1, "null": {c: "-"}, "x:y": [1, [2, 3]]}
- "\u00e4\u00b5 \u2028"
- 1.0000000000000000000001
- - a long list of maps: {one: 1, two: 2, three: 3, four: 4, five: 5, six: 6, seven: 7, eight: 8, nine: 9}
    and: [0.123456789, 0.123456789, 0.123456789, 0.123456789, 0.123456789, 0.123456789, 0.123456789, 0.1234]
  - - nested
    - {deeper: [0.123456789, 0.123456789, 0.123456789, 0.123456789, 0.123456789, 0.123456789, 0.123456789]}
)",
                                   "odd");
  ASSERT_TRUE(document) << document.error().front().message;
  expect_same(document->root, "odd");
}

TEST(YamlText, IsWrittenForPeople) {
  Node leg, legs, root;
  leg.kind = root.kind = Node::Kind::map;
  legs.kind = Node::Kind::list;
  leg.members.push_back({.key = "length", .value = make_node("180 mm")});
  leg.members.push_back({.key = "offset", .value = make_node(0.01)});
  root.members.push_back({.key = "sinew", .value = make_node(1.0)});
  for (int k = 0; k < 3; ++k) legs.items.push_back(leg);
  root.members.push_back({.key = "legs", .value = legs});
  EXPECT_EQ(yaml_text(root), R"(sinew: 1
legs:
  - {length: 180 mm, offset: 0.01}
  - {length: 180 mm, offset: 0.01}
  - {length: 180 mm, offset: 0.01}
)");
  EXPECT_EQ(yaml_line(leg), "{length: 180 mm, offset: 0.01}");
}

}  // namespace yaml_text_test
}  // namespace sinew::test

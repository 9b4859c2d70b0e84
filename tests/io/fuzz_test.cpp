// Mutated documents through parser and reader: any answer is right, a crash or a hang is not. Deterministic.
#include <gtest/gtest.h>

#include <random>

#include "io/document/parse.hpp"
#include "io/document/reader.hpp"

namespace fuzz_test {

using namespace sinew;

constexpr std::string_view yaml_seed =
    "sinew: 1\n"
    "name: my 3-FRR\n"
    "platform: {home: {x: 0, y: 0, phi: 0}, radius: 50 mm}\n"
    "defaults:\n"
    "  link: {type: arc, length: 200 mm, joints: 6, material: {E: 60 GPa}, diameter: 1 mm}\n"
    "legs:\n"
    "  - {base: {point: [0 mm, 190 mm], direction: 320 deg}, actuated: [tendon_1]}\n"
    "  - base:\n"
    "      point: [\"1/2 in\", -3e-2]\n"
    "    link: {length: ~, on: true}\n";

constexpr std::string_view json_seed =
    R"({"sinew": 1, "name": "a\u00e9", "legs": [{"base": {"point": [0, "190 mm"]}, "link": {"length": -1.5e-3, "on": true}}],
       "defaults": {"link": {"type": "rod", "joints": null}}})";

constexpr std::string_view pieces[] = {"[",           "]",     "{",    "}",   ":",       ": ",  "- ",
                                       "? ",          "\n",    "\n  ", "\t",  "#",       "&a ", "*a",
                                       "!t ",         "\"",    "'",    "|",   ">",       "~",   "null",
                                       "1e999",       "---\n", "...",  ",",   "\xFF",    "µ",   "\r\n",
                                       "%YAML 1.2\n", "<<: ",  "1/0",  "\\",  "\\u0000", "nan", "@",
                                       "`",           "  ",    "legs", "link"};

std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  for (std::size_t edits = 1 + below(5); edits > 0; --edits) {
    const std::size_t at = below(text.size() + 1), length = std::min(below(20), text.size() - at);
    switch (below(4)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, pieces[below(std::size(pieces))]);
        break;
      case 2:
        text.insert(below(text.size() + 1), text.substr(at, length));
        break;
      default:
        if (at < text.size()) text[at] = static_cast<char>(random());
    }
  }
  return text;
}

void read_link(Reader link) {
  link.required("type").choice({"arc", "rod"});
  link.required("length").quantity(Dimension::length, Range::positive());
  link.required("joints").integer(Range::between(1, 100));
  if (auto material = link.optional("material")) {
    material->required("E").quantity(Dimension::pressure, Range::positive());
    material->close();
  }
  if (auto on = link.optional("on")) on->boolean();
  link.close();
}

Errors read(const Document& document) {
  Errors errors;
  Reader robot(document, errors);
  robot.required("sinew").integer();
  robot.required("name").text();
  const auto defaults = robot.optional("defaults");
  if (defaults) defaults->members();
  for (const Reader& own : robot.required("legs").items()) {
    const Node node = defaults ? merged(*defaults->node(), *own.node()) : *own.node();
    Reader leg = own.over(node);
    leg.required("base").required("point").array<2>(Dimension::length);
    read_link(leg.required("link"));
    leg.close();
  }
  robot.close();
  return errors;
}

void hold(const Errors& errors) {
  for (const Error& error : errors) {
    ASSERT_FALSE(error.code.empty());
    ASSERT_FALSE(error.where.empty());
    ASSERT_LT(error.message.size(), 2000U);
    ASSERT_EQ(utf8_size(error.message), error.message.size());
    ASSERT_EQ(error.message.find('\n'), std::string::npos);
  }
}

TEST(Fuzz, MutatedYamlNeverCrashes) {
  std::mt19937 random(20240607);
  int read_through = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::string text = mutated(std::string(yaml_seed), random);
    const auto document = parse_yaml(text, "f.yaml");
    if (document) ++read_through;
    ASSERT_NO_FATAL_FAILURE(hold(document ? read(*document) : document.error())) << text;
  }
  EXPECT_GT(read_through, 1000);
}

TEST(Fuzz, MutatedJsonNeverCrashes) {
  std::mt19937 random(7);
  for (int i = 0; i < 20'000; ++i) {
    const std::string text = mutated(std::string(json_seed), random);
    const auto document = parse_json(text, "query");
    ASSERT_NO_FATAL_FAILURE(hold(document ? read(*document) : document.error())) << text;
  }
}

TEST(Fuzz, PathsNeverCrash) {
  std::mt19937 random(11);
  const Document document = parse_yaml(yaml_seed, "f.yaml").value();
  for (int i = 0; i < 20'000; ++i) {
    const std::string path = mutated("legs[0].base.point[1]", random);
    Node root = document.root;
    if (set(root, path, make_node(1.0))) {
      ASSERT_EQ(at(root, path)->number, 1.0) << path;
    }
  }
}

}  // namespace fuzz_test

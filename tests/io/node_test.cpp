#include "sinew/io/node.hpp"

#include <gtest/gtest.h>

#include "io/document/parse.hpp"

namespace node_test {

using namespace sinew;

Document yaml(std::string_view text) { return parse_yaml(text, "f.yaml").value(); }

TEST(Node, PathsLeadToNodes) {
  Document document = yaml("legs:\n  - link: {length: 1}\n  - link: {length: 2}\n");
  EXPECT_EQ(at(document.root, "legs[1].link.length")->number, 2.0);
  EXPECT_EQ(at(document.root, ""), &document.root);
  at(document.root, "legs[0].link.length")->number = 5;
  EXPECT_EQ(document.root.find("legs")->items[0].find("link")->find("length")->number, 5.0);
  for (const char* path :
       {"legs[2]", "legs.link", "legs[0].rod", "legs[", "legs[x]", "legs[-1]", "legs[0]link", ".", "a..b",
        "legs[99999999999999999999]", "[0]", "legs[0].link.length.x"})
    EXPECT_EQ(at(document.root, path), nullptr) << path;
}

TEST(Node, APlaceIsFileLineColumn) {
  const Document document = yaml("legs:\n  - length: 1\n");
  EXPECT_EQ(place(document, *at(document.root, "legs[0].length")), "f.yaml:2:13");
  EXPECT_EQ(place(document, make_node(1.0)), "f.yaml");
}

TEST(Node, MergeIsDeepAndKeepsPlaces) {
  const Document document = yaml(
      "defaults: {link: {type: arc, length: 1, material: {E: 5}}, list: [1, 2]}\n"
      "leg: {link: {length: 2, material: {rho: 7}}, list: [3], extra: ~}\n");
  const Node leg = merged(*document.root.find("defaults"), *document.root.find("leg"));
  EXPECT_EQ(at(leg, "link.length")->number, 2.0);
  EXPECT_EQ(at(leg, "link.length")->line, 2);
  EXPECT_EQ(at(leg, "link.type")->text, "arc");
  EXPECT_EQ(at(leg, "link.type")->line, 1);
  EXPECT_EQ(at(leg, "link.material.E")->number, 5.0);
  EXPECT_EQ(at(leg, "link.material.rho")->number, 7.0);
  EXPECT_EQ(at(leg, "list")->items.size(), 1U);
  EXPECT_EQ(at(leg, "link")->line, 2);
  EXPECT_EQ(path_of(document.root, *at(leg, "link.type")), "defaults.link.type");
}

TEST(Node, AnExplicitNullTakesADefaultAway) {
  const Document document = yaml("defaults: {closure: {type: strut}}\nleg: {closure: }\n");
  const Node leg = merged(*document.root.find("defaults"), *document.root.find("leg"));
  EXPECT_EQ(leg.find("closure")->kind, Node::Kind::null);
}

TEST(Node, SetReplacesAndAddsALastKey) {
  Document document = yaml("legs:\n  - link: {length: 1}\n");
  EXPECT_TRUE(set(document.root, "legs[0].link.length", plain_scalar("180 mm")));
  EXPECT_EQ(at(document.root, "legs[0].link.length")->text, "180 mm");
  EXPECT_TRUE(set(document.root, "legs[0].link.type", make_node("rod")));
  EXPECT_EQ(at(document.root, "legs[0].link.type")->kind, Node::Kind::string);
  EXPECT_EQ(at(document.root, "legs[0].link.type")->line, 0);
  EXPECT_TRUE(set(document.root, "legs[0]", make_node(true)));
}

std::string set_error(std::string_view path) {
  Document document = yaml("legs: [{link: {length: 1}}, {}]\nplatform: {radius: 2}\nnone: []\n");
  const auto result = set(document.root, path, make_node(1.0));
  if (result) return "";
  EXPECT_EQ(result.error().front().code, "unknown_path");
  EXPECT_EQ(result.error().front().where, path);
  return result.error().front().message;
}

TEST(Node, SetSaysWhatIsThere) {
  EXPECT_EQ(set_error("legs[2].link.length"),
            "cannot set legs[2].link.length: legs has 2 items, [0] to [1].");
  EXPECT_EQ(set_error("legs[2]"), "cannot set legs[2]: legs has 2 items, [0] to [1].");
  EXPECT_EQ(set_error("none[0]"), "cannot set none[0]: none is an empty list.");
  EXPECT_EQ(set_error("platfrom.radius"),
            "cannot set platfrom.radius: the document has no key \"platfrom\" (did you mean "
            "\"platform\"?); there are: legs, platform, none.");
  EXPECT_EQ(set_error("platform.radius.x"),
            "cannot set platform.radius.x: platform.radius is a number, not a map.");
  EXPECT_EQ(set_error("platform[0]"), "cannot set platform[0]: platform is a map, not a list.");
  EXPECT_EQ(set_error("legs[1].link.x"),
            "cannot set legs[1].link.x: legs[1] has no key \"link\"; it is empty.");
  EXPECT_EQ(set_error(""), "\"\" is not a path; write it like legs[0].link.length.");
  EXPECT_EQ(set_error("a..b"), "\"a..b\" is not a path; write it like legs[0].link.length.");
}

TEST(Node, ClosestFindsSlips) {
  const std::string_view keys[] = {"type", "length", "joints", "tendon_offset"};
  EXPECT_EQ(closest("lenght", keys), "length");
  EXPECT_EQ(closest("Length", keys), "length");
  EXPECT_EQ(closest("tendonoffset", keys), "tendon_offset");
  EXPECT_EQ(closest("x", keys), "");
  EXPECT_EQ(closest("", keys), "");
  EXPECT_EQ(closest("mass", keys), "");
  EXPECT_EQ(closest(std::string(100'000, 'a'), keys), "");
}

TEST(Node, TextOfMessagesIsBounded) { EXPECT_LT(one_line(std::string(5000, 'x'), 100).size(), 104U); }

TEST(Node, QuotesStayOnOneLineAndCutBetweenCharacters) {
  EXPECT_EQ(in_quotes("a\nb"), "\"a b\"");
  std::string text(59, 'a');
  EXPECT_EQ(in_quotes(text + "µµ"), "\"" + text + "...\"");
}

}  // namespace node_test

#include "io/document/reader.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "io/document/parse.hpp"

namespace reader_test {

using namespace sinew;

/// A document, its errors and a reader at its root.
struct Input {
  explicit Input(std::string_view yaml) : document(parse_yaml(yaml, "f.yaml").value()) {}
  Document document;
  Errors errors;
  Reader root() { return Reader(document, errors); }
  std::string text() const { return to_string(errors); }
};

struct ArcFields {
  double length = 0;
  std::optional<double> diameter = 0.001;
  int joints = 0;
  std::optional<int> segments;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("length", self.length, Dimension::length, Range::positive(), "backbone length");
    visit("diameter", self.diameter, Dimension::length, Range::positive(), "rod diameter");
    visit("joints", self.joints, Dimension::count, Range::between(1, 64), "joints of the chain");
    visit("segments", self.segments, Dimension::count, Range::positive(), "segments");
  }
};

TEST(Reader, ReadsWhatIsThere) {
  Input in("name: a\nlegs: [{length: 175 mm, on: true, n: 6, law: rod}]\nhome: [1, 30 deg]\n");
  Reader robot = in.root();
  EXPECT_EQ(robot.required("name").text(), "a");
  Reader legs = robot.required("legs");
  std::vector<Reader> items = legs.items();
  ASSERT_EQ(items.size(), 1U);
  Reader& leg = items[0];
  EXPECT_EQ(leg.path(), "legs[0]");
  EXPECT_EQ(leg.place(), "f.yaml:2:8");
  EXPECT_EQ(leg.required("length").quantity(Dimension::length, Range::positive()), 0.175);
  EXPECT_TRUE(leg.required("on").boolean());
  EXPECT_EQ(leg.required("n").integer(Range::positive()), 6);
  EXPECT_EQ(leg.required("law").choice({"arc", "rod"}), "rod");
  EXPECT_FALSE(leg.optional("closure"));
  leg.close();
  EXPECT_EQ((robot.required("home").array<2>(Dimension::angle)[1]), std::numbers::pi / 6);
  robot.close();
  EXPECT_EQ(in.text(), "");
}

TEST(Reader, AllErrorsInOneGoInTheOrderOfTheFile) {
  Input in(
      "link:\n"
      "  lenght: 200 mm\n"
      "  diameter: 0.2 kg\n"
      "  joints: 6.5\n"
      "  offset: -3 mm\n"
      "  law: rodd\n"
      "  point: [1, 2, x]\n"
      "  on: yes\n");
  {
    Reader robot = in.root();
    Reader link = robot.required("link");
    EXPECT_EQ(link.required("on").boolean(), false);
    EXPECT_EQ(link.required("point").quantities(Dimension::length, {}, 2).size(), 2U);
    EXPECT_EQ(link.required("law").choice({"arc", "rod"}), "arc");
    EXPECT_GT(link.required("length", "backbone length").quantity(Dimension::length, Range::positive()), 0);
    EXPECT_GT(link.required("diameter").quantity(Dimension::length, Range::positive()), 0);
    EXPECT_GT(link.required("offset").quantity(Dimension::length, Range::positive()), 0);
    EXPECT_GE(link.required("joints").integer(Range::between(1, 64)), 1);
    link.close();
    robot.close();
  }
  EXPECT_EQ(in.text(),
            "f.yaml:2:3: missing key \"length\" in link (backbone length). [missing_key]\n"
            "f.yaml:2:3: unknown key \"lenght\" in link; did you mean \"length\"? Known here: on, point, "
            "law, length, "
            "diameter, offset, joints. [unknown_key]\n"
            "f.yaml:3:13: link.diameter = \"0.2 kg\" is a mass; give a length (\"0.2 m\", \"200 mm\", or 0.2 "
            "for metres). "
            "[wrong_dimension]\n"
            "f.yaml:4:11: link.joints = 6.5; give a whole number (3). [not_whole]\n"
            "f.yaml:5:11: link.offset = -3 mm; it must be positive. [out_of_range]\n"
            "f.yaml:6:8: link.law = \"rodd\" is unknown; did you mean \"rod\"? Known here: arc, rod. "
            "[unknown_choice]\n"
            "f.yaml:7:10: link.point has 3 values; it must have 2. [wrong_length]\n"
            "f.yaml:7:17: link.point[2] = \"x\" is not a number; give a length (\"0.2 m\", \"200 mm\", or "
            "0.2 for metres). "
            "[not_a_number]\n"
            "f.yaml:8:7: link.on = \"yes\"; give true or false. [wrong_type]");
}

TEST(Reader, RangesAreSaidInUnitsOfPeople) {
  Input in("a: 100 deg\nb: -1\nc: 0\nd: 5\ne: 2 m\n");
  Reader map = in.root();
  map.required("a").quantity(Dimension::angle, Range::between(0, std::numbers::pi / 2));
  map.required("b").number(Range::not_negative());
  map.required("c").number({.low = 0, .high = 1, .low_excluded = true});
  map.required("d").number({.high = 1, .high_excluded = true});
  map.required("e").quantity(Dimension::length, {.high = 1});
  map.required("d").number({.low = 6});
  EXPECT_EQ(in.text(),
            "f.yaml:1:4: a = 100 deg; it must be from 0 deg to 90 deg. [out_of_range]\n"
            "f.yaml:2:4: b = -1; it must not be negative. [out_of_range]\n"
            "f.yaml:3:4: c = 0; it must be more than 0 and at most 1. [out_of_range]\n"
            "f.yaml:4:4: d = 5; it must be less than 1. [out_of_range]\n"
            "f.yaml:4:4: d = 5; it must be at least 6. [out_of_range]\n"
            "f.yaml:5:4: e = 2 m; it must be at most 1000 mm. [out_of_range]");
}

TEST(Reader, AFallbackLiesInItsRange) {
  Input in("x: long\n");
  Reader map = in.root();
  for (const Range& range :
       {Range{}, Range::positive(), Range::not_negative(), Range::between(5, 6), Range::between(-3, -2),
        Range{.low = 5, .low_excluded = true}, Range{.high = -5, .high_excluded = true},
        Range{.low = 0.2, .high = 0.3, .low_excluded = true, .high_excluded = true}}) {
    const double value = map.required("x").number(range);
    EXPECT_TRUE(range.contains(value)) << value << " in " << range.low << ", " << range.high;
  }
  EXPECT_EQ(map.required("x").integer(Range::between(5, 6)), 5);
}

TEST(Reader, NodesOfTheWrongKindAreErrorsNotCrashes) {
  Input in("number: 5\nlist: [1]\nmap: {a: 1}\ntext: word\nflag: true\nnothing: ~\n");
  Reader root = in.root();
  for (const char* key : {"number", "list", "map", "text", "flag", "nothing", "absent"}) {
    Reader r = root.required(key);
    r.quantity(Dimension::force);
    r.integer();
    r.text();
    r.boolean();
    r.choice({"a", "b"});
    r.quantities(Dimension::length, Range::positive(), 3);
    r.items();
    r.members();
    r.required("x").required("y").items();
    r.optional("x");
    r.refuse("custom", "no.");
    r.close();
  }
  const std::string text = in.text();
  for (const char* message :
       {"number = 5; give a map of keys.",
        "list is a list; give a force (\"2 N\", \"50 mN\", or 2 for newtons).",
        "map is a map; give text, in quotes if it looks like a number.", "text = \"word\"; give a list.",
        "flag = true; give a whole number (3).", "f.yaml:6:10: missing key \"nothing\".",
        "list is a list; give one of a, b.", "number = 5; give a list of 3 values, each a length"})
    EXPECT_NE(text.find(message), std::string::npos) << message << "\n" << text;
  EXPECT_EQ(text.find("absent", text.find("missing key \"absent\"") + 15), std::string::npos)
      << "a missing key is said once";
}

TEST(Reader, ANullTakesAwayADefaultThatDoesNotFit) {
  Input in("type: chord\nlength: null\n");
  Reader root = in.root();
  root.required("type").text();
  root.close();
  EXPECT_EQ(in.text(), "");
}

TEST(Reader, ARootThatIsNoMapIsSaidOnce) {
  Input in("- 1\n");
  Reader root = in.root();
  root.required("name").text();
  root.optional("legs");
  root.close();
  EXPECT_EQ(in.text(), "f.yaml:1:1: the document is a list; give a map of keys. [wrong_type]");
}

TEST(Reader, DefaultsSharedByLegsAreNamedOnceAndWhereTheyStand) {
  Input in(
      "defaults: {link: {length: 0.2 kg, lenght: 1}}\n"
      "legs:\n"
      "  - {link: {joints: 6}}\n"
      "  - {link: {joints: six}}\n");
  Reader robot = in.root();
  const Node& defaults = *robot.required("defaults").node();
  const std::vector<Reader> legs = robot.required("legs").items();
  for (const Reader& own : legs) {
    const Node node = merged(defaults, *own.node());
    Reader leg = own.over(node);
    Reader link = leg.required("link");
    link.required("length").quantity(Dimension::length);
    link.required("joints").integer();
    link.close();
  }
  robot.close();
  EXPECT_EQ(
      in.text(),
      "f.yaml:1:27: defaults.link.length = \"0.2 kg\" is a mass; give a length (\"0.2 m\", \"200 mm\", or "
      "0.2 for "
      "metres). [wrong_dimension]\n"
      "f.yaml:1:35: unknown key \"lenght\" in defaults.link; did you mean \"length\"? Known here: length, "
      "joints. "
      "[unknown_key]\n"
      "f.yaml:4:21: legs[1].link.joints = \"six\" is not a number; give a whole number (3). [not_a_number]");
}

TEST(Reader, WithoutLinesThePathIsThePlace) {
  const Document query = parse_json(R"({"inputs": [1, "x", "2 mm"], "extra": 1})", "query").value();
  Errors errors;
  Reader root(query, errors);
  root.required("robot");
  root.required("inputs").quantities(Dimension::length);
  root.close();
  EXPECT_EQ(to_string(errors),
            "query: missing key \"robot\". [missing_key]\n"
            "inputs[1]: inputs[1] = \"x\" is not a number; give a length (\"0.2 m\", \"200 mm\", or 0.2 for "
            "metres). "
            "[not_a_number]\n"
            "extra: unknown key \"extra\". Known here: robot, inputs. [unknown_key]");
}

TEST(Reader, KeysOfAHostileQueryStayShortAndOnOneLine) {
  const std::string key(100'000, 'k');
  const Document query = parse_json("{\"a\\nb\": {\"" + key + "\": {\"x\": 1}}}", "query").value();
  Errors errors;
  Reader root(query, errors);
  Reader inner = root.required("a\nb").required(key).required("x");
  inner.text();
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_LT(to_string(errors).size(), 2500U);
  EXPECT_EQ(to_string(errors).substr(0, 8), "a b.kkkk");
}

TEST(Reader, AValueSetFromOutsideIsNamedByItsPath) {
  Input in("link: {length: 1}\n");
  ASSERT_TRUE(set(in.document.root, "link.length", plain_scalar("-1 mm")));
  Reader root = in.root();
  root.required("link").required("length").quantity(Dimension::length, Range::positive());
  EXPECT_EQ(in.text(), "link.length: link.length = -1 mm; it must be positive. [out_of_range]");
}

TEST(Reader, ACallerAddsItsOwnErrors) {
  Input in("legs: [1, 2]\nlength: 0.2 m\n");
  Reader root = in.root();
  root.required("length").refuse("too_short", "it must be longer than the strut, 300 mm.");
  root.required("legs").fail("wrong_count", "3-RFR needs 3 platform points, found 2.");
  root.fail("whole", "the robot has no platform.");
  EXPECT_EQ(in.text(),
            "f.yaml:1:1: the robot has no platform. [whole]\n"
            "f.yaml:1:7: legs: 3-RFR needs 3 platform points, found 2. [wrong_count]\n"
            "f.yaml:2:9: length = 0.2 m; it must be longer than the strut, 300 mm. [too_short]");
}

TEST(Reader, ChoicesMayBeValuesOfAnyType) {
  enum class Law { arc, rod };
  Input in("law: rod\nversion: 1\n");
  Reader root = in.root();
  EXPECT_EQ(root.required("law").choice_of<Law>({{"arc", Law::arc}, {"rod", Law::rod}}), Law::rod);
  EXPECT_EQ(root.required("version").choice({"1", "2"}), "1");
  EXPECT_EQ(in.text(), "");
}

TEST(Reader, IntegersStayIntegers) {
  Input in("a: 1e10\nb: -1e300\nc: \"7\"\nd: 6.0\n");
  Reader root = in.root();
  root.required("a").integer();
  root.required("b").integer();
  EXPECT_EQ(root.required("c").integer(), 7);
  EXPECT_EQ(root.required("d").integer(), 6);
  EXPECT_EQ(in.errors.size(), 2U);
  EXPECT_EQ(in.errors[0].code, "out_of_range");
}

TEST(Reader, MembersWalkAMapOfFreeKeys) {
  Input in("set: {b: 1, a: 2}\n");
  Reader root = in.root();
  std::string keys;
  for (const auto& [key, value] : root.required("set").members())
    keys += key + "=" + value.node()->text + " ";
  EXPECT_EQ(keys, "b=1 a=2 ");
}

TEST(Reader, TheListOfErrorsHasAnEnd) {
  std::string text = "list: [";
  for (int i = 0; i < 5000; ++i) text += "x, ";
  text += "x]\n";
  for (int i = 0; i < 5000; ++i) text += "k" + std::to_string(i) + ": 1\n";
  Input in(text);
  Reader root = in.root();
  root.required("list").quantities(Dimension::mass);
  root.close();
  EXPECT_EQ(in.errors.size(), Reader::error_limit + 1);
  EXPECT_EQ(in.errors.back().code, "too_many_errors");
}

TEST(FieldReader, FillsAStructThatNamesItsFieldsOnce) {
  Input in("length: 200 mm\njoints: 6\n");
  Reader root = in.root();
  ArcFields arc;
  ArcFields::fields(arc, FieldReader(root));
  root.close();
  EXPECT_EQ(in.text(), "");
  EXPECT_EQ(arc.length, 0.2);
  EXPECT_EQ(arc.diameter, 0.001);
  EXPECT_EQ(arc.joints, 6);
  EXPECT_FALSE(arc.segments);
}

TEST(FieldReader, SaysEverythingThatIsWrong) {
  Input in("diameter: 0 mm\njoints: 100\nsegments: 2\nlen: 1\n");
  Reader root = in.root();
  ArcFields arc;
  ArcFields::fields(arc, FieldReader(root));
  root.close();
  EXPECT_EQ(in.text(),
            "f.yaml:1:1: missing key \"length\" (backbone length). [missing_key]\n"
            "f.yaml:1:11: diameter = 0 mm; it must be positive. [out_of_range]\n"
            "f.yaml:2:9: joints = 100; it must be from 1 to 64. [out_of_range]\n"
            "f.yaml:4:1: unknown key \"len\". Known here: length, diameter, joints, segments. [unknown_key]");
  EXPECT_EQ(arc.segments, 2);
}

}  // namespace reader_test

/// The table of fields and the handlers agree on what each question takes.
#include "query/fields/fields.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "sinew/session.hpp"
#include "sinew_query.hpp"

namespace sinew::test {
namespace fields_test {

using Names = std::set<std::string>;

/// Of an answer to a question with a field that nobody knows.
Names known_of(const Json& answer) {
  Names names;
  const std::string message = answer.value("error", Json::object()).value("message", "");
  const std::size_t from = message.rfind("Known here: ");
  if (from == std::string::npos) return names;
  std::string name;
  for (const char c : message.substr(from + 12)) {
    if (c == ',' || c == '.') {
      names.insert(name);
      name.clear();
    } else if (c != ' ') {
      name += c;
    }
  }
  return names;
}

struct Case {
  const char* name;
  unsigned mechanics;
  std::vector<const char*> robots;
};

/// Asked in all ways in which handlers read other fields.
Names known_by(const Case& one, const std::string& kind) {
  Names known;
  for (const char* robot : one.robots) {
    Json plain = {{"query", kind}, {"nothing", 1}};
    if (one.mechanics == of_chains && kind != "statics") plain["model"] = "prb";
    std::vector<Json> ways{plain};
    for (const char* word : {"velocity", "shape"})
      ways.push_back(plain), ways.back()["want"] = Json::array({word});
    ways.push_back(plain), ways.back()["measured_tensions"] = Json::array();
    ways.push_back(plain), ways.back()["set_at"] = Json::object();
    ways.push_back(plain), ways.back()["to"] = {{"wrench", Json::array()}};
    for (const Json& answer : ask(robot, ways)) known.merge(known_of(answer));
  }
  return known;
}

/// Read only to say why they have no use there.
const std::map<std::string, Names> refused{
    {"kinematic", {"wrench", "until", "angles"}},
    {"chains",
     {"with_respect_to", "independent", "samples", "inverse", "set_at", "hold", "lengths", "tensions",
      "until", "pose", "posture_threshold", "objective", "from", "poses", "angles", "rk4_steps"}},
    {"rods",
     {"trace", "with_respect_to", "bending", "elbow", "curvature", "along", "limit", "pose", "independent"}},
    {"serial", {}},
    {"arms", {}},
};

class FieldsOf : public testing::TestWithParam<Case> {};

TEST_P(FieldsOf, AreThoseOfTheTable) {
  const Case& one = GetParam();
  for (const Ask ask : every_ask) {
    const std::string_view kind = word_of(ask);
    const Names known = known_by(one, std::string(kind));
    const bool is_of_chains =
        one.mechanics == of_kinematic && ask == Ask::statics;  // that is answered by chains
    if (known.empty() || is_of_chains) continue;               // nobody answers it
    for (const Field& field : question_fields()) {
      if ((field.uses.of(ask) & one.mechanics) == 0) continue;
      EXPECT_TRUE(known.contains(std::string(field.name))) << one.name << ' ' << kind << ": " << field.name;
    }
    for (const std::string& name : known) {
      const Field* field = find_field(name);
      const bool is_told = field && (field->uses.of(ask) & one.mechanics) != 0;
      EXPECT_TRUE(is_told || refused.at(one.name).contains(name))
          << one.name << ' ' << kind << " takes " << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Mechanics, FieldsOf,
    testing::Values(Case{"kinematic", of_kinematic, {"3-rfr", "6-ufs", "3prs", "3-rfrr"}},
                    Case{"chains", of_chains, {"3-rfr"}}, Case{"rods", of_rods, {"3pfs-g2", "hexapod"}},
                    Case{"serial", of_serial, {"nottingham-tpcj"}}, Case{"arms", of_arms, {"two-segment"}}),
    [](const auto& one) { return std::string(one.param.name); });

TEST(Fields, AreNamedOnce) {
  Names names;
  for (const Field& field : question_fields()) {
    EXPECT_TRUE(names.insert(std::string(field.name)).second) << field.name;
    EXPECT_FALSE(field.meaning.empty());
    EXPECT_EQ(field.words.empty(), field.shape != FieldShape::word && field.shape != FieldShape::words)
        << field.name;
    EXPECT_EQ(std::ranges::count(field.meaning, '`') % 2, 0);
  }
}

/// Names and handlers are two lists in one order.
TEST(Fields, KindsOfQuestionsAreAnsweredUnderTheirNames) {
  for (const auto& [robot, kind, fields] :
       {std::tuple{"3-rfr", "forward", R"("inputs":[0.19,0.19,0.19])"},
        {"3-rfr", "inverse", R"("pose":{"x":0,"y":0,"phi":0})"},
        {"3-rfr", "velocity", R"("pose":{"x":0,"y":0,"phi":0})"},
        {"3-rfr", "shape", R"("inputs":[0.19,0.19,0.19])"},
        {"3-rfr", "statics", R"("tensions":[[0.5,0],[0.5,0],[0.5,0]])"},
        {"3-rfr", "track", R"("from":{"x":0,"y":0,"phi":0},"to":{"x":0.01,"y":0,"phi":0},"samples":2)"},
        {"nottingham-tpcj", "diagram", R"("section":0,"changes":[0,0,0])"},
        {"ftdcr-v4", "identify",
         R"("rows":{"pulls":[[0.001,0,0,0,0,0,0,0,0]],"markers":[[0.02,0,0.2]]},"fit":"bending")"},
        {"3-rfr", "describe", R"("id":1)"}}) {
    auto session = Session::open(std::string(robot)).value();
    const std::string answer = session.answer(fmt::format(R"({{"query":"{}",{}}})", kind, fields));
    EXPECT_NE(answer.find(fmt::format(R"("query":"{}")", kind)), std::string::npos) << answer;
    EXPECT_EQ(answer.find(R"("error":)"), std::string::npos) << answer;
    EXPECT_NE(std::ranges::find(ask_words, std::string_view(kind)), ask_words.end());
  }
  EXPECT_EQ(ask_words.size(), 9U);
}

}  // namespace fields_test
}  // namespace sinew::test

/// The lists of answers against what layouts say of them, for every robot.
#include "query/batch/field_layout.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "sinew/io/robot_file.hpp"
#include "sinew/session.hpp"

namespace sinew {
namespace field_layout_test {

using Json = nlohmann::ordered_json;

bool is_list_of_numbers(const Json& value) {
  if (!value.is_array() || value.empty()) return false;
  return std::ranges::all_of(value,
                             [](const Json& one) { return one.is_number() || is_list_of_numbers(one); });
}

/// Compares the layouts of all lists of numbers in an answer, which are at `place`.
void compare(const Json& value, const std::string& place, const FieldLayouts& layouts,
             std::set<std::string>& unknown) {
  if (is_list_of_numbers(value)) {
    const FieldLayout layout = layouts.output(place);
    if (layout.shape.empty()) unknown.insert(place.substr(place.rfind('.') + 1));
    for (std::size_t i = 0; i < layout.size() && !layout.shape.empty(); ++i) {
      Json::json_pointer at;
      std::string rest = layout.suffix(i);
      while (!rest.empty()) {
        at /= std::stoul(rest.substr(1));
        rest.erase(0, rest.find(']') + 1);
      }
      EXPECT_TRUE(value.contains(at) && value.at(at).is_number()) << place << layout.suffix(i);
    }
    const Json whole = value.flatten();
    EXPECT_TRUE(layout.shape.empty() || whole.size() == layout.size()) << place << " " << value;
    return;
  }
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i)
      compare(value[i], place + '[' + std::to_string(i) + ']', layouts, unknown);
  if (value.is_object())
    for (const auto& [key, one] : value.items())
      compare(one, place.empty() ? key : place + '.' + key, layouts, unknown);
}

/// Questions about a robot near home.
std::vector<Json> questions(const Json& described, Session& session) {
  if (described["kind"] == "serial") {
    const Json bends(described["sections"].size(), Json{0.1, 0.05});
    return {{{"query", "forward"}, {"configuration", bends}},
            {{"query", "velocity"}, {"configuration", bends}, {"twist", {1e-3, 0, 0, 0, 0, 0}}}};
  }
  if (described["kind"] == "arm") {
    std::vector<Json> lengths(described["sections"].size(), Json::array());
    for (const Json& tendon : described["tendons"])
      lengths[tendon["section"].get<std::size_t>()].push_back(0);
    return {{{"query", "forward"}, {"changes", lengths}}, {{"query", "velocity"}, {"changes", lengths}}};
  }
  const Json& home = described["home"];
  std::vector<Json> all{{{"query", "inverse"}, {"pose", home}}, {{"query", "velocity"}, {"pose", home}}};
  for (const char* z : {"z"})  // three inputs hold three of its freedoms
    if (home.contains("position"))
      for (const char* query : {"inverse", "velocity"})
        all.push_back(
            {{"query", query}, {"independent", {{z, home["position"][2]}, {"e1", 0.01}, {"e2", 0}}}});
  for (std::size_t q = 0, n = all.size(); q < n; ++q) {
    const Json found = Json::parse(session.answer(all[q].dump()));
    if (!found.contains("inputs") || q % 2 == 1) continue;
    for (const char* query : {"forward", "velocity"})
      all.push_back({{"query", query}, {"inputs", found["inputs"]}});
  }
  return all;
}

TEST(FieldLayouts, AreThoseOfAnswersOfChains) {
  for (const char* name : {"3-rfr", "3-frr", "3-rfrr", "6-ufs"}) {
    SCOPED_TRACE(name);
    const Robot robot = read_robot(read_robot_file(name).value()).value().as(Model::prb).value();
    Session session = Session::open(name).value();
    const Json home = Json::parse(session.answer(R"({"query": "describe"})"))["home"];
    std::set<std::string> unknown;
    for (Json question :
         {Json{{"query", "statics"}, {"set_at", home}},
          Json{{"query", "inverse"}, {"model", "prb"}, {"pose", home}, {"want", {"sensitivity"}}},
          Json{{"query", "velocity"}, {"model", "prb"}, {"pose", home}}}) {
      const std::size_t freedoms = robot.planar() ? 3 : 6;
      if (question["query"] == "velocity") question["twist"] = std::vector<double>(freedoms, 1e-3);
      const Json answer = Json::parse(session.answer(question.dump()));
      EXPECT_TRUE(answer.contains("legs")) << question << answer;
      compare(answer, "", FieldLayouts(robot, question["query"].get<std::string>()), unknown);
    }
    EXPECT_EQ(Json(unknown).dump(), "[]");
  }
}

TEST(FieldLayouts, AreThoseOfAnswers) {
  std::set<std::string> unknown;
  for (const std::string_view name : builtin_robot_names()) {
    SCOPED_TRACE(name);
    const Robot robot = read_robot(read_robot_file(std::string(name)).value()).value();
    Session session = Session::open(std::string(name)).value();
    const Json described = Json::parse(session.answer(R"({"query": "describe"})"));
    for (const Json& question : questions(described, session)) {
      SCOPED_TRACE(question.dump());
      compare(Json::parse(session.answer(question.dump())), "",
              FieldLayouts(robot, question["query"].get<std::string>()), unknown);
    }
  }
  EXPECT_EQ(Json(unknown).dump(), "[]");
}

}  // namespace field_layout_test
}  // namespace sinew

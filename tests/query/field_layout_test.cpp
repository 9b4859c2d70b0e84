/// The lists of answers against what layouts say of them, for every robot.
#include "query/batch/field_layout.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "corpus.hpp"
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
             const AnswerPlaces& places, std::set<std::string>& unknown) {
  if (is_list_of_numbers(value)) {
    const FieldLayout layout = layouts.output(place);
    const AnswerField* field = places.field(place);
    const bool is_open = field && depth_of(field->shape) > 0;  // as long as it is
    if (layout.shape.empty() && !is_open) unknown.insert(place.substr(place.rfind('.') + 1));
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
      compare(value[i], place + '[' + std::to_string(i) + ']', layouts, places, unknown);
  if (value.is_object())
    for (const auto& [key, one] : value.items())
      compare(one, place.empty() ? key : place + '.' + key, layouts, places, unknown);
}

void compare(const Json& answer, const Robot& robot, const Json& question, std::set<std::string>& unknown) {
  const auto kind = question["query"].get<std::string>();
  compare(answer, "", FieldLayouts(robot, kind), AnswerPlaces(robot, ask_of(kind).value()), unknown);
}

/// A number of each tendon, a list a section: of an arm, or of a platform on arms those of leg 0 first.
Json by_tendons(const Json& described, const std::function<double(std::size_t)>& number) {
  Json arms = Json::array();
  if (described["kind"] == "arm")
    arms.push_back(described);
  else
    for (const Json& leg : described["legs"]) arms.push_back(leg["link"]);
  Json lists = Json::array();
  std::size_t count = 0;
  for (const Json& arm : arms) {
    std::vector<Json> sections(arm["sections"].size(), Json::array());
    for (const Json& tendon : arm["tendons"])
      sections[tendon["section"].get<std::size_t>()].push_back(number(count++));
    for (Json& section : sections) lists.push_back(std::move(section));
  }
  return lists;
}

/// A question with these fields. Compilers read nested braces of such trees in more ways than one.
Json asking(std::string_view query, std::initializer_list<std::pair<const char*, Json>> fields) {
  Json question = Json::object();
  question["query"] = query;
  for (const auto& [name, value] : fields) question[name] = value;
  return question;
}
Json list_of(std::initializer_list<Json> items) {
  Json list = Json::array();
  for (const Json& item : items) list.push_back(item);
  return list;
}

/// Questions about an arm, its path with friction among them, or about a platform on arms.
std::vector<Json> questions_of_arms(const Json& described) {
  const auto tensions = [&](double first) {
    return by_tendons(described, [=](std::size_t i) { return i == 0 ? first : 0.5; });
  };
  const Json none = by_tendons(described, [](std::size_t) { return 0.0; });
  const auto point = [&](double first) {
    Json at = Json::object();
    at["tensions"] = tensions(first);
    return at;
  };
  Json track = asking("track", {{"points", list_of({point(0.6), point(1)})}, {"steps", 2}});
  if (described["kind"] == "arm") {
    track["want"] = list_of({"velocity", "shape"});
    track["motions"] = by_tendons(described, [](std::size_t i) { return i == 0 ? 1.0 : 0.5; });
  }
  Json short_track = track;
  short_track["max_iterations"] = 1;  // it ends on its way: `reached`
  std::vector<Json> all;
  all.push_back(asking("forward", {{"changes", none}}));
  all.push_back(asking("velocity", {{"changes", none}}));
  all.push_back(
      asking("forward", {{"tensions", tensions(0.6)},
                         {"want", list_of({"pose", "shape", "stability", "stiffness", "velocity"})}}));
  all.push_back(track);
  all.push_back(short_track);
  return all;
}

/// Questions about a robot near home.
std::vector<Json> questions(const Json& described, Session& session) {
  std::vector<Json> all;
  if (described["kind"] == "serial") {
    Json bends = Json::array();
    for (std::size_t m = 0; m < described["sections"].size(); ++m) bends.push_back(list_of({0.1, 0.05}));
    all.push_back(asking("forward", {{"configuration", bends}}));
    all.push_back(asking("velocity", {{"configuration", bends}, {"twist", list_of({1e-3, 0, 0, 0, 0, 0})}}));
    return all;
  }
  if (described["kind"] == "arm" || described["kind"] == "arm_legs") return questions_of_arms(described);
  const Json& home = described["home"];
  for (const char* query : {"inverse", "velocity"}) all.push_back(asking(query, {{"pose", home}}));
  if (home.contains("position")) {  // three inputs hold three of its freedoms
    Json three = Json::object();
    three["z"] = home["position"][2];
    three["e1"] = 0.01;
    three["e2"] = 0;
    for (const char* query : {"inverse", "velocity"}) all.push_back(asking(query, {{"independent", three}}));
  }
  for (std::size_t q = 0, n = all.size(); q < n; ++q) {
    const Json found = Json::parse(session.answer(all[q].dump()));
    if (!found.contains("inputs") || q % 2 == 1) continue;
    for (const char* query : {"forward", "velocity"})
      all.push_back(asking(query, {{"inputs", found["inputs"]}}));
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
      compare(answer, robot, question, unknown);
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
      compare(Json::parse(session.answer(question.dump())), robot, question, unknown);
    }
  }
  EXPECT_EQ(Json(unknown).dump(), "[]");
}

/// The name of the field of a place, as those find it who know neither robot nor question: the longest name
/// that the place ends with. Units in Python are found so.
std::string_view name_of(const std::string& place) {
  static const std::vector<AnswerField> fields = answer_fields();
  std::string words = ".";
  for (std::size_t i = 0; i < place.size(); ++i)
    if (place[i] == '[')
      i = place.find(']', i);
    else
      words += place[i];
  std::string_view longest;
  for (const AnswerField& field : fields)
    if (field.name.size() > longest.size() && words.ends_with("." + std::string(field.name)))
      longest = field.name;
  return longest;
}

/// Notes the places of numbers of which the table says nothing, or which their names do not tell apart.
void look_up(const Json& value, const std::string& place, const AnswerPlaces& places,
             std::set<std::string>& unknown) {
  if (value.is_number()) {
    const AnswerField* field = places.field(place);
    if (!field || name_of(place) != field->name) unknown.insert(place);
  }
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i)
      look_up(value[i], place + '[' + std::to_string(i) + ']', places, unknown);
  if (value.is_object())
    for (const auto& [key, one] : value.items())
      if (key != "id") look_up(one, place.empty() ? key : place + '.' + key, places, unknown);
}

TEST(AnswerPlaces, HaveEveryNumberOfEveryAnswer) {
  std::size_t answers = 0, paths = 0, fits = 0;
  for (const std::string_view name : builtin_robot_names()) {
    SCOPED_TRACE(name);
    Session session = Session::open(std::string(name)).value();
    const Json described = Json::parse(session.answer(R"({"query": "describe"})"));
    std::vector<Json> asked = questions(described, session);
    for (Json& query : test::corpus_of(name)) asked.push_back(std::move(query));
    for (const Json& query : asked) {
      const Ask ask = ask_of(query["query"].get<std::string>()).value();
      if (ask == Ask::describe) continue;  // it says a file again
      const Json answer = Json::parse(session.answer(query.dump()));
      std::set<std::string> unknown;
      look_up(answer, "", AnswerPlaces(ask), unknown);
      EXPECT_TRUE(unknown.empty()) << query << "\n" << Json(unknown);
      answers += !answer.contains("error");
      paths += answer.contains("one_sided") && answer.contains("in_motion");
      fits += answer.contains("parameters");
    }
  }
  EXPECT_GT(answers, 100U);
  EXPECT_GT(paths, 0U);
  EXPECT_GT(fits, 0U);
}

TEST(AnswerPlaces, TellNumbersOfOneNameApart) {
  const auto unit = [](Ask ask, const char* place) { return AnswerPlaces(ask).field(place)->unit; };
  EXPECT_EQ(unit(Ask::track, "rows[3].point"), "");
  EXPECT_EQ(unit(Ask::velocity, "type_2.point[1]"), "m");
  EXPECT_EQ(unit(Ask::diagram, "point[0]"), "rad");
  EXPECT_EQ(unit(Ask::forward, "changes[0][2]"), "m");
  EXPECT_EQ(unit(Ask::track, "rows[1].changes[0][2]"), "m");
  EXPECT_EQ(unit(Ask::track, "in_motion.changes[0][2]"), "m/s");
  EXPECT_EQ(unit(Ask::track, "one_sided[4].growing.changes[0][2]"), "");
  EXPECT_EQ(unit(Ask::track, "one_sided[4].shrinking.tensions[0][2]"), "");
  EXPECT_EQ(unit(Ask::track, "reached.part"), "");
  for (const char* place : {"", "rows[3].nothing", "rows[3].", "rows[3]", "[3]", "]x[", "x[", "pose", "pose.",
                            ".x", "residual.x"})
    EXPECT_EQ(AnswerPlaces(Ask::track).field(place), nullptr) << place;
}

}  // namespace field_layout_test
}  // namespace sinew

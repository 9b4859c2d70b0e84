/// The table of places against the answers themselves, of every robot.
#include "query/fields/answer_places.hpp"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "corpus.hpp"
#include "io/document/parse.hpp"
#include "query/batch/answer_path.hpp"
#include "query/batch/field_layout.hpp"
#include "query/tree_session.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/robot/assembly.hpp"

namespace sinew {
namespace answer_places_test {

using Json = nlohmann::ordered_json;
using Names = std::set<std::string>;

/// Questions that have answers to look into.
std::vector<Json> questions_to(std::string_view robot) {
  std::vector<Json> queries = test::corpus_of(robot);
  std::erase_if(queries, [](const Json& query) { return query["query"] == "describe"; });
  return queries;
}

Ask ask_of(const Json& query) { return sinew::ask_of(query["query"].get<std::string>()).value(); }

Robot as_asked(const Robot& robot, const Json& query) {
  const std::string model = query.value("model", "");
  const bool is_of_lengths =
      robot.arm() && (model == "pcc" || model == "lsk" || ask_of(query) == Ask::diagram);
  if (is_of_lengths) return robot.as(Model::cc).value();
  const bool is_on_chains = model == "prb" || ask_of(query) == Ask::statics;
  return is_on_chains && robot.model() == Model::cc && !robot.serial() && !robot.arm()
             ? robot.as(Model::prb).value()
             : robot;
}

/// The places of all numbers and flags; of lists of numbers the list and its first number.
void collect(const Json& value, const std::string& place, Names& places) {
  if (value.is_number() || value.is_boolean()) places.insert(place);
  if (value.is_array() && !value.empty()) collect(value[0], place + "[0]", places);
  if (value.is_object())
    for (const auto& [key, one] : value.items())
      if (key != "id") collect(one, place.empty() ? key : place + '.' + key, places);
}

class EveryAnswer : public testing::Test {
 protected:
  template <class Use>
  void each(const Use& use) {
    for (const std::string_view name : builtin_robot_names()) {
      SCOPED_TRACE(name);
      const Document document = read_robot_file(std::string(name)).value();
      const Robot robot = read_robot(document).value();
      TreeSession session = TreeSession::open(document).value();
      for (const Json& query : questions_to(name)) {
        SCOPED_TRACE(query.dump());
        use(as_asked(robot, query), query, [&](const Json& asked) {
          return Json::parse(session.answer(parse_json(asked.dump(), "query").value()).json());
        });
      }
    }
  }
};

TEST_F(EveryAnswer, HasOnlyPlacesOfTheTable) {
  std::size_t count = 0;
  each([&](const Robot& robot, const Json& query, const auto& answer) {
    if (query.contains("set")) return;
    const AnswerPlaces known(robot, ask_of(query));
    const FieldLayouts layouts(robot, query["query"].get<std::string>());
    Names places;
    collect(answer(query), "", places);
    for (const std::string& place : places) {
      const auto found = known.find(place);
      EXPECT_TRUE(found) << place << ": " << found.error();
      if (!found) continue;
      if (found->last->is_value()) {
        EXPECT_EQ(layouts.why_no_column(place), "") << place;
      }
      EXPECT_TRUE(found->root->with.empty() || query.contains(found->root->with)) << place;
      ++count;
    }
  });
  EXPECT_GT(count, 1000U);
}

constexpr std::string_view words[] = {"pose",      "legs",    "velocity",    "shape", "stiffness",
                                      "stability", "margins", "sensitivity", "lines"};

/// What two words give: of chains `legs` too, of arcs `shape` too, of arms `stability` too.
bool is_of_two(const std::string& place) {
  return place.starts_with("stiffness") || place.starts_with("compliance") || place.starts_with("lines") ||
         place == "buckling_margin";
}

/// A word of `want` gives what the table says, and nothing else of the table.
TEST_F(EveryAnswer, HasWhatItsWantsGive) {
  std::size_t count = 0;
  each([&](const Robot& robot, Json query, const auto& answer) {
    const Ask ask = ask_of(query);
    if (query.contains("set") || query.contains("all") || ask == Ask::track || ask == Ask::identify) return;
    for (const char* field : {"want", "twist", "rates", "along", "limit", "samples", "motions"})
      query.erase(field);
    const AnswerPlaces known(robot, ask);
    const Document asked = parse_json(query.dump(), "query").value();
    for (std::size_t k = 0; k < std::size(words); ++k) {
      query["want"] = Json::array({words[k]});
      const Json found = answer(query);
      if (found.contains("error") || found["status"] != "converged" || found.contains("message")) continue;
      for (const std::string& place : known.given_by(static_cast<Want>(k), asked.root)) {
        std::string pointer = "/" + place;
        for (std::size_t at = 0; (at = pointer.find_first_of(".[]", at)) != std::string::npos;)
          pointer.replace(at, 1, pointer[at] == ']' ? "" : "/");
        EXPECT_TRUE(found.contains(Json::json_pointer(pointer))) << words[k] << ' ' << place;
        ++count;
      }
      Names places;
      collect(found, "", places);
      const Wants wanted = known.wanted({static_cast<Want>(k)});
      for (const std::string& place : places) {
        const auto at = known.find(place);
        EXPECT_TRUE(at) << place;
        if (at && at->root->want && !at->root->is_always && !is_of_two(place)) {
          EXPECT_TRUE(wanted.has(*at->root->want)) << words[k] << ' ' << place;
        }
      }
    }
  });
  EXPECT_GT(count, 1000U);
}

/// What the table says to be told without the legs is the same without them.
TEST_F(EveryAnswer, IsTheSameWithoutLegs) {
  std::size_t count = 0;
  each([&](const Robot& robot, Json query, const auto& answer) {
    const Wants named = named_wants(parse_json(query.dump(), "query").value().root);
    if (query.contains("set") || query.value("start", Json()) == "last" || !(named & usual_wants).is_empty())
      return;
    const AnswerPlaces known(robot, ask_of(query));
    const Json whole = answer(query);
    query["want"].push_back("pose");
    const Json narrow = answer(query);
    if (narrow.contains("error")) return;  // its `want` does not know the word
    for (const auto& [key, value] : whole.items()) {
      Names places;
      collect(value, key, places);
      if (!places.empty() && known.is_told(*places.begin(), named | Wants{Want::pose})) {
        ++count;
        EXPECT_TRUE(narrow.contains(key) && narrow[key] == value) << key;
      }
    }
  });
  EXPECT_GT(count, 500U);
}

/// Fields that have one name are one to those who look them up by it.
void expect_one_of_each_name(AnswerGroup group, std::map<std::string_view, AnswerField>& fields) {
  for (const AnswerWord& word : group) {
    expect_one_of_each_name(word.below, fields);
    if (word.below.count > 0) continue;
    const AnswerField& first = fields.try_emplace(word.field.name, word.field).first->second;
    EXPECT_EQ(first.unit, word.field.unit) << word.field.name;
    EXPECT_EQ(first.meaning, word.field.meaning) << word.field.name;
  }
}

TEST(AnswerFields, HaveOneMeaningAName) {
  std::map<std::string_view, AnswerField> fields;
  expect_one_of_each_name(answer_words(), fields);
  EXPECT_EQ(fields.size(), answer_fields().size());
}

}  // namespace answer_places_test
}  // namespace sinew

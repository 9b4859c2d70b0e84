// Every field of every query to every robot, null, absent and of the wrong kind: an answer, or an error that
// says where. The queries are those that the fuzz target begins with (tests/fuzz/corpus/session): together
// they have every field.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "paths.hpp"
#include "sinew/session.hpp"

namespace every_field_test {

using namespace sinew;
using Json = nlohmann::ordered_json;
using Place = Json::json_pointer;
namespace fs = std::filesystem;

const fs::path source = test::source_folder;

struct Asked {
  std::string robot;
  std::vector<Json> queries;
};

std::vector<Asked> corpus() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(source / "tests/fuzz/corpus/session"))
    files.push_back(entry.path());
  std::ranges::sort(files);
  std::vector<Asked> all;
  for (const fs::path& file : files) {
    std::ifstream stream(file);
    Asked asked;
    std::getline(stream, asked.robot);
    for (std::string line; std::getline(stream, line);) asked.queries.push_back(Json::parse(line));
    all.push_back(std::move(asked));
  }
  return all;
}

void collect(const Json& json, const Place& here, std::vector<Place>& places) {
  if (!here.empty()) places.push_back(here);
  if (json.is_object())
    for (const auto& [key, value] : json.items()) collect(value, here / key, places);
  if (json.is_array())
    for (std::size_t i = 0; i < json.size(); ++i) collect(json[i], here / i, places);
}

Json without(Json query, const Place& place) {
  Json& parent = query[place.parent_pointer()];
  if (parent.is_object())
    parent.erase(place.back());
  else
    parent.erase(static_cast<std::size_t>(std::stoul(place.back())));
  return query;
}

Json with(Json query, const Place& place, const Json& value) {
  query[place] = value;
  return query;
}

bool has_null(const Json& json) {
  return json.is_null() || (json.is_structured() && std::any_of(json.begin(), json.end(), has_null));
}

/// Robots, and how many questions were put to them.
class EveryField : public testing::Test {
 protected:
  Json ask(Session& session, const Json& query) {
    ++count_;
    session.forget();
    const std::string text = session.answer(query.dump());
    Json answer = Json::parse(text, nullptr, false);
    const auto say = [&] { return query.dump() + "\n" + text.substr(0, 1000); };
    EXPECT_TRUE(answer.is_object()) << say();
    EXPECT_FALSE(has_null(answer)) << say();
    if (answer.contains("error")) {
      for (const char* key : {"code", "where", "message"})
        EXPECT_NE(answer["error"].value(key, ""), "") << say();
    } else {
      const std::string status = answer.value("status", "");
      EXPECT_NE(status, "") << say();
      if (status != "converged" && status != "unstable") {
        EXPECT_NE(answer.value("message", ""), "") << say();
      }
    }
    return answer;
  }
  std::size_t count_ = 0;
};

Session open(const std::string& robot) {
  return Session::open((source / "robots" / (robot + ".yaml")).string()).value();
}

TEST_F(EveryField, NullAbsentAndOfTheWrongKindIsAnsweredOrRefusedByItsPlace) {
  std::atomic<bool> is_late = true;  // what the search would find is not asked here, only what is read
  for (const Asked& asked : corpus()) {
    Session session = open(asked.robot);
    session.stop_on(StopToken(is_late));
    for (const Json& query : asked.queries) {
      std::vector<Place> places;
      collect(query, Place(), places);
      for (const Place& place : places) {
        SCOPED_TRACE(asked.robot + " " + place.to_string());
        const Json absent = ask(session, without(query, place)),
                   null = ask(session, with(query, place, nullptr));
        if (query[place.parent_pointer()].is_object() &&
            place.parent_pointer() != Place("/set")) {  // there null takes away
          EXPECT_EQ(null, absent) << query;
        }
        const Json boolean = ask(session, with(query, place, true));
        if (!query[place].is_boolean()) {
          EXPECT_TRUE(boolean.contains("error")) << query << boolean;
        }
        for (const Json& value : {Json("text"), Json::array(), Json::object(), Json(1e300), Json(-1), Json(0),
                                  Json("1 kg"), Json::array({Json::array({1, 2}), nullptr})})
          ask(session, with(query, place, value));
      }
    }
  }
  fmt::print("{} questions\n", count_);
}

TEST_F(EveryField, AFieldOfAnotherQueryIsRefusedOrReadAndNullIsAsIfItWereAbsent) {
  const auto all = corpus();
  std::map<std::string, Json> fields;
  for (const Asked& asked : all)
    for (const Json& query : asked.queries)
      for (const auto& [key, value] : query.items())
        if (key != "query") fields.try_emplace(key, value);
  std::atomic<bool> is_late = true;
  for (const Asked& asked : all) {
    Session session = open(asked.robot);
    session.stop_on(StopToken(is_late));
    for (const Json& query : asked.queries) {
      const Json plain = ask(session, query);
      for (const auto& [key, value] : fields) {
        if (query.contains(key)) continue;
        SCOPED_TRACE(asked.robot + " " + key);
        Json more = query;
        more[key] = nullptr;
        EXPECT_EQ(ask(session, more), plain) << query;
        more[key] = value;
        ask(session, more);
      }
    }
  }
  fmt::print("{} questions\n", count_);
}

TEST_F(EveryField, TheCorpusAsksEveryQueryThatARobotKnows) {
  std::set<std::string> kinds;
  for (const Asked& asked : corpus()) {
    Session session = open(asked.robot);
    for (const Json& query : asked.queries) {
      kinds.insert(query["query"]);
      if (query.contains("all")) continue;  // takes long
      EXPECT_FALSE(ask(session, query).contains("error")) << asked.robot << query;
    }
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"describe", "diagram", "forward", "identify", "inverse", "shape",
                                          "statics", "track", "velocity"}));
}

}  // namespace every_field_test

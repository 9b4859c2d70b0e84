/// `identify`: what the question finds is what the library finds; columns or a table in, an arm that answers
/// out; rows that are wrong are refused by their place.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <sstream>

#include "io/document/parse.hpp"
#include "measured_arms.hpp"
#include "sinew/session.hpp"
#include "sinew_query.hpp"

namespace sinew::test {
namespace arm_identify_test {

/// Every stride-th row of a recording, as columns of a question.
Json columns_of(const MeasuredRows& rows, std::size_t stride) {
  Json columns{{"pulls", Json::array()},
               {"markers", Json::array()},
               {"time", Json::array()},
               {"blocks", Json::array()}};
  const std::size_t tendons = rows.pulls.size() / rows.size();
  for (std::size_t k = 0; k < rows.size(); k += stride) {
    const auto part = [&](const std::vector<double>& all, std::size_t width) {
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(width * k);
      return std::vector<double>(first, first + static_cast<std::ptrdiff_t>(width));
    };
    columns["pulls"].push_back(part(rows.pulls, tendons));
    columns["markers"].push_back(part(rows.markers, 3));
    columns["time"].push_back(rows.time[k]);
    columns["blocks"].push_back(rows.blocks[k]);
  }
  return columns;
}

MeasuredRows thinned(const MeasuredRows& rows, std::size_t stride) {
  MeasuredRows some;
  const std::size_t tendons = rows.pulls.size() / rows.size();
  for (std::size_t k = 0; k < rows.size(); k += stride) {
    for (std::size_t i = 0; i < tendons; ++i) some.pulls.push_back(rows.pulls[tendons * k + i]);
    for (std::size_t i = 0; i < 3; ++i) some.markers.push_back(rows.markers[3 * k + i]);
    some.time.push_back(rows.time[k]);
    some.blocks.push_back(rows.blocks[k]);
  }
  return some;
}

Json asked(Session& session, const Json& query) { return Json::parse(session.answer(query.dump())); }
Session open(const std::string& name) { return Session::open(name).value(); }

constexpr std::size_t stride = 10;
const char* const names = "bending,marker,base,tendons.offset";

TEST(ArmIdentifyQuery, FindsWhatTheLibraryFinds) {
  const Recording all = recording("ftdcr-v4");
  Session session = open("ftdcr-v4");
  const Json answer = asked(
      session, {{"query", "identify"}, {"rows", columns_of(all.rows, stride)}, {"fit", names}, {"folds", 3}});
  ASSERT_EQ(answer.value("status", ""), "converged") << answer;
  const MeasuredArm start = measured_arm("ftdcr-v4");
  const MeasuredRows rows = thinned(all.rows, stride);
  const auto parameters = fit_parameters(start, names).value();
  const Identified found = identify(start, parameters, rows).value();
  const HeldOut held_out = hold_out(start, parameters, rows, folds_of(rows, 3)).value();
  EXPECT_EQ(answer["rows"], 81);
  EXPECT_EQ(answer["errors"]["before"]["rms"], found.before.rms);
  EXPECT_EQ(answer["errors"]["fitted"]["rms"], found.train.rms);
  EXPECT_EQ(answer["errors"]["held_out"]["rms"], held_out.errors.rms);
  EXPECT_EQ(answer["noise"], found.noise);
  ASSERT_EQ(answer["parameters"].size(), parameters.size());
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const Json& one = answer["parameters"][p];
    EXPECT_EQ(one["name"], parameters[p].name);
    EXPECT_EQ(one["value"], found.parameters[p].value);
    EXPECT_EQ(one["deviation"], found.parameters[p].deviation);
    EXPECT_EQ(one["at_bound"], found.parameters[p].at_bound);
  }
  // by another way: distances of what is said to be computed
  ASSERT_EQ(answer["by_row"].size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Json& row = answer["by_row"][k];
    EXPECT_EQ(row["held_out_distance"], held_out.by_row[k]);
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i)
      square += std::pow(row["computed"][i].get<double>() - rows.markers[3 * k + i], 2);
    EXPECT_NEAR(std::sqrt(square), row["distance"].get<double>(), 1e-5);
  }
}

TEST(ArmIdentifyQuery, ItsFileIsAnArmThatAnswersAndIsFittedAlready) {
  const Recording all = recording("ftdcr-v4");
  Session session = open("ftdcr-v4");
  Json query{{"query", "identify"}, {"rows", columns_of(all.rows, stride)}, {"fit", names}, {"folds", 0}};
  const Json answer = asked(session, query);
  auto document = parse_yaml(answer.at("file").get<std::string>(), "fitted");
  ASSERT_TRUE(document) << to_string(document.error());
  Session fitted = Session::open(std::move(*document)).value();
  const Json tip = asked(fitted, {{"query", "forward"}, {"changes", {{-0.003, 0, 0}}}, {"model", "cc"}});
  EXPECT_EQ(tip.value("status", ""), "converged") << tip;
  const Json again = asked(fitted, query);
  EXPECT_NEAR(again["errors"]["before"]["rms"].get<double>(), answer["errors"]["fitted"]["rms"].get<double>(),
              1e-6);
}

TEST(ArmIdentifyQuery, ATableSaysTheSameAsColumns) {
  const Recording all = recording("ftdcr-v4");
  const MeasuredRows rows = thinned(all.rows, 40);
  const std::string text = to_csv(measured_table(rows, *load("ftdcr-v4")->arm()));
  Session session = open("ftdcr-v4");
  Json query{{"query", "identify"}, {"rows", text}, {"fit", {"bending", "marker"}}, {"folds", 0}};
  const Json by_table = asked(session, query);
  ASSERT_EQ(by_table.value("status", ""), "converged") << by_table;
  query["rows"] = columns_of(all.rows, 40);
  query["fit"] = "bending,marker";
  const Json by_columns = asked(session, query);
  EXPECT_NEAR(by_columns["errors"]["fitted"]["rms"].get<double>(),
              by_table["errors"]["fitted"]["rms"].get<double>(), 1e-12);
}

/// Of measuring axes turned by a quarter.
TEST(ArmIdentifyQuery, TakesAxesAsRowsSayWhereAsked) {
  const Recording all = recording("ftdcr-v4");
  Session session = open("ftdcr-v4");
  Json query{{"query", "identify"},
             {"rows", columns_of(all.rows, stride)},
             {"fit", "bending,marker,base,gravity"},
             {"folds", 0}};
  const double given = asked(session, query)["errors"]["fitted"]["rms"];
  for (Json& row : query["rows"]["markers"]) row = {-row[1].get<double>(), row[0], row[2]};
  const Json warned = asked(session, query);
  EXPECT_NE(warned.value("message", "").find("map: true"), std::string::npos) << warned.value("message", "");
  EXPECT_FALSE(warned.contains("map"));
  query["map"] = true;
  const Json mapped = asked(session, query);
  EXPECT_NEAR(mapped["map"]["turn"].get<double>(), 1.57, 0.3);
  EXPECT_LT(mapped["errors"]["fitted"]["rms"].get<double>(), 1.3 * given);
  EXPECT_GT(warned["errors"]["fitted"]["rms"].get<double>(), 2 * given);
}

TEST(ArmIdentifyQuery, RefusesByPlace) {
  Session session = open("ftdcr-v4");
  const Json zeros(std::vector<double>(9, 0.0)), marker{0, 0, 0.2};
  const Json good{{"pulls", {zeros, zeros}}, {"markers", {marker, marker}}};
  const auto refused = [&](Json rows, Json more = Json::object()) {
    Json query{{"query", "identify"}, {"rows", std::move(rows)}, {"fit", "bending"}, {"folds", 0}};
    query.update(more);
    const Json answer = asked(session, query);
    const Json error = answer.value("error", Json::object());
    return error.value("code", answer.dump()) + " at " + error.value("where", "");
  };
  const auto with = [&](const char* name, Json value) {
    Json rows = good;
    rows[name] = std::move(value);
    return rows;
  };
  EXPECT_EQ(refused(7), "wrong_type at rows");
  EXPECT_EQ(refused(""), "no_heading at rows:0");
  EXPECT_EQ(refused("x[mm]\n1\n").substr(0, 14), "missing_column");
  EXPECT_EQ(refused(with("pulls", Json::array({zeros}))), "wrong_length at rows.markers");
  EXPECT_EQ(refused(with("pulls", {zeros, {0, 1}})), "wrong_length at rows.pulls[1]");
  EXPECT_EQ(refused(with("markers", {marker, {0, 0, "1 kg"}})), "wrong_dimension at rows.markers[1][2]");
  EXPECT_EQ(refused(with("markers", {marker, {0, 0, nullptr}})).substr(0, 10), "wrong_type");
  EXPECT_EQ(refused(with("time", Json::array({0}))), "wrong_length at rows.time");
  EXPECT_EQ(refused(with("time", {1, 0})), "not_in_order at rows: row 2");
  EXPECT_EQ(refused(with("blocks", {0, 0.5})), "not_whole at rows: row 2");
  EXPECT_EQ(refused(with("tensions", {1})), "unknown_key at rows.tensions");
  EXPECT_EQ(refused({{"pulls", Json::array()}, {"markers", Json::array()}}), "no_rows at rows");
  EXPECT_EQ(refused(good, {{"fit", "bendng"}}), "unknown_name at fit bendng");
  EXPECT_EQ(refused(good, {{"fit", Json::array()}}), "missing_value at fit");
  EXPECT_EQ(refused(good, {{"folds", 1}}), "out_of_range at folds");
  EXPECT_EQ(refused(good, {{"folds", 3}}), "too_few at folds");
  EXPECT_EQ(refused(good, {{"noise", 0}}), "out_of_range at noise");
  std::string table =
      to_csv(measured_table(thinned(recording("ftdcr-v4").rows, 810), *load("ftdcr-v4")->arm()));
  const std::string row = table.substr(table.find('\n', table.find("x[mm]")) + 1);
  for (int k = 0; k < 20000; ++k) table += row;
  EXPECT_EQ(refused(table), "too_many at rows");
  Session other = open("3-rfr");
  EXPECT_EQ(asked(other, {{"query", "identify"}, {"rows", good}})["status"], "unsupported");
}

/// What a stop leaves is an answer, and says so.
TEST(ArmIdentifyQuery, StopsWithTheBestSoFar) {
  const Recording all = recording("ftdcr-v4");
  Session session = open("ftdcr-v4");
  std::atomic<bool> is_late = true;
  session.stop_on(StopToken(is_late));
  const Json answer = asked(session, {{"query", "identify"}, {"rows", columns_of(all.rows, 1)}});
  EXPECT_EQ(answer.value("status", ""), "stopped") << answer;
  EXPECT_NE(answer.value("message", ""), "");
}

}  // namespace arm_identify_test
}  // namespace sinew::test

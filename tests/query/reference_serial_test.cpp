/// Serial robots through `sinew query` against tests/data/lsk, whose numbers come from another
/// implementation.
#include <gtest/gtest.h>

#include "serial_robots.hpp"
#include "sinew_query.hpp"

namespace sinew::test {
namespace reference_serial_test {

double number(const Json& text) { return std::stod(text.get<std::string>()); }

/// Settings that make a robot of the library the robot of a case.
Json settings(const Json& c) {
  Json set = Json::object();
  for (std::size_t m = 0; m < c["M"].get<std::size_t>(); ++m) {
    const std::string section = "sections[" + std::to_string(m) + "].";
    set[section + "segments"] = c["N"];
    set[section + "joint"] = number(c["L_mm"]) * 1e-3;
    set[section + "disc.height"] = number(c["h_mm"]) * 1e-3;
    set[section + "disc.radius"] = "10 mm";
    set[section + "tendons.radius"] = number(c["r_c_mm"]) * 1e-3;
    set[section + "tendons.angle"] = degrees(number(c["delta_m_deg"][m]));
    set[section + "limit"] = c["kind"] == "tp" ? "170 deg" : "350 deg";
  }
  return set;
}

Json configuration(const Json& c, const char* key) {
  Json list = Json::array();
  for (const auto& pair : c[key]) list.push_back({number(pair[0]), number(pair[1])});
  return list;
}

double largest_gap(const Json& ours, const Json& theirs, double unit) {
  double gap = 0;
  for (std::size_t m = 0; m < theirs.size(); ++m)
    for (std::size_t i = 0; i < theirs[m].size(); ++i)
      gap = std::max(gap, std::abs(ours[m][i].get<double>() - number(theirs[m][i]) * unit));
  return gap;
}

Json ask_one(const Json& c, const Json& query) {
  return ask(c["kind"] == "tp" ? "nottingham-tpcj" : "nottingham-neutral", {query}).front();
}

class SerialQuery : public testing::TestWithParam<int> {
 protected:
  Json c = read_json("data/lsk/references.json")["cases"][static_cast<std::size_t>(GetParam())];
};

TEST_P(SerialQuery,
       GoesFromConfigurationToChangesAndPoses) {  // @verifies LSK (1)-(5), (7)-(9), (11)-(13), (15), (16)
  for (const char* model : {"pcc", "lsk"}) {
    const Json answer = ask_one(c, {{"query", "forward"},
                                    {"set", settings(c)},
                                    {"configuration", configuration(c, "q_rad")},
                                    {"model", model}});
    ASSERT_EQ(answer["status"], "converged") << answer.dump();
    EXPECT_LT(
        largest_gap(answer["changes"], c[model == std::string("pcc") ? "dl_pcc_mm" : "dl_lsk_mm"], 1e-3),
        1e-15);
    for (std::size_t m = 0; m < c["q_rad"].size(); ++m)
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(answer["sections"][m]["position"][i].get<double>(),
                    number(c["section_end_pose"][m][i][3]) * 1e-3, 1e-15);
  }
}

TEST_P(SerialQuery, GoesFromChangesToConfiguration) {  // @verifies LSK (10)
  const std::array<std::array<const char*, 3>, 3> ways{{{"pcc", "dl_pcc_mm", "pcc_inverse_of_dl_pcc"},
                                                        {"lsk", "dl_lsk_mm", "lsk_inverse_of_dl_lsk"},
                                                        {"lsk", "dl_pcc_mm", "lsk_inverse_of_dl_pcc"}}};
  for (const auto& [model, from, to] : ways) {
    Json changes = Json::array();
    for (const auto& section : c[from]) {
      Json one = Json::array();
      for (const auto& change : section) one.push_back(number(change) * 1e-3);
      changes.push_back(one);
    }
    const Json answer =
        ask_one(c, {{"query", "forward"}, {"set", settings(c)}, {"changes", changes}, {"model", model}});
    const auto expected = reference_bends(c, to);
    for (std::size_t m = 0; m < expected.size(); ++m) {
      const double a = answer["configuration"][m][0], b = answer["configuration"][m][1];
      const Bend bend = c["kind"] == "tp" ? Bend(a, b) : Bend(a * std::cos(b), a * std::sin(b));
      EXPECT_LT((bend - expected[m]).norm(), 1e-13);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lsk, SerialQuery, testing::Range(0, 12));

/// Bends of three arcs from their twists, ξ = (ω_x, ω_y, 0, …) with ω = (−b_y, b_x).
std::vector<Bend> bends_of_twists(const Json& xi) {
  std::vector<Bend> bends;
  for (std::size_t k = 0; k < 3; ++k)
    bends.emplace_back(xi[2 * k + 1].get<double>(), -xi[2 * k].get<double>());
  return bends;
}

double gap(const Json& configuration, const std::vector<Bend>& expected) {
  double worst = 0;
  for (std::size_t m = 0; m < expected.size(); ++m) {
    const double theta = configuration[m][0], phi = configuration[m][1];
    worst = std::max(worst, (Bend(theta * std::cos(phi), theta * std::sin(phi)) - expected[m]).norm());
  }
  return worst;
}

Json polar(const std::vector<Bend>& bends) {
  Json list = Json::array();
  for (const Bend& bend : bends) list.push_back({bend.norm(), std::atan2(bend.y(), bend.x())});
  return list;
}

TEST(SerialQuery, ThreeArcsHaveTheTipAndEverySolutionOfTheReference) {
  const Json& data = read_json("data/field/cc3_fk_and_all_ik.json");
  const Json forward =
      ask("three-arcs", {{{"query", "forward"}, {"configuration", polar(bends_of_twists(data["fk"]["xi"]))}}})
          .front();
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(forward["tip"]["position"][i].get<double>(),
                data["fk"]["T_rowmajor_3x4"][4 * i + 3].get<double>(), 1e-11);

  const Json& inverse = data["ik_all_solutions"];
  const double alpha = 15 * std::numbers::pi / 16;
  const std::array<double, 3> axis{0.48, std::sqrt(3.0) / 10, -0.86};
  Json quaternion = Json::array({std::cos(alpha / 2)});
  for (const double part : axis) quaternion.push_back(std::sin(alpha / 2) * part);
  const Json answer =
      ask("three-arcs", {{{"query", "inverse"},
                          {"pose", {{"position", inverse["pose_r"]}, {"quaternion", quaternion}}},
                          {"all", true}}})
          .front();
  EXPECT_EQ(answer["status"], "converged");
  EXPECT_EQ(answer["complete"], true);
  EXPECT_EQ(answer["count"], inverse["solutions_xi"].size());
  for (const Json& xi : inverse["solutions_xi"]) {
    double nearest = 1;
    for (const Json& ours : answer["solutions"])
      nearest = std::min(nearest, gap(ours["configuration"], bends_of_twists(xi)));
    EXPECT_LT(nearest, 2e-9) << xi.dump();
  }
}

TEST(SerialQuery, DrawsTheDiagramsOfTheReference) {  // [LSK] section 4
  for (const Json& e : read_json("data/lsk/polygons.json")["examples"]) {
    const bool is_twin = e["kind"] == "tp";
    const auto tendons = e["dl_mm"].size();
    const std::string robot =
        std::string(tendons == 3 ? "nottingham-" : "four-tendon-") + (is_twin ? "tpcj" : "neutral");
    Json changes = Json::array();
    for (const double change : e["dl_mm"]) changes.push_back(change * 1e-3);
    Json query{{"query", "diagram"},
               {"section", 0},
               {"changes", changes},
               {"set", {{"sections[0].tendons.angle", e["delta_section_rad"]}}},
               {"tolerance", e["eps_mm"].get<double>() * 1e-3}};
    const bool is_travel = e["envelope"][0] == "hexagon";  // by the largest change of a tendon [mm]
    query["envelope"] = is_travel ? Json("actuator") : Json(e["envelope"][0]);
    query["limit"] = e["envelope"][1].get<double>() * (is_travel ? 1e-3 : 1);
    const Json answer = ask(robot, {query}).front();
    ASSERT_TRUE(answer.contains("class")) << answer.dump();
    EXPECT_EQ(answer["class"], e["class"]) << e["name"];
    EXPECT_EQ(answer["partial"], e["partial"]) << e["name"];
    for (std::size_t j = 0; j < 2; ++j)
      EXPECT_NEAR(answer["point"][j].get<double>(), e["ls_solution"][j].get<double>(), 1e-13);
    EXPECT_NEAR(answer["margin"].get<double>() * 1e3, e["margin_mm"].get<double>(), 1e-12) << e["name"];
    EXPECT_NEAR(answer["over_tension"].get<double>() * 1e3, e["least_over_tension_mm"].get<double>(), 1e-12);
    EXPECT_NEAR(answer["area"].get<double>(), e["area_envelope"].get<double>(), 1e-13) << e["name"];
  }
}

}  // namespace reference_serial_test
}  // namespace sinew::test

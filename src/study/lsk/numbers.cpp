/// The numbers that [LSK] derives and prints, and its misprints, by what they come to with the sizes of Table
/// 2. Theory: docs/theory/model_error.md
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/chord_error.hpp"
#include "sinew/analysis/tendon_limits.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/serial.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/lsk/example.hpp"

namespace sinew::inline v1 {
namespace {

using lsk::degree;
using Findings = std::vector<Finding>;

constexpr int poses = 200'000;
constexpr std::uint32_t seed = 1;

/// A number that the paper rounds to so many decimals.
Finding rounded(std::string quantity, double paper, int decimals, double ours, const char* unit) {
  return compare::given(std::move(quantity), fmt::format("{:.{}f} {}", paper, decimals, unit),
                        fmt::format("{:.{}f} {}", ours, decimals + 3, unit), std::abs(ours - paper),
                        0.5 * std::pow(10, -decimals) * (1 + 1e-9), unit);
}

/// Largest span of the tendons of a section [m].
double widest(const std::vector<TendonTravel>& travel, std::size_t section) {
  double most = 0;
  for (std::size_t i = 3 * section; i < 3 * section + 3; ++i) most = std::max(most, travel[i].span());
  return most;
}

// ---------------------------------------------------------------- table

Table table_of(const SerialRobot& robot, const LinearConsequences& random) {
  Table table{"section",        "evaluations_5",    "evaluations_12", "ratio",          "one_axis_travel[mm]",
              "lsk_travel[mm]", "exact_travel[mm]", "mean_slack[mm]", "most_slack[mm]", "dead_zone[deg]"};
  table.comments = lsk::provenance("lsk/numbers", "per section; evaluations of a robot of so many sections");
  table.comments.push_back(fmt::format(
      "mean_slack: {} random poses, seed {}; dead_zone: of the bend of all sections so far", poses, seed));
  const auto one = one_axis_travel(robot);
  const auto lsk = tendon_travel(robot, kernel::Model::linear),
             exact = tendon_travel(robot, kernel::Model::exact);
  const auto slack = largest_linear_slack(robot);
  for (std::size_t m = 0; m < one.size(); ++m) {
    const auto count = tendon_evaluations(static_cast<int>(m) + 1);
    table.add_row({double(m + 1), double(count.anew), double(count.carried),
                   double(count.anew) / double(count.carried), one[m] * 1e3, widest(lsk, m) * 1e3,
                   widest(exact, m) * 1e3, random.slack[m].mean * 1e3, slack[m].slack * 1e3,
                   slack[m].dead_zone / degree});
  }
  return table;
}

// ---------------------------------------------------------------- findings

void add_sizes(Findings& findings, const SerialRobot& robot) {
  const Section& section = robot.sections.front();
  findings.push_back(compare::printed("total length, M N (L + h)", 175,
                                      1e3 * std::round(robot.length() * 1e12) / 1e12, "mm"));
  findings.push_back(compare::printed("degrees of freedom, 2 M", 10, 2.0 * robot.section_count(), ""));
  findings.push_back(compare::printed("tendons and motors, 3 M", 15, robot.tendon_count(), ""));
  std::set<long> angles;
  for (const Section& s : robot.sections)
    for (int i = 0; i < s.tendons; ++i) angles.insert(std::lround(s.tendon_angle / degree) % 360 + 120 * i);
  std::set<long> turned;
  for (const long angle : angles) turned.insert(angle % 360);
  findings.push_back(compare::claimed("δ_m = m·24° gives each tendon a place of its own", "m·24°",
                                      fmt::format("{} different angles, all multiples of 24°", turned.size()),
                                      std::abs(double(turned.size()) - 15), 0, ""));
  findings.push_back({"3.2: bend of a segment where a section of 8 bends by 90°", "90/8 = 11.25°",
                      fmt::format("{}° a twin pivot: {} of them share a plane", 90.0 / (section.segments / 2),
                                  section.segments / 2),
                      "", "differs"});
}

void add_sensitivity_and_travel(Findings& findings, const SerialRobot& robot) {
  const auto lsk = tendon_travel(robot, kernel::Model::linear),
             exact = tendon_travel(robot, kernel::Model::exact);
  findings.push_back(rounded("(23), bend of a section per change of a tendon", 23.38, 2,
                             bend_per_length(robot.sections.front()) / degree * 1e-3, "deg/mm"));
  const double one = one_axis_travel(robot).back() * 1e3;
  findings.push_back(rounded("(24), travel for the bend about one axis", 41.05, 2, one, "mm"));
  findings.push_back(compare::given(
      "(24), largest travel over all bends: |cos d| + |sin d| times as much at d = 120°", "41.05 mm",
      fmt::format("{:.4f} mm", widest(lsk, 4) * 1e3), std::abs(widest(lsk, 4) * 1e3 - 41.05), 0.005, "mm"));
  SerialRobot turned = robot;
  for (Section& s : turned.sections) s.tendon_angle = 45 * degree;
  findings.push_back({"the same of a tendon at 45°, the worst there is: √2", "not stated",
                      fmt::format("{:.4f} mm", widest(tendon_travel(turned, kernel::Model::linear), 4) * 1e3),
                      "", "for information"});
  findings.push_back({"the same by constant curvature", "not stated",
                      fmt::format("{:.4f} mm", widest(exact, 4) * 1e3), "", "for information"});
}

void add_counts(Findings& findings) {
  const auto five = tendon_evaluations(5);
  findings.push_back(compare::printed("K of (5) at M = 5, 3/2 (M² + M)", 45, double(five.anew), ""));
  findings.push_back(compare::printed("K of (12) at M = 5, 3 M", 15, double(five.carried), ""));
  findings.push_back(compare::given(
      "6.1: how many times faster", "M = 5",
      fmt::format("(M + 1)/2 = {:g} by (5) and (12)", double(five.anew) / double(five.carried)),
      std::abs(double(five.anew) / double(five.carried) - 5), 1e-12, ""));
  findings.push_back({"evaluations that exact constant curvature needs, M = 5", "45",
                      fmt::format("{}: sums carried along serve it as well", five.carried), "", "differs"});
}

void add_stacked_error(Findings& findings, const SerialRobot& robot) {
  const double L = lsk::printed.joint, r = lsk::printed.tendon_radius, b = lsk::printed.limit * degree;
  const double all = lsk::printed.sections * lsk::printed.segments, root = std::sqrt(2.0);
  const TendonLengths l = lengths_at_equal_bends(robot, b, 45 * degree);
  const double error = 100 * (l.linear / l.exact - 1);
  findings.push_back(rounded("error at 24°, (17)", 0.7, 1, 100 * chord_error(b), "%"));
  const double printed_21 = all * (L / b - root * r) * std::sin(b / 2), printed_22 = all * (L - root * r * b);
  findings.push_back(compare::given("(21) at 24°", fmt::format("{:.4f} mm as printed", printed_21),
                                    fmt::format("{:.4f} mm: M N (2L/β − √2 r_c) sin(β/2)", l.exact * 1e3),
                                    std::abs(l.exact * 1e3 - printed_21), 1e-9, "mm"));
  findings.push_back(compare::given("(22) at 24°", fmt::format("{:.4f} mm as printed", printed_22),
                                    fmt::format("{:.4f} mm: M N (L − r_c β/√2)", l.linear * 1e3),
                                    std::abs(l.linear * 1e3 - printed_22), 1e-9, "mm"));
  findings.push_back(compare::claimed(
      "(21) and (22) have the error (17)",
      fmt::format("{:.1f} % as printed", 100 * std::abs(printed_22 / printed_21 - 1)),
      fmt::format("{:.5f} % corrected", error), std::abs(error - 100 * chord_error(b)), 1e-12, "%"));
  double off = 0, most = 0, worst_at = 0;
  for (int d = 0; d < 360; ++d) {
    const TendonLengths here = lengths_at_equal_bends(robot, b, d * degree);
    off = std::max(off, std::abs(100 * (here.linear / here.exact - 1) - error));
    if (here.linear - here.exact > most) {
      most = here.linear - here.exact;
      worst_at = d;
    }
  }
  findings.push_back({"section 5: direction in which the relative error is largest", "45°",
                      fmt::format("none: the same in all directions to {} %", compare::small(off)), "",
                      off < 1e-12 ? "differs" : "agrees"});
  findings.push_back({"the absolute error is largest at", "45°",
                      fmt::format("{:g}°, the outer tendon: {:.4f} mm", worst_at, most * 1e3), "",
                      "differs"});
  const double inner = (L - r * b) * chord_error(b) / (1 + chord_error(b)),
               outer = (L + r * b) * chord_error(b) / (1 + chord_error(b));
  findings.push_back({"the error as a share of the change, which is what a motor is told", "not stated",
                      fmt::format("{:.3f} % of the inner tendon, {:.3f} % of the outer, a joint at 24°",
                                  100 * inner / (r * b), 100 * outer / (r * b)),
                      "", "for information"});
}

void add_consequences(Findings& findings, const SerialRobot& robot, const LinearConsequences& random) {
  const auto slack = largest_linear_slack(robot);
  const Section& first = robot.sections.front();
  findings.push_back({"tip off its place when driven by LSK", "3 mm measured, its cause not named",
                      fmt::format("mean {:.2f}, 95 % below {:.2f}, largest {:.2f} mm, {} random poses",
                                  random.commanded.mean * 1e3, random.commanded.p95 * 1e3,
                                  random.commanded.largest * 1e3, poses),
                      "", "for information"});
  findings.push_back(
      {"slack that LSK leaves in tendons of section 5", "not stated",
       fmt::format("mean {:.3f}, at most {:.3f} mm: bends are then free by ±{:.1f}° in all",
                   random.slack.back().mean * 1e3, slack.back().slack * 1e3, slack.back().dead_zone / degree),
       "", "for information"});
  const double small = linear_freedom(first, lsk::in_degrees(10, -5)),
               large = linear_freedom(first, lsk::in_degrees(24, 24));
  findings.push_back(
      {"how far section 1 alone can be from its bend, a joint", "not stated",
       fmt::format("{:.4f}° at (10°, −5°), {:.4f}° at (24°, 24°)", small / degree, large / degree), "",
       "for information"});
}

// ---------------------------------------------------------------- misprints

/// T_y(a) R_x(b) T_y(−c) T_z(h) of (3) and (4), rotations of the frame's axes by b.
Eigen::Isometry3d joint(double a, double b, double c, double h) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.translate(Eigen::Vector3d(0, a, 0)).rotate(Eigen::AngleAxisd(b, Eigen::Vector3d::UnitX()));
  return out.translate(Eigen::Vector3d(0, -c, h));
}

/// A section by (3), [mm]; as printed its second T_y is −L/θ.
Eigen::Vector3d tip_of_3(double theta, double phi, double sign, double second) {
  const int N = lsk::printed.segments;
  const double L = lsk::printed.joint;
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.rotate(Eigen::AngleAxisd(phi, Eigen::Vector3d::UnitZ()));
  for (int k = 0; k < N; ++k)
    out = out * joint(L * N / theta, sign * theta / N, second / theta, lsk::printed.disc);
  return out.translation();
}

std::string point(const Eigen::Vector3d& p) {
  return fmt::format("({:.2f}, {:.2f}, {:.2f}) mm", p.x(), p.y(), p.z());
}

/// Of a section's tendons where its joints bend by 24° about both axes.
std::string exact_lengths(const Section& section) {
  const double bend = lsk::printed.limit * degree;
  const auto pull = kernel::exact_pull(section.map(), {bend, bend});
  std::string all;
  for (int i = 0; i < section.tendons; ++i)
    all += fmt::format("{}{:.3f}", i > 0 ? ", " : "",
                       1e3 * (section.arc_length() + kernel::tendon_change(pull, section.direction(i))));
  return all;
}

void add_misprints(Findings& findings, const SerialRobot& robot, const SerialRobot& neutral) {
  const double L = lsk::printed.joint, N = lsk::printed.segments, r = lsk::printed.tendon_radius,
               small = 1e-6, theta = 60 * degree, phi = 35 * degree, d = 24 * degree;
  const double straight = 2 * std::sin(small / (2 * N)) * (L * N / small);
  findings.push_back(compare::given("(1): length of a straight section, N L",
                                    fmt::format("{:.4g} mm as printed", straight),
                                    fmt::format("{:g} mm", neutral.sections.front().arc_length() * 1e3),
                                    std::abs(straight - 19), 1e-6, "mm"));
  findings.push_back(compare::given("(1): share of r_c that counts at θ = 60°, φ = 35°, δ = 24°",
                                    fmt::format("sin(φ + δ) = {:.3f}", std::sin(phi + d)),
                                    fmt::format("cos(φ − δ) = {:.3f}, as (15) has it", std::cos(phi - d)),
                                    std::abs(std::sin(phi + d) - std::cos(phi - d)), 1e-9, ""));
  const double printed_2 = N * 2 * (L / (24 * degree) - r) * std::sin(12 * degree);
  findings.push_back({"(2) has no δ: lengths of three tendons at β₁ = β₂ = 24°",
                      fmt::format("{:.3f} mm for all as printed", printed_2),
                      exact_lengths(robot.sections.front()) + " mm: (8) has cos δ and sin δ", "", "differs"});
  SerialWorkspace work(neutral);
  std::vector<Bend> bends(neutral.sections.size(), Bend(0, 0));
  bends[0] = Bend(theta * std::cos(phi), theta * std::sin(phi));
  section_ends(bends, work);
  const Eigen::Vector3d ours = work.ends[0].p * 1e3, printed_3 = tip_of_3(theta, phi, 1, L);
  findings.push_back(compare::given("(3): end of a section of 35 mm at θ = 60°, φ = 35°", point(printed_3),
                                    point(ours), (ours - printed_3).norm(), 1e-9, "mm"));
  const Eigen::Vector3d backwards = tip_of_3(1e-4, phi, 1, L * N);
  findings.push_back(compare::given("(3), (4): a straight section with R_x(+β), N (h + L)",
                                    fmt::format("{:.3f} mm as printed", backwards.z()), "35 mm with R_x(−β)",
                                    std::abs(backwards.z() - 35), 1e-3, "mm"));
  const Eigen::Vector3d fixed = tip_of_3(theta, phi - 90 * degree, -1, L * N);
  findings.push_back(compare::claimed("(3) with −L N/θ, R_x(−θ/N) and R_z(φ − 90°) is ours", "not printed",
                                      point(fixed), (fixed - ours).norm(), 1e-11, "mm"));
}

// ---------------------------------------------------------------- figure

Panel travel_panel(const SerialRobot& robot) {
  Series lsk{"LSK, over all bends", {}, {}, Mark::points, Colour::blue, 2.5};
  Series exact{"constant curvature", {}, {}, Mark::circles, Colour::vermillion, 2};
  const auto linear = tendon_travel(robot, kernel::Model::linear),
             pcc = tendon_travel(robot, kernel::Model::exact);
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double x = 1 + double(i / 3) + 0.2 * (double(i % 3) - 1);
    for (Series* series : {&lsk, &exact}) series->x.push_back(x);
    lsk.y.push_back(linear[i].span() * 1e3);
    exact.y.push_back(pcc[i].span() * 1e3);
  }
  Series printed{"(24): 41.05 mm", {0.5, 5.5}, {41.05, 41.05}, Mark::dashed, Colour::black, 2};
  return {"(a) travel of the 15 tendons, three a section",
          {.label = "section", .unit = "", .low = 0.5, .high = 5.5, .step = 1},
          {.label = "travel", .unit = "mm", .low = 0, .high = 80},
          {exact, lsk, printed},
          {},
          Legend::top_left};
}

Panel count_panel() {
  Series anew{"(5): every tendon anew", {}, {}, Mark::line_points, Colour::vermillion, 2};
  Series carried{"(12): sums carried along", {}, {}, Mark::line_points, Colour::blue, 2};
  for (int m = 1; m <= 10; ++m) {
    const auto count = tendon_evaluations(m);
    anew.x.push_back(m);
    anew.y.push_back(double(count.anew));
    carried.x.push_back(m);
    carried.y.push_back(double(count.carried));
  }
  return {"(b) evaluations for all tendons",
          {.label = "sections M", .unit = "", .low = 0, .high = 11, .step = 2},
          {.label = "evaluations K", .unit = "", .low = 0},
          {anew, carried},
          {},
          Legend::top_left};
}

Panel slack_panel(const SerialRobot& robot, const LinearConsequences& random) {
  Series most{"all bends at 24°", {}, {}, Mark::line_points, Colour::vermillion, 2};
  Series p95{"95 % of random poses below", {}, {}, Mark::line_points, Colour::orange, 2};
  Series mean{"mean of random poses", {}, {}, Mark::line_points, Colour::blue, 2};
  const auto slack = largest_linear_slack(robot);
  for (std::size_t m = 0; m < slack.size(); ++m) {
    for (Series* series : {&most, &p95, &mean}) series->x.push_back(double(m + 1));
    most.y.push_back(slack[m].slack * 1e3);
    p95.y.push_back(random.slack[m].p95 * 1e3);
    mean.y.push_back(random.slack[m].mean * 1e3);
  }
  return {"(c) slack that LSK leaves",
          {.label = "section", .unit = "", .low = 0.5, .high = 5.5, .step = 1},
          {.label = "slack of each tendon", .unit = "mm", .low = 0, .high = 0.9},
          {most, p95, mean},
          {},
          Legend::top_left};
}

}  // namespace

Expected<ItemResult> lsk_numbers(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load_serial("nottingham-tpcj"), neutral = load_serial("nottingham-neutral");
  if (!robot) return tl::unexpected(robot.error());
  if (!neutral) return tl::unexpected(neutral.error());
  const LinearConsequences random = linear_consequences(*robot, poses, seed);
  ItemResult result;
  add_sizes(result.findings, *robot);
  add_sensitivity_and_travel(result.findings, *robot);
  add_counts(result.findings);
  add_stacked_error(result.findings, *robot);
  add_consequences(result.findings, *robot, random);
  add_misprints(result.findings, *robot, *neutral);
  const Figure figure{.title = "",
                      .panels = {travel_panel(*robot), count_panel(), slack_panel(*robot, random)},
                      .columns = 3,
                      .width = 1500,
                      .height = 460,
                      .comments = lsk::provenance("lsk/numbers", "travel, evaluations, slack")};
  result.tables.emplace_back("numbers", table_of(*robot, random));
  result.figures.emplace_back("numbers", figure);
  return result;
}

}  // namespace sinew::inline v1

#include "study/tripod/loads/table_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sinew::inline v1::tripod {
namespace {

constexpr std::size_t x = 0, y = 1, z = 2, e3 = 3;  // of `variables`
constexpr std::array printed_names{"x_p", "y_p", "z_p", "e_3"};
constexpr auto force = Load::force_z, about_x = Load::moment_x, about_y = Load::moment_y;

// ---------------------------------------------------------------- what the paper's numbers say by themselves

/// By the threefold symmetry of robot and inputs a small moment about y does to x what one about x does to y,
/// and a force along z the same to both, so that only the ranges differ.
Finding order_of_columns(const RmsCells& cells) {
  double low = 1e9, high = 0;
  for (std::size_t step = 1; step <= load_steps; ++step) {
    const double ratio = cell(cells, force, step, x) / cell(cells, force, step, y);
    low = std::min(low, ratio), high = std::max(high, ratio);
  }
  const auto limits = [&](Load a, std::size_t u, Load b, std::size_t v) {
    return linear_limit(cells, a, u) / linear_limit(cells, b, v);
  };
  return {
      "order of the columns, from the paper's numbers alone", "z_p, e_3, x_p, y_p",
      fmt::format("x_p, y_p, z_p, e_3: column 1 over 2 is {:.4f} to {:.4f} under F_z; for small moments 1 "
                  "of M_x over 2 of M_y {:.4f}, 1 of M_y over 2 of M_x {:.4f}, as components x, y of a "
                  "vector with ranges of that ratio; 4 of M_x over 4 of M_y {:.4f}, as a scalar",
                  low, high, limits(about_x, x, about_y, y), limits(about_y, x, about_x, y),
                  limits(about_x, e3, about_y, e3)),
      "", "for information"};
}

Finding poles(const RmsCells& paper, const ComparedTables& all) {
  std::string ours;
  for (const TableOfOurs& one : all.ours)
    ours += fmt::format("{}{} {:.1f}", ours.empty() ? "" : ", ", one.name, pole(one.cells, force, x));
  return {
      "F_z at which F over RMS of x_p, a straight line, would be 0",
      fmt::format("{:.1f} N from its numbers, of y_p {:.1f} N", pole(paper, force, x), pole(paper, force, y)),
      ours + " N", "", "for information"};
}

/// Of all columns but z_p under moments, or of these: at home z_p changes with the square of a moment, where
/// the platform is tilted with the moment itself.
std::string limit_ratios(bool of_z_under_moments) {
  double low = 1e9, high = 0, z_low = 1e9, z_high = 0;
  for (const Load load : loads)
    for (std::size_t v = 0; v < variables.size(); ++v) {
      const double ratio = linear_limit(table_1.cells, load, v) / linear_limit(table_2.cells, load, v);
      const bool is_left_out = v == z && load != force;
      double &least = is_left_out ? z_low : low, &most = is_left_out ? z_high : high;
      least = std::min(least, ratio), most = std::max(most, ratio);
    }
  return of_z_under_moments ? fmt::format("{:.2f} to {:.2f}", z_low, z_high)
                            : fmt::format("{:.2f} to {:.2f}", low, high);
}

void add_limits(std::vector<Finding>& findings) {
  const double diameters = std::pow(4.0 / 3, 4);
  findings.push_back({"Table 1 over Table 2 for small loads, from the paper's numbers alone",
                      fmt::format("{:.2f} = (4/3)⁴ where only the diameter differs", diameters),
                      fmt::format("{}; (4/3)⁴ · 210/83 = {:.4f}: the tables are of two moduli",
                                  limit_ratios(false), diameters * 210 / 83),
                      "", "for information"});
  findings.push_back({"the same for z_p under moments", "not printed",
                      limit_ratios(true) + ": no clean linear limit within the loads of Table 1", "",
                      "for information"});
}

// ---------------------------------------------------------------- findings

void add_header(std::vector<Finding>& findings, const PrintedTable& paper, const ComparedTables& all) {
  findings.push_back({"geometry of the robot, grid of inputs", "not printed",
                      "G1, inferred from (36) and the RMSE of e_3; G2, nominal; fitted; cubes of 9³ lengths",
                      "", "for information"});
  findings.push_back(
      {"the geometry \"fitted\" and its cube", "not printed",
       "fitted to Table 1 itself: that it agrees is no evidence; another, of other inputs, comes near it", "",
       "for information"});
  findings.push_back({"why G1 and G2 differ", "not printed",
                      "neither they nor their cubes were chosen for these numbers, which depend on both", "",
                      "for information"});
  findings.push_back(order_of_columns(paper.cells));
  findings.push_back(poles(paper.cells, all));
  add_limits(findings);
  if (!all.beside.empty())
    findings.push_back({"modulus of the rods of 4 mm", "83 GPa with Figs. 11 to 13, not said again",
                        "compared at 210 GPa, which the two tables ask for; 83 GPa beside it", "",
                        "for information"});
}

/// `G1 0.317, G2 0.229 …` of one cell over something.
std::string listed(const std::vector<TableOfOurs>& ours, Load load, std::size_t step, std::size_t v,
                   double over, int digits) {
  std::string text;
  for (const TableOfOurs& one : ours)
    text += fmt::format("{}{} {:.{}f}", text.empty() ? "" : ", ", one.name,
                        cell(one.cells, load, step, v) / over, digits);
  return text;
}

/// In percent, with the modulus where there is more than one.
std::string percent(const std::vector<TableOfOurs>& ours, Load load, std::size_t step, std::size_t v) {
  const std::string& modulus = ours.front().modulus;
  return listed(ours, load, step, v, 1, 4) + " %" + (modulus.empty() ? "" : " of " + modulus);
}

Finding compared(const PrintedTable& paper, const ComparedTables& all, Load load, std::size_t step,
                 std::size_t v) {
  const double printed = cell(paper.cells, load, step, v);
  const double off = std::abs(std::log(cell(all.ours.back().cells, load, step, v) / printed));
  std::string ours = percent(all.ours, load, step, v);
  if (!all.beside.empty()) ours += "; " + percent(all.beside, load, step, v);
  return {fmt::format("{} = {} {}, {}", name_of(load), value_of(load, step), unit_of(load), printed_names[v]),
          fmt::format("{:.4f} %", printed), std::move(ours),
          "times " + listed(all.ours, load, step, v, printed, 2),
          off < std::log(close) ? "agrees" : "differs"};
}

/// All cells of a geometry over the paper's.
Finding summary(const PrintedTable& paper, const TableOfOurs& ours) {
  std::array<double, variables.size()> logs{};
  double squares = 0;
  int within = 0, within_half = 0, count = 0;
  each_cell([&](Load load, std::size_t step, std::size_t v) {
    const double log = std::log(cell(ours.cells, load, step, v) / cell(paper.cells, load, step, v));
    logs[v] += log / static_cast<double>(loads.size() * load_steps);
    squares += log * log;
    within += std::abs(log) < std::log(close);
    within_half += std::abs(log) < std::log(1.5);
    ++count;
  });
  return {fmt::format("{}: all cells, ours over the paper's", ours.label()), "not printed",
          fmt::format("geometric means: x_p {:.2f}, y_p {:.2f}, z_p {:.2f}, e_3 {:.2f}; rms logarithm {:.2f}",
                      std::exp(logs[x]), std::exp(logs[y]), std::exp(logs[z]), std::exp(logs[e3]),
                      std::sqrt(squares / count)),
          fmt::format("{} of {} within 20 %, {} within a factor of 1.5", within, count, within_half),
          "for information"};
}

}  // namespace

void add_table_findings(std::vector<Finding>& findings, const PrintedTable& paper,
                        const ComparedTables& all) {
  add_header(findings, paper, all);
  for (const auto* some : {&all.ours, &all.beside})
    for (const TableOfOurs& one : *some) findings.push_back(summary(paper, one));
  each_cell([&](Load load, std::size_t step, std::size_t v) {
    findings.push_back(compared(paper, all, load, step, v));
  });
}

}  // namespace sinew::inline v1::tripod

/// TDPCR Fig. 11: the indices of the 3-RFR along the trajectory of section 5.1 on pseudo-rigid chains. The
/// paper prints no numbers. What it concludes of them compares numbers of different units; both are checked.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/linalg.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tdpcr/example51_chains.hpp"
#include "study/tdpcr/index_panel.hpp"

namespace sinew::inline v1 {
namespace {

using compare::number, compare::small;
using example51::ChainSample, example51::Sample;
using std::numbers::pi;
using Chains = std::vector<ChainSample>;
using Index = double Indices::*;

constexpr std::size_t first = 0, last = 58;  // pose 59 is singular

Table table_of(const Chains& chains) {
  Table table{"k",
              "eta",
              "x[m]",
              "phi[rad]",
              "condition",
              "position[m/rad]",
              "rotation[rad/rad]",
              "determinant[m^4]"};
  for (int leg = 1; leg <= 3; ++leg)
    for (int joint = 2; joint <= 6; ++joint)
      table.columns.push_back(Column::named(fmt::format("theta_{}{}[rad]", leg, joint)));
  table.comments = compare::provenance("tdpcr/fig11", "indices along the trajectory", example51::six_links);
  table.comments.push_back(
      "position, rotation: 2-norms of the blocks of U, eq. (40); empty where J is singular");
  for (std::size_t k = 0; k < chains.size(); ++k) {
    const ChainSample& s = chains[k];
    const Indices& indices = s.velocity.indices;
    std::vector<double> row{static_cast<double>(k),
                            s.eta,
                            s.pose.x,
                            s.pose.phi,
                            indices.condition,
                            indices.position,
                            indices.rotation,
                            s.velocity.determinant};
    for (const ChainLegState& leg : s.legs) row.insert(row.end(), leg.angles.begin(), leg.angles.begin() + 5);
    table.add_row(row);
  }
  return table;
}

// ---------------------------------------------------------------- findings

Finding growth(const char* name, Index index, const char* unit, const Chains& chains) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = first; k < last; ++k)
    least = std::min(least, chains[k + 1].velocity.indices.*index / chains[k].velocity.indices.*index - 1);
  const double begin = chains[first].velocity.indices.*index, end = chains[last].velocity.indices.*index;
  return {fmt::format("{} at k = 0 → {}", name, last), "curve rises to infinity; numbers not printed",
          fmt::format("{} → {}{}", number(begin), number(end), unit),
          fmt::format("× {:.1f}; smallest step {:+.2g} %", end / begin, 100 * least),
          least > 0 ? "holds" : "fails"};
}

Finding rate(const char* name, double index, double limit, double eta) {
  const double value = index * pi / 3 * (1 - eta), off = value / limit - 1;
  return {fmt::format("{}·(π/3 − φ) at η = 1 − {:.0e}, derived limit {:.10g}", name, 1 - eta, limit),
          "to infinity; rate not printed", fmt::format("{:.10g}", value), small(off) + " relative",
          std::abs(off) < 5e-5 ? "holds" : "fails"};
}

Finding closure(const Chains& exact, const Chains& runge_kutta) {
  double drift = 0, closed = 0, angles = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    drift = std::max(drift, runge_kutta[k].velocity.rates.closure_error);
    closed = std::max(closed, exact[k].velocity.rates.closure_error);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 5; ++j)
        angles = std::max(angles, std::abs(exact[k].legs[i].angles[j] - runge_kutta[k].legs[i].angles[j]));
  }
  return {"least norm by 59 Runge-Kutta steps, against the flow (of the chord alone)", "how, it does not say",
          fmt::format("legs drift open by {} m, the flow by {} m", small(drift), small(closed)),
          small(angles) + " rad", angles < 1e-8 ? "agree" : "differ"};
}

/// The claim of section 5.1, and what it hangs on.
void add_artefact(std::vector<Finding>& findings, const std::vector<Sample>& arcs, const Chains& chains,
                  const ChainLegs<Planar>& robot) {
  const auto cc = [&](std::size_t k) { return arcs[k].indices.rotation; };
  const auto prb = [&](std::size_t k) { return chains[k].velocity.indices.rotation; };
  findings.push_back(
      {"‖U_θr‖ smaller than ‖U_r‖, k = 0", "smaller",
       fmt::format("{} rad/rad, {} rad/m; with tendons in mm {} rad/mm", number(prb(first)),
                   number(cc(first)), number(1e-3 * cc(first))),
       fmt::format("ratio {:.4g} 1/m, or {:.4g} 1/mm", cc(first) / prb(first), 1e-3 * cc(first) / prb(first)),
       "unit artefact"});
  findings.push_back(
      {"‖U_r‖ / ‖U_θr‖ along the path", "CC more sensitive to the singularity",
       fmt::format("{:.4g} → {:.4g} 1/m at k = 0 → {}", cc(first) / prb(first), cc(last) / prb(last), last),
       fmt::format("{:+.2g} %", 100 * (cc(last) / prb(last) / (cc(first) / prb(first)) - 1)),
       "a factor of units"});
  const double arc_growth = cc(last) / cc(first), chain_growth = prb(last) / prb(first);
  findings.push_back({fmt::format("growth of ‖U_θr‖ against ‖U_r‖, k = 0 → {}", last),
                      "more stable (smaller)",
                      fmt::format("× {:.2f} against × {:.2f}", chain_growth, arc_growth),
                      fmt::format("{:+.2g} %", 100 * (chain_growth / arc_growth - 1)),
                      chain_growth < arc_growth ? "holds" : "fails"});
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (std::size_t k = first; k <= last; ++k) {
    const auto legs = example51::evenly_bent(robot, chains[k].pose);
    if (!legs) continue;
    const auto rates = chain_rates(robot, chains[k].pose, *legs);
    std::array<double, 3> row;  // all joints of a leg turn alike: Δl = d (n − 1) Δθ
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < 5; ++j) sum += rates.K[i][j];
      row[i] = chains[k].velocity.inverse(2, static_cast<Eigen::Index>(i)) * sum /
               (5 * robot.legs[i].tendon_offset);
    }
    const double ratio = std::hypot(row[0], row[1], row[2]) / cc(k);
    low = std::min(low, ratio), high = std::max(high, ratio);
  }
  findings.push_back({"the same in equal units (metres of tendon, joints of a leg alike), over ‖U_r‖",
                      "not given", fmt::format("{:.3f} to {:.3f}; n/(n − 1) = 1.2", low, high), "",
                      "no less sensitive"});
}

/// What (54), put right, reads from shapes of least norm: without a wrench no chord bears a force.
Finding chord_forces(const Chains& chains, const ChainLegs<Planar>& robot) {
  double low = 0, high = -std::numeric_limits<double>::infinity();
  const ChainSample& s = chains[last];
  for (std::size_t i = 0; i < 3; ++i) {
    const ChainLeg<Planar>& leg = robot.legs[i];
    const auto angles = s.legs[i].of(leg.chain);
    std::vector<double> torques;
    for (std::size_t j = 0; j < angles.size(); ++j)
      torques.push_back(leg.spring(static_cast<int>(j)) * angles[j]);
    const Vec2<double> u = leg.chain.tip(angles).position;
    const double force = dot(tip_wrench(leg.chain, torques, angles).force, u) / std::sqrt(squared_norm(u));
    low = std::min(low, force), high = std::max(high, force);
  }
  return {fmt::format("chord forces that (54) reads from these shapes, k = {}, no wrench", last),
          "section 3.2: tendon lengths from (54)", fmt::format("{:.3f} to {:.3f} N", low, high), "true: 0",
          "inconsistent; ask inverse statics"};
}

Series curve(std::string label, Index index, const Chains& chains) {
  Series series{
      .label = std::move(label), .x = {}, .y = {}, .mark = Mark::line_points, .colour = Colour::blue};
  for (const ChainSample& s : chains) {
    series.x.push_back(s.eta);
    series.y.push_back(s.velocity.indices.*index);
  }
  return series;
}

/// ‖U_r‖ of arcs in units that make both begin alike.
Series scaled_arcs(const std::vector<Sample>& arcs, Index index, double at_first) {
  const double scale = at_first / (arcs[first].indices.*index);
  Series series{.label = fmt::format("constant curvature, × {:.3g} m", scale),
                .x = {},
                .y = {},
                .mark = Mark::line,
                .colour = Colour::orange};
  for (const Sample& s : arcs) {
    series.x.push_back(s.eta);
    series.y.push_back(scale * (s.indices.*index));
  }
  return series;
}

Figure figure_of(const std::vector<Sample>& arcs, const Chains& chains, const example51::Rates& limit) {
  Figure figure{.title = "3-RFR, pseudo-rigid chains: towards a type II singularity",
                .panels = {},
                .width = 760,
                .height = 1000,
                .comments = compare::provenance("tdpcr/fig11", "Fig. 11", example51::six_links)};
  figure.panels.push_back(example51::index_panel(
      example51::log_axis("condition number of J", "", 1, 3000),
      {curve("as the paper has it (m and m²)", &Indices::condition, chains)}, limit.condition));
  const auto pair = [&](const char* label, Index index) {
    return std::vector<Series>{curve(label, index, chains),
                               scaled_arcs(arcs, index, chains[first].velocity.indices.*index)};
  };
  figure.panels.push_back(example51::index_panel(example51::log_axis("‖Uθₚ‖", "m/rad", 0.004, 4),
                                                 pair("position sensitivity", &Indices::position),
                                                 limit.position));
  figure.panels.push_back(example51::index_panel(example51::log_axis("‖Uθᵣ‖", "rad/rad", 0.4, 400),
                                                 pair("rotation sensitivity", &Indices::rotation),
                                                 limit.rotation));
  figure.panels.back().x.label = "η, along the trajectory";
  return figure;
}

}  // namespace

Expected<ItemResult> tdpcr_fig11(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load("3-rfr");
  if (!robot) return tl::unexpected(robot.error());
  const auto arcs = example51::trajectory(*robot);
  if (!arcs) return tl::unexpected(arcs.error());
  const auto on_chains = example51::chains(*robot);
  if (!on_chains) return tl::unexpected(on_chains.error());
  const auto chains = example51::trajectory(*on_chains, 0);
  if (!chains) return tl::unexpected(chains.error());
  const auto runge_kutta = example51::trajectory(*on_chains, 1);
  if (!runge_kutta) return tl::unexpected(runge_kutta.error());
  const auto near_end = example51::sample(*on_chains, 1 - 1e-5);
  if (!near_end) return tl::unexpected(near_end.error());
  const example51::Rates limit = example51::rates(arcs->back(), chains->back());

  ItemResult result;
  auto& findings = result.findings;
  findings.push_back(growth("condition number of J", &Indices::condition, "", *chains));
  findings.push_back(growth("‖U_θp‖", &Indices::position, " m/rad", *chains));
  findings.push_back(growth("‖U_θr‖", &Indices::rotation, " rad/rad", *chains));
  const Indices& end = near_end->velocity.indices;
  findings.push_back(rate("condition", end.condition, limit.condition, near_end->eta));
  findings.push_back(rate("‖U_θp‖", end.position, limit.position, near_end->eta));
  findings.push_back(rate("‖U_θr‖", end.rotation, limit.rotation, near_end->eta));
  findings.push_back(closure(*chains, *runge_kutta));
  add_artefact(findings, *arcs, *chains, *on_chains);
  findings.push_back(chord_forces(*chains, *on_chains));

  result.tables.emplace_back("fig11", table_of(*chains));
  result.figures.emplace_back("fig11", figure_of(*arcs, *chains, limit));
  return result;
}

}  // namespace sinew::inline v1

/// How chains approach the rod they stand for: chord and turn between free ends under tendons' moment m and a
/// chord force f, against the elastica, over the number of links. Theory: docs/theory/pseudo_rigid.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinematics/chains/chain.hpp"
#include "sinew/io/table.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"

namespace sinew::inline v1 {
namespace {

constexpr double length = 0.2, stiffness = 2.9452431127404317e-3;  // ℓ [m], EI [N m²] of the 3-RFR's legs
constexpr std::array<int, 5> links{4, 6, 8, 16, 32};

struct Case {
  double moment, force;  ///< m [N m], f [N], > 0 pulls the ends apart
  const char* name;
};
constexpr std::array cases{Case{-0.02, 0, "m = −20 mN m"}, Case{-0.02, 0.03, "m = −20 mN m, f = 30 mN"},
                           Case{-0.03, -0.03, "m = −30 mN m, f = −30 mN"}};

struct Bent {
  double chord, turn;  ///< [m], [rad]
};

/// EI θ′ = m − f x in the chord's frame, tip on the y axis: Runge-Kutta, and the first direction by secants.
Bent elastica(const Case& load) {
  struct Point {
    double x, y, angle;
  };
  const auto shoot = [&](double direction) {
    constexpr int steps = 4000;
    constexpr double h = length / steps;
    const auto slope = [&](const Point& p) {
      return Point{-std::sin(p.angle), std::cos(p.angle), (load.moment - load.force * p.x) / stiffness};
    };
    const auto ahead = [](const Point& p, const Point& k, double by) {
      return Point{p.x + by * k.x, p.y + by * k.y, p.angle + by * k.angle};
    };
    Point p{0, 0, direction};
    for (int i = 0; i < steps; ++i) {
      const Point k1 = slope(p), k2 = slope(ahead(p, k1, h / 2)), k3 = slope(ahead(p, k2, h / 2)),
                  k4 = slope(ahead(p, k3, h));
      p = {p.x + h / 6 * (k1.x + 2 * k2.x + 2 * k3.x + k4.x),
           p.y + h / 6 * (k1.y + 2 * k2.y + 2 * k3.y + k4.y),
           p.angle + h / 6 * (k1.angle + 2 * k2.angle + 2 * k3.angle + k4.angle)};
    }
    return p;
  };
  double before = -0.5 * load.moment * length / stiffness,
         now = 1.01 * before;  // half a bend beside the chord
  double x_before = shoot(before).x;
  for (int round = 0; round < 30; ++round) {
    const double x = shoot(now).x;
    if (std::abs(x) < 1e-16 || x == x_before) break;
    const double next = now - x * (now - before) / (x - x_before);
    before = now, x_before = x, now = next;
  }
  const Point tip = shoot(now);
  return {tip.y, tip.angle - now};
}

/// s k θ = m t + f g, by iteration: the chord force is well below buckling.
Bent chain_under(const Case& load, int count, PrbDiscretisation model) {
  const PseudoRigid chain{.length = length, .links = count, .model = model};
  std::vector<double> angles(static_cast<std::size_t>(chain.joints()));
  for (int round = 0; round < 200; ++round) {
    const auto tip = chain.tip<double>(angles);
    const double chord = tip.position.norm();
    for (std::size_t j = 0; j < angles.size(); ++j) {
      const int joint = static_cast<int>(j);
      angles[j] =
          (load.moment * chain.turn_weight(joint) + load.force * dot(tip.position, tip.rate[j]) / chord) /
          (stiffness / chain.link_length() * chain.spring(joint));
    }
  }
  return {chain.tip<double>(angles).position.norm(), chain.turn<double>(angles)};
}

std::vector<std::string> provenance() {
  return {fmt::format("sinew {}, study tdpcr/chains: chains of n links against the elastica", version()),
          "backbone of 200 mm, EI = 2.945 mN m², free ends; M0: as [TDPCR], M0w: ends weighted 3/2"};
}

struct LinkErrors {
  std::array<double, links.size()> chord, turn;
};

LinkErrors errors_of(const Case& load, PrbDiscretisation model) {
  const Bent rod = elastica(load);
  LinkErrors errors{};
  for (std::size_t k = 0; k < links.size(); ++k) {
    const Bent bent = chain_under(load, links[k], model);
    errors.chord[k] = std::abs(bent.chord - rod.chord);
    errors.turn[k] = std::abs(bent.turn - rod.turn);
  }
  return errors;
}

/// Of the last doubling of n; none where rounding is all that is left.
Finding order(const Case& load, const char* model, const char* what,
              const std::array<double, links.size()>& errors, double expected, const char* unit) {
  const double fine = errors[links.size() - 1], coarse = errors[links.size() - 2];
  const bool is_exact = coarse < 1e-11;
  const double found = std::log2(coarse / fine);
  return {fmt::format("{} of {}, {}", what, model, load.name),
          expected > 0 ? fmt::format("derived: order {:.0f}", expected) : "derived: exact",
          is_exact ? fmt::format("exact to {} {}", compare::small(fine), unit)
                   : fmt::format("order {:.2f}; {} {} at n = 6", found, compare::small(errors[1]), unit),
          is_exact ? "" : fmt::format("{:+.2f}", found - expected),
          (is_exact || std::abs(found - expected) < 0.2) && is_exact == (expected == 0) ? "holds" : "fails"};
}

Panel panel_of(const char* title, const char* unit, bool is_chord) {
  Panel panel{
      .title = title,
      .x = {.label = "number of links n", .unit = "", .log = true, .low = 3.5, .high = 36},
      .y = {.label = is_chord ? "error of the chord" : "error of the turn", .unit = unit, .log = true},
      .series = {},
      .notes = {},
      .legend = Legend::bottom_left};
  constexpr std::array colours{Colour::blue, Colour::orange, Colour::green};
  for (std::size_t c = 1; c < cases.size(); ++c)
    for (const PrbDiscretisation model : {PrbDiscretisation::even, PrbDiscretisation::weighted}) {
      const LinkErrors errors = errors_of(cases[c], model);
      const bool is_even = model == PrbDiscretisation::even;
      Series series{.label = fmt::format("{}, {}", is_even ? "M0" : "M0w", cases[c].name),
                    .x = {},
                    .y = {},
                    .mark = is_even ? Mark::dashed : Mark::line_points,
                    .colour = colours[c]};
      for (std::size_t k = 0; k < links.size(); ++k) {
        series.x.push_back(links[k]);
        series.y.push_back(is_chord ? 1e6 * errors.chord[k] : 1e3 * errors.turn[k]);
      }
      panel.series.push_back(std::move(series));
    }
  return panel;
}

}  // namespace

Expected<ItemResult> tdpcr_chains(const StudyItem&, const std::filesystem::path&) {
  ItemResult result;
  Table table{"moment[N m]", "force[N]", "weighted", "n", "chord_error[m]", "turn_error[rad]"};
  table.comments = provenance();
  for (const Case& load : cases)
    for (const PrbDiscretisation model : {PrbDiscretisation::even, PrbDiscretisation::weighted}) {
      const bool is_even = model == PrbDiscretisation::even;
      const LinkErrors errors = errors_of(load, model);
      for (std::size_t k = 0; k < links.size(); ++k)
        table.add_row(std::array{load.moment, load.force, is_even ? 0.0 : 1.0, static_cast<double>(links[k]),
                                 errors.chord[k], errors.turn[k]});
      const char* name = is_even ? "M0" : "M0w";
      result.findings.push_back(order(load, name, "chord", errors.chord, 2, "m"));
      result.findings.push_back(order(load, name, "turn", errors.turn,
                                      is_even           ? 1
                                      : load.force == 0 ? 0
                                                        : 2,
                                      "rad"));
    }
  result.tables.emplace_back("chains", table);
  Figure figure{.title = "Pseudo-rigid chains against the elastica",
                .panels = {},
                .columns = 2,
                .width = 1200,
                .height = 520,
                .comments = provenance()};
  figure.panels.push_back(panel_of("chord", "µm", true));
  figure.panels.push_back(panel_of("turn: what tendons feel", "mrad", false));
  result.figures.emplace_back("chains", figure);
  return result;
}

}  // namespace sinew::inline v1

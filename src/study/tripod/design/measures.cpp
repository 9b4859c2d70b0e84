#include "study/tripod/design/measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::inline v1::tripod {
namespace {

constexpr double platform_radius = 0.125;  // of both presets, and of the 3PRS below (19) [m]

/// Sums for the two shapes of a shift, (e₂, −e₁) and (2 e₁ e₂, e₁² − e₂²).
struct TwoTerms {
  double aa = 0, ab = 0, bb = 0, ap = 0, bp = 0;

  void add(double a, double b, double p) {
    aa += a * a, ab += a * b, bb += b * b;
    ap += a * p, bp += b * p;
  }
  double first() const { return (ap * bb - bp * ab) / (aa * bb - ab * ab); }
  double second() const { return (bp * aa - ap * ab) / (aa * bb - ab * ab); }
};

/// Numbers in other units without the last digits, which the factor of units spoils.
std::vector<double> in_units(std::vector<double> values, double factor) {
  for (double& value : values) value = std::round(value * factor * 1e9) / 1e9;
  return values;
}

/// The different values of a column, ascending.
std::vector<double> values_of(const Swept& study, const char* column) {
  std::vector<double> values = study[column];
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

}  // namespace

double Measures::twist() const { return 2 * std::asin(turn) * 180 / std::numbers::pi; }

double Measures::relative() const { return distance / rigid; }

Measures measures(const Swept& study, std::span<const std::size_t> rows) {
  Measures of{.asked = rows.size()};
  const auto &xs = study["x"], &ys = study["y"], &e3s = study["e3"], &e1s = study["e1"], &e2s = study["e2"];
  double turns = 0, shifts = 0, rigid = 0, apart = 0;
  TwoTerms terms;
  for (const std::size_t k : rows) {
    const double x = xs[k], y = ys[k], e3 = e3s[k];
    if (!std::isfinite(x + y + e3)) continue;
    const double e1 = e1s[k], e2 = e2s[k], cosine = e1 * e1 - e2 * e2;
    const double x_rigid = -2 * platform_radius * e1 * e2, y_rigid = -platform_radius * cosine;
    ++of.solved;
    turns += e3 * e3;
    shifts += x * x + y * y;
    rigid += x_rigid * x_rigid + y_rigid * y_rigid;
    apart += (x - x_rigid) * (x - x_rigid) + (y - y_rigid) * (y - y_rigid);
    terms.add(e2, 2 * e1 * e2, x);
    terms.add(-e1, cosine, y);
  }
  const auto mean = [&](double sum) { return std::sqrt(sum / static_cast<double>(of.solved)); };
  of.turn = mean(turns), of.shift = mean(shifts), of.rigid = mean(rigid), of.distance = mean(apart);
  of.drift = terms.first(), of.square = terms.second();
  return of;
}

const Measures& Designs::at(std::size_t radius, std::size_t height, std::size_t angle) const {
  return all[(radius * heights.size() + height) * angles.size() + angle];
}

std::vector<double> Designs::over_angle(std::size_t radius, std::size_t height, Measure measure) const {
  std::vector<double> values;
  for (std::size_t k = 0; k < angles.size(); ++k) values.push_back(at(radius, height, k).*measure);
  return values;
}

Designs designs(const Swept& study) {
  const std::vector<double> radii = values_of(study, "rA"), heights = values_of(study, "h"),
                            angles = values_of(study, "psi");
  Designs made{in_units(radii, 1e3), in_units(heights, 1e3), in_units(angles, 180 / std::numbers::pi), {}};
  const auto &rA = study["rA"], &h = study["h"], &psi = study["psi"];
  for (const double radius : radii)
    for (const double height : heights)
      for (const double angle : angles)
        made.all.push_back(measures(study, rows_where(study, [&](std::size_t k) {
                                      return rA[k] == radius && h[k] == height && psi[k] == angle;
                                    })));
  return made;
}

const Measures& Loaded::at(std::size_t load, std::size_t diameter) const {
  return all[load * diameters.size() + diameter];
}

std::vector<double> Loaded::over_diameter(std::size_t load, Measure measure) const {
  std::vector<double> values;
  for (std::size_t k = 0; k < diameters.size(); ++k) values.push_back(at(load, k).*measure);
  return values;
}

Loaded loaded(const Swept& study, std::string name, double height) {
  const std::vector<double> loads = values_of(study, "load"), diameters = values_of(study, "d");
  Loaded made{std::move(name), height, in_units(diameters, 1e3), {}, 0};
  std::vector<std::size_t> first;
  for (const double load : loads)
    for (const double diameter : diameters) {
      const auto rows = rows_where(
          study, [&](std::size_t k) { return study["load"][k] == load && study["d"][k] == diameter; });
      made.all.push_back(measures(study, rows));
      if (load != loads.front()) continue;
      if (first.empty()) first = rows;
      for (const char* column : {"x", "y", "e3"})
        for (std::size_t i = 0; i < rows.size(); ++i)
          made.unloaded_change =
              worse(made.unloaded_change, std::abs(study[column][rows[i]] - study[column][first[i]]));
    }
  return made;
}

}  // namespace sinew::inline v1::tripod

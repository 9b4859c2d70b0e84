#include "study/tripod/loads/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sinew::inline v1::tripod {
namespace {

Finding judged(std::string quantity, std::string paper, std::string ours, bool holds) {
  return {std::move(quantity), std::move(paper), std::move(ours), "", holds ? "holds" : "fails"};
}

double mean(std::span<const double> values) {
  double sum = 0, count = 0;
  for (const double value : values)
    if (std::isfinite(value)) sum += value, count += 1;
  return sum / count;
}

std::vector<double> without_mean(std::vector<double> values) {
  const double middle = mean(values);
  for (double& value : values) value -= middle;
  return values;
}

/// Loaded over unloaded, each about its mean: the factor of least squares, and how like their shapes are.
struct Scaling {
  double factor, likeness;
};

Scaling scaling(const std::vector<double>& unloaded, const std::vector<double>& loaded) {
  const std::vector<double> from = without_mean(unloaded), to = without_mean(loaded);
  const double like = likeness(from, to);
  return {like * root_mean_square(to) / root_mean_square(from), like};
}

/// A study at one load: what is asked about it.
struct Change {
  const Swept& study;
  LoadCase at;

  LoadedPairs of(std::string_view variable) const { return pairs_of(study, at, variable); }

  /// Of the two variables together, each about its mean.
  Scaling scaling_of(std::string_view a, std::string_view b) const {
    const auto joined = [&](std::vector<double> LoadedPairs::*state) {
      std::vector<double> values = without_mean(of(a).*state);
      const std::vector<double> more = without_mean(of(b).*state);
      values.insert(values.end(), more.begin(), more.end());
      return values;
    };
    return scaling(joined(&LoadedPairs::unloaded), joined(&LoadedPairs::loaded));
  }
  Scaling scaling_of(std::string_view variable) const {
    const LoadedPairs pairs = of(variable);
    return scaling(pairs.unloaded, pairs.loaded);
  }

  /// √(Δa² + Δb²), pose by pose.
  std::vector<double> sizes(std::string_view a, std::string_view b) const {
    std::vector<double> size = of(a).change();
    const std::vector<double> other = of(b).change();
    for (std::size_t k = 0; k < size.size(); ++k) size[k] = std::hypot(size[k], other[k]);
    return size;
  }
  double rms(std::string_view a, std::string_view b) const { return root_mean_square(sizes(a, b)); }

  /// How much of the change is the same everywhere: |mean| over root mean square.
  double shift(std::string_view a, std::string_view b) const {
    return std::hypot(mean(of(a).change()), mean(of(b).change())) / rms(a, b);
  }
};

Finding relative_rms_at(const std::string& name, const Swept& study, Load load, std::size_t step) {
  const auto row = [&](const auto& value) {
    return fmt::format("{:.4f}, {:.4f}, {:.4f}, {:.4f} %", value(0), value(1), value(2), value(3));
  };
  const auto ours = [&](const char* variable) {
    return relative_rms(pairs_of(study, {Rods::thin, load, step}, variable));
  };
  return {fmt::format("{}: relative RMS of x_p, y_p, z_p, e_3 under {} = {} {}", name, name_of(load),
                      value_of(load, step), unit_of(load)),
          row([&](std::size_t v) { return cell(table_1.cells, load, step, v); }),
          row([&](std::size_t v) { return ours(variables[v]); }),
          fmt::format("e_1 {:.4f}, e_2 {:.4f} %", ours("e1"), ours("e2")), "for information"};
}

Finding contraction(const std::string& name, const Change& change, const char* paper) {
  const double factor = change.scaling_of("e1", "e2").factor;
  return judged(name + ": e_1, e_2 contract", paper, fmt::format("factor {:.4f}", factor), factor < 1);
}

Finding lowering(const std::string& name, const Change& change, const char* paper) {
  const LoadedPairs z = change.of("z");
  const auto size = [](const std::vector<double>& values) {
    return std::ranges::max(values) - std::ranges::min(values);
  };
  const double down = mean(z.change());
  return judged(name + ": z_p contracts", paper,
                fmt::format("lower by {:.3f} mm in the mean; its range times {:.4f}", -1e3 * down,
                            size(z.loaded) / size(z.unloaded)),
                down < 0);
}

/// The half of the poses that are tilted more against the other half.
Finding with_tilt(const std::string& name, const Change& change) {
  const std::vector<double> e1 = change.of("e1").unloaded, e2 = change.of("e2").unloaded,
                            sizes = change.sizes("e1", "e2");
  std::vector<double> tilts(e1.size());
  for (std::size_t k = 0; k < tilts.size(); ++k) tilts[k] = std::hypot(e1[k], e2[k]);
  std::vector<double> sorted = tilts;
  std::ranges::sort(sorted);
  std::vector<double> inner, outer;
  for (std::size_t k = 0; k < tilts.size(); ++k)
    (tilts[k] < sorted[sorted.size() / 2] ? inner : outer).push_back(sizes[k]);
  const double ratio = root_mean_square(outer) / root_mean_square(inner);
  return judged(
      name + ": e_1, e_2 change more where the platform is tilted",
      "higher differences as the end effector rotates",
      fmt::format("rms of the tilted half {:.2f} times that of the other; correlation with the tilt {:.2f}",
                  ratio, likeness(without_mean(sizes), without_mean(tilts))),
      ratio > 1);
}

Finding shapes(const std::string& name, const Change& change, const char* paper) {
  const Scaling e3 = change.scaling_of("e3"), x = change.scaling_of("x"), y = change.scaling_of("y");
  return judged(name + ": shapes of e_3, x_p, y_p remain, but for a shift", paper,
                fmt::format("likeness {:.4f}, {:.4f}, {:.4f}; factors {:.3f}, {:.3f}, {:.3f}", e3.likeness,
                            x.likeness, y.likeness, e3.factor, x.factor, y.factor),
                std::min({e3.likeness, x.likeness, y.likeness}) > 0.99);
}

Finding shifting(const std::string& name, const Change& change) {
  const double tilt = change.shift("e1", "e2"), place = change.shift("x", "y");
  const auto middle = [&](const char* variable) {
    const double shift = mean(change.of(variable).change());
    return std::abs(shift) < 1e-9 ? 0 : shift;  // the sign of what rounding leaves means nothing
  };
  return judged(
      name + ": poses are shifted as a whole", "an additional shifting effect",
      fmt::format("mean change e_1 {:+.4f}, e_2 {:+.4f}, x_p {:+.2f} mm, y_p {:+.2f} mm: {:.2f} of the rms "
                  "of e_1, e_2 and {:.2f} of that of x_p, y_p",
                  middle("e1"), middle("e2"), 1e3 * middle("x"), 1e3 * middle("y"), tilt, place),
      std::min(tilt, place) > 0.5);
}

/// By threefold symmetry small moments about x and y do the same over a symmetric set of poses.
Finding unequal(const std::string& name, const Swept& study) {
  const auto ratio = [&](std::size_t step, const char* a, const char* b) {
    return Change{study, {Rods::thin, Load::moment_x, step}}.rms(a, b) /
           Change{study, {Rods::thin, Load::moment_y, step}}.rms(a, b);
  };
  const double most = ratio(load_steps, "x", "y");
  return judged(
      name + ": moments about x and y do not do the same", "effects are not equal",
      fmt::format(
          "rms of the shift in x_p, y_p under M_x over that under M_y {:.3f} for 0.25 N m, {:.3f} for "
          "1 N m; of e_1, e_2 {:.3f}, {:.3f}; 1 for small moments by symmetry",
          ratio(1, "x", "y"), most, ratio(1, "e1", "e2"), ratio(load_steps, "e1", "e2")),
      std::abs(most - 1) > 0.01);
}

}  // namespace

void add_load_claims(std::vector<Finding>& findings, const std::string& name, const Swept& study, Load load) {
  for (std::size_t step = 1; step <= load_steps; ++step)
    findings.push_back(relative_rms_at(name, study, load, step));
  const bool is_force = load == Load::force_z;
  const Change change{study, {Rods::thin, load, load_steps}};
  findings.push_back(contraction(name, change, is_force ? "a little contraction" : "similar considerations"));
  findings.push_back(lowering(name, change, is_force ? "a little contraction" : "similar considerations"));
  findings.push_back(with_tilt(name, change));
  findings.push_back(shapes(
      name, change, is_force ? "a scaling effect while their shapes remain" : "similar considerations"));
  if (is_force) return;
  findings.push_back(shifting(name, change));
  findings.push_back(unequal(name, study));
}

}  // namespace sinew::inline v1::tripod

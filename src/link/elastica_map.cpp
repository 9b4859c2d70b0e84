#include "link/elastica_map.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

namespace sinew::inline v1 {
namespace {

constexpr double straight = 1e-5;  // 1 − w ~ d²: below, rounding of w hides the force
constexpr double tip_tolerance = 1e-14;

bool is_odd(int count) { return count % 2 != 0; }

/// Half the period of the curvature along the rod, in units of its length: 2K(k)/√f, by the
/// arithmetic-geometric mean of 1 and k′ = |sin(χ/2)|.
double half_period(const Vec2<double>& local_force) {
  const double n = std::abs(local_force[0]), t = local_force[1], f = std::hypot(n, t);
  double a = 1, b = t > 0 ? n / std::sqrt(2 * f * (f + t)) : std::sqrt((f - t) / (2 * f));
  if (!(f > 0) || !(b > 0)) return std::numeric_limits<double>::infinity();
  for (int k = 0; k < 60 && a - b > 1e-15 * a; ++k) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return std::numbers::pi / (a * std::sqrt(f));
}

int negative_eigenvalues(const Mat<double, 2, 2>& a) {
  if (cross(a.col(0), a.col(1)) < 0) return 1;
  return a(0, 0) + a(1, 1) < 0 ? 2 : 0;
}

// Under a dead force the in-plane index is the number of zeros of ∂θ/∂χ in (0, 1), counted from the tip, the
// out-of-plane one that of sin(θ − φ), φ the force's direction. By Sturm each has exactly one between any two
// neighbouring zeros of the curvature, and its sign at the base says whether there is one more. Holding the
// tip takes off the negative eigenvalues of the compliance.
ElasticaEquilibrium equilibrium(double d, const Vec2<double>& local_force, const ElasticaTangent& tangent) {
  ElasticaEquilibrium e{tangent.state, local_force, tangent.stiffness(), 0, 0, -1, -1};
  const double force = e.state.force[0], period = half_period(local_force);
  e.inflections = std::isfinite(period) ? static_cast<int>(std::ceil(1 / period)) - 1 : 0;
  e.out_of_plane_stiffness = d != 0 ? force / d : std::numeric_limits<double>::quiet_NaN();
  if (!e.stiffness.allFinite()) return e;
  const auto zeros = [&](double sign_at_base) {
    return e.inflections + ((sign_at_base < 0) != is_odd(e.inflections) ? 1 : 0);
  };
  const double rate = cross(tangent.force_rate.col(0), tangent.force_rate.col(1));  // ∂θ/∂χ at the base
  e.unstable_in_plane = zeros(rate) - negative_eigenvalues(e.stiffness);
  const double lateral = force != 0 ? force : d;
  e.unstable_out_of_plane = zeros(lateral * local_force[0]) - (lateral * d <= 0 ? 1 : 0);
  return e;
}

/// The tip in coordinates (d, z), z² = 2(1 − w) − d²: near the straight rod d and z are proportional to its
/// bend, where 1 − w is to the square, so that Newton's method and the cells' linear models hold there as
/// elsewhere.
struct Chart {
  explicit Chart(const ElasticaTangent& tangent) : point(of(tangent.state.tip)), rate(tangent.tip_rate) {
    rate.row(1) = (rate.row(1) + point[0] * rate.row(0)) / -point[1];
  }
  static Vec2<double> of(const Vec2<double>& tip) {
    return {tip[0], std::sqrt(2 * (1 - tip[1]) - tip[0] * tip[0])};
  }

  Vec2<double> point;
  Mat<double, 2, 2> rate;  ///< by the local force
};

/// A step of Newton's method, taken in n cosh √t instead of n: what bends the rod at its base under tension.
Vec2<double> moved(const Vec2<double>& local_force, const Vec2<double>& step) {
  const auto growth = [](double t) { return t > 0 ? std::cosh(std::sqrt(t)) : 1; };
  const double n = local_force[0], t = local_force[1], here = growth(t), root = std::sqrt(t);
  const double slope = t > 0 ? 0.5 * std::sinh(root) / root : 0;
  const double next = t + step[1];
  return {(here * (n + step[0]) + n * slope * step[1]) / growth(next), next};
}

/// Looks for the local forces whose tip is the wanted one.
class Search {
 public:
  Search(const Vec2<double>& tip, const ElasticaMapOptions& options)
      : tip_(tip),
        goal_(Chart::of(tip)),
        options_(options) {}

  void run();
  void list(ElasticaMap& map) const;

 private:
  struct Found {
    Vec2<double> local_force;
    ElasticaTangent tangent;
  };

  void visit(double x, double y, double half_x, double half_y);
  void start(Vec2<double> local_force);
  void keep(const Vec2<double>& local_force, const ElasticaTangent& tangent);

  Vec2<double> tip_, goal_;
  ElasticaMapOptions options_;
  std::vector<Found> found_;
};

// Cells are even in x = √f and in y with tan(χ/4) = sinh(x y)/sinh(x): a straight rod under tension
// multiplies χ by cosh x on its way to the base, and even steps of χ would miss the bend there.
void Search::run() {
  const double end = std::sqrt(options_.force_bound);
  const int columns = options_.refinement * std::max(96, static_cast<int>(std::ceil(end / 0.07)));
  const int rows = columns;
  const double half_x = 0.5 * end / columns, half_y = 0.5 / rows;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) visit((2 * i + 1) * half_x, (2 * j + 1) * half_y, half_x, half_y);
}

void Search::visit(double x, double y, double half_x, double half_y) {
  const double whole = std::sinh(x), q = std::sinh(x * y) / whole, bend = 4 / (1 + q * q);
  const double chi = 4 * std::atan(q), f = x * x;
  const Vec2<double> local_force = elastica_local_force(f, chi);
  const ElasticaTangent tangent = elastica_tangent(local_force);
  const Vec2<double> along_chi = bend * Vec2<double>(-local_force[1], local_force[0]);
  const Vec2<double> by_y = along_chi * (x * std::cosh(x * y) / whole);
  const Vec2<double> by_x =
      2 / x * local_force + along_chi * ((y * std::cosh(x * y) - q * std::cosh(x)) / whole);
  const Chart here(tangent);
  const Vec2<double> a = half_x * (here.rate * by_x), b = half_y * (here.rate * by_y);
  for (const double side : {1.0, -1.0}) {
    const Vec2<double> gap = here.point - Vec2<double>(side * goal_[0], goal_[1]);
    // Too far by either coordinate alone, which needs no inverse, or too far in cells.
    if (!(std::abs(gap[0]) <= 2 * (std::abs(a[0]) + std::abs(b[0])))) continue;
    if (!(std::abs(gap[1]) <= 2 * (std::abs(a[1]) + std::abs(b[1])))) continue;
    if (std::max(std::abs(cross(gap, b)), std::abs(cross(a, gap))) > 4 * std::abs(cross(a, b))) continue;
    start(Vec2<double>(side * local_force[0], local_force[1]));
  }
}

void Search::start(Vec2<double> local_force) {
  ElasticaTangent tangent = elastica_tangent(local_force);
  Chart chart(tangent);
  for (int iteration = 0; iteration < 30; ++iteration) {
    const Vec2<double> gap = chart.point - goal_;
    const double error = gap.norm();
    const Vec2<double> by_n = chart.rate.col(0), by_t = chart.rate.col(1);
    const Vec2<double> newton = Vec2<double>(cross(by_t, gap), cross(gap, by_n)) / cross(by_n, by_t);
    double fraction = 1;
    do {
      tangent = elastica_tangent(moved(local_force, fraction * newton));
      chart = Chart(tangent);
    } while (!((chart.point - goal_).norm() < error) && (fraction *= 0.5) > 0.02);
    if (!((chart.point - goal_).norm() < error)) break;
    local_force = moved(local_force, fraction * newton);
    if (local_force.norm() > 2 * options_.force_bound + 10) return;
  }
  tangent = elastica_tangent(local_force);
  if ((tangent.state.tip - tip_).norm() <= tip_tolerance && local_force.norm() <= options_.force_bound)
    keep(local_force, tangent);
}

void Search::keep(const Vec2<double>& local_force, const ElasticaTangent& tangent) {
  for (const Found& other : found_) {
    const Vec2<double> apart = local_force - other.local_force;
    if (apart.norm() < 1e-6 * (1 + local_force.norm())) return;
    if ((tangent.tip_rate * apart).norm() < 4e-14 && apart.norm() < 1) return;
  }
  found_.push_back({local_force, tangent});
}

void Search::list(ElasticaMap& map) const {
  for (const Found& found : found_)
    map.equilibria.push_back(equilibrium(tip_[0], found.local_force, found.tangent));
  std::sort(map.equilibria.begin(), map.equilibria.end(), [](const auto& a, const auto& b) {
    return a.state.energy != b.state.energy ? a.state.energy < b.state.energy
                                            : a.local_force[0] > b.local_force[0];
  });
}

}  // namespace

ElasticaEquilibrium elastica_equilibrium(const Vec2<double>& local_force) {
  const ElasticaTangent tangent = elastica_tangent(local_force);
  return equilibrium(tangent.state.tip[0], local_force, tangent);
}

ElasticaMap elastica_map(const Vec2<double>& tip, const ElasticaMapOptions& options) {
  ElasticaMap map;
  const double reach = std::hypot(tip[0], tip[1]);
  if (!std::isfinite(reach) || !(options.force_bound > 0 && options.force_bound <= 300)) {
    map.report.status = Status::left_domain;
    map.report.message.append("the tip must be finite and the bound on the force in (0, 300]");
    return map;
  }
  if (std::abs(tip[0]) < straight && std::abs(1 - tip[1]) < straight * straight) {
    map.report.status = Status::singular;
    map.report.message.append("the rod is straight: the axial force is undetermined");
    return map;
  }
  if (reach >= 1) {
    map.report.status = Status::unreachable;
    map.report.message.append("the tip is farther from the base than the rod is long");
    return map;
  }
  Search search(tip, options);
  search.run();
  search.list(map);
  for (const auto& e : map.equilibria)
    map.report.residual = std::max(map.report.residual, (e.state.tip - tip).norm());
  if (map.equilibria.empty()) {
    map.report.status = Status::left_domain;
    map.report.message.append("no equilibrium was found within the bound on the force");
  } else if (tip[0] == 0) {
    map.report.status = Status::singular;
    map.report.message.append("the tip is on the base tangent's line: the plane of the rod is undetermined");
  }
  return map;
}

}  // namespace sinew::inline v1

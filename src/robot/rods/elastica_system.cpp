#include "robot/rods/elastica_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/at.hpp"

namespace sinew::inline v1 {
namespace {

template <class Group>
const auto& basis_of(const Group&) {
  return GalerkinBasis<Group::nodes>::get();
}

/// LDLᵀ without pivoting in place, rows first; number of negative pivots.
template <std::size_t N>
int factor_symmetric(double (&a)[N][N]) {
  int negative = 0;
  for (std::size_t j = 0; j < N; ++j) {
    for (std::size_t k = 0; k < j; ++k) {
      const double scaled = a[j][k] / a[k][k];
      a[j][j] -= scaled * a[j][k];
      for (std::size_t m = j + 1; m < N; ++m) a[m][j] -= a[m][k] * scaled;
      a[j][k] = scaled;
    }
    negative += a[j][j] < 0;
  }
  return negative;
}

/// The least of bending over rotation of a clamped rod, π²/4, less a little: what works against it by less
/// everywhere leaves it stable.
constexpr double least_bending = 2.46;

/// Unstable directions out of the rod's plane, see docs/theory/elastica.md.
template <class Group>
int unstable_aside(const Group& rods, int i) {
  constexpr std::size_t N = Group::nodes;
  const auto& basis = basis_of(rods);
  const double fd = rods.load[i] * rods.force_d[i], fw = rods.load[i] * rods.force_w[i];
  double matrix[N][N], x[N];
  bool bends_less = true;
  for (std::size_t j = 0; j < N; ++j) {
    double slope = 0;
    for (std::size_t k = 0; k < N; ++k) slope += basis.slope[j][k] * rods.theta[k][i];
    x[j] = fd * rods.sine[j][i] + fw * rods.cosine[j][i] - basis.weight[j] * slope * slope;
    bends_less = bends_less && x[j] > -least_bending * basis.weight[j];
  }
  if (bends_less) return 0;  // as most rods do
  for (std::size_t j = 0; j < N; ++j) {
    std::copy_n(basis.bending[j], N, matrix[j]);
    matrix[j][j] += x[j];
  }
  const int negative = factor_symmetric(matrix);
  double soft = 0;
  for (std::size_t j = 0; j < N; ++j) {
    x[j] = basis.weight[j];
    for (std::size_t k = 0; k < j; ++k) x[j] -= matrix[j][k] * x[k];
    soft += x[j] * x[j] / matrix[j][j];
  }
  return negative - (soft < 0);
}

}  // namespace

ElasticaSystem::ElasticaSystem(const ParallelRobot<RodLeg>& robot)
    : RodGroup(robot),
      coarse_(at((robot.leg_count() + rod_lanes - 1) / rod_lanes)),
      fine_(coarse_.size()),
      fed_(coarse_.size()) {
  const auto fill = [&](auto& groups) {
    for (auto& rods : groups) rods = {};
    for (int k = 0; k < rods_; ++k) {
      const RodLeg& leg = robot.legs[at(k)];
      auto& rods = groups[at(k / rod_lanes)];
      const int i = k % rod_lanes;
      put(leg.base.p, rods.base, i);
      put(leg.tangent(), rods.tangent, i);
      put(leg.platform_point, rods.platform_point, i);
      rods.flexibility[i] = 1 / leg.link.bending_stiffness();
      rods.active[i] = 1;
      rods.length[i] = 1;
    }
    fill_idle_lanes(groups.back());
  };
  fill(coarse_);
  fill(fine_);
}

/// Lanes without a rod do what the first of their group does, and count for nothing.
template <class Group>
void ElasticaSystem::fill_idle_lanes(Group& last) const {
  const auto fill = [&](RodLane& lane) {
    for (int i = (rods_ - 1) % rod_lanes + 1; i < rod_lanes; ++i) lane[i] = lane[0];
  };
  for (auto* lanes : {last.base, last.tangent, last.platform_point, last.lateral})
    for (int k = 0; k < 3; ++k) fill(lanes[k]);
  for (RodLane& lane : last.theta) fill(lane);
  for (RodLane* lane : {&last.flexibility, &last.length, &last.force_d, &last.force_w}) fill(*lane);
}

const LimbTraits& ElasticaSystem::traits() const {
  // stiff robots turn the best truncation into forces; with the quick one poses were within 2e-13 m of exact
  // ones
  static constexpr LimbTraits traits{
      .best_truncation = 1e-17, .quick_truncation = 1e-10, .has_no_rest = no_rest_of_tangents};
  return traits;
}

void ElasticaSystem::save(LimbState& to) const {
  save_common(to, is_fine_, fine_.size() * sizeof(FineRods::State));
  with([&]<class Group>(std::span<const Group> groups) {
    for (const Group& rods : groups) to.put<typename Group::State>(rods);
  });
}

void ElasticaSystem::restore(const LimbState& from) {
  LimbState::Reader reader(from);
  is_fine_ = restore_common(reader) != 0;
  with([&]<class Group>(std::span<Group> groups) {
    for (Group& rods : groups) reader.get<typename Group::State>(rods);
  });
}

Vec3<double> ElasticaSystem::base(int rod) const {
  return with_rod(rod, [](const auto& rods, int i) { return vector_of(rods.base, i); });
}

Vec3<double> ElasticaSystem::platform_point(int rod) const {
  return with_rod(rod, [](const auto& rods, int i) { return vector_of(rods.platform_point, i); });
}

double ElasticaSystem::stiffness(int rod) const {
  return with_rod(rod, [](const auto& rods, int i) { return 1 / rods.flexibility[i]; });
}

double ElasticaSystem::length(int rod) const {
  return with_rod(rod, [](const auto& rods, int i) { return rods.length[i]; });
}

void ElasticaSystem::set_feed(int rod, double length) {
  with([&](auto groups) {
    groups[at(rod / rod_lanes)].length[rod % rod_lanes] = length;
    if (rod % rod_lanes == 0) fill_idle_lanes(groups.back());
  });
}

void ElasticaSystem::set_inputs(Numbers inputs) {
  with([&](auto groups) {
    for (int k = 0; k < static_cast<int>(groups.size()) * rod_lanes; ++k) {
      const int rod = k < rods_ ? k : k / rod_lanes * rod_lanes;  // idle lanes: the first of their group
      groups[at(k / rod_lanes)].length[k % rod_lanes] = inputs[at(input_of(rod))];
    }
  });
}

namespace {

/// The states of some groups at other nodes; `rows` interpolates.
template <class From, class To, class Rows>
void carry(const std::vector<From>& from, std::vector<To>& to, const Rows& rows) {
  for (std::size_t g = 0; g < to.size(); ++g) {
    for (std::size_t j = 0; j < To::size; ++j)
      for (int i = 0; i < rod_lanes; ++i) {
        to[g].theta[j][i] = 0;
        for (std::size_t k = 0; k < From::size; ++k) to[g].theta[j][i] += rows[j][k] * from[g].theta[k][i];
      }
    std::copy_n(from[g].length, rod_lanes, to[g].length);
    std::copy_n(from[g].force_d, rod_lanes, to[g].force_d);
    std::copy_n(from[g].force_w, rod_lanes, to[g].force_w);
    for (int c = 0; c < 3; ++c) std::copy_n(from[g].lateral[c], rod_lanes, to[g].lateral[c]);
  }
}

}  // namespace

void ElasticaSystem::refine() {
  if (!is_fine_) carry(coarse_, fine_, refinement().fine_from_coarse);
  is_fine_ = true;
}

void ElasticaSystem::coarsen() {
  if (is_fine_) carry(fine_, coarse_, refinement().coarse_from_fine);
  is_fine_ = false;
}

double ElasticaSystem::evaluate(bool from_scratch) {
  constexpr int max_carried = 64;  // each rounds by 2e-16
  if (carried_ > max_carried) from_scratch = true;
  if (from_scratch) carried_ = 0;
  const double w = platform_.R.w, x = platform_.R.v[0], y = platform_.R.v[1], z = platform_.R.v[2];
  const double xx = 2 * x * x, yy = 2 * y * y, zz = 2 * z * z, xy = 2 * x * y, xz = 2 * x * z, yz = 2 * y * z,
               wx = 2 * w * x, wy = 2 * w * y, wz = 2 * w * z;
  const double rotation[9] = {1 - yy - zz, xy - wz, xz + wy, xy + wz,    1 - xx - zz,
                              yz - wx,     xz - wy, yz + wx, 1 - xx - yy};
  std::copy_n(rotation, 9, held_.rotation);
  for (int k = 0; k < 3; ++k) held_.position[k] = platform_.p[k];
  with([&](auto groups) { rod_kernels::evaluate(groups, held_, from_scratch, sums_); });
  return sums_.error;
}

bool ElasticaSystem::linearise() {
  has_inverse_ = with([&](auto groups) { return rod_kernels::linearise(groups, held_, sums_); });
  return has_inverse_ || lu_.factor(sums_.stiffness, radius_);
}

const SmallLu<6>& ElasticaSystem::factors() const {
  lu_.factor(sums_.stiffness, radius_);
  return lu_;
}

ElasticaSystem::Wrench ElasticaSystem::wrench_residual() const {
  return wrench() - Eigen::Map<const Wrench>(sums_.wrench);
}

ElasticaSystem::Twist ElasticaSystem::step(bool fresh) {
  with([&](auto groups) { rod_kernels::step(groups, held_, fresh, sums_); });
  if (has_inverse_) return Eigen::Map<const Twist>(sums_.twist);
  const Wrench wanted = ElasticaSystem::wrench_residual();
  Twist twist;
  lu_.solve(wanted.data(), twist.data());
  return twist;
}

void ElasticaSystem::move(const Twist& twist, Numbers fed) {
  if (!fed.empty())
    for (int k = 0; k < static_cast<int>(fed_.size()) * rod_lanes; ++k) {
      const int rod = k < rods_ ? k : k / rod_lanes * rod_lanes;  // idle lanes: the first of their group
      fed_[at(k / rod_lanes)].length[k % rod_lanes] = fed[at(input_of(rod))];
    }
  move_platform(twist);
  ++carried_;
  with([&](auto groups) { rod_kernels::apply(groups, twist.data(), fed.empty() ? nullptr : fed_.data()); });
}

ElasticaSystem::Wrench ElasticaSystem::input_wrench_jacobian(int input) const {
  Wrench sum = Wrench::Zero();
  for (int k = 0; k < rods_; ++k) {
    if (input_of(k) != input) continue;
    with_rod(k, [&](const auto& rods, int i) {
      const Vec3<double> force =
          vector_of(rods.lateral, i) * rods.feed_d[i] + vector_of(rods.tangent, i) * rods.feed_w[i];
      sum.template head<3>() += force;
      sum.template tail<3>() += cross(vector_of(rods.arm, i), force);
    });
  }
  return sum;
}

ElasticaSystem::Aim ElasticaSystem::aim(int index) const {
  return with_rod(index, [&](const auto& rods, int i) -> Aim {
    const Vec3<double> tangent = vector_of(rods.tangent, i);
    const Vec3<double> tip = platform_.point(vector_of(rods.platform_point, i)) - vector_of(rods.base, i);
    const double w = dot(tangent, tip);
    const Vec3<double> aside = tip - w * tangent;
    const double d = aside.norm();
    return {d, w, aside / d, 1 / rods.flexibility[i]};
  });
}

void ElasticaSystem::set_shape(int index, double length, std::span<const double> theta, double force_d,
                               double force_w, const Vec3<double>& lateral) {
  is_fine_ = false;
  CoarseRods& rods = coarse_[at(index / rod_lanes)];
  const int i = index % rod_lanes;
  rods.length[i] = length;
  for (std::size_t j = 0; j < coarse_nodes; ++j) rods.theta[j][i] = theta[j];
  rods.force_d[i] = force_d;
  rods.force_w[i] = force_w;
  put(lateral, rods.lateral, i);
  fill_idle_lanes(coarse_.back());
}

namespace {

/// Calls `use(a, b)` with every pair of lanes two states have.
template <class From, class To, class Use>
void each_lane(const From& from, To& to, Use&& use) {
  use(from.length, to.length);
  for (std::size_t j = 0; j < coarse_nodes; ++j) use(from.theta[j], to.theta[j]);
  use(from.force_d, to.force_d);
  use(from.force_w, to.force_w);
  for (int c = 0; c < 3; ++c) use(from.lateral[c], to.lateral[c]);
}

}  // namespace

void ElasticaSystem::copy_rod(int index, CoarseRods& to, int lane) const {
  const CoarseRods& rods = coarse_[at(index / rod_lanes)];
  const int i = index % rod_lanes;
  each_lane(rods, to, [&](const RodLane& a, RodLane& b) { b[lane] = a[i]; });
  for (int c = 0; c < 3; ++c) {
    to.base[c][lane] = rods.base[c][i];
    to.tangent[c][lane] = rods.tangent[c][i];
    to.platform_point[c][lane] = rods.platform_point[c][i];
  }
  to.flexibility[lane] = rods.flexibility[i];
  to.active[lane] = 1;
}

void ElasticaSystem::take_rod(int index, const CoarseRods::State& from, int lane) {
  is_fine_ = false;
  CoarseRods& rods = coarse_[at(index / rod_lanes)];
  each_lane(from, rods, [&](const RodLane& a, RodLane& b) { b[index % rod_lanes] = a[lane]; });
  fill_idle_lanes(coarse_.back());
}

void ElasticaSystem::get_rod(int index, std::span<double> coordinates) const {
  with_rod(index, [&]<class Group>(const Group& rods, int i) {
    // the same shape on the other side where d < 0
    const double sign = rods.tip_d[i] < 0 ? -1 : 1;
    double theta[Group::nodes];
    for (std::size_t k = 0; k < Group::nodes; ++k) theta[k] = rods.theta[k][i];
    if constexpr (Group::nodes == fine_nodes) {
      for (std::size_t j = 0; j < fine_nodes; ++j) coordinates[j] = sign * theta[j];
    } else {
      const auto& fine_from_coarse = refinement().fine_from_coarse;
      for (std::size_t j = 0; j < fine_nodes; ++j) {
        double fine = 0;
        for (std::size_t k = 0; k < coarse_nodes; ++k) fine += fine_from_coarse[j][k] * theta[k];
        coordinates[j] = sign * fine;
      }
    }
    coordinates[fine_nodes] = sign * rods.force_d[i];
    coordinates[fine_nodes + 1] = rods.force_w[i];
    coordinates[fine_nodes + 2] = rods.length[i];
    std::ranges::fill(coordinates.subspan(fine_nodes + 3), 0.0);
  });
}

void ElasticaSystem::set_rod(int index, std::span<const double> coordinates, const Vec3<double>& lateral) {
  is_fine_ = true;
  FineRods& rods = fine_[at(index / rod_lanes)];
  const int i = index % rod_lanes;
  for (std::size_t j = 0; j < fine_nodes; ++j) rods.theta[j][i] = coordinates[j];
  rods.force_d[i] = coordinates[fine_nodes];
  rods.force_w[i] = coordinates[fine_nodes + 1];
  rods.length[i] = coordinates[fine_nodes + 2];
  put(lateral, rods.lateral, i);
  fill_idle_lanes(fine_.back());
}

void ElasticaSystem::set_rods(Numbers coordinates) {
  for (int k = 0; k < rods_; ++k)
    set_rod(k, coordinates.subspan(at(coordinate_of(k)), RodLeg::coordinates), aim(k).lateral);
}

double ElasticaSystem::effort(int rod) const {
  return with_rod(rod, [](const auto& rods, int i) { return rods.force_w[i]; });
}
double ElasticaSystem::closing_effort(int rod) const {
  return with_rod(rod, [](const auto& rods, int i) { return rods.force_w[i] + rods.fix_w[i]; });
}
ElasticaSystem::Twist ElasticaSystem::effort_jacobian(int rod) const {
  return with_rod(rod, [](const auto& rods, int i) {
    const Vec3<double> by_tip =
        vector_of(rods.lateral, i) * rods.stiff_dw[i] + vector_of(rods.tangent, i) * rods.stiff_ww[i];
    Twist row;
    row << by_tip, cross(vector_of(rods.arm, i), by_tip);
    return row;
  });
}

RodResult ElasticaSystem::rod(int index) const {
  return with_rod(index, [](const auto& rods, int i) {
    const double length = rods.length[i], stiffness = 1 / rods.flexibility[i];
    const Vec3<double> h = vector_of(rods.lateral, i), t = vector_of(rods.tangent, i);
    const double sign = rods.tip_d[i] < 0 ? -1 : 1;
    double tip = 0;
    for (int j = 0; j < rods.nodes; ++j) tip += basis_of(rods).at_tip[j] * rods.theta[j][i];
    // Moment about the base and the first integral ½EIκ² + n·t: as accurate as the forces are, which the
    // polynomial's derivative is not.
    const double moment = rods.force_d[i] * rods.tip_w[i] - rods.force_w[i] * rods.tip_d[i];
    const double integral = moment * moment / (2 * stiffness) + rods.force_w[i];
    RodResult reading;
    reading.length = length;
    reading.tip_angle = sign * tip;
    reading.lateral_force = sign * rods.force_d[i];
    reading.axial_force = rods.force_w[i];
    reading.force = h * rods.force_d[i] + t * rods.force_w[i];
    reading.force_0 = reading.force;
    reading.moment_0 = cross(t, h) * moment;
    reading.curvature_0 = reading.moment_0 / stiffness;
    reading.tip = vector_of(rods.base, i) + h * rods.tip_d[i] + t * rods.tip_w[i];
    reading.chord = std::hypot(rods.tip_d[i], rods.tip_w[i]);
    // ½EIκ² = H − |n| cos of the tangent's angle from n: largest where it points against n, else at the base
    double low = std::min(0.0, tip), high = std::max(0.0, tip);
    for (int j = 0; j < rods.nodes; ++j) {
      low = std::min(low, rods.theta[j][i]);
      high = std::max(high, rods.theta[j][i]);
    }
    constexpr double turn = 2 * std::numbers::pi;
    const double against = std::atan2(-rods.force_d[i], -rods.force_w[i]);
    const bool is_reached = against + turn * std::ceil((low - against) / turn) <= high;
    const double pull = std::hypot(rods.force_d[i], rods.force_w[i]);
    reading.largest_curvature =
        is_reached ? std::sqrt(2 * (integral + pull) / stiffness) : std::abs(moment) / stiffness;
    reading.energy = integral * length - rods.force_d[i] * rods.tip_d[i] - rods.force_w[i] * rods.tip_w[i];
    return reading;
  });
}

/// By the inertia of bordered matrices: the negative directions of H on the constraint are
/// neg(H) − neg(AᵀH⁻¹A).
std::array<int, 2> ElasticaSystem::unstable_with_tip_held(int index) const {
  return with_rod(index, [](const auto& rods, int i) -> std::array<int, 2> {
    int in_plane = 0;
    for (const RodLane& pivot : rods.pivot) in_plane += pivot[i] < 0;
    const double dd = rods.soft_dd[i], det = dd * rods.soft_ww[i] - rods.soft_dw[i] * rods.soft_dw[i];
    in_plane -= det < 0 ? 1 : dd < 0 ? 2 : 0;
    return {in_plane, unstable_aside(rods, i)};
  });
}

/// The Galerkin solution is best in energy, so that tips err by the square of the shape's error.
double ElasticaSystem::truncation() const {
  alignas(64) RodLane largest;
  with([&](auto groups) { rod_kernels::truncation(groups, largest); });
  return *std::max_element(largest, largest + rod_lanes);
}

std::vector<Vec3<double>> ElasticaSystem::centreline(int index, int samples) const {
  return with_rod(index, [&](const auto& rods, int i) {
    const auto& node = basis_of(rods).node;
    const Vec3<double> h = vector_of(rods.lateral, i), t = vector_of(rods.tangent, i);
    const auto angle = [&](double s) {
      double sum = 0;
      for (int j = 0; j < rods.nodes; ++j) {
        double l = s / node[j];
        for (int k = 0; k < rods.nodes; ++k)
          if (k != j) l *= (s - node[k]) / (node[j] - node[k]);
        sum += l * rods.theta[j][i];
      }
      return sum;
    };
    std::vector<Vec3<double>> points{vector_of(rods.base, i)};
    const int panels = 1 + 24 / samples;  // between two points; 24 in all give the tip to rounding
    const double step = 1.0 / (panels * (samples - 1)), offset = std::sqrt(3.0 / 5) / 2;
    double d = 0, w = 0;
    for (int k = 0; k < panels * (samples - 1); ++k) {  // three-point Gauss
      for (const auto& [place, weight] :
           {std::pair{0.5 - offset, 5.0 / 18}, std::pair{0.5, 8.0 / 18}, std::pair{0.5 + offset, 5.0 / 18}}) {
        const double theta = angle((k + place) * step);
        d += step * weight * std::sin(theta);
        w += step * weight * std::cos(theta);
      }
      if ((k + 1) % panels == 0) points.push_back(points.front() + (h * d + t * w) * rods.length[i]);
    }
    return points;
  });
}

}  // namespace sinew::inline v1

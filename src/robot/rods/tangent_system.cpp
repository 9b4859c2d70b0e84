#include "robot/rods/tangent_system.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "math/linalg.hpp"
#include "robot/rods/spectral_rod.hpp"
#include "robot/rods/tangent_kernels.hpp"

namespace sinew::inline v1 {

using namespace spectral;

namespace {

/// The lanes of so many nodes' tangents.
void copy_tangents(const RodLane (*from)[3], int nodes, RodLane (*to)[3]) {
  std::copy_n(&from[0][0][0], nodes * 3 * rod_lanes, &to[0][0][0]);
}

}  // namespace

TangentSystem::TangentSystem(const ParallelRobot<RodLeg>& robot)
    : HeavyRodGroup(robot),
      groups_(at((robot.leg_count() + rod_lanes - 1) / rod_lanes)),
      fed_(groups_.size()) {
  for (TangentRods& rods : groups_) rods = {};
  for (int k = 0; k < rods_; ++k) {
    const RodLeg& leg = robot.legs[at(k)];
    TangentRods& rods = groups_[at(k / rod_lanes)];
    const int i = k % rod_lanes;
    put(leg.base.p, rods.base, i);
    for (auto& tangent : rods.tangent) put(leg.tangent(), tangent, i);
    put(leg.platform_point, rods.platform_point, i);
    put(leg.platform_tangent, rods.platform_tangent, i);
    rods.clamped[i] = leg.is_clamped ? 1 : 0;
    rods.flexibility[i] = 1 / leg.link.bending_stiffness();
    rods.stretch[i] = leg.link.stretch_compliance();
    rods.shear[i] = leg.link.shear_compliance();
    rods.active[i] = 1;
    rods.length[i] = 1;
    put(leg.link.load, rods.weight, i);
  }
  fill_idle_lanes();
}

/// Lanes without a rod do what the first of their group does, and count for nothing.
void TangentSystem::fill_idle_lanes() {
  TangentRods& last = groups_.back();
  const auto fill = [&](RodLane& lane) {
    for (int i = (rods_ - 1) % rod_lanes + 1; i < rod_lanes; ++i) lane[i] = lane[0];
  };
  for (auto* lanes : {last.base, last.platform_point, last.platform_tangent, last.weight, last.force})
    for (int c = 0; c < 3; ++c) fill(lanes[c]);
  for (RodLane* lane : {&last.clamped, &last.flexibility, &last.stretch, &last.shear, &last.length})
    fill(*lane);
  for (auto& tangent : last.tangent)
    for (RodLane& lane : tangent) fill(lane);
}

const LimbTraits& TangentSystem::traits() const {
  // forces are good to 1e-12 of themselves with the best truncation, lengths to 1e-9 with the quick one
  static constexpr LimbTraits traits{
      .best_truncation = 1e-15, .quick_truncation = 1e-9, .has_no_rest = no_rest_of_tangents};
  return traits;
}

void TangentSystem::save(LimbState& to) const {
  save_common(to, elements_, groups_.size() * sizeof(TangentState));
  for (const TangentRods& rods : groups_) {
    to.put(std::span(rods.tangent).first(at(elements_ * degree + 1)));
    to.put(rods.length);
    to.put(rods.force);
  }
}

void TangentSystem::restore(const LimbState& from) {
  LimbState::Reader reader(from);
  elements_ = restore_common(reader);
  for (TangentRods& rods : groups_) {
    reader.get(std::span(rods.tangent).first(at(elements_ * degree + 1)));
    reader.get(rods.length);
    reader.get(rods.force);
  }
}

Vec3<double> TangentSystem::base(int rod) const {
  return with_rod(rod, [](const auto& rods, int i) { return vector_of(rods.base, i); });
}

Vec3<double> TangentSystem::platform_point(int rod) const {
  return with_rod(rod, [](const auto& rods, int i) { return vector_of(rods.platform_point, i); });
}

double TangentSystem::stiffness(int rod) const {
  return with_rod(rod, [](const auto& rods, int i) { return 1 / rods.flexibility[i]; });
}

double TangentSystem::length(int rod) const {
  return with_rod(rod, [](const auto& rods, int i) { return rods.length[i]; });
}

void TangentSystem::set_feed(int rod, double length) {
  groups_[at(rod / rod_lanes)].length[rod % rod_lanes] = length;
  if (rod % rod_lanes == 0) fill_idle_lanes();
}

void TangentSystem::set_inputs(Numbers inputs) {
  for (int k = 0; k < static_cast<int>(groups_.size()) * rod_lanes; ++k) {
    const int rod = k < rods_ ? k : k / rod_lanes * rod_lanes;  // idle lanes: the first of their group
    groups_[at(k / rod_lanes)].length[k % rod_lanes] = inputs[at(input_of(rod))];
  }
}

void TangentSystem::weigh(int rod, const Vec3<double>& weight) {
  put(weight, groups_[at(rod / rod_lanes)].weight, rod % rod_lanes);
  fill_idle_lanes();
}

/// The tangent at a place of [0, 1]: interpolated and put back to length 1.
Vec3<double> TangentSystem::tangent_at(const RodLane (*tangents)[3], int lane, double along) const {
  const int element = std::min(static_cast<int>(along * elements_), elements_ - 1);
  double row[degree + 1];
  lagrange(along * elements_ - element, row);
  Vec3<double> t = Vec3<double>::Zero();
  for (int j = 0; j <= degree; ++j) t += row[j] * vector_of(tangents[element * degree + j], lane);
  return t.normalized();
}

void TangentSystem::change_elements(int elements) {
  for (TangentRods& rods : groups_) {
    RodLane old[TangentState::max_nodes + 1][3];
    copy_tangents(rods.tangent, elements_ * degree + 1, old);
    for (int node = 1; node <= elements * degree; ++node)
      for (int i = 0; i < rod_lanes; ++i)
        put(tangent_at(old, i, place_of(node, elements).along), rods.tangent[node], i);
  }
  elements_ = elements;
}

void TangentSystem::get_rod(int index, std::span<double> coordinates) const {
  with_rod(index, [&](const TangentRods& rods, int i) {
    auto to = coordinates.begin();
    for (int node = 0; node < rod_tangents; ++node)
      to = std::ranges::copy(tangent_at(rods.tangent, i, place_of(node, coordinate_elements).along), to).out;
    to = std::ranges::copy(vector_of(rods.force, i), to).out;
    *to = rods.length[i];
  });
}

void TangentSystem::set_rods(Numbers coordinates) {
  elements_ = coordinate_elements;
  std::span<const double>::iterator from;
  const auto next = [&] {
    const Vec3<double> v(from[0], from[1], from[2]);
    from += 3;
    return v;
  };
  for (int k = 0; k < rods_; ++k) {
    TangentRods& rods = groups_[at(k / rod_lanes)];
    const int i = k % rod_lanes;
    from = coordinates.begin() + coordinate_of(k);
    for (int node = 0; node < rod_tangents; ++node) put(next().normalized(), rods.tangent[node], i);
    put(next(), rods.force, i);
    rods.length[i] = *from++;
  }
  fill_idle_lanes();
}

void TangentSystem::refine() {
  if (!is_finest()) change_elements(levels[level_of(elements_) + 1]);
}

void TangentSystem::coarsen() {
  if (is_fine()) change_elements(levels[level_of(elements_) - 1]);
}

bool TangentSystem::can_coarsen(double wanted) const { return is_fine() && 1000 * truncation() < wanted; }

double TangentSystem::evaluate(bool from_scratch) {
  const Mat<double, 3, 3> R = platform_.R.matrix();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) held_.rotation[3 * r + c] = R(r, c);
  for (int k = 0; k < 3; ++k) held_.position[k] = platform_.p[k];
  tangent_kernels::evaluate(groups_, elements_, held_, from_scratch, sums_);
  return sums_.error;
}

bool TangentSystem::linearise() {
  tangent_kernels::linearise(groups_, elements_, sums_);
  return lu_.factor(sums_.stiffness, radius_);
}

TangentSystem::Wrench TangentSystem::wrench_residual() const {
  return wrench() - Eigen::Map<const Wrench>(sums_.wrench);
}

TangentSystem::Twist TangentSystem::step(bool fresh) {
  if (!fresh) tangent_kernels::close(groups_, elements_, sums_);
  const Wrench wanted = TangentSystem::wrench_residual();
  Twist twist;
  lu_.solve(wanted.data(), twist.data());
  return twist;
}

void TangentSystem::move(const Twist& twist, Numbers fed) {
  if (!fed.empty())
    for (int k = 0; k < static_cast<int>(fed_.size()) * rod_lanes; ++k) {
      const int rod = k < rods_ ? k : k / rod_lanes * rod_lanes;  // idle lanes: the first of their group
      fed_[at(k / rod_lanes)].length[k % rod_lanes] = fed[at(input_of(rod))];
    }
  move_platform(twist);
  tangent_kernels::apply(groups_, elements_, twist.data(), fed.empty() ? nullptr : fed_.data());
}

TangentSystem::Wrench TangentSystem::input_wrench_jacobian(int input) const {
  Wrench sum = Wrench::Zero();
  for (int k = 0; k < rods_; ++k)
    if (input_of(k) == input)
      with_rod(k, [&](const auto& rods, int i) {
        for (int r = 0; r < 6; ++r) sum[r] += rods.feed[r][i];
      });
  return sum;
}

bool TangentSystem::draw_rods() {
  const Mat<double, 3, 3> R = platform_.R.matrix();
  elements_ = coarse_elements;
  for (int k = 0; k < rods_; ++k) {
    TangentRods& rods = groups_[at(k / rod_lanes)];
    const int i = k % rod_lanes;
    const Vec3<double> way = platform_.p + R * vector_of(rods.platform_point, i) - vector_of(rods.base, i);
    const double chord = way.norm();
    if (!(chord > 0)) return false;
    const Vec3<double> from = vector_of(rods.tangent[0], i) * chord;
    // without moment at the tip the cubic's second derivative is 0 there
    const Vec3<double> to = rods.clamped[i] > 0
                                ? Vec3<double>(R * vector_of(rods.platform_tangent, i) * chord)
                                : Vec3<double>(1.5 * way - 0.5 * from);
    const Vec3<double> twice = 6 * way - 4 * from - 2 * to, thrice = 6 * from + 6 * to - 12 * way;
    double length = 0;
    for (int node = 0; node <= elements_ * degree; ++node) {
      const auto [s, weight] = place_of(node, elements_);
      const Vec3<double> slope = from + s * twice + s * s / 2 * thrice;
      length += weight * slope.norm();
      if (node > 0) put(slope.normalized(), rods.tangent[node], i);
    }
    rods.length[i] = length;
    const Vec3<double> ahead = way / chord;
    put((ahead * dot(ahead, thrice) - thrice) / (rods.flexibility[i] * length * length * length), rods.force,
        i);
  }
  fill_idle_lanes();
  return true;
}

void TangentSystem::move_to_rest(double most) {
  for (int k = 0; k < static_cast<int>(fed_.size()) * rod_lanes; ++k) {
    const TangentRods& rods = groups_[at(k / rod_lanes)];
    const int i = k % rod_lanes;
    const Vec3<double> tip = vector_of(rods.tip, i) - vector_of(rods.tip_gap, i), ahead = tip / tip.norm();
    const double pull = dot(ahead, Vec3<double>(vector_of(rods.force, i) + vector_of(rods.fix, i)));
    const double fed = -pull / dot(ahead, vector_of(rods.feed, i)), limit = most * rods.length[i];
    fed_[at(k / rod_lanes)].length[i] = std::isfinite(fed) ? std::clamp(fed, -limit, limit) : 0;
  }
  const Twist rest = Twist::Zero();
  tangent_kernels::apply(groups_, elements_, rest.data(), fed_.data());
}

/// ∫ (p − a) ds: where the rod's own weight acts, times its length.
Vec3<double> TangentSystem::lever(const TangentRods& rods, int i) const {
  const double length = rods.length[i];
  const Vec3<double> weight = vector_of(rods.weight, i), force = vector_of(rods.force, i);
  Vec3<double> sum = Vec3<double>::Zero();
  for (int node = 0; node <= elements_ * degree; ++node) {
    const auto [s, share] = place_of(node, elements_);
    const Vec3<double> t = vector_of(rods.tangent[node], i), n = force + weight * (length * (1 - s));
    sum += share * (1 - s) * (t * (1 + rods.stretch[i] * dot(n, t)) + n * rods.shear[i]);
  }
  return sum * (length * length);
}

double TangentSystem::weight_energy() const {
  double energy = 0;
  for (int k = 0; k < rods_; ++k)
    energy -= with_rod(k, [&](const TangentRods& rods, int i) {
      return dot(vector_of(rods.weight, i),
                 Vec3<double>(lever(rods, i) + rods.length[i] * vector_of(rods.base, i)));
    });
  return energy;
}

double TangentSystem::effort(int rod) const {
  return with_rod(rod, [](const TangentRods& rods, int i) {
    const Vec3<double> force = vector_of(rods.force, i) + vector_of(rods.weight, i) * rods.length[i];
    return dot(vector_of(rods.tangent[0], i), force);
  });
}
double TangentSystem::closing_effort(int rod) const {
  return effort(rod) + with_rod(rod, [](const TangentRods& rods, int i) {
           return dot(vector_of(rods.tangent[0], i), vector_of(rods.fix, i));
         });
}
TangentSystem::Twist TangentSystem::effort_jacobian(int rod) const {
  return with_rod(rod, [](const TangentRods& rods, int i) {
    constexpr int symmetric[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    const Vec3<double> t = vector_of(rods.tangent[0], i);
    Vec3<double> by_tip = Vec3<double>::Zero();
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) by_tip[r] += rods.stiffness[symmetric[r][c]][i] * t[c];
    Twist row;
    row << by_tip, cross(vector_of(rods.arm, i), by_tip) +
                       vector_of(rods.turned[0], i) * dot(t, vector_of(rods.coupling[0], i)) +
                       vector_of(rods.turned[1], i) * dot(t, vector_of(rods.coupling[1], i));
    return row;
  });
}

RodResult TangentSystem::rod(int index) const {
  return with_rod(index, [&](const TangentRods& rods, int i) {
    const double length = rods.length[i], stiffness = 1 / rods.flexibility[i];
    const Vec3<double> weight = vector_of(rods.weight, i), force = vector_of(rods.force, i);
    const Vec3<double> t0 = vector_of(rods.tangent[0], i), tip = vector_of(rods.tip, i);
    const auto& basis = LobattoBasis<element_degree>::get();
    RodResult reading;
    double stretched = 0, bent = 0, largest = 0;
    for (int node = 0; node <= elements_ * degree; ++node) {
      const auto [s, share] = place_of(node, elements_);
      const Vec3<double> t = vector_of(rods.tangent[node], i), n = force + weight * (length * (1 - s));
      const double along = dot(n, t);
      stretched += share * (rods.stretch[i] * along * along + rods.shear[i] * dot(n, n));
    }
    for (int e = 0; e < elements_; ++e)
      for (int j = 0; j <= degree; ++j) {
        const Vec3<double> t = vector_of(rods.tangent[e * degree + j], i);
        Vec3<double> slope = Vec3<double>::Zero();
        for (int m = 0; m <= degree; ++m) {
          const Vec3<double> other = vector_of(rods.tangent[e * degree + m], i);
          bent += elements_ * basis.bending[j][m] * dot(t, other);
          slope += elements_ / length * basis.slope[j][m] * other;
        }
        largest = std::max(largest, slope.norm());
      }
    reading.length = length;
    reading.chord = tip.norm();
    reading.tip = vector_of(rods.base, i) + tip;
    reading.force = force;
    reading.force_0 = force + weight * length;
    reading.moment = vector_of(rods.moment, i);
    // by the balance of the whole rod: as accurate as the forces are
    reading.moment_0 = reading.moment + cross(tip, force) + cross(lever(rods, i), weight);
    reading.moment_0 -= t0 * dot(t0, reading.moment_0);
    reading.curvature_0 = reading.moment_0 / stiffness;
    reading.axial_force = dot(force, t0);
    // away from the guide's line, as the tip lies; of a rod that does not bend in one plane what is left
    const Vec3<double> aside = (tip - t0 * dot(t0, tip)).stableNormalized();
    const Vec3<double> last = vector_of(rods.tangent[elements_ * degree], i);
    reading.lateral_force = std::copysign((force - t0 * reading.axial_force).norm(), dot(force, aside));
    reading.tip_angle = std::copysign(std::atan2(cross(t0, last).norm(), dot(t0, last)), dot(last, aside));
    reading.energy = stiffness / (2 * length) * bent + length / 2 * stretched;
    reading.largest_curvature = largest;
    return reading;
  });
}

/// By the inertia of bordered matrices, as ElasticaSystem: the negative directions of H on the constraint are
/// neg(H) − neg(C), those of a free tip's own block among H's.
std::array<int, 2> TangentSystem::unstable_with_tip_held(int index) const {
  return with_rod(index, [&](const TangentRods& rods, int i) -> std::array<int, 2> {
    const int tip = elements_ * degree;
    int count = 0;
    for (int node = 1; node < tip; ++node)
      for (const RodLane& pivot : rods.pivot[node]) count += pivot[i] < 0;
    if (!(rods.clamped[i] > 0)) {
      const double first = rods.tip_pivot[0][i], cross = rods.tip_pivot[1][i];
      const double second = rods.tip_pivot[2][i] - cross * cross / first;
      count += (first < 0) + (second < 0);
    }
    std::array<double, 9> stiffness;
    constexpr int symmetric[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    for (std::size_t k = 0; k < 9; ++k) stiffness[k] = rods.stiffness[symmetric[k]][i];
    std::array<double, 3> values;
    symmetric_eigenvalues(MatrixView(stiffness.data(), 3, 3), values);
    for (const double value : values) count -= value < 0;
    return {count, 0};
  });
}

double TangentSystem::truncation() const {
  // what the tip missed was 1e-7 to 7e-5 of the squares (docs/theory/tangent_rod.md)
  constexpr double per_square = 1e-4;
  alignas(64) RodLane largest;
  tangent_kernels::truncation(groups_, elements_, largest);
  return per_square * *std::max_element(largest, largest + rod_lanes);
}

std::vector<Vec3<double>> TangentSystem::centreline(int index, int samples) const {
  return with_rod(index, [&](const TangentRods& rods, int i) {
    const double length = rods.length[i];
    const Vec3<double> weight = vector_of(rods.weight, i), force = vector_of(rods.force, i);
    const auto slope = [&](double s) -> Vec3<double> {
      const int element = std::min(static_cast<int>(s * elements_), elements_ - 1);
      double row[degree + 1];
      lagrange(s * elements_ - element, row);
      Vec3<double> t = Vec3<double>::Zero();
      for (int j = 0; j <= degree; ++j) t += row[j] * vector_of(rods.tangent[element * degree + j], i);
      const Vec3<double> n = force + weight * (length * (1 - s));
      return t * (1 + rods.stretch[i] * dot(n, t)) + n * rods.shear[i];
    };
    std::vector<Vec3<double>> points{vector_of(rods.base, i)};
    const int panels = 1 + 64 / (samples - 1);  // between two points; 64 in all give the tip to 1e-12
    const double step = 1.0 / (panels * (samples - 1)), offset = std::sqrt(3.0 / 5) / 2;
    Vec3<double> p = points.front();
    for (int k = 0; k < panels * (samples - 1); ++k) {  // three-point Gauss
      p += length * step *
           (5.0 / 18 * (slope((k + 0.5 - offset) * step) + slope((k + 0.5 + offset) * step)) +
            8.0 / 18 * slope((k + 0.5) * step));
      if ((k + 1) % panels == 0) points.push_back(p);
    }
    return points;
  });
}

}  // namespace sinew::inline v1

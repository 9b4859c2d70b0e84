/// @file rod_robots.hpp
/// Robots of rods as tests need them: the two tripods of tests/data/tripod/, random ones of any number of
/// rods, guides and stiffnesses, and states of equilibrium to begin from. How far a rod is from an exact
/// elastica.
#pragma once
#include <random>
#include <vector>

#include "kinematics/rods/path.hpp"
#include "link/elastica.hpp"
#include "robot/pose.hpp"
#include "robot/rods/elastica_system.hpp"
#include "robot/rods/general_system.hpp"
#include "robot/rods/mechanism.hpp"
#include "robot/rods/rod_work.hpp"
#include "robot/rods/tangent_system.hpp"
#include "tripod_3pfs.hpp"

namespace sinew::test {

/// Groups of rods as solvers have them: mechanisms without closing legs.
using ElasticaSystem = Mechanism<v1::ElasticaSystem>;
using TangentSystem = Mechanism<v1::TangentSystem>;
using GeneralSystem = Mechanism<v1::GeneralSystem>;

namespace judge = shooting;
using RodRobot = ParallelRobot<RodLeg>;
using Wrench6 = ElasticaSystem::Wrench;

/// Largest, any NaN kept.
inline void worsen(double& worst, double x) { worst = std::isnan(worst) || x <= worst ? worst : x; }

/// @name Robots
/// @{

/// The rotation of least angle that takes +y to this unit vector.
inline SO3<double> turn_to(const Vec3<double>& tangent) {
  const Vec3<double> y(0, 1, 0);
  return SO3<double>{1 + dot(y, tangent), cross(y, tangent)}.normalised();
}

inline RodLeg rod_leg(const Vec3<double>& base, const Vec3<double>& platform_point, double stiffness,
                      const Vec3<double>& tangent = {0, 0, 1}) {
  RodLeg leg;
  leg.base = {base, turn_to(tangent)};
  leg.link.diameter = 3e-3;
  leg.link.youngs_modulus = 1;
  leg.link.youngs_modulus = stiffness / leg.link.bending_stiffness();
  leg.platform_point = platform_point;
  return leg;
}

/// @tparam System of those above
template <class System>
RodWork work_of(const RodRobot& robot, const Vec3<double>& gravity = Vec3<double>::Zero()) {
  auto system = std::make_unique<System>(robot);
  system->set_gravity(gravity);
  return RodWork(std::move(system));
}

inline SE3<double> level(double height) { return {Vec3<double>(0, 0, height), SO3<double>::identity()}; }
inline SE3<double> home(const RodRobot& robot) { return SE3<double>::from(robot.home); }

/// The tripods of the reference data by their measures.
struct RodTripod {
  const char* name;
  double base_radius, platform_radius, half_angle;  ///< [m], [m], of a pair [deg]
  double height, length;                            ///< at home [m]

  judge::Tripod data() const {
    constexpr double degree = 3.14159265358979323846 / 180;
    judge::Tripod t;
    for (std::size_t k = 0; k < 6; ++k) {
      const double azimuth = (90.0 + 120.0 * double(k / 2)) * degree;
      const double at = azimuth + (k % 2 == 0 ? -half_angle : half_angle) * degree;
      t.base[k] = base_radius * judge::Vector3d(std::cos(at), std::sin(at), 0);
      t.platform[k] = platform_radius * judge::Vector3d(std::cos(azimuth), std::sin(azimuth), 0);
    }
    t.bending_stiffness = 83e9 * 3.14159265358979323846 * std::pow(0.003, 4) / 64;
    return t;
  }
};
inline constexpr RodTripod g1{"G1", 0.175, 0.125, 3, 0.2, 0.20755705266417177};
inline constexpr RodTripod g2{"G2", 0.25, 0.125, 30, 0.4, 0.4346969702550149};

/// Rods 2j and 2j + 1 share input j.
inline RodRobot tripod_robot(const judge::Tripod& t, const SE3<double>& home) {
  std::vector<RodLeg> legs;
  for (std::size_t k = 0; k < 6; ++k) legs.push_back(rod_leg(t.base[k], t.platform[k], t.bending_stiffness));
  const std::array<int, 6> tied = {-1, 0, -1, 2, -1, 4};
  return {legs, pose_of(home), t.platform[0].norm(), tied};
}
inline RodRobot tripod_robot(const RodTripod& t) { return tripod_robot(t.data(), level(t.height)); }

class RodRandom {
 public:
  explicit RodRandom(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  Vec3<double> vector(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size);
    return {x, y, uniform(-size, size)};
  }
  Wrench6 wrench(double force, double moment) {
    Wrench6 w;
    w.head<3>() = vector(force);
    w.tail<3>() = vector(moment);
    return w;
  }
  SE3<double> near(const SE3<double>& pose, double shift, double turn) {
    const Vec3<double> p = pose.p + vector(shift);
    return {p, SO3<double>::exp(vector(turn)).compose(pose.R)};
  }

  /// Guides around a circle that lean by up to `lean` [rad]; an input a rod.
  RodRobot robot(int rods, double lean) {
    std::vector<RodLeg> legs;
    for (int k = 0; k < rods; ++k) {
      const double at = 2 * 3.14159265358979323846 * (k + uniform(-0.2, 0.2)) / rods;
      const double radius = uniform(0.2, 0.26), inner = uniform(0.1, 0.13), up = uniform(-0.02, 0.02);
      const Vec3<double> base(radius * std::cos(at), radius * std::sin(at), up);
      const Vec3<double> point(inner * std::cos(at + 0.4), inner * std::sin(at + 0.4), -up);
      const Vec3<double> tangent = SO3<double>::exp(vector(lean)).rotate(Vec3<double>(0, 0, 1));
      legs.push_back(rod_leg(base, point, uniform(0.1, 0.4), tangent));
    }
    return {legs, pose_of(level(uniform(0.35, 0.45))), 0.12};
  }

 private:
  std::mt19937 engine_;
};
/// @}

/// @name States
/// @{

/// Newton's method on the rods alone, the platform held, down to rounding.
template <class System>
bool close_rods(System& system) {
  for (int k = 0; k < 12; ++k) {
    system.evaluate();
    if (!(system.limb_error() < 1e3)) return false;
    if (system.limb_error() < 1e-14) break;
    system.linearise();
    system.move(System::Twist::Zero());
  }
  system.evaluate();
  return system.limb_error() <= 1e-11;
}

/// Evaluated and linearised under the wrench that holds this state.
template <class System>
bool balance(System& system) {
  system.set_wrench(Wrench6::Zero());
  system.evaluate();
  system.set_wrench(-system.wrench_residual());
  system.evaluate();
  return system.linearise();
}

/// Rods at a pose with lengths of no special kind: laid there to rest, then fed so that what they are longer
/// than their chord becomes half to three times as much. In balance, linearised.
inline bool lay(ElasticaSystem& system, const SE3<double>& pose, RodRandom& random) {
  if (!system.rest_at(pose)) return false;
  const RodTarget from = present(system);
  RodTarget to = from;
  for (int k = 0; k < system.limbs(); ++k) {
    const double chord = system.rod(k).chord;
    to.lengths[std::size_t(k)] = chord + random.uniform(0.5, 3) * (system.length(k) - chord);
  }
  LimbState last = system.state();
  for (double part = 0, stride = 0.1; part < 1;) {
    const double next = std::min(1.0, part + stride);
    for (std::size_t k = 0; k < std::size_t(system.limbs()); ++k)
      system.set_feed(int(k), from.lengths[k] + next * (to.lengths[k] - from.lengths[k]));
    if (close_rods(system)) {
      part = next;
      system.save(last);
    } else {
      system.restore(last);
      stride /= 2;
      if (stride < 1e-3) return false;
    }
  }
  return balance(system);
}

/// What the world must exert on the platform at a pose displaced by (δp, δφ), the rods following.
template <class System>
Wrench6 wrench_beside(System& system, const LimbState& from, const Vec<double, 6>& by,
                      std::span<const double> fed = {}) {
  system.restore(from);
  const SO3<double> turn = SO3<double>::exp(Vec3<double>(by.tail<3>()));
  const SE3<double> there = system.platform();
  system.set_platform({there.p + by.head<3>(), turn.compose(there.R)});
  for (int k = 0; k < system.limbs() && !fed.empty(); ++k)
    system.set_feed(k, system.length(k) + fed[std::size_t(system.input_of(k))]);
  if (!close_rods(system)) return Wrench6::Constant(std::nan(""));
  balance(system);
  return system.wrench();
}
/// @}

/// @name Judges
/// @{

/// The equilibrium of a tripod, whose rods are integrated anew from its forces.
inline judge::Mismatch reintegrated(const judge::Tripod& t, const RodGroup& system) {
  judge::PerRod<double> lengths;
  judge::PerRod<judge::Vector3d> forces;
  for (int k = 0; k < 6; ++k) {
    lengths[std::size_t(k)] = system.length(k);
    forces[std::size_t(k)] = system.rod(k).force;
  }
  const judge::Wrench wrench{system.wrench().head<3>(), system.wrench().tail<3>()};
  return judge::reintegrate(t, lengths, wrench, system.platform().p, system.platform().R.matrix(), forces);
}

/// Distance of a rod from an exact elastica: differences of tip, tip angle, and, over the force's size,
/// force, base curvature and energy, in the units of a rod of unit length and stiffness. The largest of them.
inline double off(const ElasticaState<double>& exact, const ElasticaState<double>& rod) {
  const double size = 1 + rod.force.norm();
  double worst = 0;
  worsen(worst, (exact.tip - rod.tip).norm());
  worsen(worst, (exact.force - rod.force).norm() / size);
  worsen(worst, std::abs(exact.tip_angle - rod.tip_angle));
  worsen(worst, std::abs(exact.base_curvature - rod.base_curvature) / std::sqrt(size));
  worsen(worst, std::abs(exact.energy - rod.energy) / size);
  return worst;
}

/// A rod's reading in its plane, unit length and stiffness.
inline ElasticaState<double> planar_state(const RodResult& rod, const RodLeg& leg) {
  const ElasticaUnits unit{rod.length, leg.link.bending_stiffness()};
  const Vec3<double> way = (rod.tip - leg.base.p) / rod.length, tangent = leg.tangent();
  const double w = dot(tangent, way);
  const Vec3<double> aside = way - w * tangent;
  const Vec3<double> normal = cross(tangent, aside) / aside.norm();
  return {{aside.norm(), w},
          {rod.lateral_force / unit.force(), rod.axial_force / unit.force()},
          rod.tip_angle,
          dot(normal, rod.curvature_0) / unit.curvature(),
          rod.energy / unit.energy()};
}

/// The local force (across and along the tip's tangent) that a state says it has.
inline Vec2<double> local_force(const ElasticaState<double>& rod) {
  const double s = std::sin(rod.tip_angle), c = std::cos(rod.tip_angle);
  return {rod.force[0] * c - rod.force[1] * s, rod.force[0] * s + rod.force[1] * c};
}

/// How far the rod is from the nearest of three exact ones: that of its local force, that of its tip, that of
/// its force. One or another is ill conditioned where a rod is nearly straight, or near its buckling.
inline double off_elastica(const ElasticaState<double>& rod) {
  Vec2<double> local = local_force(rod);
  double best = off(elastica<double>(local), rod);
  const auto better = [&](double x) { best = x < best || std::isnan(best) ? x : best; };
  better(off(elastica_under_force(rod.force, rod.tip_angle).state, rod));
  for (int k = 0; k < 2; ++k) {
    const ElasticaTangent at = elastica_tangent(local);
    const Mat<double, 2, 2>& rate = at.tip_rate;
    const Vec2<double> gap = rod.tip - at.state.tip;
    local +=
        Vec2<double>(rate(1, 1) * gap[0] - rate(0, 1) * gap[1], rate(0, 0) * gap[1] - rate(1, 0) * gap[0]) /
        (rate(0, 0) * rate(1, 1) - rate(0, 1) * rate(1, 0));
  }
  better(off(elastica<double>(local), rod));
  return best;
}

/// The same of the worst rod of a robot.
inline double off_elastica(const RodRobot& robot, const RodGroup& system) {
  double worst = 0;
  for (int k = 0; k < system.limbs(); ++k)
    worsen(worst, off_elastica(planar_state(system.rod(k), robot.legs[std::size_t(k)])));
  return worst;
}
/// @}

}  // namespace sinew::test

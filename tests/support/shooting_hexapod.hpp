/// @file shooting_hexapod.hpp
/// Hexapods of rods the way the field solves them: every rod a Cosserat rod with a rotation along it,
/// integrated from its guide by Runge-Kutta, 36 unknowns (base force, the moment's part across the guide,
/// length), Newton's method with a Jacobian by differences. Shares nothing with the library but the robot's
/// numbers: it judges and is the baseline of the benchmark.
#pragma once
#include <Eigen/Dense>
#include <vector>

#include "leg/rod_leg.hpp"
#include "robot/parallel.hpp"
#include "sinew/link/state.hpp"

namespace sinew::test {

class ShootingHexapod {
 public:
  using Unknowns = Eigen::Matrix<double, 36, 1>;
  struct Rod {
    Eigen::Vector3d p, n, m;
    Eigen::Matrix3d R;
  };

  ShootingHexapod(const ParallelRobot<RodLeg>& robot, const Vec3<double>& gravity, int steps)
      : legs_(robot.legs),
        gravity_(gravity),
        steps_(steps) {}

  /// What Newton's method starts from: straight rods of these lengths without force.
  Unknowns straight(double length) const {
    Unknowns v = Unknowns::Zero();
    for (int k = 0; k < 6; ++k) v[6 * k + 5] = length;
    return v;
  }

  /// The six of a rod from what is known of it elsewhere.
  Eigen::Matrix<double, 6, 1> unknowns(int k, const RodResult& rod) const {
    const Eigen::Vector3d moment = frame(legs_[std::size_t(k)].tangent()).transpose() * rod.moment_0;
    Eigen::Matrix<double, 6, 1> v;
    v << rod.force_0, moment[0], moment[1], rod.length;
    return v;
  }

  /// The rod's tip from its base force, the moment's two parts there, and its length.
  Rod integrate(int k, const Eigen::Matrix<double, 6, 1>& v) const {
    const RodLeg& leg = legs_[std::size_t(k)];
    Rod at{leg.base.p, v.head<3>(), Eigen::Vector3d::Zero(), frame(leg.tangent())};
    at.m = at.R * Eigen::Vector3d(v[3], v[4], 0);
    const double h = v[5] / steps_;
    for (int i = 0; i < steps_; ++i) {
      const Rod a = rate(leg, at), b = rate(leg, moved(at, a, h / 2)), c = rate(leg, moved(at, b, h / 2)),
                d = rate(leg, moved(at, c, h));
      at.p += h / 6 * (a.p + 2 * b.p + 2 * c.p + d.p);
      at.n += h / 6 * (a.n + 2 * b.n + 2 * c.n + d.n);
      at.m += h / 6 * (a.m + 2 * b.m + 2 * c.m + d.m);
      at.R += h / 6 * (a.R + 2 * b.R + 2 * c.R + d.R);
    }
    return at;
  }

  /// Gaps of tips and tangents, then what is missing in force and moment.
  Unknowns gaps(const std::array<Rod, 6>& rods, const SE3<double>& pose, const Vec<double, 6>& wrench) const {
    Unknowns gap;
    gap.tail<6>() = wrench;
    for (int k = 0; k < 6; ++k) {
      const RodLeg& leg = legs_[std::size_t(k)];
      const Rod& rod = rods[std::size_t(k)];
      const Eigen::Vector3d arm = pose.R.rotate(leg.platform_point);
      gap.segment<3>(5 * k) = rod.p - pose.p - arm;
      const Eigen::Matrix3d across = frame(pose.R.rotate(leg.platform_tangent));
      // a ball joint has no moment across the tangent, a clamp has the tangent
      const Eigen::Vector3d off = leg.is_clamped ? Eigen::Vector3d(rod.R.col(2)) : rod.m;
      gap.segment<2>(5 * k + 3) = (leg.is_clamped ? across : rod.R).leftCols<2>().transpose() * off;
      gap.segment<3>(30) -= rod.n;
      gap.segment<3>(33) -= arm.cross(rod.n) + (leg.is_clamped ? rod.m : Eigen::Vector3d::Zero().eval());
    }
    return gap;
  }

  std::array<Rod, 6> rods(const Unknowns& v) const {
    std::array<Rod, 6> all;
    for (int k = 0; k < 6; ++k) all[std::size_t(k)] = integrate(k, v.segment<6>(6 * k));
    return all;
  }

  /// Newton's method from v, in place; its last residual. Each difference integrates the one rod it touches.
  double solve(Unknowns& v, const SE3<double>& pose, const Vec<double, 6>& wrench, double tolerance,
               int most = 20) const {
    std::array<Rod, 6> all = rods(v);
    Unknowns gap = gaps(all, pose, wrench);
    for (int i = 0; i < most && !(gap.lpNorm<Eigen::Infinity>() <= tolerance); ++i) {
      Eigen::Matrix<double, 36, 36> J;
      for (int c = 0; c < 36; ++c) {
        const int k = c / 6;
        const double h = 1e-7;
        Eigen::Matrix<double, 6, 1> beside = v.segment<6>(6 * k);
        beside[c % 6] += h;
        std::array<Rod, 6> others = all;
        others[std::size_t(k)] = integrate(k, beside);
        J.col(c) = (gaps(others, pose, wrench) - gap) / h;
      }
      v -= J.partialPivLu().solve(gap);
      all = rods(v);
      gap = gaps(all, pose, wrench);
    }
    return gap.lpNorm<Eigen::Infinity>();
  }

 private:
  static Eigen::Matrix3d frame(const Eigen::Vector3d& z) {
    Eigen::Matrix3d R;
    R.col(0) = z.unitOrthogonal();
    R.col(1) = z.cross(R.col(0));
    R.col(2) = z;
    return R;
  }
  static Rod moved(const Rod& at, const Rod& by, double h) {
    return {at.p + h * by.p, at.n + h * by.n, at.m + h * by.m, at.R + h * by.R};
  }
  Rod rate(const RodLeg& leg, const Rod& at) const {
    const double EI = leg.link.bending_stiffness();
    const double shear = leg.link.shear_compliance(), axial = shear + leg.link.stretch_compliance();
    const double GJ =
        leg.link.shear_modulus > 0 ? 4 * EI * leg.link.shear_modulus / (2 * leg.link.youngs_modulus) : EI;
    const Eigen::Vector3d n = at.R.transpose() * at.n, m = at.R.transpose() * at.m;
    const Eigen::Vector3d v(shear * n[0], shear * n[1], 1 + axial * n[2]), u(m[0] / EI, m[1] / EI, m[2] / GJ);
    Eigen::Matrix3d turn;
    turn << 0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0;
    const Eigen::Vector3d p = at.R * v;
    return {p, -leg.link.mass_per_length() * gravity_, -p.cross(at.n), at.R * turn};
  }

  std::vector<RodLeg> legs_;
  Eigen::Vector3d gravity_;
  int steps_;
};

}  // namespace sinew::test

/// @file tripod_3pfs.hpp
/// The flexible tripod (or any robot of six such rods) as data, and the judge of an equilibrium somebody
/// claims for it: its rods integrated anew at order 8. Reads nothing of the library, and solves nothing.
///
///   const Mismatch off = reintegrate(tripod, lengths, wrench, p, R, n);
///   EXPECT_LT(off.closure, 1e-12);
///
/// Base axes throughout. n_i is the force of the platform on rod i, so that Σ n = F_ext (29).
#pragma once
#include "rod_3pfs.hpp"

namespace sinew::test::shooting {

using Eigen::Vector3d;
template <class T>
using PerRod = std::array<T, 6>;

struct Tripod {
  PerRod<Vector3d> base;      ///< a_i [m], base frame
  PerRod<Vector3d> platform;  ///< r_i [m], platform frame
  double bending_stiffness;   ///< EI [N m²]
};

struct Wrench {
  Vector3d force = Vector3d::Zero();   ///< F_ext at P [N]
  Vector3d moment = Vector3d::Zero();  ///< M_ext about P [N m]
};

/// (3) and (22).
template <class S>
Eigen::Matrix<S, 3, 3> rotation(const S& e0, const S& e1, const S& e2, const S& e3) {
  Eigen::Matrix<S, 3, 3> R;
  R << e0 * e0 + e1 * e1 - e2 * e2 - e3 * e3, 2.0 * (e1 * e2 - e0 * e3), 2.0 * (e1 * e3 + e0 * e2),
      2.0 * (e1 * e2 + e0 * e3), e0 * e0 - e1 * e1 + e2 * e2 - e3 * e3, 2.0 * (e2 * e3 - e0 * e1),
      2.0 * (e1 * e3 - e0 * e2), 2.0 * (e2 * e3 + e0 * e1), e0 * e0 - e1 * e1 - e2 * e2 + e3 * e3;
  return R;
}

template <class S>
Vector3<S> cross(const Vector3<S>& a, const Vector3<S>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// How far a claimed equilibrium is from (27)-(29) when its rods are integrated anew.
struct Mismatch {
  double closure = 0;        ///< largest |a + p(L) − p − R r| [m]
  double tip_curvature = 0;  ///< largest |u(L)| [1/m]
  double torsion = 0;        ///< largest |u_z(0)| that the moment at the base would ask for [1/m]
  double force = 0;          ///< |Σ n − F| [N]
  double moment = 0;         ///< |Σ (b − p) × n − M| about P [N m]
};

/// Judge pose (p, R) and the rods' forces n_i [N]. The base curvature follows from them: m' = −p' × n and
/// m(L) = 0 give m(0) = (b − a) × n.
inline Mismatch reintegrate(const Tripod& t, const PerRod<double>& L, const Wrench& w, const Vector3d& p,
                            const Eigen::Matrix3d& R, const PerRod<Vector3d>& n,
                            const Integration& how = {}) {
  const auto worse = [](double& worst, double x) { worst = std::isnan(worst) || x <= worst ? worst : x; };
  Mismatch worst;
  Vector3d force = -w.force, moment = -w.moment;
  for (std::size_t i = 0; i < 6; ++i) {
    const Vector3d b = p + R * t.platform[i], u = cross<double>(b - t.base[i], n[i]) / t.bending_stiffness;
    const Section<double> y = tip(n[i], u[0], u[1], L[i], t.bending_stiffness, how);
    worse(worst.closure, (t.base[i] + Vector3d(y[0], y[1], y[2]) - b).norm());
    worse(worst.tip_curvature, std::hypot(y[7], y[8]));
    worse(worst.torsion, std::abs(u[2]));
    force += n[i];
    moment += cross<double>(b - p, n[i]);
  }
  worst.force = force.norm();
  worst.moment = moment.norm();
  return worst;
}

}  // namespace sinew::test::shooting

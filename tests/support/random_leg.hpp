/// @file random_leg.hpp
/// Legs of every kind with random parameters, filled through the fields each part names.
#pragma once
#include <random>

#include "robot/parallel.hpp"
#include "tendon/theta_is.hpp"
#include "uniform.hpp"

namespace sinew::test {

/// Fills any length with a plausible one.
struct RandomFields {
  std::mt19937& random;
  void operator()(std::string_view, double& field, Dimension, Range, std::string_view) const {
    field = std::uniform_real_distribution(0.05, 0.3)(random);
  }
  template <class T>
  void operator()(std::string_view, std::optional<T>&, Dimension, Range, std::string_view) const {}
};

/// Anywhere about the origin, turned anyhow.
template <class Space>
typename Space::template Frame<double> random_frame(std::mt19937& random, double reach) {
  const auto any = [&](double size) { return uniform(random, -size, size); };
  if constexpr (Space::dimension == 2)
    return SE2<double>::from(any(reach), any(reach), any(3.14));
  else
    return {Vec3<double>(any(reach), any(reach), any(reach)),
            SO3<double>::exp(Vec3<double>(any(1.8), any(1.8), any(1.8)))};
}

inline double& tendon_offset(TendonPair& drive) { return drive.offset; }
inline double& tendon_offset(SwivelDrive& drive) { return drive.tendons.offset; }

template <class LegT>
LegT random_leg(std::mt19937& random) {
  LegT leg{};
  const RandomFields fill{random};
  LegT::Link::fields(leg.link, fill);
  LegT::Drive::fields(leg.drive, fill);
  LegT::Closure::fields(leg.closure, fill);
  if constexpr (requires { tendon_offset(leg.drive); }) tendon_offset(leg.drive) /= 20;
  if constexpr (requires { leg.drive.theta_is; })
    if (uniform(random, 0, 1) < 0.5) leg.drive.theta_is = ThetaIs::chord;
  leg.base = random_frame<typename LegT::Space>(random, 0.2);
  leg.platform_point = random_frame<typename LegT::Space>(random, 0.1).p;
  return leg;
}

/// A curvature of a link of this length: anywhere within its turn, straight, or a hair beside it.
inline double random_curvature(std::mt19937& random, double length) {
  const double turn = 2 * std::numbers::pi / length;
  switch (std::uniform_int_distribution(0, 6)(random)) {
    case 0:
      return 0;
    case 1:
      return uniform(random, -1e-8, 1e-8);
    case 2:
      return uniform(random, -1e-3, 1e-3);
    case 3:
      return uniform(random, 0.999, 1) * turn;
    default:
      return uniform(random, -turn, turn);
  }
}

/// A branch coordinate of this leg: a curvature, or a slide.
template <class LegT>
double random_branch(std::mt19937& random, const LegT& leg) {
  if constexpr (HasArc<typename LegT::Link>)
    return random_curvature(random, leg.link.arc().length);
  else
    return uniform(random, -0.5, 0.5);
}

template <class LegT>
typename LegT::Coordinates random_coordinates(std::mt19937& random, const LegT& leg) {
  typename LegT::Coordinates q;
  for (int j = 0; j + 1 < LegT::coordinates; ++j) q[j] = uniform(random, -3.14, 3.14);
  q[LegT::coordinates - 1] = random_branch(random, leg);
  return q;
}

inline PlanarPose random_pose(std::mt19937& random) {
  return {uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1), uniform(random, -3.14, 3.14)};
}

}  // namespace sinew::test

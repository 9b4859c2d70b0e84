/// @file swivel_drive.hpp
/// Drive of a swivelled arc: a motor in its base joint and a pair of tendons. Theory: docs/theory/tendon.md
#pragma once
#include "tendon/input_kind.hpp"
#include "tendon/pair.hpp"
#include "tendon/theta_is.hpp"

namespace sinew::inline v1 {

/// Inputs (θ, ℓ₁): angle of the base joint [rad], length of tendon 1 [m]. Coordinates (θ of the tangent, κ).
struct SwivelDrive {
  static constexpr int inputs = 2;
  static constexpr std::array input_kinds{InputKind{"theta", Dimension::angle},
                                          InputKind{"tendon_1", Dimension::length}};

  TendonPair tendons;
  ThetaIs theta_is = ThetaIs::tangent;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    TendonPair::fields(self.tendons, visit);
  }

  template <class Link>
  Vec<double, 2> coordinates(const Link& link, std::span<const double> a) const {
    const double curvature = tendons.coordinates(link, a.subspan(1))[0];
    return {a[0] + lead(link) * curvature, curvature};
  }

  template <class Link>
  Vec<double, 2> commands(const Link& link, const Vec<double, 2>& q) const {
    return {q[0] - lead(link) * q[1], tendons.commands(link, Vec<double, 1>(q[1]))[0]};
  }

  /// ∂q/∂a, constant.  @implements TDPCR (65)-(66)
  template <class Link>
  Mat<double, 2, 2> rate(const Link& link) const {
    const double lambda = tendons.rate(link)(0, 0);
    Mat<double, 2, 2> rate;
    rate << 1, lead(link) * lambda, 0, lambda;
    return rate;
  }

  double tendon_offset() const { return tendons.offset; }
  double domain() const { return tendons.domain(); }
  std::array<double, 2> lengths(double backbone_length, double curvature) const {
    return tendons.lengths(backbone_length, curvature);
  }

 private:
  /// Of the tangent before the commanded angle, per curvature [m].
  template <class Link>
  double lead(const Link& link) const {
    return theta_is == ThetaIs::chord ? link.arc().tangent_lead(1) : 0;
  }
};

}  // namespace sinew::inline v1

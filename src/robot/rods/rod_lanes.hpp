/// @file rod_lanes.hpp
/// Eight rods side by side, one a SIMD lane: of one robot, or the same rod of eight poses. All numbers of
/// their Newton step live here. Theory: docs/theory/galerkin_rod.md
#pragma once
#include <cstddef>

#include "link/galerkin.hpp"
#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

inline constexpr int rod_lanes = 8;
using RodLane = double[rod_lanes];

/// Three lanes hold the vectors of so many rods: that of rod i.
inline Vec3<double> vector_of(const RodLane* lanes, int i) { return {lanes[0][i], lanes[1][i], lanes[2][i]}; }
inline void put(const Vec3<double>& v, RodLane* lanes, int i) {
  for (int k = 0; k < 3; ++k) lanes[k][i] = v[k];
}

/// What Newton's method moves, and what a path is resumed from.
/// @tparam N Gauss nodes a rod
template <std::size_t N>
struct PlaneRodState {
  RodLane length;            ///< L [m]
  RodLane theta[N];          ///< angle from the base tangent at the Gauss nodes [rad]
  RodLane force_d, force_w;  ///< of the platform on the tip: lateral and along the base tangent [N]
  RodLane lateral[3];        ///< unit vector h of the lateral direction, base axes
};

template <std::size_t N>
struct alignas(64) RodLanes : PlaneRodState<N> {
  static constexpr int nodes = N;
  static constexpr std::size_t size = N;
  using Lane = RodLane;
  using State = PlaneRodState<N>;

  /// @name What the rods are. A lane without a rod repeats another and is not active.
  /// @{
  Lane base[3], tangent[3];  ///< base point [m] and unit tangent there
  Lane platform_point[3];    ///< platform axes [m]
  Lane flexibility;          ///< 1/EI [1/(N m²)]
  Lane active;               ///< 1 or 0
  /// @}

  /// @name At the last evaluation
  /// @{
  Lane sine[N], cosine[N];  ///< wⱼ sin θⱼ, wⱼ cos θⱼ
  Lane bent[N];             ///< Bθ; a step carries it on
  Lane gap[N];              ///< r = Bθ − (L²/EI)(Fd c − Fw s)
  Lane gap_d, gap_w;        ///< tip of the rod less the platform point, lateral and axial [m]
  Lane tip_d, tip_w;        ///< the platform point, lateral (signed) and axial [m]
  Lane load;                ///< L²/EI [1/N]
  Lane arm[3];              ///< platform point from the reference point, base axes [m]
  /// @}

  /// @name Factors kept from the last linearisation: H = LDLᵀ, and what they say of the tip
  /// @{
  Lane lower[N * (N - 1) / 2], pivot[N];  ///< L by rows, 1/D
  Lane stiffening[N];                     ///< what H has on its diagonal beside B
  Lane sine_kept[N], cosine_kept[N];      ///< s, c of then
  Lane by_d[N], by_w[N];                  ///< H⁻¹c, −H⁻¹s
  Lane stiff_dd, stiff_dw, stiff_ww;      ///< in-plane tip stiffness [N/m]
  Lane soft_dd, soft_dw, soft_ww;         ///< cᵀH⁻¹c, …: its compliance, dimensionless
  Lane fix_d, fix_w;                      ///< force that closes the gaps at a resting platform [N]
  Lane feed_d, feed_w;                    ///< force per length fed at a resting platform [N/m]
  /// @}
};

}  // namespace sinew::inline v1

/// @file tendon_pair.h
/// Two opposite tendons of one planar link, tendon 1 on the side towards which a positive curvature bends.
/// Freestanding C++14, no includes, no heap: the desktop library and a microcontroller run this same code.
/// Theory: docs/theory/tendon.md
#ifndef SINEW_KERNEL_TENDON_PAIR_H
#define SINEW_KERNEL_TENDON_PAIR_H

namespace sinew {
namespace kernel {

/// Tendon lengths against signed curvature for a backbone that keeps its length.
///
/// With signed curvature the paper's three cases of the ratio h/κ in (16), one of them "undefined", are one
/// affine map, regular through the straight link:  ℓ₁ = ℓ(1 − dκ),  ℓ₂ = ℓ(1 + dκ),  ℓ₁ + ℓ₂ = 2ℓ.
template <class S>
struct TendonPair {
  S length;  ///< backbone length ℓ [m], > 0
  S offset;  ///< distance d of either tendon from the backbone [m], > 0

  /// Length of tendon 1 [m] at curvature κ [1/m].  @implements TDPCR (10)
  template <class T>
  constexpr T tendon_1(T curvature) const {
    return length * (T(1) - offset * curvature);
  }

  /// Length of tendon 2 [m] at curvature κ [1/m].
  template <class T>
  constexpr T tendon_2(T curvature) const {
    return length * (T(1) + offset * curvature);
  }

  /// Curvature κ [1/m] from the length of tendon 1 [m], tendon 2 following.  @implements TDPCR (11)
  template <class T>
  constexpr T curvature(T tendon_1_length) const {
    return (length - tendon_1_length) / (offset * length);
  }

  /// λ = dκ/dℓ₁ = −1/(dℓ) [1/m²], a constant: (15) with ℓ₁ + ℓ₂ = 2ℓ and the sign kept.
  /// @implements TDPCR (12)-(16)
  constexpr S curvature_rate() const { return S(-1) / (offset * length); }
};

}  // namespace kernel
}  // namespace sinew

#endif

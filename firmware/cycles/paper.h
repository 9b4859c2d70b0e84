/// @file paper.h
/// PCC as section 6.1 of [LSK] codes it: for each tendon of each section a sum over the sections it passes,
/// with a sine and a reciprocal each. Misprints are mended (docs/errata.md). It has no value where a section
/// is straight.
#ifndef SINEW_FIRMWARE_PAPER_H
#define SINEW_FIRMWARE_PAPER_H

#include "sinew/kernel/polar.h"

namespace paper {

using sinew::kernel::Bend;

/// The same direction within half a turn, of an angle between two.
template <class S>
S turned(S angle) {
  const S half = S(sinew::kernel::detail::pi), whole = S(2 * sinew::kernel::detail::pi);
  return angle > half ? angle - whole : angle < -half ? angle + whole : angle;
}
template <class S>
S sine(S angle) {
  return sinew::kernel::direction_at(turned(angle)).sine;
}
template <class S>
S cosine(S angle) {
  return sinew::kernel::direction_at(turned(angle)).cosine;
}
// Hidden from the compiler, which else takes a call out of a loop of one turn: the paper's program has it in
// there.
inline float sine(float angle) {
  asm volatile("" : "+r"(angle));
  return static_cast<float>(__builtin_sin(static_cast<double>(angle)));
}
inline float cosine(float angle) {
  asm volatile("" : "+r"(angle));
  return static_cast<float>(__builtin_cos(static_cast<double>(angle)));
}

/// A robot of equal sections [mm, rad] and the directions of its tendons.
template <class S, unsigned Sections>
struct Robot {
  S joints, length, radius;  ///< N, L, r_c
  S angles[Sections][3];     ///< delta of each tendon
  S arms[Sections][3][2];    ///< r_c (cos delta, sin delta)

  /// (1), of bends (theta, phi).
  void polar_changes(const Bend<S> (&bends)[Sections], S (&changes)[Sections][3]) const {
    const S twice = joints + joints, straight = S(joints * length);
    S neutral = S(0.0);
    for (unsigned m = 0; m < Sections; ++m) {
      neutral += straight;
      for (unsigned i = 0; i < 3; ++i) {
        S sum = S(0.0);
        for (unsigned k = 0; k <= m; ++k)
          sum += S(S(twice * sine(S(bends[k].x / twice))) *
                   S(straight / bends[k].x - S(radius * cosine(S(bends[k].y - angles[m][i])))));
        changes[m][i] = sum - neutral;
      }
    }
  }

  /// (2), of bends (beta_1, beta_2).
  void twin_changes(const Bend<S> (&bends)[Sections], S (&changes)[Sections][3]) const {
    const S half = S(0.5), straight = S(joints * length);
    S neutral = S(0.0);
    for (unsigned m = 0; m < Sections; ++m) {
      neutral += straight;
      for (unsigned i = 0; i < 3; ++i) {
        S sum = S(0.0);
        for (unsigned k = 0; k <= m; ++k)
          sum += S(joints * (S((length / bends[k].x - arms[m][i][0]) * sine(S(bends[k].x * half))) +
                             S((length / bends[k].y - arms[m][i][1]) * sine(S(bends[k].y * half)))));
        changes[m][i] = sum - neutral;
      }
    }
  }
};

}  // namespace paper

#endif

/// @file section.h
/// Tendons of a serial robot's sections: what a bend asks of them, and the bend from what they did. Exact
/// piecewise constant curvature (PCC) and its linearisation (LSK) by the same running sum, so both take one
/// pass over the sections; PCC needs no double loop and is not singular when straight.
///
/// A section is N joints with a disc each. Its bend (x, y) is
/// - of a neutral backbone x = θ cos φ, y = θ sin φ of the whole section: each joint bends by θ/N towards φ;
/// - of twin-pivot joints x = β₁, y = β₂ per joint: N/2 joints bend about each axis.
///
/// A tendon at angle d passes every joint at radius r, so it changes by  Δl = common − (X cos d + Y sin d)
/// with X, Y, common summed over the sections it passes. One unit of length throughout, angles in rad.
/// Freestanding C++14, no includes but its neighbour, no heap. Theory: docs/theory/section.md
#ifndef SINEW_KERNEL_SECTION_H
#define SINEW_KERNEL_SECTION_H

#include "sinew/kernel/arc.h"

namespace sinew {
namespace kernel {

/// What bends: one backbone in the middle, or pairs of pivots that bend about two axes in turn.
enum class Backbone : unsigned char { neutral, twin_pivot };
/// PCC, LSK.
enum class Model : unsigned char { exact, linear };

/// @tparam Angle scalar of angles and ratios, at least −4 to 4
/// @tparam Length scalar of lengths
template <class Angle, class Length = Angle>
struct Section {
  Backbone backbone;
  Length length;   ///< N L: arc length of its backbone, > 0
  Length gain;     ///< g: N r/2 of twin-pivot joints, r of a neutral backbone, > 0
  Angle per_gain;  ///< 1/g
  Angle half;      ///< half of what one joint has of the bend: 1/2 twin-pivot, 1/(2N) neutral
};

/// @param joints N, of twin pivots even
/// @param joint_length arc length of one joint
/// @param radius of the tendons about the backbone, in the same unit
template <class Angle, class Length = Angle>
constexpr Section<Angle, Length> make_section(Backbone backbone, int joints, double joint_length,
                                              double radius) {
  const bool twin = backbone == Backbone::twin_pivot;
  const double gain = twin ? 0.5 * joints * radius : radius;
  return {backbone, Length(joints * joint_length), Length(gain), Angle(1 / gain),
          Angle(twin ? 0.5 : 0.5 / joints)};
}

/// Bend of a section [rad].
template <class Angle>
struct Bend {
  Angle x, y;
};

/// Direction of a tendon around the discs.
template <class Angle>
struct Direction {
  Angle cosine, sine;
};

/// What sections ask of a tendon that passes them: Δl = common − (x cos d + y sin d).
template <class Length>
struct Pull {
  Length x, y, common;
};

template <class Length>
constexpr Pull<Length> operator+(const Pull<Length>& a, const Pull<Length>& b) {
  return {a.x + b.x, a.y + b.y, a.common + b.common};
}

/// LSK: the chord factor left out.  @implements LSK (7), (8), (13)
template <class Angle, class Length>
constexpr Pull<Length> linear_pull(const Section<Angle, Length>& section, const Bend<Angle>& bend) {
  return {Length(section.gain * bend.x), Length(section.gain * bend.y), Length(0.0)};
}

/// What chords lack of their arcs, as shares: of the pull towards x and y, and of the length.
template <class Angle>
struct ChordLoss {
  Angle x, y, length;
};
/// Of a section at this bend.
template <class Angle, class Length>
constexpr ChordLoss<Angle> chord_loss_of(const Section<Angle, Length>& section, const Bend<Angle>& bend) {
  const Angle x = Angle(section.half * bend.x), y = Angle(section.half * bend.y);
  const Angle w_x = Angle(x * x), w_y = Angle(y * y);
  if (section.backbone == Backbone::neutral) {
    const Angle loss = chord_loss(w_x + w_y);
    return {loss, loss, loss};
  }
  Angle loss_x{}, loss_y{};
  chord_losses(w_x, w_y, loss_x, loss_y);
  return {loss_x, loss_y, Angle(Angle(0.5) * (loss_x + loss_y))};
}

/// PCC.  @implements LSK (1), (2)
template <class Angle, class Length>
constexpr Pull<Length> exact_pull(const Section<Angle, Length>& section, const Bend<Angle>& bend) {
  const ChordLoss<Angle> loss = chord_loss_of(section, bend);
  const Pull<Length> straight = linear_pull(section, bend);
  return {straight.x + Length(straight.x * loss.x), straight.y + Length(straight.y * loss.y),
          Length(section.length * loss.length)};
}

template <Model model, class Angle, class Length>
constexpr Pull<Length> pull(const Section<Angle, Length>& section, const Bend<Angle>& bend) {
  return model == Model::exact ? exact_pull(section, bend) : linear_pull(section, bend);
}

/// The pull of a section of variable length, `extension` longer than at rest: x and y are the same, and
/// what is common to its tendons grows by as much as its chords do.
template <Model model, class Angle, class Length>
constexpr Pull<Length> pull(const Section<Angle, Length>& section, const Bend<Angle>& bend,
                            Length extension) {
  Section<Angle, Length> longer = section;
  longer.length = section.length + extension;
  const Pull<Length> bent = pull<model>(longer, bend);
  return {bent.x, bent.y, bent.common + extension};
}

/// What of an extension the tendons feel: the share of chords in their arcs.
template <Model model, class Angle, class Length>
constexpr Angle chord_share(const Section<Angle, Length>& section, const Bend<Angle>& bend) {
  return model == Model::exact ? Angle(1.0) + chord_loss_of(section, bend).length : Angle(1.0);
}

/// The extension whose pull has this in common, the section's own: the inverse of the above.
template <Model model, class Angle, class Length>
constexpr Length extension(const Section<Angle, Length>& section, const Bend<Angle>& bend, Length common) {
  const Length own = common - pull<model>(section, bend).common;
  return model == Model::exact ? Length(own / Length(chord_share<model>(section, bend))) : own;
}

/// Change of a tendon in that direction, Δl > 0 pays out.  @implements LSK (9), (11), (15), (16)
template <class Angle, class Length>
constexpr Length tendon_change(const Pull<Length>& pull, const Direction<Angle>& at) {
  return pull.common - Length(pull.x * at.cosine + pull.y * at.sine);
}

/// The pull that comes nearest to the changes of tendons spread evenly around the discs, in least squares,
/// and their mean as `common`: n tendons that agree are met exactly.
/// @implements LSK (10), which prints neither the factor 2/n nor, of n tendons, any but 3
template <class Angle, class Length>
constexpr Pull<Length> nearest_pull(const Length* changes, const Direction<Angle>* at, int tendons) {
  auto x = changes[0] * at[0].cosine, y = changes[0] * at[0].sine;  // of fixed point twice as wide
  auto sum = changes[0] * Angle(1.0);
  for (int i = 1; i < tendons; ++i) {
    x += changes[i] * at[i].cosine;
    y += changes[i] * at[i].sine;
    sum += changes[i] * Angle(1.0);
  }
  const Angle share = Angle(1.0 / tendons), twice = Angle(2.0 / tendons);
  return {-Length(Length(x) * twice), -Length(Length(y) * twice), Length(Length(sum) * share)};
}

/// Bend of a section from its own share of a pull.
template <class Angle, class Length>
constexpr Bend<Angle> linear_bend(const Section<Angle, Length>& section, Length x, Length y) {
  return {Angle(x * section.per_gain), Angle(y * section.per_gain)};
}

/// The same for PCC, in closed form: the pull is that of chords, x = g · 2 sin(β₁/2) and so on, and each
/// chord has one arc |β| ≤ π a joint. A longer chord u has none; its bend is π/2 · u, beyond π.
template <class Angle, class Length>
constexpr Bend<Angle> exact_bend(const Section<Angle, Length>& section, Length x, Length y) {
  const Bend<Angle> chord = linear_bend(section, x, y);
  const Angle half_x = Angle(section.half * chord.x), half_y = Angle(section.half * chord.y);
  const Angle y_x = Angle(half_x * half_x), y_y = Angle(half_y * half_y);
  if (section.backbone == Backbone::neutral) {
    const Angle ratio = arc_over_chord(y_x + y_y);
    return {Angle(chord.x * ratio), Angle(chord.y * ratio)};
  }
  return {Angle(chord.x * arc_over_chord(y_x)), Angle(chord.y * arc_over_chord(y_y))};
}

/// Bend of a section from its own share of a pull, by either model.
template <Model model, class Angle, class Length>
constexpr Bend<Angle> bend(const Section<Angle, Length>& section, Length x, Length y) {
  return model == Model::exact ? exact_bend(section, x, y) : linear_bend(section, x, y);
}

// The same of a model that is chosen while it runs.

template <class Angle, class Length>
constexpr Pull<Length> pull(Model model, const Section<Angle, Length>& section, const Bend<Angle>& bend) {
  return model == Model::exact ? exact_pull(section, bend) : linear_pull(section, bend);
}
template <class Angle, class Length>
constexpr Pull<Length> pull(Model model, const Section<Angle, Length>& section, const Bend<Angle>& bend,
                            Length extension) {
  return model == Model::exact ? pull<Model::exact>(section, bend, extension)
                               : pull<Model::linear>(section, bend, extension);
}
template <class Angle, class Length>
constexpr Bend<Angle> bend(Model model, const Section<Angle, Length>& section, Length x, Length y) {
  return model == Model::exact ? exact_bend(section, x, y) : linear_bend(section, x, y);
}
template <class Angle, class Length>
constexpr Angle chord_share(Model model, const Section<Angle, Length>& section, const Bend<Angle>& bend) {
  return model == Model::exact ? chord_share<Model::exact>(section, bend) : Angle(1.0);
}
template <class Angle, class Length>
constexpr Length extension(Model model, const Section<Angle, Length>& section, const Bend<Angle>& bend,
                           Length common) {
  return model == Model::exact ? extension<Model::exact>(section, bend, common)
                               : extension<Model::linear>(section, bend, common);
}

}  // namespace kernel
}  // namespace sinew

#endif

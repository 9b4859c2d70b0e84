/// @file diagram.hpp
/// The section diagram: what tendons that were driven some way leave a section free to do, and whether they
/// agree. Its plane is that of the section's bend x = (x, y) [rad]: kernel/section.h.
/// Theory: docs/theory/section_diagram.md
///
/// Tendon i in direction uᵢ, paid out by Δlᵢ, of which earlier sections ask eᵢ, has at the bend x the slack
///
///   linear    σᵢ(x) = Δlᵢ − eᵢ + g uᵢ·x              not too short in a half-plane
///   exact     σᵢ(x) = Δlᵢ − eᵢ + uᵢ·p(x) + λ(x)      p: pull of chords, λ: length they lack; curved frontier
///
/// The section can be wherever no tendon is too short. One model per question: driven by exact lengths, a
/// section that is asked about in the linear model seems over-tensioned, and the other way round slack.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "sinew/kernel/section.h"
#include "sinew/math/vec.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// Tendons that end at one section, spread evenly around its discs, at least 3. One direction a change.
struct SectionTendons {
  std::span<const kernel::Direction<double>> at;  ///< cosine and sine of each tendon's angle, no unit
  std::span<const double> changes;                ///< Δl [m], > 0 pays out
};

/// Bends a section is allowed.
struct Envelope {
  /// Its form.
  enum class Kind {
    square,   ///< |x|, |y| ≤ limit [rad]
    disc,     ///< |(x, y)| ≤ limit [rad]
    actuator  ///< g |uᵢ·x| ≤ limit [m] for each tendon: the travel it has, chord factor left out
  };
  Kind kind = Kind::square;
  double limit = 0;  ///< ≥ 0
};

/// A section, its tendons, and what it is allowed.
struct DiagramQuestion {
  kernel::Section<double> section;  ///< its sizes [m]: `Section::map`
  SectionTendons tendons;
  Envelope envelope;
  double tolerance = 0;                   ///< of a tendon [m]: encoder step, friction, stretch
  kernel::Pull<double> earlier{0, 0, 0};  ///< what the bends of earlier sections ask of these tendons [m]
  kernel::Model model = kernel::Model::linear;  ///< linear: as the paper; exact: PCC
  double deviation = 1e-4;  ///< arcs are sampled so that no chord is farther from them [rad]
};

/// What tendons together leave a section.
enum class TendonConsistency {
  exact,          ///< taut within the tolerance: one bend
  indeterminate,  ///< no tendon too short, some slack: a set of bends
  inconsistent,   ///< whatever the bend, some tendon is too short
  unreachable     ///< they agree on bends outside the envelope only
};

/// Points on one frontier [rad].
using Curve = std::vector<Vec2<double>>;

/// The answer to a DiagramQuestion.
struct SectionDiagram {
  /// - `converged`: all is known.
  /// - `left_domain`: nothing is; the message says what was wrong with the question.
  /// - `stalled`, exact model only: the free set has several parts and `boundary` is that of the largest, or
  ///   not all of its boundary was found and `boundary` and `area` are not to be trusted; see the message.
  Report report;
  TendonConsistency agree = TendonConsistency::inconsistent;
  bool partial = false;  ///< indeterminate, with a tendon that is taut at `point`

  Vec2<double> point{0, 0};         ///< bend [rad] that meets the tendons' differences in least squares
  bool point_is_allowed = false;    ///< it lies in the envelope
  std::vector<double> slack;        ///< of each tendon at `point` [m], < 0: too short
  double margin = 0;                ///< largest least slack of any allowed bend [m]
  Vec2<double> margin_point{0, 0};  ///< where it is; `point` if that is one of several
  double over_tension = 0;  ///< max(0, −margin): least stretch any allowed bend needs of its worst tendon [m]

  std::vector<HalfPlane> frontiers;  ///< linear: of each tendon [rad]; it is not too short within
  /// Exact: of each tendon, σᵢ = 0 where it passes near the envelope; it is not too short to the left.
  std::vector<Curve> curves;
  std::optional<Polygon> free;  ///< bends no tendon forbids; absent in the exact model
  double free_area = 0;         ///< [rad²]

  /// Those in the envelope: counter-clockwise, convex in the linear model. Empty, a point or a segment where
  /// thinner than rounding.
  Polygon boundary;
  double area = 0;  ///< of that set [rad²], not of the sampled polygon: exact; in the exact model to 1e-8
};

/// @param question lengths in m, angles in rad. Exact model: an envelope that bends no joint by half a turn,
/// twin pivots by less than a quarter about each axis
/// @return classified by slack against the tolerance, never by area: a set without area may be a segment.
/// [LSK] sections 4.1 and 4.2.
SINEW_API SectionDiagram section_diagram(const DiagramQuestion& question);

/// Bends of a section in the linear model where the sections before it are not exact either. Its tendons only
/// fix the sum of the bends they pass, so it may be at any difference of two points, one of its own polygon
/// and one of theirs.
///
/// Tendons that no bend satisfies stretch, and where they then hold a section is a matter of forces: an
/// over-tensioned section has no polygon, so it has no outline and hands none on.
struct SectionOutline {
  /// Why there is no outline.
  enum class Missing { none, previous_over_tensioned, over_tensioned, beyond_envelope };
  Report report;     ///< `converged` or `left_domain`
  Polygon boundary;  ///< [rad], cut with the envelope; empty where it is missing
  double area = 0;   ///< [rad²], exact
  Missing missing = Missing::none;
};

/// @param question as above, changes of whole tendons; `earlier`, `model` and `tolerance` are not used
/// @param previous tendons of the section before, base to there; their polygon is not cut with any envelope
/// [LSK] section 4.2, whose polygon of one section takes those before it for exact.
SINEW_API SectionOutline section_outline(const DiagramQuestion& question, const SectionTendons& previous);

}  // namespace sinew::inline v1

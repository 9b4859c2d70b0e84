/// @file capstan.hpp
/// Tensions along a tendon that rubs at its guides (Coulomb): how far it slips at each, from what lay in
/// every span before. Theory: docs/theory/tendon_friction.md
#pragma once
#include <vector>

namespace sinew::inline v1::strain {

/// A tendon from guide to guide, motor first: its spans, and the guides between them.
struct CapstanSpans {
  std::vector<double> stretch;     ///< e: what a span is longer than what lay in it, unstretched [m]
  std::vector<double> compliance;  ///< c of each span [m/N], > 0
  std::vector<double> grip;        ///< b = μθ of the guide after each span but the last [1], ≥ 0
  bool held = false;               ///< the first span has this tension, whatever its stretch
  double tension = 0;              ///< [N]
};

/// How each guide answers.
enum class Grip : signed char {
  inward = -1,  ///< the tendon slips towards its fixed end, which pulls e^b stronger
  sticks = 0,
  outward = 1,  ///< it slips towards the motor, whose side pulls e^b stronger
};

/// Tensions of the spans once the tendon has slipped as far as it must: where T is not 0,
/// T₋ = T₊ e^±b at guides that slip, between these at those that stick. They are unique.
class CapstanTensions {
 public:
  void find(const CapstanSpans& spans);
  /// Tensions with guides answering as `grips` says, whether they may or not.
  void follow(const CapstanSpans& spans);
  /// T after a guide over that before it, as `grips` says of one that slips.
  double ratio(const CapstanSpans& spans, std::size_t guide) const;
  /// Guides at the edge of slipping, where less than this has moved [m], count as those that stick.
  void loosen(const CapstanSpans& spans, double least);

  std::vector<double> tension;  ///< of each span [N]
  std::vector<double> slip;     ///< what moved outward at each guide [m]
  std::vector<Grip> grips;      ///< of each guide; that of a guide without friction is `outward`
  /// ∂T/∂e, square, and ∂T/∂b, a row a span, by what find() or follow() left; of taut tendons.
  void derivatives(const CapstanSpans& spans, std::vector<double>& by_stretch,
                   std::vector<double>& by_grip) const;

 private:
  struct Segment {
    double from, slope, offset;  ///< slope·T − offset from this T on
  };
  std::vector<Segment> force_, next_;
  std::vector<double> wanted_;
};

}  // namespace sinew::inline v1::strain

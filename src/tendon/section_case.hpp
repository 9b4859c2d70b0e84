/// @file section_case.hpp
/// A question of the section diagram, checked and made ready: slack of a bend, and whether the envelope holds
/// it.
#pragma once
#include <limits>
#include <string_view>

#include "sinew/kernel/tendon_state.h"
#include "sinew/tendon/diagram.hpp"

namespace sinew::inline v1 {

struct SectionCase {
  static constexpr double ulps = 32 * std::numeric_limits<double>::epsilon();

  explicit SectionCase(const DiagramQuestion& asked);

  std::size_t tendons() const { return own.size(); }
  bool is_exact() const { return question.model == kernel::Model::exact; }
  bool is_disc() const { return question.envelope.kind == Envelope::Kind::disc; }
  Vec2<double> direction(std::size_t i) const { return {at[i].cosine, at[i].sine}; }

  kernel::Pull<double> pull(const Vec2<double>& bend) const;
  Vec2<double> bend(const Vec2<double>& pull) const;  ///< of the model in use
  double slack(std::size_t i, const kernel::Pull<double>& pull) const {
    return kernel::tendon_slack(own[i], pull, at[i]);
  }
  double min_slack(const Vec2<double>& bend) const;
  double depth(const Vec2<double>& bend) const;  ///< in the envelope [rad], < 0: beyond it
  bool allows(const Vec2<double>& bend) const { return depth(bend) >= -ulps * bend.norm(); }

  const DiagramQuestion& question;
  std::span<const kernel::Direction<double>> at;
  std::vector<double> own;       ///< changes less what earlier sections ask [m]
  std::vector<HalfPlane> sides;  ///< of the envelope [rad]; none of a disc
  Polygon corners;               ///< of the envelope; none of a disc
  double rounding;               ///< of a slack [m]
};

/// What is wrong with a question; empty if nothing is.
std::string_view complaint(const DiagramQuestion& question);
std::string_view complaint(const SectionTendons& tendons, double gain);

/// The bends at which no tendon is too short, in the linear model. @param gain of the section; 1: pulls, not
/// bends
std::vector<HalfPlane> frontiers(std::span<const kernel::Direction<double>> at, std::span<const double> own,
                                 double gain);

}  // namespace sinew::inline v1

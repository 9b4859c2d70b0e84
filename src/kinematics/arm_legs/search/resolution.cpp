#include "kinematics/arm_legs/search/resolution.hpp"

#include <fmt/format.h>

#include <array>

namespace sinew::inline v1 {
namespace {

struct Finer {
  int order, elements;
};
constexpr std::array<Finer, 4> along_a_section{{{-1, 8}, {5, 16}, {7, 32}, {9, 64}}};
constexpr std::array<Finer, 5> from_disc_to_disc{{{-1, 2}, {3, 3}, {4, 5}, {5, 8}, {6, 13}}};

std::span<const Finer> finer_bases(const ArmOptions& options) {
  if (options.order >= 0 || options.elements > 0 || !(options.accuracy > 0)) return {};
  if (options.model == ArmModel::rod) return along_a_section;
  if (options.model == ArmModel::subsegment_rod) return from_disc_to_disc;
  return {};
}

/// An error beyond so many times the accuracy is reported [1]: it is an estimate by two polynomials, and less
/// would refuse answers that are good enough.
constexpr double reported_multiple = 10;

}  // namespace

std::vector<ArmBasis> bases_of(const ArmOptions& options) {
  std::vector<ArmBasis> bases;
  for (const Finer& finer : finer_bases(options))
    bases.push_back({options.model, finer.order, finer.elements});
  if (bases.empty()) bases.push_back({options.model, options.order, options.elements});
  return bases;
}

bool levels_are_for(const ArmOptions& options, const ArmLegsWorkspace::Impl& impl) {
  return impl.model == options.model && impl.order == options.order && impl.elements == options.elements &&
         impl.levels.size() == bases_of(options).size();
}

void prepare_levels(const ArmOptions& options, const LegsBreaks& breaks, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  if (levels_are_for(options, impl) && impl.breaks == breaks) return;
  impl.levels.clear();
  impl.levels.resize(bases_of(options).size());
  impl.model = options.model, impl.order = options.order, impl.elements = options.elements;
  impl.breaks = breaks;
}

double moved_by(ArmGroup& coarse, ArmGroup& fine, bool is_pose_prescribed) {
  const auto &a = coarse.platform(), &b = fine.platform();
  if (!is_pose_prescribed)
    return (a.p - b.p).norm() + coarse.radius() * (a.R.inverse().compose(b.R)).log().norm();
  const ArmGroup::Wrench change = constraint_wrench(fine) - constraint_wrench(coarse);
  ArmGroup::Matrix twists, by_tendon;
  if (!fine.factor_limbs() || !fine.answers(twists, by_tendon)) return 0;  // at a fold nothing is told
  const Vec<double, 6> twist = twists.rightCols(6) * change;
  return twist.head<3>().norm() + coarse.radius() * twist.tail<3>().norm();
}

double error_left(double moved, const ArmBasis& coarse, const ArmBasis& fine) {
  const double by = static_cast<double>(fine.elements) / coarse.elements;
  return moved / (by * by * by * by - 1);
}

void report_coarse(double error, double wanted, Report& report) {
  if (!(error > reported_multiple * wanted)) return;
  report.status = Status::stalled;
  report.message = FixedText<240>(fmt::format(
      "the finest polynomials still move the platform by {:.1e} m: loads or tensions are too large", error));
}

ArmGroup::Wrench constraint_wrench(ArmGroup& group) {
  group.evaluate();
  return group.constraint_wrench();
}

}  // namespace sinew::inline v1

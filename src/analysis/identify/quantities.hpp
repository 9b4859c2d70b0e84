/// @file quantities.hpp
/// What of a measured arm can be fitted: names, units, bounds, and the numbers that each stands for.
#pragma once
#include <Eigen/Core>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/identify/arm_rows.hpp"

namespace sinew::inline v1::identification {

/// What a quantity belongs to.
enum class Owner { section, passage, tendon, arm };

struct QuantityWords {
  ArmQuantity quantity;
  std::string_view name, unit;
  Owner owner;
  bool is_factor;
  double lower, upper, prior;  ///< of the coordinate
};
std::span<const QuantityWords> all_quantities();
const QuantityWords& words_of(ArmQuantity quantity);

inline int section_count(const MeasuredArm& arm) { return static_cast<int>(arm.arm.sections.size()); }
inline int tendon_count(const MeasuredArm& arm) { return static_cast<int>(arm.arm.tendons.size()); }

/// Calls with each section, or tendon, or passage that a field means: visit(tendon, section).
template <class Visit>
void each(const MeasuredArm& arm, const ArmField& field, Visit visit) {
  const Owner owner = words_of(field.quantity).owner;
  if (owner == Owner::arm) return visit(-1, -1);
  if (owner == Owner::section) {
    for (int m = 0; m < section_count(arm); ++m)
      if (field.section < 0 || field.section == m) visit(-1, m);
    return;
  }
  for (int i = 0; i < tendon_count(arm); ++i) {
    if (field.tendon >= 0 && field.tendon != i) continue;
    if (owner == Owner::tendon) {
      visit(i, -1);
      continue;
    }
    for (int m = 0; m <= arm.arm.tendons[at(i)].section(); ++m)
      if (field.section < 0 || field.section == m) visit(i, m);
  }
}

/// With a gain and an offset of every tendon.
MeasuredArm completed(MeasuredArm arm);
/// Masses change by a factor, and have no value in common.
bool is_of_masses(const FitParameter& parameter);
double value_of(const MeasuredArm& arm, const FitParameter& parameter);
/// Where the fit begins. A toe of 0 has no derivative of its own: it begins at its prior, and 0 stays what
/// the prior draws it to.
double first_coordinate(const MeasuredArm& start, const FitParameter& parameter);
MeasuredArm changed(const MeasuredArm& start, const std::vector<FitParameter>& parameters,
                    const Eigen::VectorXd& x);

}  // namespace sinew::inline v1::identification

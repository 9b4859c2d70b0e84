/// Derivatives of the last equilibrium: Jacobian, compliance and stiffness.
#include "base/at.hpp"
#include "kinematics/arm_legs/legs_work.hpp"

namespace sinew::inline v1 {

ArmLegsRates arm_legs_rates(const ArmLegs& robot, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  ArmLegsRates rates;
  if (!impl.has_last()) return rates;
  ArmGroup& group = impl.group();
  group.evaluate();
  ArmGroup::Matrix twists, by_tendon;
  if (!group.factor_limbs()) return rates;
  rates.opposed = group.has_redundant_tendons();
  rates.regular = group.answers(twists, by_tendon);
  if (!rates.regular) return rates;
  const auto flat = [](const ArmGroup::Matrix& matrix) {
    return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
  };
  const int count = group.feeds();
  rates.J = flat(twists.leftCols(count));
  rates.compliance = flat(twists.rightCols(6));
  rates.answers = flat(by_tendon.leftCols(count));
  rates.answers_by_wrench = flat(by_tendon.rightCols(6));
  rates.has_stiffness = group.linearise();
  if (!rates.has_stiffness) return rates;
  const auto stiffness = group.stiffness();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      if (!robot.is_planar || i != j || i < 2 || i > 4) rates.stiffness[at(6 * i + j)] = stiffness(i, j);
  return rates;
}

}  // namespace sinew::inline v1

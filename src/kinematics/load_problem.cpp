#include "kinematics/load_problem.hpp"

namespace sinew::inline v1 {

template <class Space>
GrownLoad grow_load(LimbGroup<Space>& group, LimbPlaces<Space>& places,
                    const Vec<double, Space::dof>& direction, double limit, StopToken stop,
                    const GrowthBudget& budget) {
  double bending = 0;  // a force that bends the limbs, roughly
  for (int k = 0; k < group.limbs(); ++k) bending += group.stiffness(k) / (group.length(k) * group.length(k));
  const double largest = direction.cwiseAbs().maxCoeff(), unit = bending / largest;
  const Vec<double, Space::dof> load = direction / largest * bending;
  using Problem = LoadProblem<Space>;
  Tracer<Problem> tracer(Problem(group, load), 0, places[0], places[1]);
  int steps = 0;
  const Growth grown = GrowingLoad<Problem>(tracer, places[2], places[3]).run(limit / unit, stop, [&] {
    return steps++ < budget.steps && tracer.iterations() < budget.iterations;
  });
  return {grown.end, grown.end == GrowthEnd::limit ? limit : grown.parameter * unit,
          grown.definite_until < 0 ? -1 : grown.definite_until * unit, tracer.iterations()};
}

#define SINEW_OF(Space)                                                                               \
  template GrownLoad grow_load(LimbGroup<Space>&, LimbPlaces<Space>&, const Vec<double, Space::dof>&, \
                               double, StopToken, const GrowthBudget&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1

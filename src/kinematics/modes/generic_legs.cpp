#include "kinematics/modes/leg_sections.hpp"

namespace sinew::inline v1::detail {
namespace {

/// Six equations with rows of unit length, at right angles to each other.
Sections random_sections(ComplexNumbers& random) {
  Mat<Complex, leg_coordinates, 6> unit;
  for (Complex& entry : unit.reshaped()) entry = random.next();
  for (int k = 0; k < 6; ++k) {
    for (int other = 0; other < k; ++other) unit.col(k) -= unit.col(other) * unit.col(other).dot(unit.col(k));
    unit.col(k).normalize();
  }
  return unit.adjoint();
}

/// A point of the Study quadric and equations that it solves.
GenericLegs one_solution(ComplexNumbers& random) {
  Study x;
  for (Complex& entry : x.reshaped()) entry = random.next();
  const Complex excess = (x.head<4>().array() * x.tail<4>().array()).sum();
  x.tail<4>() -= x.head<4>() * (excess / (x.head<4>().array() * x.head<4>().array()).sum());
  GenericLegs legs{random_sections(random), {x}};
  const LegCoordinates y = leg_coordinates_of(x);
  const Vec<Complex, 6> value = legs.sections * y;
  legs.sections -= value * (y.adjoint() / y.squaredNorm());
  return legs;
}

/// Solutions carried along a pencil; those whose path fails are left out.
std::vector<Study> carried(const std::vector<Study>& solutions, const Sections& from, const Sections& to) {
  const Pencil pencil(from, to);
  std::vector<Study> arrived;
  for (const Study& x : solutions) {
    Path<Pencil> path(pencil, x, 0.0);
    if (path.advance(1.0) && path.refine()) arrived.push_back(path.point());
  }
  return arrived;
}

}  // namespace

const GenericLegs& generic_legs() {
  static const GenericLegs found = [] {
    ComplexNumbers random(20260);
    GenericLegs legs = one_solution(random);
    const Sections far = random_sections(random);
    // There and back by two ways is a loop about some of the points where solutions merge; it comes back to
    // another solution than it left.
    for (int loop = 0; loop < 60 && legs.solutions.size() < max_modes; ++loop) {
      const Complex there = random.phase(), back = random.phase();
      const auto away = carried(legs.solutions, legs.sections, there * far);
      for (const Study& x : carried(away, back * far, legs.sections)) {
        const auto is_known = [&](const Study& y) { return same_ray(x, y, 1e-8); };
        if (std::ranges::none_of(legs.solutions, is_known)) legs.solutions.push_back(x);
      }
    }
    return legs;
  }();
  return found;
}

}  // namespace sinew::inline v1::detail

namespace sinew::inline v1 {
template class Path<detail::Pencil>;
}

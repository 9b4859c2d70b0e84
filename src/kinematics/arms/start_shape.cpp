/// A shape from which a search begins, and that of an equilibrium, as mean curvatures of equal parts.
#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "kinematics/arms/arm_work.hpp"

namespace sinew::inline v1 {
namespace {

using Curvatures = std::span<const std::array<double, 3>>;

/// Angle from the base to a place [rad], as if its axis did not turn.
std::array<double, 3> angle_to(Curvatures curvatures, double length, double place) {
  const double part = length / static_cast<double>(curvatures.size());
  std::array<double, 3> angle{};
  for (std::size_t k = 0; k < curvatures.size(); ++k) {
    const double covered = std::clamp(place - static_cast<double>(k) * part, 0.0, part);
    for (std::size_t i = 0; i < 3; ++i) angle[i] += covered * curvatures[k][i];
  }
  return angle;
}

/// Without a bar on a joint that turns freely after the last section [m].
double backbone_of(const strain::RodModel& model) {
  const std::size_t count = model.elements.size();
  const bool has_bar =
      count > 1 && model.elements[count - 1].points == 0 && model.elements[count - 2].is_pivot;
  return model.places[has_bar ? count - 1 : count];
}

/// What a joint stands for: halfway to those beside it.
std::array<double, 2> share_of(const strain::RodModel& model, int joint) {
  const auto is_joint = [&](int e) {
    return model.elements[at(e)].points == 1 && !model.elements[at(e)].is_pivot;
  };
  const int count = static_cast<int>(model.elements.size());
  int before = joint - 1, after = joint + 1;
  while (before >= 0 && !is_joint(before)) --before;
  while (after < count && !is_joint(after)) ++after;
  const double here = model.places[at(joint)];
  return {before < 0 ? 0 : (model.places[at(before)] + here) / 2,
          after == count ? backbone_of(model) : (here + model.places[at(after)]) / 2};
}

}  // namespace

void take_curvatures(Curvatures curvatures, const strain::RodModel& model, std::vector<double>& y) {
  std::fill(y.begin(), y.end(), 0.0);
  const double length = backbone_of(model);
  for (const strain::Piece& piece : model.pieces) {
    if (model.elements[at(model.spans[at(piece.first_span)].first_element)].is_pivot) continue;
    double* own = y.data() + piece.first;
    const strain::Span& last = model.spans[at(piece.first_span + piece.spans - 1)];
    for (int e = model.spans[at(piece.first_span)].first_element; e < last.first_element + last.elements;
         ++e) {
      const strain::Element& element = model.elements[at(e)];
      const std::array<double, 2> ends =
          element.points == 1 ? share_of(model, e) : std::array{model.places[at(e)], model.places[at(e + 1)]};
      const auto before = angle_to(curvatures, length, ends[0]),
                 after = angle_to(curvatures, length, ends[1]);
      for (int g = 0; g < element.points; ++g)
        for (std::size_t c = 3; c < 6; ++c) {
          const double angle = after[c - 3] - before[c - 3];
          const double bent = element.points == 1 ? angle : angle / (ends[1] - ends[0]);
          for (int a = 0; a < piece.modes[c]; ++a)
            own[piece.offset[c] + a] += element.weight * element.modes[at(g)][at(a)] *
                                        (bent - element.rest[at(g)][c]) / piece.scale[c];
        }
    }
  }
}

std::vector<std::array<double, 3>> arm_curvatures(const Arm& arm, int parts, const ArmWorkspace& work) {
  std::vector<double> places;
  for (int k = 0; k <= parts; ++k) places.push_back(arm.length() * k / parts);
  const std::vector<SE3<double>> frames = arm_frames(arm, places, work);
  std::vector<std::array<double, 3>> curvatures;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    const Vec3<double> turn = frames[k - 1].R.inverse().compose(frames[k].R).log() * (parts / arm.length());
    curvatures.push_back({turn[0], turn[1], turn[2]});
  }
  return curvatures;
}

}  // namespace sinew::inline v1

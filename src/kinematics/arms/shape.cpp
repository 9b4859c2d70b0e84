#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "kinematics/arms/arm_work.hpp"
#include "strain/rod_frames.hpp"

namespace sinew::inline v1 {
namespace {

/// The piece that an element is in.
const strain::Piece& piece_of(const strain::RodModel& model, int element) {
  const auto found = std::ranges::partition_point(model.pieces, [&](const strain::Piece& piece) {
    const strain::Span& last = model.spans[at(piece.first_span + piece.spans - 1)];
    return last.first_element + last.elements <= element;
  });
  return *found;
}

}  // namespace

SE3<double> pose_of(const strain::RodFrame& frame) {
  return {place_of(frame), SO3<double>::from(turn_of(frame))};
}

strain::Six strain_at(const strain::RodModel& model, const strain::RodWork& work, double place, int& near) {
  const int count = static_cast<int>(model.elements.size());
  while (near > 0 && model.places[at(near)] >= place) --near;
  while (near + 1 < count && (model.places[at(near + 1)] < place || model.elements[at(near)].is_pivot))
    ++near;
  const strain::Element& element = model.elements[at(near)];
  strain::Six xi = element.rest[0];
  if (element.points == 1 || !(element.to > element.from)) return xi;  // a rigid link
  const strain::Piece& piece = piece_of(model, near);
  const double length = element.to - element.from, x = 2 * (place - element.from) / length - 1;
  for (std::size_t c = 0; c < 6; ++c) {
    const int modes = piece.modes[c] / piece.stretches;
    const double* own = work.y.data() + piece.first + piece.offset[c] + element.stretch * modes;
    double before = 0, value = 1, bent = 0;
    for (int a = 0; a < modes; ++a) {
      bent += std::sqrt((2.0 * a + 1) / length) * value * own[a];
      const double next = ((2.0 * a + 1) * x * value - a * before) / (a + 1);
      before = value;
      value = next;
    }
    xi[c] += piece.scale[c] * bent;
  }
  return xi;
}

std::vector<std::array<double, 6>> arm_strains(const Arm&, std::span<const double> places,
                                               const ArmWorkspace& work) {
  const ArmRod& entry = *work.impl().levels[at(work.impl().level)];
  std::vector<std::array<double, 6>> strains;
  int near = 0;
  for (const double place : places) strains.push_back(strain_at(entry.model, entry.rod.work(), place, near));
  return strains;
}

std::vector<SE3<double>> arm_frames(const Arm&, std::span<const double> places, const ArmWorkspace& work) {
  const ArmRod& entry = *work.impl().levels[at(work.impl().level)];
  const auto& frames = entry.rod.work().frames;
  std::vector<SE3<double>> poses;
  int near = 0;
  for (const double place : places) {
    if (place >= entry.model.places.back()) {
      poses.push_back(pose_of(frames.back()));
      continue;
    }
    strain_at(entry.model, entry.rod.work(), place, near);
    if (near + 1 < static_cast<int>(entry.model.elements.size()) &&
        entry.model.elements[at(near + 1)].points == 1 && !entry.model.elements[at(near + 1)].is_pivot &&
        place > entry.model.places[at(near + 1)] - 1e-12 * entry.model.places.back()) {
      poses.push_back(pose_of(frames[at(near + 2)]));  // a joint at the place has turned
      continue;
    }
    const double start = entry.model.places[at(near)], h = std::max(0.0, place - start),
                 side = h / std::sqrt(12.0);
    int same = near;
    const auto a = strain_at(entry.model, entry.rod.work(), start + h / 2 - side, same),
               b = strain_at(entry.model, entry.rod.work(), start + h / 2 + side, same);
    Vec<double, 6> omega;  // a Magnus step, as between nodes
    const Vec3<double> va(a[0], a[1], a[2]), ua(a[3], a[4], a[5]), vb(b[0], b[1], b[2]), ub(b[3], b[4], b[5]);
    const double k = std::sqrt(3.0) / 12 * h * h;
    omega.head<3>() = 0.5 * h * (va + vb) + k * (cross(ua, vb) + cross(va, ub));
    omega.tail<3>() = 0.5 * h * (ua + ub) + k * cross(ua, ub);
    poses.push_back(pose_of(frames[at(near)]).compose(SE3<double>::exp(omega)));
  }
  return poses;
}

std::vector<std::vector<Vec3<double>>> arm_tendon_lines(const Arm& arm, const ArmWorkspace& work) {
  const strain::RodModel& model = work.impl().levels[at(work.impl().level)]->model;
  std::vector<std::vector<Vec3<double>>> lines(arm.tendons.size());
  double from = 0;
  for (std::size_t m = 0; m < arm.sections.size(); ++m) {
    const ArmSection& section = arm.sections[m];
    const bool discs = section.discs.count > 0 && model.guides.empty();
    const int points = discs ? section.discs.count : 20;
    std::vector<double> places;
    for (int k = m == 0 ? 0 : 1; k <= points; ++k) places.push_back(from + section.length * k / points);
    const auto frames = arm_frames(arm, places, work);
    for (std::size_t i = 0; i < arm.tendons.size(); ++i) {
      if (arm.tendons[i].section() < static_cast<int>(m)) continue;
      const TendonRoute& route = arm.tendons[i].routes[m];
      for (std::size_t k = 0; k < frames.size(); ++k) {
        const double share = (places[k] - from) / section.length,
                     radius = route.start_radius + share * (route.end_radius - route.start_radius),
                     angle = route.start_angle + share * (route.end_angle - route.start_angle);
        lines[i].push_back(frames[k].point({radius * std::cos(angle), radius * std::sin(angle), 0}));
      }
    }
    from += section.length;
  }
  return lines;
}

}  // namespace sinew::inline v1

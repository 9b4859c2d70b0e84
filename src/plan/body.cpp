#include "plan/body.hpp"
#include "link/bent_joint.hpp"
#include "link/bent_motion.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::inline v1 {
namespace {

int pieces_of(double length, double spacing) {
  return std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-9)));
}

}  // namespace

Posture posture_of(const InsertionStep& step) {
  Posture x{step.stage};
  for (const Bend& bend : step.bends) x.push_back(bend[0]), x.push_back(bend[1]);
  return x;
}

InsertionStep step_of(std::span<const double> posture) {
  InsertionStep step;
  step.stage = posture[0];
  for (std::size_t k = 1; k + 1 < posture.size(); k += 2) step.bends.emplace_back(posture[k], posture[k + 1]);
  return step;
}

Body::Body(const InsertionScene& scene, double spacing)
    : robot_(&scene.robot),
      base_(scene.base),
      axis_(scene.axis),
      unknowns_(posture_size(scene.robot)) {
  double arc = 0;
  const auto add = [&](int section) {
    radii_.push_back(robot_->sections[static_cast<std::size_t>(section)].outer_radius());
    arcs_.push_back(arc);
    sections_.push_back(section);
  };
  add(0);
  for (int m = 0; m < robot_->section_count(); ++m) {
    const Section& section = robot_->sections[static_cast<std::size_t>(m)];
    for (int joint = 0; joint < section.segments; ++joint)
      for (const bool is_joint : {true, false}) {
        const double length = is_joint ? section.joint : section.disc_height;
        if (!(length > 0)) continue;
        const int count = pieces_of(length, spacing);
        for (int k = 0; k < count; ++k) {
          pieces_.push_back({m, is_joint, joint, length / count, 1.0 / count});
          arc += length / count;
          add(m);
        }
      }
  }
  // a piece of a joint that turns by dθ moves what is distal by at most dθ times the arc from its base
  levers_.assign(radii_.size() * unknowns_, 0.0);
  for (std::size_t i = 0; i < radii_.size(); ++i) {
    levers_[i * unknowns_] = 1;
    for (std::size_t k = 0; k < i; ++k) {
      const Piece& piece = pieces_[k];
      if (!piece.is_joint) continue;
      const Section& section = robot_->sections[static_cast<std::size_t>(piece.section)];
      const Bend share = section.joint_bend(Bend(1, 1), piece.joint);
      const double lever = (arcs_[i] - arcs_[k]) * piece.share;
      const std::size_t at = i * unknowns_ + 1 + 2 * static_cast<std::size_t>(piece.section);
      levers_[at] += lever * share.x();
      levers_[at + 1] += lever * share.y();
    }
  }
  points_.resize(radii_.size());
  rates_.assign(radii_.size() * unknowns_, Vec3<double>(0, 0, 0));
  turns_.assign(unknowns_, Vec3<double>(0, 0, 0));
}

void Body::place(std::span<const double> posture, bool rates) {
  posture_.assign(posture.begin(), posture.end());
  SE3<double> frame = base_;
  frame.p += posture[0] * axis_;
  points_[0] = frame.p;
  std::fill(turns_.begin(), turns_.end(), Vec3<double>(0, 0, 0));
  Mat<double, 3, 3> R = frame.R.matrix();
  if (rates) {
    std::fill_n(rates_.begin(), unknowns_, Vec3<double>(0, 0, 0));
    rates_[0] = axis_;
  }
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    const Section& section = robot_->sections[static_cast<std::size_t>(piece.section)];
    const std::size_t own = 1 + 2 * static_cast<std::size_t>(piece.section);
    Vec3<double>* const rate = &rates_[(i + 1) * unknowns_];
    const Vec3<double>* const before = &rates_[i * unknowns_];
    if (!piece.is_joint) {
      const Vec3<double> arm = R.col(2) * piece.length;
      points_[i + 1] = points_[i] + arm;
      if (rates)
        for (std::size_t k = 0; k < unknowns_; ++k) rate[k] = before[k] + cross(turns_[k], arm);
      continue;
    }
    const Bend share = section.joint_bend(Bend(1, 1), piece.joint);
    const double x = share.x() * piece.share, y = share.y() * piece.share;
    const BentMotion<double> bent =
        BentJoint{piece.length, 0, 1}.motion(x * posture[own], y * posture[own + 1]);
    const Vec3<double> arm = R * Vec3<double>(bent.pose.p[0], bent.pose.p[1], bent.pose.p[2]);
    points_[i + 1] = points_[i] + arm;
    if (rates) {
      for (std::size_t k = 0; k < unknowns_; ++k) rate[k] = before[k] + cross(turns_[k], arm);
      double columns[2][3][2];
      for (int j = 0; j < 3; ++j) bent.shift[j].store(columns[0][j]), bent.turn[j].store(columns[1][j]);
      for (int c = 0; c < 2; ++c) {
        const double scale = c == 0 ? x : y;
        if (scale == 0) continue;
        const auto column = [&](int which) {
          return Vec3<double>(columns[which][0][c], columns[which][1][c], columns[which][2][c]);
        };
        rate[own + static_cast<std::size_t>(c)] += R * column(0) * scale;
        turns_[own + static_cast<std::size_t>(c)] += R * column(1) * scale;
      }
    }
    frame.R = frame.R.compose({bent.pose.w, Vec3<double>(bent.pose.v[0], bent.pose.v[1], bent.pose.v[2])});
    R = frame.R.matrix();
  }
  direction_ = R.col(2);
}

double Body::sagitta(std::size_t i) const {
  const Piece& piece = pieces_[i];
  if (!piece.is_joint) return 0;
  const Bend share =
      robot_->sections[static_cast<std::size_t>(piece.section)].joint_bend(Bend(1, 1), piece.joint);
  const std::size_t own = 1 + 2 * static_cast<std::size_t>(piece.section);
  return 0.125 * piece.length * piece.share *
         std::hypot(share.x() * posture_[own], share.y() * posture_[own + 1]);
}

double Body::motion_bound(std::size_t i, std::span<const double> from, std::span<const double> to) const {
  double sum = 0;
  for (std::size_t k = 0; k < movers(i); ++k) sum += levers_[i * unknowns_ + k] * std::abs(to[k] - from[k]);
  return sum;
}

double Body::sag_bound(std::size_t i, const InsertionWeight& weight) const {
  // GJ = EI/(1 + ν) of a round backbone, which is softest in torsion: ν ≤ 0.5
  const double stiffness = weight.stiffness / 1.5;
  double sum = 0;
  for (std::size_t k = 0; k < i; ++k) {
    if (!pieces_[k].is_joint) continue;
    const double distal = arcs_.back() - arcs_[k], moment = weight.by_length * distal * distal / 2;
    sum += moment / stiffness * pieces_[k].length * (arcs_[i] - arcs_[k]);
  }
  return sum;
}

}  // namespace sinew::inline v1

/// @file search.hpp
/// What the searches of a plan share: robot and solids, limits, contact. One per thread.
#pragma once
#include "plan/body.hpp"
#include "plan/descent.hpp"
#include "plan/obstacles.hpp"
#include "sinew/plan/insertion.hpp"

namespace sinew::inline v1 {

/// Where a robot comes nearest to the solids.
struct Gap {
  double size = 0;        ///< [m], at most what was looked for
  std::size_t point = 0;  ///< of the body
  int solid = -1;
};

/// Of the backbone, which the body is to follow: points and their arc lengths, straight on before the first.
struct Guide {
  std::vector<Vec3<double>> points;
  std::vector<double> arcs;
  Vec3<double> behind{0, 0, 1};  ///< direction in which it comes to the first point
  Vec3<double> at(double arc) const;
};

class Search {
 public:
  /// @param spacing of the points along the backbone, of the least radius
  Search(const InsertionScene& scene, const Obstacles& obstacles, double spacing);

  Body body;
  std::vector<double> lower, upper;
  double goal = 0;  ///< clearance that contact terms ask for [m]
  Deadline deadline;

  /// Bends within the limits of their sections.
  void project(std::vector<double>& x) const;
  /// Terms of contact; after `body.place`.
  void add_contact(Quadratic& at) const;
  void add_target(Quadratic& at) const;
  /// @param advance of the body along the guide: its base stands at that arc [m]
  void add_guide(Quadratic& at, const Guide& guide, double advance, double weight) const;
  /// After `body.place`.
  Gap gap(double within) const;
  double tip_error() const;
  bool is_at_target() const;
  const InsertionScene& scene() const { return *scene_; }

  Posture descended(Posture x, const std::function<void(Quadratic&)>& more, int max_steps, bool holds_stage);

 private:
  const InsertionScene* scene_;
  const Obstacles* obstacles_;
};

}  // namespace sinew::inline v1

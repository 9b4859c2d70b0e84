/// @file batch.hpp
/// Many poses of one robot, eight at once in the lanes. The rows are cut into eight stretches of neighbours;
/// each lane walks along its own, and a pose that does not come at once is solved alone.
#pragma once
#include "kinematics/rods/solve.hpp"
#include "robot/rods/elastica_system.hpp"

namespace sinew::inline v1 {

class RodBatch {
 public:
  /// Robot's system and home, see solve_rods; must outlive the batch. Allocates.
  RodBatch(RodWork& work, const SE3<double>& home);

  /// Where what is found goes: one a row.
  struct Found {
    std::span<SpatialPose> poses;
    std::span<Status> statuses;
    std::span<double> residuals;  ///< or none
  };

  /// @param rows inputs of every pose, one after the other
  /// @param check_stability whether it is asked if they hold by themselves
  /// Poses as those of a quick resumed answer.
  void solve(std::span<const double> rows, const RodGroup::Wrench& wrench, bool check_stability,
             const Found& found);

  /// The same, each row by a way of its own from home, where the system is.
  void solve_from_home(std::span<const double> rows, const RodGroup::Wrench& wrench, bool check_stability,
                       const Found& found);

 private:
  /// What eight ways from home share.
  struct Home {
    std::vector<CoarseRods> rods;
    PoseLanes poses;
  };
  Home lanes_at_home();
  int way_from(const Home& home, std::span<const double> rows, const RodGroup::Wrench& wrench);
  void walk_from(const Home& home, std::span<const double> rows, const RodGroup::Wrench& wrench, int steps);
  void put(int lane, std::size_t row, const Report& report, const Found& found) const;
  void set_lengths(int lane, Numbers inputs);
  void to_lane(int lane);
  void from_lane(int lane);
  void take_system(int lane);
  RodQuestion question_of(int lane, bool check_stability) const;
  bool settles_from_home(int lane, Numbers inputs, Report& report);
  bool solve_lane(int lane, Numbers inputs, bool check_stability, Report& report);
  double worst() const;
  void walk();

  RodWork* work_;
  ElasticaSystem* system_;
  SE3<double> home_;
  std::vector<CoarseRods> rods_;
  std::vector<CoarseRods::State> before_;
  PoseLanes poses_{}, poses_before_{};
  std::array<bool, rod_lanes> knows_{};  ///< the lane is in equilibrium
  int walked_ = 0;                       ///< rows
};

}  // namespace sinew::inline v1

/// @file kinematics.hpp
/// Questions to robots whose legs bear no load.
#pragma once
#include "query/handlers.hpp"
#include "sinew/kinematics/forward.hpp"

namespace sinew::inline v1 {

/// What is wanted of a configuration, with the fields of its words.
struct KinematicWants {
  Wants words = {};
  std::vector<double> twist = {};   ///< of `velocity`
  std::optional<Along> along = {};  ///< likewise
  int samples = 0;                  ///< of `shape`
};

/// One configuration.
struct KinematicQuestion : Context {
  explicit KinematicQuestion(const Context& context) : Context(context) {}

  /// @name What was read
  /// @{
  Configuration given = {};
  std::vector<double> near_inputs = {};  ///< of `inverse`: its solution is the one nearest to these
  bool wants_trace = false, wants_all = false;
  KinematicWants wanted = {};
  /// @}

  void read();
  void solve();
  void tell();
  void tell_all();

 private:
  void read_loads();
  void solve_forward();
  void solve_inverse();
  void find_modes();
  void tell_modes();

  Solved found_ = {};
  bool has_pose_ = false;                    ///< a pose stands for the answer
  bool is_searched_ = false;                 ///< by iterations, of `forward`
  std::span<const double> inputs_ = {};      ///< of `inverse`; view into the workspace
  std::optional<AssemblyModes> modes_ = {};  ///< of `forward`, where all are wanted
  std::vector<TraceStep> trace_ = {};
};

void answer_kinematic_track(Context& context);

}  // namespace sinew::inline v1

/// @file arm_statics.hpp
/// The shape of a tendon-driven arm at rest: bends of least energy under tendons that stretch, only pull,
/// and rub. Lengths are those of exact PCC from the sinew library; it shares nothing with the firmware's
/// table. Theory: docs/theory/simulated_arm.md
#pragma once

#include <span>
#include <vector>

#include "sinew/kinematics/serial.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::firmware {

/// What of an arm its file does not say; the values are ours, of an arm as thick as a finger.
struct ArmMaterial {
  double tension_at_limit = 6;    ///< of the one tendon that holds a section bent to its limit [N]
  double stiffness = 3e4;         ///< EA of a tendon [N], where the robot's file does not say
  double outside = 0.25;          ///< its length between motor and arm [m], likewise
  double friction = 0.02;         ///< of a tendon's tension, in each section that it passes
  double rest_at = 1.5;           ///< discs touch where a bend is so many times its limit
  double contact_stiffness = 50;  ///< of touching discs, in bending stiffnesses
};

/// One tendon between its motor and its section's end.
struct Tendon {
  double stiffness = 0;     ///< from its motor on, k [N/m]
  double paid_out = 0;      ///< beyond what the straight arm needs [m]
  bool is_cut = false;      ///< it pulls nothing,
  double rubs_from = 0;     ///< d from which its friction counts [m]
  double friction = 0;      ///< [N], most there can be
  double tension = 0;       ///< at the arm [N]
  double friction_now = 0;  ///< [N], > 0 where it resists becoming longer
};

class ArmStatics {
 public:
  /// Throws std::runtime_error where the robot has more sections than the library solves for.
  ArmStatics(const SerialRobot& robot, const ArmMaterial& material);
  ArmStatics(const ArmStatics&) = delete;
  ArmStatics& operator=(const ArmStatics&) = delete;

  std::vector<Tendon> tendons;  ///< section by section
  std::vector<Bend> bends;      ///< [rad]

  /// From where the bends are to those of least energy. Whether that has moved anything.
  bool settle();

  /// Of bends, with the tendons as they are [J] and, where there is room for it, its derivatives [N m].
  double energy(std::span<const Bend> bends, std::span<double> gradient = {});
  /// What each tendon's way through the arm is longer than through the straight one [m].
  std::span<const double> ways(std::span<const Bend> bends);

  double bending_stiffness(std::size_t section) const { return bending_[section]; }  ///< [N m/rad]
  double friction_share(std::size_t tendon) const { return rubs_[tendon]; }
  double inner_stiffness(std::size_t tendon) const { return inner_[tendon]; }  ///< from the arm's base on
  double outer_stiffness(std::size_t tendon) const { return outer_[tendon]; }  ///< up to there
  int iterations() const { return iterations_; }                               ///< of the last `settle`

 private:
  double energy_of_bending(std::span<const Bend> bends, std::span<double> gradient) const;
  double energy_of_tendons(std::span<const Bend> bends);
  void add_gradient_of_tendons(std::span<double> gradient) const;
  void make_hessian(std::span<const Bend> bends);
  bool step();
  bool update_friction();
  void slide();

  SerialWorkspace work_;
  ArmMaterial material_;
  std::vector<double> bending_, most_, rubs_, inner_, outer_;
  std::vector<double> gradient_, hessian_, newton_, slopes_, stiffness_;
  std::vector<Bend> tried_, before_;
  int iterations_ = 0;
};

}  // namespace sinew::firmware

/// @file faults.hpp
/// What can go wrong, by a line of text each: tendons of a simulated arm, its serial line, its controller.
#pragma once

#include <random>
#include <string>

#include "simulator/controller.hpp"
#include "simulator/simulated_arm.hpp"

namespace sinew::firmware {

class Faults {
 public:
  /// @param arm where there is one
  Faults(Controller& controller, SimulatedArm* arm, std::vector<int> tendons_of_sections)
      : controller_(controller),
        arm_(arm),
        tendons_(std::move(tendons_of_sections)) {}

  /// What a line is answered: `ok`, `? ` and a reason, or what it asked for. Without a newline.
  std::string obey(const std::string& line);
  bool has_quit() const { return has_quit_; }
  /// What the serial line makes of bytes, either way.
  std::string on_line(std::string bytes);

 private:
  std::string obey_arm(const std::string& verb, std::size_t tendon);
  std::string tendon_of(int section, int tendon, std::size_t& index) const;

  Controller& controller_;
  SimulatedArm* arm_;
  std::vector<int> tendons_;
  std::mt19937 random_{1};
  double noise_ = 0;  ///< share of bytes in which a bit is wrong
  bool is_unplugged_ = false, has_quit_ = false;
};

}  // namespace sinew::firmware

/// @file rod_question.hpp
/// One equilibrium of a robot on rods as a question gives it.
#pragma once
#include "query/rods/rods.hpp"

namespace sinew::inline v1 {

struct RodQuestion : Context {
  explicit RodQuestion(const Context& context) : Context(context) {}

  /// @name What was read
  /// @{
  RodQuery at = {};
  RodWants wanted = {};
  std::optional<Until<Spatial>> until = {};
  bool wants_all = false;
  /// @}

  void read();
  void solve();
  void tell();
  void tell_all();

 private:
  void read_forward();
  void read_inverse();

  RodStart start_ = {};  ///< of `inverse`
  Report begun_ = {};    ///< there
  Equilibrium found_ = {};
  std::optional<LoadPath> growth_ = {};
};

}  // namespace sinew::inline v1

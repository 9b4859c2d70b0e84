/// @file handlers.hpp
/// Who answers questions: of each kind of mechanics one object with what it tells, what it lacks, and a
/// handler for each kind of question. session.cpp chooses among them.
#pragma once
#include <span>
#include <string_view>

#include "query/wants.hpp"

namespace sinew::inline v1 {

class RowPlaces;
struct SamplerKind;

using Handler = void (*)(Context&);

/// A field that other robots have in every question that solves, with why these have none.
struct Lack {
  std::string_view field, why;
};

/// One kind of mechanics. A handler that is null: nobody answers that in this version.
struct Handlers {
  std::string_view robots;  ///< as refusals call them
  Wants wants;              ///< what they tell of a configuration
  ByKind<Handler> answers;
  std::span<const Lack> lacks = {};
  /// What computes many rows of a question without asking each; empty `make` where there is nothing quicker.
  SamplerKind (*plan)(Context&, const RowPlaces&) = nullptr;

  constexpr Handler of(Ask ask) const { return answers.of(ask); }
};

extern const Handlers kinematic_handlers;  ///< of legs that bear no load: arcs and rails
extern const Handlers chain_handlers;      ///< of pseudo-rigid chains
extern const Handlers rod_handlers;        ///< of elastic rods
extern const Handlers serial_handlers;     ///< of stacks of arcs, whose tendons' lengths give their shape
extern const Handlers arm_handlers;        ///< of arms that bear loads
extern const Handlers arm_legs_handlers;   ///< of platforms on arms

void describe_platform(Context& context);  ///< of robots with a platform on arcs, rails, chains or rods

}  // namespace sinew::inline v1

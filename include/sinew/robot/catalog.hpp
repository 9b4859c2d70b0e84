/// @file catalog.hpp
/// The closed sets of this build: which kinds of leg exist and which named architectures expand to them.
/// A new robot is a row of `architectures`, or just a file; a new closure or link is a line in `PlanarLegs`.
#pragma once
#include <array>
#include <string_view>
#include <variant>

#include "sinew/leg/chord.hpp"
#include "sinew/leg/leg.hpp"
#include "sinew/leg/strut.hpp"
#include "sinew/link/arc.hpp"
#include "sinew/tendon/pair.hpp"

namespace sinew::inline v0 {

template <class... Ts>
struct TypeList {};

/// Every kind of planar leg.
using PlanarLegs = TypeList<Leg<Planar, Arc, TendonPair, Chord>, Leg<Planar, Arc, TendonPair, Strut>>;

/// A named architecture: legs all alike, evenly around the base and the platform.
struct Architecture {
  std::string_view name;  ///< as the paper writes it
  std::string_view space;
  int legs;
  std::string_view link, closure;  ///< names of the parts of each leg
  std::string_view source;
};

inline constexpr std::array architectures{
    Architecture{"3-RFR", "planar", 3, "arc", "chord", "TDPCR 2.1.1"},
    Architecture{"3-FRR", "planar", 3, "arc", "strut", "TDPCR 2.1.2"},
};

}  // namespace sinew::inline v0

/// @file catalog.hpp
/// The closed sets of this build: which kinds of leg exist and which named architectures expand to them.
/// A new robot is a row of `architectures`, or just a file; a new closure or link is a line in `PlanarLegs`.
#pragma once
#include <array>
#include <string_view>
#include <variant>

#include "leg/chord.hpp"
#include "leg/hinged_strut.hpp"
#include "leg/leg.hpp"
#include "leg/pin.hpp"
#include "leg/rod_leg.hpp"
#include "leg/strut.hpp"
#include "link/arc.hpp"
#include "link/rail.hpp"
#include "link/swivel.hpp"
#include "tendon/pair.hpp"
#include "tendon/slide_drive.hpp"
#include "tendon/swivel_drive.hpp"

namespace sinew::inline v1 {

template <class... Ts>
struct TypeList {};

/// Every kind of planar leg ...
using PlanarLegs =
    TypeList<Leg<Planar, Arc, TendonPair, Chord>, Leg<Planar, Arc, TendonPair, Strut>,
             Leg<Planar, Swivel<Arc>, SwivelDrive, Strut>, Leg<Planar, Swivel<Arc>, SwivelDrive, Pin>>;

/// ... and of spatial leg that closes.
using SpatialLegs =
    TypeList<Leg<Spatial, Arc, TendonPair, Chord>, Leg<Spatial, Rail, SlideDrive, HingedStrut>>;

/// Every kind of leg of a robot that bears load: of rods at least one leg is. Closing legs beside them bear
/// whatever it takes to keep them closed.
template <class List>
struct WithRods;
template <class... Ts>
struct WithRods<TypeList<Ts...>> {
  using type = TypeList<RodLeg, Ts...>;
};
using LoadedLegs = WithRods<SpatialLegs>::type;

/// A named architecture: legs all alike around the base and the platform.
struct Architecture {
  std::string_view name;  ///< as the paper writes it
  std::string_view space;
  int legs;
  std::string_view link, closure;  ///< names of the parts of each leg
  std::string_view source;
  std::string_view summary;
};

inline constexpr std::array architectures{
    Architecture{"3-RFR", "planar", 3, "arc", "chord", "TDPCR 2.1.1",
                 "planar, three tendon-driven links between free revolute joints"},
    Architecture{"3-FRR", "planar", 3, "arc", "strut", "TDPCR 2.1.2",
                 "planar, three tendon-driven links clamped to the base, each with a rigid strut"},
    Architecture{"3-RFRR", "planar", 3, "swivel", "strut", "TDPCR 4.2",
                 "planar, redundant: three tendon-driven links on motors, each with a rigid strut"},
    Architecture{"6-UFS", "spatial", 6, "arc", "chord", "TDPCR 4.1",
                 "spatial, six tendon-driven links between universal and spherical joints"},
    Architecture{
        "3-PRS", "spatial", 3, "rail", "hinged_strut", "3PFS 3.1",
        "spatial, rigid: three carriages on rails, each with a strut on a hinge; it tilts and lifts"},
};

}  // namespace sinew::inline v1

/// @file rod_systems.hpp
/// The mechanisms on rods there are, all of one face: what solves one solves all.
#pragma once
#include "robot/general_system.hpp"
#include "robot/mechanism.hpp"
#include "robot/rod_system.hpp"
#include "robot/tangent_system.hpp"

/// Calls `X` with each of them: one line instantiates a template for all.
#define SINEW_FOR_EACH_ROD_SYSTEM(X)            \
  X(::sinew::Mechanism<::sinew::RodSystem>)     \
  X(::sinew::Mechanism<::sinew::TangentSystem>) \
  X(::sinew::Mechanism<::sinew::GeneralSystem>)

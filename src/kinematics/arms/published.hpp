/// @file published.hpp
/// Equilibria of arms as published codes write them, to meet their numbers. Theory: docs/theory/arm_models.md
#pragma once
#include <span>
#include <string_view>

#include "sinew/kinematics/arm.hpp"
#include "strain/relax.hpp"

namespace sinew::inline v1 {

/// Whether this balance can be asked for of this arm, or why not.
Report fits_balance(const Arm& arm, std::span<const TendonCommand> commands, const ArmLoad& load,
                    const ArmOptions& options);

/// Takes a rod with its loads and holds to a balance other than by energy. Stability is not told.
/// @param warm from the coordinates that stand in it; else from the equilibrium by energy
strain::Relaxed relax_published(const Arm& arm, std::span<const TendonCommand> commands,
                                const ArmOptions& options, const strain::RelaxOptions& relax, bool warm,
                                strain::LoadedRod& rod);

/// Why it did not.
std::string_view published_words(Status status);

}  // namespace sinew::inline v1

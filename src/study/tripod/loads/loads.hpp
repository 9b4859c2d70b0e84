/// @file loads.hpp
/// What loads do to the poses of the flexible tripod, [3PFS] Figs. 14 to 16, Tables 1 and 2: the samples of
/// studies/3pfs-*-loads.yaml in pairs of the same inputs. Theory: docs/theory/tripod_loads.md
#pragma once
#include <array>
#include <string_view>
#include <vector>

#include "study/tripod/loads/printed_tables.hpp"
#include "study/tripod/swept.hpp"

namespace sinew::inline v1::tripod {

struct LoadedGeometry {
  const char *name, *study;
};

/// G1 and G2 are presets, robots/3pfs-*.yaml; the third was fitted to Table 1.
inline constexpr std::array<LoadedGeometry, 3> loaded_geometries{
    {{"G1", "3pfs-g1-loads"}, {"G2", "3pfs-g2-loads"}, {"fitted", "3pfs-fitted-loads"}}};

/// As the studies' axis `rods` counts them: 3 mm of 83 GPa, 4 mm of 83 GPa, 4 mm of 210 GPa.
enum class Rods { thin, thick, thick_steel };

struct LoadCase {
  Rods rods;
  Load load;
  std::size_t step;  ///< of the load; 0: none
};

/// Samples of a case, in the order of their inputs: those of two cases are pairs, row by row.
std::vector<std::size_t> rows_of(const Swept& study, const LoadCase& at);

/// A variable at the same inputs without a load and with it. NaN where there is no equilibrium.
struct LoadedPairs {
  std::vector<double> unloaded, loaded;
  std::vector<double> change() const;
};
LoadedPairs pairs_of(const Swept& study, const LoadCase& at, std::string_view variable);

/// Which of the pairs have the lengths of their rods add up to those of the middle of the cube.
std::vector<std::size_t> middle_layer(const Swept& study);
LoadedPairs at_rows(const LoadedPairs& pairs, std::span<const std::size_t> rows);

/// RMS of the change over the size of the range of the unloaded variable [%]: Tables 1 and 2.
double relative_rms(const LoadedPairs& pairs);

/// Of every load, step and variable.
RmsCells relative_rms(const Swept& study, Rods rods);

}  // namespace sinew::inline v1::tripod

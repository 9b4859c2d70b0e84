/// @file parts.hpp
/// What 3pfs/design is made of: tables, findings, the figure.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "io/figure/figure.hpp"
#include "sinew/io/table.hpp"
#include "study/reproduce.hpp"
#include "study/tripod/design/measures.hpp"

namespace sinew::inline v1::tripod {

/// Where a value is among those of a dimension.
inline std::size_t index_of(const std::vector<double>& values, double wanted) {
  return static_cast<std::size_t>(std::ranges::find(values, wanted) - values.begin());
}

/// Over the height and the pair angle, without load.
void add_dimension_findings(std::vector<Finding>& findings, const Designs& made);

/// Over the radius of the base, and all dimensions beside each other.
void add_lever_findings(std::vector<Finding>& findings, const Designs& made);

/// @param study one of those of diameters, for its tilts
Expected<void> add_load_findings(std::vector<Finding>& findings, std::span<const Loaded> presets,
                                 const Swept& study);

/// Which pair angles keep the tripod near the rigid one, and in which order to choose.
void add_recommendations(std::vector<Finding>& findings, const Designs& made,
                         std::span<const Loaded> presets);

Figure design_figure(const Designs& made, std::span<const Loaded> presets);

}  // namespace sinew::inline v1::tripod

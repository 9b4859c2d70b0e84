/// @file study_items.hpp
/// What `reproduce` makes: items of the study layer, and the one that plans a way in, which is there where
/// planning is built.
#pragma once
#include <vector>

#include "study/reproduce.hpp"
#include "verbs.hpp"

namespace sinew::cli {

inline constexpr StudyItem insertion_item{"lsk/fig12",
                                          "A way into the compressor of an engine, found and checked"};

/// All of them, in the order of the papers.
std::vector<StudyItem> all_items();

/// As `sinew::reproduce`, of any of them.
Expected<Reproduction> reproduce_item(std::string_view id, const std::filesystem::path& out,
                                      const FigureOptions& page);

/// @name Of planning; without it, `not_built`
/// @{
Expected<ItemResult> insertion_result();
int plot_insertion(const Arguments& arguments);  ///< of plot, a scene with --along
/// @}

}  // namespace sinew::cli

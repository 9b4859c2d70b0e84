/// @file reduction.hpp
/// What is kept of a chunk's samples: all of them, or a few sums a cell. As bytes, for the log and for ranks.
#pragma once
#include <vector>

#include "query/batch/sampler.hpp"
#include "sinew/study/study.hpp"
#include "study/sweep/samples.hpp"

namespace sinew::inline v1 {

/// The samples of a chunk as bytes: outputs column after column, then statuses.
void pack_samples(std::span<const double> outputs, std::span<const SampleStatus> statuses,
                  std::vector<std::byte>& bytes);

/// Sums of one reduction over some samples of a cell.
struct CellSum {
  double value = 0;  ///< largest, smallest, sum, or sum of squares
  double count = 0;  ///< of the values in it
};

/// What a chunk adds to its cells: for each cell its CellSum of every reduction.
void pack_cells(const Study& study, const SampleBlock& block, std::vector<std::byte>& bytes);

/// Adds sums of more samples of the same cell.
void add(StudyReduction::Kind kind, CellSum& sum, const CellSum& more);
/// NaN where there were no values.
double value_of(StudyReduction::Kind kind, const CellSum& sum);

}  // namespace sinew::inline v1

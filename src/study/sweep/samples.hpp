/// @file samples.hpp
/// The samples of a study: how they are cut into chunks, and what the axes are at each. Nothing here depends
/// on who computes a chunk, so that one thread, many or a cluster give the same data.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/study/study.hpp"

namespace sinew::inline v1 {

/// A stretch of samples, [first, first + count).
struct Chunk {
  std::size_t first = 0, count = 0;
};

/// Samples cut into chunks of about the same size: of whole cells, what becomes one value of a reduction; of
/// whole rows of a cell that is too large; or of pieces of a row that is.
class Chunks {
 public:
  Chunks() = default;
  /// @param cell samples that belong together; @param row of a path, of which cells have a whole number
  Chunks(std::size_t samples, std::size_t cell, std::size_t row, std::size_t about);

  std::size_t count() const { return count_; }
  Chunk operator[](std::size_t k) const;
  std::size_t largest() const { return rows_ > 0 ? rows_ * row_ : part_; }

 private:
  std::size_t samples_ = 0, row_ = 1, count_ = 0;
  std::size_t rows_ = 1;              ///< a chunk; 0: a row has several
  std::size_t part_ = 0, parts_ = 1;  ///< of a row that is cut: samples of a piece, pieces
};

/// Values of all axes at the samples of a chunk, axis after axis, then those of the derived values. On a path
/// every other row runs backwards, so that neighbours in the list are neighbours on the grid.
void axis_values(const Study& study, const Chunk& chunk, bool snakes, std::span<double> values);

/// Puts what was computed in that order back into the order of the samples.
template <class T>
void unwind(const Chunk& chunk, std::size_t row, std::span<T> values) {
  for (std::size_t begin = row; begin < chunk.count; begin += 2 * row)
    std::reverse(values.begin() + static_cast<std::ptrdiff_t>(begin),
                 values.begin() + static_cast<std::ptrdiff_t>(std::min(begin + row, chunk.count)));
}

/// Samples of a row of the grid; of others 1.
std::size_t row_of(const Study& study);

}  // namespace sinew::inline v1

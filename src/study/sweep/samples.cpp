#include "study/sweep/samples.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "study/sweep/terms.hpp"

namespace sinew::inline v1 {
namespace {

/// A number of its own for each sample and axis, whoever asks for it: the finaliser of SplitMix64 (Steele,
/// Lea, Flood 2014) over a counter.
std::uint64_t scrambled(std::uint64_t seed, std::uint64_t counter) {
  std::uint64_t z = seed * 0xd1342543de82ef95U + (counter + 1) * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

/// In [0, 1).
double uniform(std::uint64_t seed, std::uint64_t counter) {
  return static_cast<double>(scrambled(seed, counter) >> 11U) * 0x1p-53;
}

double random_value(const StudyAxis& axis, std::uint64_t seed, std::uint64_t counter) {
  const double one = uniform(seed, 2 * counter);
  if (axis.kind == StudyAxis::Kind::uniform) return std::lerp(axis.low, axis.high, one);
  const double turn = 2 * std::numbers::pi * uniform(seed, 2 * counter + 1);  // Box and Muller
  return axis.low + axis.high * std::sqrt(-2 * std::log1p(-one)) * std::cos(turn);
}

/// Derived values behind those of the axes.
void derive(const Study& study, std::size_t count, std::span<double> values) {
  if (study.derived.empty()) return;
  const std::size_t axes = study.axes.size();
  std::vector<double> one(study.variable_count());  // of one sample
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t a = 0; a < axes; ++a) one[a] = values[a * count + i];
    for (std::size_t d = 0; d < study.derived.size(); ++d) {
      one[axes + d] = value_of(study.derived[d].is, one);
      values[(axes + d) * count + i] = one[axes + d];
    }
  }
}

}  // namespace

Chunks::Chunks(std::size_t samples, std::size_t cell, std::size_t row, std::size_t about)
    : samples_(samples),
      row_(cell <= about || row <= about ? cell : row) {
  const std::size_t all = samples / row_;
  if (row_ <= about) {
    rows_ = std::max<std::size_t>(1, about / row_);
    count_ = (all + rows_ - 1) / rows_;
    return;
  }
  const std::size_t step = row <= about ? row : 1;  // pieces end where rows do
  rows_ = 0;
  parts_ = (row_ + about - 1) / about;
  part_ = ((row_ + parts_ - 1) / parts_ + step - 1) / step * step;
  parts_ = (row_ + part_ - 1) / part_;
  count_ = all * parts_;
}

Chunk Chunks::operator[](std::size_t k) const {
  if (rows_ > 0) {
    const std::size_t size = rows_ * row_, first = k * size;
    return {first, std::min(size, samples_ - first)};
  }
  const std::size_t begin = k % parts_ * part_;
  return {k / parts_ * row_ + begin, std::min(part_, row_ - begin)};
}

void axis_values(const Study& study, const Chunk& chunk, bool snakes, std::span<double> values) {
  const std::size_t axes = study.axes.size(), row = row_of(study);
  for (std::size_t i = 0; i < chunk.count; ++i) {
    const std::size_t in_row = i % row, length = std::min(row, chunk.count - (i - in_row));
    const bool is_back = snakes && i / row % 2 == 1;
    std::size_t k = chunk.first + (is_back ? i - in_row + (length - 1 - in_row) : i);
    for (std::size_t a = axes; a-- > 0;) {
      const StudyAxis& axis = study.axes[a];
      double& value = values[a * chunk.count + i];
      if (study.sampling == Study::Sampling::random) {
        value = random_value(axis, study.seed, k * axes + a);
      } else if (study.sampling == Study::Sampling::listed) {
        value = axis.values[k];
      } else {
        value = axis.values[k % axis.values.size()];
        k /= axis.values.size();
      }
    }
  }
  derive(study, chunk.count, values);
}

std::size_t row_of(const Study& study) {
  return study.sampling == Study::Sampling::grid ? study.axes.back().values.size() : 1;
}

}  // namespace sinew::inline v1

#include "study/sweep/reduction.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace sinew::inline v1 {
namespace {

using Kind = StudyReduction::Kind;

template <class T>
void append(std::span<const T> values, std::vector<std::byte>& bytes) {
  const auto raw = std::as_bytes(values);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

CellSum one(Kind kind, double value) { return {kind == Kind::rms ? value * value : value, 1}; }

CellSum sum_of(const StudyReduction& reduction, const SampleBlock& block, std::size_t first,
               std::size_t count) {
  CellSum sum;
  for (std::size_t k = first; k < first + count; ++k) {
    if (block.statuses[k] == left_out) continue;
    const double value = reduction.kind == Kind::part ? (block.statuses[k] == converged ? 1.0 : 0.0)
                                                      : block.output(reduction.output, k);
    const bool counts = reduction.kind == Kind::part || block.statuses[k] == converged;
    if (counts && std::isfinite(value)) add(reduction.kind, sum, one(reduction.kind, value));
  }
  return sum;
}

}  // namespace

void pack_samples(std::span<const double> outputs, std::span<const SampleStatus> statuses,
                  std::vector<std::byte>& bytes) {
  bytes.clear();
  append<double>(outputs, bytes);
  append<SampleStatus>(statuses, bytes);
}

void pack_cells(const Study& study, const SampleBlock& block, std::vector<std::byte>& bytes) {
  const std::size_t cell = std::min(study.reduced_samples(), block.count);
  std::vector<CellSum> sums;
  for (std::size_t first = 0; first < block.count; first += cell)
    for (const StudyReduction& reduction : study.reductions)
      sums.push_back(sum_of(reduction, block, first, cell));
  bytes.clear();
  append<CellSum>(sums, bytes);
}

void add(Kind kind, CellSum& sum, const CellSum& more) {
  if (more.count == 0) return;
  if (sum.count == 0)
    sum.value = more.value;
  else if (kind == Kind::max)
    sum.value = std::max(sum.value, more.value);
  else if (kind == Kind::min)
    sum.value = std::min(sum.value, more.value);
  else
    sum.value += more.value;
  sum.count += more.count;
}

double value_of(Kind kind, const CellSum& sum) {
  if (sum.count == 0) return std::numeric_limits<double>::quiet_NaN();
  if (kind == Kind::max || kind == Kind::min) return sum.value;
  return kind == Kind::rms ? std::sqrt(sum.value / sum.count) : sum.value / sum.count;
}

}  // namespace sinew::inline v1

#include "study/sweep/left_out.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/base/numbers.hpp"
#include "study/sweep/terms.hpp"

namespace sinew::inline v1 {
namespace {

/// Of the size of what is summed: some thousand roundings.
constexpr double rounding = 1e-12;

bool is_limited(const StudyDerived& derived) {
  return std::isfinite(derived.low) || std::isfinite(derived.high);
}

class Sieve {
 public:
  Sieve(const Study& study, Sampler sampler)
      : study_(study),
        sampler_(std::move(sampler)),
        one_(study.variable_count()) {}

  void operator()(const SampleBlock& block) {
    choose(block);
    const std::size_t n = kept_.size();
    if (n == block.count) return sampler_(block);
    *block.done += block.count - n;
    std::ranges::fill(block.statuses, left_out);
    for (std::size_t o = 0; o < block.outputs.size(); ++o)
      for (std::size_t k = 0; k < block.count; ++k) block.output(o, k) = not_a_number;
    if (n == 0) return;
    axes_.resize(one_.size() * n);
    outputs_.resize(study_.outputs.size() * n);
    statuses_.assign(n, converged);
    for (std::size_t a = 0; a < one_.size(); ++a)
      for (std::size_t k = 0; k < n; ++k) axes_[a * n + k] = block.input(a, kept_[k]);
    place_columns<const double>(axes_, n, inputs_of_kept_);
    place_columns<double>(outputs_, n, outputs_of_kept_);
    sampler_({n, inputs_of_kept_, outputs_of_kept_, statuses_, block.done, block.stop});
    for (std::size_t k = 0; k < n; ++k) block.statuses[kept_[k]] = statuses_[k];
    for (std::size_t o = 0; o < study_.outputs.size(); ++o)
      for (std::size_t k = 0; k < n; ++k) block.output(o, kept_[k]) = outputs_[o * n + k];
  }

 private:
  void choose(const SampleBlock& block) {
    kept_.clear();
    for (std::size_t k = 0; k < block.count; ++k) {
      for (std::size_t a = 0; a < one_.size(); ++a) one_[a] = block.input(a, k);
      if (!is_left_out(study_, one_)) kept_.push_back(k);
    }
  }

  const Study& study_;
  Sampler sampler_;
  std::vector<double> one_;  ///< sample
  std::vector<std::size_t> kept_;
  std::vector<double> axes_, outputs_;  ///< of what is kept
  InputColumns inputs_of_kept_;
  OutputColumns outputs_of_kept_;
  std::vector<SampleStatus> statuses_;
};

}  // namespace

bool is_left_out(const Study& study, std::span<const double> values) {
  for (std::size_t d = 0; d < study.derived.size(); ++d) {
    const StudyDerived& derived = study.derived[d];
    const double value = values[study.axes.size() + d];
    if (value >= derived.low && value <= derived.high) continue;
    const double margin = rounding * size_of(derived.is, values);
    if (!(value >= derived.low - margin && value <= derived.high + margin)) return true;
  }
  return false;
}

Sampler without_left_out(const Study& study, Sampler sampler) {
  if (std::ranges::none_of(study.derived, is_limited)) return sampler;
  // std::function copies what it holds
  return [sieve = std::make_shared<Sieve>(study, std::move(sampler))](const SampleBlock& block) {
    (*sieve)(block);
  };
}

}  // namespace sinew::inline v1

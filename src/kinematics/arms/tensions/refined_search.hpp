/// @file refined_search.hpp
/// Searches for tensions by coarse polynomials, then by finer ones.
#pragma once
#include <memory>
#include <vector>

#include "kinematics/arms/tensions/tension_search.hpp"

namespace sinew::inline v1 {

/// A search at polynomials that find the way, then again from its end at those that its end needs.
class RefinedSearch {
 public:
  RefinedSearch() = default;
  RefinedSearch(const RefinedSearch&) = delete;
  RefinedSearch& operator=(const RefinedSearch&) = delete;
  virtual ~RefinedSearch() = default;

  /// What is searched: at the polynomials that find the way, or at those that the last answer has.
  virtual std::unique_ptr<PulledBody> body(bool is_first) = 0;
  /// From the body's equilibrium, which was brought back: the answer, at polynomials that are fine enough.
  virtual Report refine(const std::vector<double>& tensions) = 0;
  /// Whether what is off the target is refined, too.
  virtual bool refines_nearest() const = 0;
  /// The body's equilibrium as the search has it, which was brought back.
  virtual Report as_found(PulledBody& body, const std::vector<double>& tensions) = 0;

  /// Its residual is what the body's tip is off.
  Report run(const ArmTarget& target, TensionSearch search);
};

}  // namespace sinew::inline v1

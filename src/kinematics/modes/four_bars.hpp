/// Two legs and the platform between them are a chain of four bars from anchor to anchor: it closes only if
/// no bar is longer than the other three together.
#pragma once
#include <span>

#include "leg/platform_constraint.hpp"
#include "sinew/solve/report.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {

/// True, with the reason and `unreachable`, where two legs prove that no pose exists.
template <int D>
bool are_torn(std::span<const PlatformConstraint<D>> legs, Report& report) {
  for (std::size_t j = 1; j < legs.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) {
      const PlatformConstraint<D>&a = legs[i], &b = legs[j];
      const double base = (b.anchor - a.anchor).norm(), bar = (b.platform_point - a.platform_point).norm();
      const double longest = std::max({base, bar, a.distance, b.distance});
      const double excess = 2 * longest - (base + bar + a.distance + b.distance);
      if (!(excess > 1e-12 * longest)) continue;
      report.status = Status::unreachable;
      report.message.append("no pose closes legs[");
      append_number(report.message, static_cast<int>(i));
      report.message.append("] and legs[");
      append_number(report.message, static_cast<int>(j));
      report.message.append("] together: with these inputs a gap of ");
      append_mm(report.message, excess);
      report.message.append(" always remains");
      return true;
    }
  return false;
}

}  // namespace sinew::inline v1

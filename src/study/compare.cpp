#include "study/compare.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace sinew::inline v1::compare {

std::vector<std::string> provenance(std::string_view id, std::string_view what, std::string_view robot) {
  return {fmt::format("sinew {}, study {}: {}", version(), id, what), std::string(robot)};
}

std::string number(double value) { return fmt::format("{:.6g}", value); }

std::string small(double value) { return value == 0 ? "0" : fmt::format("{:.1e}", value); }

Finding printed(std::string quantity, double paper, double ours, const char* unit) {
  const double difference = ours - paper;
  const bool same = std::abs(difference) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(paper);
  return {std::move(quantity), fmt::format("{} {}", paper, unit), fmt::format("{} {}", number(ours), unit),
          small(difference), same ? "agrees" : "differs"};
}

Finding given(std::string quantity, std::string paper, std::string ours, double off, double bound,
              const char* unit) {
  return {std::move(quantity), std::move(paper), std::move(ours),
          fmt::format("{}{}{} at most", small(off), *unit ? " " : "", unit),
          off <= bound ? "agrees" : "differs"};
}

Finding within(std::string quantity, std::string reference, std::string ours, double off, double tolerance,
               const char* unit) {
  return {std::move(quantity), std::move(reference), std::move(ours),
          fmt::format("{}, tolerance {:g}{}{}", small(off), tolerance, *unit ? " " : "", unit),
          off <= tolerance ? "agrees" : "differs"};
}

Finding claimed(std::string quantity, std::string paper, std::string ours, double off, double bound,
                const char* unit) {
  Finding finding = given(std::move(quantity), std::move(paper), std::move(ours), off, bound, unit);
  finding.verdict = off <= bound ? "holds" : "fails";
  return finding;
}

}  // namespace sinew::inline v1::compare

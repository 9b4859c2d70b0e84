#include "sinew/solve/report.hpp"

#include <fmt/format.h>

namespace sinew::inline v1 {

std::string_view to_string(Status status) noexcept {
  switch (status) {
    case Status::unreachable:
      return "unreachable";
    case Status::left_domain:
      return "left_domain";
    case Status::slack:
      return "slack";
    case Status::singular:
      return "singular";
    case Status::stalled:
      return "stalled";
    case Status::iteration_limit:
      return "iteration_limit";
    case Status::unstable:
      return "unstable";
    case Status::converged:
      return "converged";
    case Status::stopped:
      return "stopped";
    case Status::bad_input:
      return "bad_input";
    case Status::unsupported:
      return "unsupported";
  }
  return "unknown";
}

std::string to_string(const Report& report) {
  std::string text(to_string(report.status));
  if (report.iterations > 0) {
    text += fmt::format(" {} {} iteration{}", report.ok() ? "in" : "after", report.iterations,
                        report.iterations == 1 ? "" : "s");
  }
  const bool is_measured = report.ok() || report.iterations > 0 || report.residual > 0;
  if (is_measured) text += fmt::format(", residual {:.1e}", report.residual);
  if (!report.message.empty()) text += fmt::format(": {}", report.message.view());
  return text;
}

}  // namespace sinew::inline v1

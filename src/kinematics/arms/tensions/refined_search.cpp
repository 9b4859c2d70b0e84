#include "kinematics/arms/tensions/refined_search.hpp"

#include <fmt/format.h>

#include "kinematics/arms/tensions/target_rows.hpp"

namespace sinew::inline v1 {
namespace {

/// Searches, each by the polynomials that the end of the one before needed [1]: it begins so near its end
/// that more are only asked for where finer polynomials go on moving the tip.
constexpr int most_refined_searches = 4;
/// Equilibria and their Newton's steps of a search that is made again [1]: it has a few steps to go.
constexpr int most_work_again = 1000;

/// Of a search that ended without an equilibrium.
Report without_equilibrium(const FoundTensions& found, const TensionSearch& search, int iterations) {
  const std::string why =
      found.has_begun
          ? fmt::format("the search for tensions lost the equilibrium of the {} on its way", search.what)
          : fmt::format(
                "the search for tensions has nowhere to begin: of {} first tensions, none at all and "
                "some of each, none holds the {} under these loads",
                search.starts, search.what);
  return {Status::stalled, iterations, 0,
          FixedText<240>(why + "; give a start, where others hold it, or less load")};
}

}  // namespace

Report RefinedSearch::run(const ArmTarget& target, TensionSearch search) {
  int iterations = 0;
  Report report;
  bool is_confirmed = true;
  for (int round = 0; round < most_refined_searches; ++round) {
    const std::unique_ptr<PulledBody> searched = body(round == 0);
    const FoundTensions found = search_tensions(target, search, *searched);
    iterations += found.report.iterations;
    const Status status = found.report.status;
    if (status == Status::bad_input || status == Status::unsupported || status == Status::stopped)
      return found.report;
    if (!(found.report.residual < error_of_none)) return without_equilibrium(found, search, iterations);
    searched->bring_back();
    const bool is_near = found.report.residual <= search.precision,
               is_far = found.report.residual > far_multiple * search.precision;
    report = is_near || refines_nearest() ? refine(found.tensions) : as_found(*searched, found.tensions);
    is_confirmed = report.is_solved() || report.status == Status::stopped || !is_far;
    if (!is_confirmed) {
      searched->bring_back();
      report = as_found(*searched, found.tensions);
    }
    report.iterations = iterations;
    if (!report.is_solved()) return report;
    report.residual = off_target(target, searched->tip(), search.length);
    if (searched->last_tensions().empty()) return report;  // it does not hold, and none goes on from it
    if (!is_near || report.residual <= search.precision) break;
    search.from_last = true;
    search.starts = 1;
    search.most_work = most_work_again;
  }
  if (report.residual > far_multiple * search.precision) {
    const std::string up_to = search.asked > 0 ? fmt::format(" up to {:.4g} N", search.asked) : std::string();
    const std::string_view by = is_confirmed ? "" : ", by coarse polynomials that finer ones do not confirm";
    report.status = Status::unreachable;
    report.message = FixedText<240>(fmt::format(
        "no tensions{} were found that take the {} there; the nearest is off by {:.2e} of {} length or rad{}",
        up_to, search.what, report.residual, search.whose, by));
  }
  return report;
}

}  // namespace sinew::inline v1

#include "kinematics/arms/inverse_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/at.hpp"

namespace sinew::inline v1 {
namespace {

/// What the tip is off, and its rates by tensions: rows of places over the arm's length and of angles.
struct Rows {
  std::vector<double> off, J;  ///< J: rows × tendons
};

/// Twist in base axes from the tip to the target, of what the target gives.
std::vector<double> tip_off(const ArmTarget& target, const SE3<double>& tip, double length) {
  std::vector<double> off;
  if (target.position)
    for (std::size_t i = 0; i < 3; ++i)
      off.push_back(((*target.position)[i] - tip.p[static_cast<int>(i)]) / length);
  if (target.quaternion) {
    const SO3<double> wanted = SE3<double>::from({{0, 0, 0}, *target.quaternion}).R;
    const Vec3<double> turn = wanted.compose(tip.R.inverse()).log();
    for (int i = 0; i < 3; ++i) off.push_back(turn[i]);
  } else if (target.direction) {
    Vec3<double> to((*target.direction)[0], (*target.direction)[1], (*target.direction)[2]);
    to /= to.norm();
    const Vec3<double> z = tip.rotate({0, 0, 1});
    Vec3<double> axis = cross(z, to);
    const double sine = axis.norm(), angle = std::atan2(sine, dot(z, to));
    if (sine > 1e-12)
      axis *= angle / sine;
    else if (angle > 1)
      axis = tip.rotate({angle, 0, 0});
    // the two turns across the axis
    const Vec3<double> x = tip.rotate({1, 0, 0}), y = tip.rotate({0, 1, 0});
    off.push_back(dot(axis, x));
    off.push_back(dot(axis, y));
  }
  return off;
}

Rows rows_of(const ArmTarget& target, const SE3<double>& tip, const std::vector<double>& J, double length) {
  Rows rows;
  rows.off = tip_off(target, tip, length);
  const std::size_t m = J.size() / 6;
  const auto add = [&](const Vec3<double>& by, std::size_t first, double scale) {
    for (std::size_t k = 0; k < m; ++k) {
      double sum = 0;
      for (std::size_t i = 0; i < 3; ++i) sum += by[static_cast<int>(i)] * J[(first + i) * m + k];
      rows.J.push_back(scale * sum);
    }
  };
  if (target.position)
    for (int i = 0; i < 3; ++i) add(Vec3<double>(i == 0, i == 1, i == 2), 0, 1 / length);
  if (target.quaternion)
    for (int i = 0; i < 3; ++i) add(Vec3<double>(i == 0, i == 1, i == 2), 3, 1);
  else if (target.direction) {
    add(tip.rotate({1, 0, 0}), 3, 1);
    add(tip.rotate({0, 1, 0}), 3, 1);
  }
  return rows;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

/// Of all 0 ≤ x ≤ most that make A x = b as nearly as can be the one nearest to `centre`: an active set on
/// (AᵀA + small) x = Aᵀb + small centre.
std::vector<double> bounded_once(const std::vector<double>& A, const std::vector<double>& b,
                                 const std::vector<double>& centre, double most) {
  const std::size_t m = centre.size();
  double size = 0;
  for (const double a : A) size += a * a;
  const double small = 1e-7 * size / static_cast<double>(m) + 1e-300;
  std::vector<double> normal(m * m, 0.0), side(m, 0.0), x(m, 0.0);
  for (std::size_t i = 0; i < m; ++i) {
    side[i] = small * centre[i];
    for (std::size_t r = 0; r < b.size(); ++r) side[i] += A[r * m + i] * b[r];
    for (std::size_t j = 0; j < m; ++j)
      for (std::size_t r = 0; r < b.size(); ++r) normal[i * m + j] += A[r * m + i] * A[r * m + j];
    normal[i * m + i] += small;
  }
  enum class At { low, free, high };
  std::vector<At> state(m, At::free);
  for (int round = 0; round < 100; ++round) {
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < m; ++i)
      if (state[i] == At::free) free.push_back(i);
    const std::size_t n = free.size();
    std::vector<double> small_matrix(n * n), right(n), found(n);
    for (std::size_t i = 0; i < n; ++i) {
      right[i] = side[free[i]];
      for (std::size_t j = 0; j < m; ++j)
        if (state[j] == At::high) right[i] -= normal[free[i] * m + j] * most;
      for (std::size_t j = 0; j < n; ++j) small_matrix[i * n + j] = normal[free[i] * m + free[j]];
    }
    // Cholesky's method
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t j = 0; j < k; ++j)
        small_matrix[k * n + k] -= small_matrix[k * n + j] * small_matrix[k * n + j];
      small_matrix[k * n + k] = std::sqrt(std::max(small_matrix[k * n + k], 1e-300));
      for (std::size_t i = k + 1; i < n; ++i) {
        for (std::size_t j = 0; j < k; ++j)
          small_matrix[i * n + k] -= small_matrix[i * n + j] * small_matrix[k * n + j];
        small_matrix[i * n + k] /= small_matrix[k * n + k];
      }
    }
    found = right;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) found[i] -= small_matrix[i * n + j] * found[j];
      found[i] /= small_matrix[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t j = i + 1; j < n; ++j) found[i] -= small_matrix[j * n + i] * found[j];
      found[i] /= small_matrix[i * n + i];
    }
    bool changed = false;
    for (std::size_t i = 0; i < m; ++i) x[i] = state[i] == At::high ? most : 0;
    for (std::size_t i = 0; i < n; ++i) {
      x[free[i]] = found[i];
      if (found[i] < 0) state[free[i]] = At::low, changed = true;
      if (found[i] > most) state[free[i]] = At::high, changed = true;
    }
    if (changed) continue;
    std::size_t worst = m;
    double gain = 1e-12 * size;
    for (std::size_t i = 0; i < m; ++i) {
      if (state[i] == At::free) continue;
      double slope = side[i];
      for (std::size_t j = 0; j < m; ++j) slope -= normal[i * m + j] * x[j];
      if (state[i] == At::high) slope = -slope;
      if (slope > gain) gain = slope, worst = i;
    }
    if (worst == m) break;
    state[worst] = At::free;
  }
  for (double& value : x) value = std::clamp(value, 0.0, most);
  return x;
}

/// The same without what the weight of the centre leaves of A x − b: it is taken back.
std::vector<double> bounded_least_squares(const std::vector<double>& A, const std::vector<double>& b,
                                          const std::vector<double>& centre, double most) {
  const std::size_t m = centre.size();
  std::vector<double> asked = b, x;
  for (int round = 0; round < 4; ++round) {
    x = bounded_once(A, asked, centre, most);
    for (std::size_t r = 0; r < b.size(); ++r) {
      double left = b[r];
      for (std::size_t i = 0; i < m; ++i) left -= A[r * m + i] * x[i];
      asked[r] += left;
    }
  }
  return x;
}

double squares(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum;
}

}  // namespace

std::vector<TendonCommand> as_commands(const std::vector<double>& tensions) {
  std::vector<TendonCommand> commands;
  for (const double tension : tensions) commands.push_back({TendonHeld::tension, tension});
  return commands;
}

double usual_tension(const Arm& arm) {
  double least = 1e300;
  for (std::size_t m = 0; m < arm.sections.size(); ++m)
    for (const ArmTendon& tendon : arm.tendons) {
      if (tendon.section() != static_cast<int>(m)) continue;
      const ArmSection& section = arm.sections[m];
      least = std::min(least, section.start.bending_x / (section.length * tendon.routes[m].start_radius));
    }
  return least;
}

double most_tension(const ArmInverseOptions& options, double usual) {
  constexpr double unbounded = 1e3;  // usual tensions: an arm that is pulled so hard is bent to a point
  return options.most_tension > 0 ? options.most_tension : unbounded * usual;
}

std::string_view target_misfit(const ArmTarget& target) {
  if (!target.position && !target.direction && !target.quaternion) return "the target is empty";
  if (target.direction && target.quaternion) return "the target has a direction and a quaternion; keep one";
  double sum = 0;
  if (target.position)
    for (const double x : *target.position) sum += x;
  if (target.direction) {
    double square = 0;
    for (const double x : *target.direction) square += x * x;
    if (!(square > 0)) return "the direction has no length";
    sum += square;
  }
  if (target.quaternion) {
    double square = 0;
    for (const double x : *target.quaternion) square += x * x;
    if (!(square > 0)) return "the quaternion has no length";
    sum += square;
  }
  if (!std::isfinite(sum)) return "the target is not finite";
  return {};
}

double off_target(const ArmTarget& target, const SE3<double>& tip, double length) {
  return largest(tip_off(target, tip, length));
}

namespace {

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
  for (int round = 0; round < 4; ++round) {
    const std::unique_ptr<PulledBody> searched = body(round == 0);
    const FoundTensions found = search_tensions(target, search, *searched);
    iterations += found.report.iterations;
    const Status status = found.report.status;
    if (status == Status::bad_input || status == Status::unsupported || status == Status::stopped)
      return found.report;
    if (!(found.report.residual < 1e300)) return without_equilibrium(found, search, iterations);
    searched->bring_back();
    const bool is_near = found.report.residual <= search.precision,
               is_far = found.report.residual > 10 * search.precision;
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
    search.most_work = 1000;
  }
  if (report.residual > 10 * search.precision) {
    const std::string up_to = search.asked > 0 ? fmt::format(" up to {:.4g} N", search.asked) : std::string();
    const std::string_view by = is_confirmed ? "" : ", by coarse polynomials that finer ones do not confirm";
    report.status = Status::unreachable;
    report.message = FixedText<240>(fmt::format(
        "no tensions{} were found that take the {} there; the nearest is off by {:.2e} of {} length or rad{}",
        up_to, search.what, report.residual, search.whose, by));
  }
  return report;
}

FoundTensions search_tensions(const ArmTarget& target, const TensionSearch& search, PulledBody& body) {
  FoundTensions best;
  best.report.residual = 1e300;
  const std::size_t m = search.tendons;
  const double usual = search.usual, most = search.most;
  constexpr double near = 1e-3;  // of the length, or rad: what a step along the target may be off
  int iterations = 0, spent = 0;
  const auto pull = [&](const std::vector<double>& tensions, bool from_last) {
    const Report report = body.pull(tensions, from_last);
    spent += 1 + report.iterations;
    return report;
  };
  const auto error_at = [&] { return off_target(target, body.tip(), search.length); };
  for (int start = 0;
       start < search.starts && best.report.residual > search.precision && spent < search.most_work;
       ++start) {
    std::vector<double> tensions(m, 0.0);
    // every tendon in turn, then pairs of neighbours further on
    if (start > 0)
      for (std::size_t i = 0; i < m; ++i)
        if ((i * 7 + static_cast<std::size_t>(start) * 5) % m < 1 + m / 3)
          tensions[i] = std::min(most, usual * (0.4 + 0.15 * start));
    const bool from_last = start == 0 && search.from_last;
    if (const auto last = body.last_tensions(); from_last && !last.empty())
      for (std::size_t i = 0; i < m; ++i) tensions[i] = std::clamp(last[i], 0.0, most);
    Report report = pull(tensions, from_last);
    if (report.status == Status::bad_input || report.status == Status::stopped ||
        report.status == Status::unsupported) {
      best.report = report;
      best.tensions = tensions;
      return best;
    }
    if (!report.is_solved()) continue;
    best.has_begun = true;
    double error = error_at(), radius = 0.5 * usual, longest_before = 1e300;
    // To the target by the nearest tensions; along it to the least; and to the target again, exactly.
    enum class Way { there, least, exact } way = Way::there;
    for (int k = 0; k < 100 && spent < search.most_work; ++k, ++iterations) {
      if (way == Way::there && error < near) way = Way::least, radius = std::max(radius, 0.1 * usual);
      if (way == Way::exact && error <= search.precision) break;
      std::vector<double> J;
      if (!body.rates(J)) break;
      const Rows rows = rows_of(target, body.tip(), J, search.length);
      std::vector<double> b = rows.off;
      for (std::size_t r = 0; r < b.size(); ++r)
        for (std::size_t i = 0; i < m; ++i) b[r] += rows.J[r * m + i] * tensions[i];
      const bool least = way == Way::least;
      std::vector<double> next =
          bounded_least_squares(rows.J, b, least ? std::vector<double>(m, 0.0) : tensions, most);
      double longest = 0;
      for (std::size_t i = 0; i < m; ++i) longest = std::max(longest, std::abs(next[i] - tensions[i]));
      if (least && longest < 1e-4 * usual) {
        way = Way::exact;
        continue;
      }
      if (longest < 1e-13 * usual) break;
      const double share = std::min(1.0, radius / longest);
      for (std::size_t i = 0; i < m; ++i) next[i] = tensions[i] + share * (next[i] - tensions[i]);
      const Report trial = pull(next, true);
      if (trial.status == Status::stopped) {
        best.report = trial;
        best.tensions = tensions;
        return best;
      }
      const double after = trial.is_solved() ? error_at() : 1e300;
      // Along the target the sum may rise a little again where that leads back to it.
      const bool leads_back =
          after < 0.3 * error || (after < 10 * search.precision && longest < longest_before);
      if (least ? after < near && (squares(next) < squares(tensions) || leads_back) : after < error) {
        longest_before = longest;
        if (share < 1) radius *= 2;
        tensions = next;
        report = trial;
        error = after;
      } else {
        radius = 0.4 * std::min(radius, longest);
        report = pull(tensions, true);
        if (!report.is_solved() && report.status != Status::stopped) {  // the way back gives way, too
          report = pull(tensions, false);
          if (report.is_solved()) error = error_at();
        }
        if (report.status == Status::stopped) {
          best.report = report;
          best.tensions = tensions;
          return best;
        }
        if (!report.is_solved()) break;
        if (radius < 1e-8 * usual) break;
        if (least && radius < 1e-3 * usual) way = Way::exact, radius = usual;
      }
    }
    if (error < best.report.residual && report.is_solved()) {
      best.tensions = tensions;
      best.report = report;
      best.report.residual = error;
      body.keep();
    }
  }
  best.report.iterations = iterations;
  return best;
}

}  // namespace sinew::inline v1

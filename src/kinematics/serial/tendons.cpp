/// Bends and tendon changes of serial robots, by the kernel's maps.
#include <algorithm>
#include <cmath>

#include "sinew/base/numbers.hpp"
#include "sinew/kernel/tendon_state.h"
#include "sinew/kinematics/serial.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {
namespace {

using Pull = kernel::Pull<double>;

kernel::Bend<double> kernel_bend(const Bend& bend) { return {bend.x(), bend.y()}; }

Pull pull_of(const SerialWorkspace& work, std::size_t m, const Bend& bend, kernel::Model model) {
  return kernel::pull(model, work.maps[m], kernel_bend(bend), work.extensions[m]);
}

void name_section(FixedText<240>& text, std::size_t section) {
  text = {};
  text.append("sections[");
  append_number(text, static_cast<int>(section));
  text.append("]");
}

/// The first tendon that has as much as the extreme one; rounding does not choose between equals.
int first_as(std::span<const double> slack, double extreme) {
  const auto is_as = [&](double one) { return std::abs(one - extreme) <= 1e-9 * std::abs(extreme); };
  return static_cast<int>(std::ranges::find_if(slack, is_as) - slack.begin());
}

void say_tendon(Report& report, Status status, std::size_t section, int tendon, double length,
                std::string_view what) {
  report.status = status;
  name_section(report.message, section);
  report.message.append(": tendon ");
  append_number(report.message, tendon);
  report.message.append(" is ");
  append_mm(report.message, length);
  report.message.append(what);
}

void set_extensions(const Section& at_rest, std::size_t m, double extension, SerialWorkspace& work) {
  work.extensions[m] = extension;
  work.sections[m].joint = at_rest.extended(extension).joint;
}

/// What the tendons of a section say, if it is worse than what was found before.
void report_tendons(std::size_t m, std::span<const double> slack, double tolerance, Report& report) {
  const auto [least, most] = std::ranges::minmax(slack);
  if (kernel::tendon_state(least, tolerance) == kernel::TendonState::over_tensioned)
    say_tendon(
        report, Status::unreachable, m, first_as(slack, least), -least,
        " too short where its section's tendons are met best: they contradict one another (over-tensioned)");
  else if (report.ok() && kernel::tendon_state(most, tolerance) == kernel::TendonState::slack)
    say_tendon(report, Status::slack, m, first_as(slack, most), most,
               " longer than the bend needs: it is slack, and the bend not determined");
}

/// Whether joints can have chords of the section's pull: |2 sin(β/2)| ≤ 2, a little more by rounding.
bool has_arcs(const Section& section, const kernel::Section<double>& map, double x, double y) {
  const double a = x * map.per_gain * map.half, b = y * map.per_gain * map.half, whole = 1 + 1e-12;
  return section.is_twin() ? std::abs(a) <= whole && std::abs(b) <= whole : std::hypot(a, b) <= whole;
}

}  // namespace

void set_extensions(const SerialRobot& robot, std::span<const double> extensions, SerialWorkspace& work) {
  if (!work.fits(robot) || !work.fits(extensions))
    return void(std::ranges::fill(work.extensions, not_a_number));
  for (std::size_t m = 0; m < extensions.size(); ++m)
    set_extensions(robot.sections[m], m, extensions[m], work);
}

void tendon_changes(std::span<const Bend> bends, kernel::Model model, SerialWorkspace& work) {
  if (!work.fits(bends)) return void(std::ranges::fill(work.changes, not_a_number));
  Pull sum{};
  auto direction = work.directions.begin();
  auto change = work.changes.begin();
  for (std::size_t m = 0; m < work.maps.size(); ++m) {
    sum = sum + pull_of(work, m, bends[m], model);
    for (int i = 0; i < work.tendons[m]; ++i) *change++ = kernel::tendon_change(sum, *direction++);
  }
}

kernel::Pull<double> pull_of_all(std::span<const Bend> bends, kernel::Model model,
                                 const SerialWorkspace& work) {
  if (!work.fits(bends)) return {not_a_number, not_a_number, not_a_number};
  Pull sum{};
  for (std::size_t m = 0; m < work.maps.size(); ++m) sum = sum + pull_of(work, m, bends[m], model);
  return sum;
}

void add_slack(std::span<const double> more, SerialWorkspace& work) {
  if (!work.fits(more)) return void(std::ranges::fill(work.changes, not_a_number));
  auto change = work.changes.begin();
  for (std::size_t m = 0; m < work.maps.size(); ++m)
    for (int i = 0; i < work.tendons[m]; ++i) *change++ += more[m];
}

double tendon_tolerance(const SerialRobot& robot) {
  return std::max(robot.tolerance, 1e-12 * robot.length());
}

namespace {

/// What a limit says of a section, if no section before it was beyond one.
void check_extension(const Section& section, std::size_t m, double extension, Report& report) {
  const double slop = 1e-12 * section.arc_length();
  const bool is_long = extension > section.max_extension + slop;
  if (!report.ok() || !(is_long || extension < section.min_extension - slop)) return;
  report.status = Status::left_domain;
  name_section(report.message, m);
  report.message.append(" is ");
  append_mm(report.message, std::abs(extension));
  report.message.append(extension > 0 ? " longer than at rest, its limit is "
                                      : " shorter than at rest, its limit is ");
  append_mm(report.message, std::abs(is_long ? section.max_extension : section.min_extension));
}

}  // namespace

Report check_limits(const SerialRobot& robot, std::span<const Bend> bends,
                    std::span<const double> extensions) {
  Report report;
  if (bends.size() > robot.sections.size() || (!extensions.empty() && extensions.size() != bends.size())) {
    report.status = Status::bad_input;
    report.message.append("bends and extensions need one value a section of the robot");
    return report;
  }
  for (std::size_t m = 0; m < bends.size() && report.ok(); ++m) {
    const Section& section = robot.sections[m];
    const double bend = section.is_twin() ? bends[m].lpNorm<Eigen::Infinity>() : bends[m].norm();
    if (!extensions.empty()) check_extension(section, m, extensions[m], report);
    if (!report.ok() || bend <= section.limit * (1 + 1e-12)) continue;
    report.status = Status::left_domain;
    name_section(report.message, m);
    report.message.append(section.is_twin() ? " bends its joints by " : " bends by ");
    append_degrees(report.message, bend);
    report.message.append(", its limit is ");
    append_degrees(report.message, section.limit);
  }
  return report;
}

Report bends_of_changes(const SerialRobot& robot, Numbers changes, kernel::Model model,
                        SerialWorkspace& work) {
  if (!work.fits(robot) || changes.size() != work.changes.size()) {
    Report report;
    report.status = Status::bad_input;
    report.message.append("changes need one value a tendon, in a workspace of this robot");
    return report;
  }
  std::copy(changes.begin(), changes.end(), work.changes.begin());
  Report report;
  const double tolerance = tendon_tolerance(robot);
  Pull asked{}, needed{};
  std::size_t first = 0;
  for (std::size_t m = 0; m < work.maps.size(); ++m) {
    const auto count = static_cast<std::size_t>(work.tendons[m]);
    const std::span<double> slack(work.slack.data() + first, count);
    const auto* directions = work.directions.data() + first;
    const Pull sum = kernel::nearest_pull(work.changes.data() + first, directions, work.tendons[m]);
    const double x = sum.x - asked.x, y = sum.y - asked.y;
    const auto bend = kernel::bend(model, work.maps[m], x, y);
    work.bends[m] = {bend.x, bend.y};
    asked = sum;
    const bool bends_so = model == kernel::Model::linear || has_arcs(robot.sections[m], work.maps[m], x, y);
    if (const Section& section = robot.sections[m]; section.is_extensible() && bends_so) {
      const double wanted = kernel::extension(model, work.maps[m], bend, sum.common - needed.common);
      set_extensions(section, m, std::clamp(wanted, section.min_extension, section.max_extension), work);
    }
    needed = needed + pull_of(work, m, work.bends[m], model);
    for (std::size_t i = 0; i < count; ++i)
      slack[i] = kernel::tendon_slack(work.changes[first + i], needed, directions[i]);
    if (!bends_so && report.status != Status::unreachable) {
      report.status = Status::unreachable;
      name_section(report.message, m);
      report.message.append(" would have to bend a joint by more than half a turn");
    }
    if (report.status != Status::unreachable) report_tendons(m, slack, tolerance, report);
    first += count;
  }
  if (report.status == Status::unreachable) return report;
  const Report limits = check_limits(robot, work.bends, work.extensions);
  return limits.ok() ? report : limits;
}

namespace {

/// ∂pull/∂bend, one column a component of the bend.
struct PullRate {
  Mat<double, 2, 2> bend;  ///< of x and y
  Vec2<double> common;
};

/// With h the half angle a joint has of a bend b and s = sinc: ∂s/∂b = −sinc_slope(h)·(h/b)²·b.
PullRate pull_rate(const kernel::Section<double>& section, double length, const Bend& bend,
                   kernel::Model model) {
  const double g = section.gain;
  PullRate rate{Mat<double, 2, 2>(Mat<double, 2, 2>::Identity() * g), Vec2<double>::Zero()};
  if (model == kernel::Model::linear) return rate;
  const Vec2<double> half = section.half * bend;
  if (section.backbone == kernel::Backbone::neutral) {
    const double angle = half.norm();
    const Vec2<double> s_rate = -sinc_slope(angle) * section.half * half;
    rate.bend = g * (sinc(angle) * Mat<double, 2, 2>::Identity() + bend * s_rate.transpose());
    rate.common = length * s_rate;
  } else {
    for (int j = 0; j < 2; ++j) {
      rate.bend(j, j) = g * std::cos(half[j]);
      rate.common[j] = -0.5 * length * sinc_slope(half[j]) * section.half * half[j];
    }
  }
  return rate;
}

}  // namespace

void tendon_rates(std::span<const Bend> bends, kernel::Model model, SerialWorkspace& work) {
  if (!work.fits(bends)) return void(std::ranges::fill(work.K, not_a_number));
  std::fill(work.K.begin(), work.K.end(), 0.0);
  const std::size_t columns = 2 * work.maps.size();
  for (std::size_t k = 0; k < work.maps.size(); ++k) {
    const PullRate rate = pull_rate(work.maps[k], work.sections[k].arc_length(), bends[k], model);
    std::size_t row = 0;
    for (std::size_t m = 0; m < work.maps.size(); ++m)
      for (int i = 0; i < work.tendons[m]; ++i, ++row) {
        if (m < k) continue;
        const auto& at = work.directions[row];
        const Vec2<double> change = rate.common - rate.bend.transpose() * Vec2<double>(at.cosine, at.sine);
        work.K[row * columns + 2 * k] = change[0];
        work.K[row * columns + 2 * k + 1] = change[1];
      }
  }
}

}  // namespace sinew::inline v1

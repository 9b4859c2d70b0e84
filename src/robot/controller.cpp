#include "robot/controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sinew/kernel/crc32.h"

namespace sinew::inline v1 {
namespace {

constexpr double millimetres = 1e3;  ///< of a metre
constexpr double largest = std::numeric_limits<std::int16_t>::max();
constexpr double max_unlike = 4;     ///< greatest gain over least: what a share's inverse holds
constexpr double lost_chord = 3e-8;  ///< of its series, half a step of a float
constexpr int max_bits = 30;         ///< behind the point, of numbers that are all small
constexpr int min_terms = 2;

/// As many bits behind the point as `most` leaves, so that it stays below 2¹⁵ with so many steps to spare.
int fraction_of(double most, double spare = 1) {
  int bits = max_bits;
  while (bits >= 0 && std::ldexp(most, bits) > largest - spare) --bits;
  return bits;
}

/// Terms of the loss at the section's limit, as many as a float can tell.
std::vector<double> chord_series(const kernel::Section<double>& map, double limit) {
  const double square = map.half * map.half, w = square * limit * limit;
  std::vector<double> series;
  double coefficient = 1, power = 1;
  for (int k = 1;; ++k) {
    coefficient /= -(2.0 * k) * (2.0 * k + 1);  // of w^k in sin √w / √w
    power *= square;
    if (k > min_terms && std::abs(coefficient * std::pow(w, k)) < lost_chord) return series;
    series.push_back(coefficient * power);
  }
}

ControllerSection make_section(const Section& section, double greatest) {
  const kernel::Section<double> map = section.map();
  ControllerSection result;
  result.backbone = section.backbone;
  result.limit = section.limit;
  result.share = map.gain / greatest;
  result.half_length = 0.5 * section.arc_length() * millimetres;
  const double gain = greatest * millimetres;
  for (int i = 0; i < section.tendons; ++i) {
    const kernel::Direction<double> at = section.direction(i);
    const double back = 2 / (section.tendons * gain);
    result.rows.push_back({-gain * at.cosine, -gain * at.sine});
    result.back.push_back({-back * at.cosine, -back * at.sine});
  }
  result.series = chord_series(map, section.limit);
  result.most_common = 2 * result.half_length * -kernel::chord_loss(std::pow(map.half * section.limit, 2));
  return result;
}

bool is_alike(const Section& a, const Section& b) {
  return a.backbone == b.backbone && a.segments == b.segments && a.joint == b.joint &&
         a.tendon_radius == b.tendon_radius && a.limit == b.limit;
}

Expected<void> check(const SerialRobot& robot) {
  for (std::size_t m = 0; m < robot.sections.size(); ++m) {
    const Section& section = robot.sections[m];
    const std::string where = fmt::format("sections[{}]", m);
    if (section.is_extensible())
      return failure(
          "extensible", where,
          "its length varies; a controller's table is of sections that keep theirs: remove `extension`");
    if (section.tendons != robot.sections[0].tendons)
      return failure(
          "unlike_tendons", where,
          fmt::format("it has {} tendons, sections[0] has {}; a controller's table has as many for each",
                      section.tendons, robot.sections[0].tendons));
    if (!std::isfinite(section.limit))
      return failure("no_limit", where,
                     "the formats of integers follow from the largest bends: give the section a `limit`");
  }
  return {};
}

/// Sums of limits along the robot, as of the greatest gain [rad]: what running sums can reach.
double longest_sum(const ControllerTable& table) {
  double sum = 0, most = 0;
  for (const ControllerSection& section : table.sections) {
    sum += section.share * section.limit;
    most = std::max({most, sum, section.limit});
  }
  return most;
}

/// What exact PCC takes from all tendons alike, at most [mm].
double longest_common(const ControllerTable& table) {
  double sum = 0;
  for (const ControllerSection& section : table.sections) sum += section.most_common;
  return sum;
}

/// The running sum of integers at the limits of all sections, as a controller forms it and with a step for
/// what exact PCC rounds.
std::int64_t longest_short_sum(const ControllerTable& table, int angle_bits) {
  std::int64_t sum = 0, most = 0;
  for (const ControllerSection& section : table.sections) {
    const auto limit = static_cast<std::int64_t>(std::ldexp(section.limit, angle_bits));
    const std::int64_t shared = limit * fixed_point(section.share, ShortBits::share);
    sum += (table.alike ? limit : (shared >> ShortBits::share) + 1) + 1;
    most = std::max({most, sum, limit});
  }
  return most;
}

Expected<ShortBits> choose_bits(const ControllerTable& table, double gain) {
  double row = 0, back = 0, half = 0, pull = 0;
  for (const ControllerSection& section : table.sections) {
    std::array<double, 2> sums{};
    for (const auto& [a, b] : section.rows) pull = std::max(pull, std::abs(a) + std::abs(b));
    for (std::size_t i = 0; i < section.rows.size(); ++i)
      for (const std::size_t axis : {0u, 1u}) {
        row = std::max(row, std::abs(section.rows[i][axis]));
        back = std::max(back, std::abs(section.back[i][axis]));
        sums[axis] += std::abs(section.back[i][axis]);
      }
    // Their products with whatever was measured fit 32 bits.
    back = std::max({back, sums[0] / 2, sums[1] / 2});
    half = std::max(half, section.half_length);
  }
  ShortBits bits;
  bits.angle = std::min(fraction_of(longest_sum(table)), 15);
  while (bits.angle >= 0 && longest_short_sum(table, bits.angle) > std::numeric_limits<std::int16_t>::max())
    --bits.angle;
  bits.row = fraction_of(row);
  bits.half = std::min(fraction_of(half), 15);
  bits.length = bits.angle + bits.row - 16;
  if (bits.length > 15) bits.row -= std::exchange(bits.length, 15) - 15;
  // Exact PCC takes from all tendons alike what has to fit beside the pull of all sections at their limits;
  // each section rounds its part.
  const double rounded = 2 + static_cast<double>(table.sections.size());
  while (std::ldexp(pull * longest_sum(table) + longest_common(table), bits.length) > largest - rounded)
    --bits.row, --bits.length;
  bits.back = std::min(fraction_of(back, 2 + table.tendons / 4.0), bits.angle - bits.length + 16);
  if (bits.angle < 0 || bits.length < 0 || bits.half < 0 || bits.length + bits.back <= bits.angle)
    return failure(
        "out_of_range", "sections",
        fmt::format("gains up to {:.3g} mm, bends up to {:.3g} rad and half lengths up to {:.3g} mm do not "
                    "fit 16 bits",
                    gain, longest_sum(table), half));
  return bits;
}

/// Counts of motors fit 32 bits wherever tendons can be.
Expected<void> check_counts(const ControllerTable& table) {
  const double counts = table.counts_per_mm * table.length_step();
  if (table.counts_per_mm == 0 || (counts < 32767 && counts * 65536 >= 1)) return {};
  return failure(
      "out_of_range", "motor",
      fmt::format("{:.4g} counts a mm do not fit: give between {:.3g} and {:.3g}", table.counts_per_mm,
                  1 / (65536 * table.length_step()), 32766 / table.length_step()));
}

}  // namespace

double ControllerTable::angle_step() const { return std::ldexp(1.0, -bits.angle); }
double ControllerTable::length_step() const { return std::ldexp(1.0, -bits.length); }

double ControllerTable::rounding() const {
  // Half a step of the result, half a step of both numbers of a row, and of a share's product with each bend.
  const double row = std::ldexp(0.5, -bits.row), sum = 2 * longest_sum(*this);
  double gain = 0;
  for (const ControllerSection& section : sections)
    for (const auto& pair : section.rows) gain = std::max(gain, std::abs(pair[0]) + std::abs(pair[1]));
  const double shared = 0.5 * angle_step() + std::ldexp(0.5, -ShortBits::share) * longest_sum(*this);
  return length_step() / 2 + row * sum + (alike ? 0 : static_cast<double>(sections.size()) * gain * shared);
}

std::int32_t ControllerTable::counts_per_step() const {
  const double counts = counts_per_mm > 0 ? counts_per_mm * length_step() : 1;
  return static_cast<std::int32_t>(std::lround(counts * 65536));
}

std::int64_t ControllerTable::short_tolerance() const {
  // Three roundings stand between setpoints and what is compared with them, and half a count.
  const double count = counts_per_mm > 0 ? 0.5 / counts_per_mm / length_step() : 0;
  return std::max(fixed_point(tolerance, bits.length), static_cast<std::int64_t>(std::ceil(2 + count)));
}

std::int64_t ControllerTable::short_limit(const ControllerSection& section) const {
  return static_cast<std::int64_t>(std::floor(std::ldexp(section.limit, bits.angle)));
}

std::uint32_t ControllerTable::hash() const {
  kernel::Crc32 crc;
  const auto add = [&](std::int64_t value) { crc.add_text(fmt::format("{},", value)); };
  for (const int size :
       {static_cast<int>(sections.size()), tendons, bits.angle, bits.length, bits.row, bits.back})
    add(size);
  for (const ControllerSection& section : sections) {
    add(static_cast<int>(section.backbone));
    add(short_limit(section));
    add(alike ? 0 : fixed_point(section.share, ShortBits::share));
    for (std::size_t i = 0; i < section.rows.size(); ++i)
      for (const std::size_t axis : {0u, 1u}) {
        add(fixed_point(section.rows[i][axis], bits.row));
        add(fixed_point(section.back[i][axis], bits.back));
      }
  }
  add(short_tolerance());
  add(counts_per_step());
  for (const ControllerSection& section : sections)
    if (model == kernel::Model::exact) {
      add(fixed_point(section.half_length, bits.half));
      for (const double term : section.series) add(fixed_point(term, ShortBits::loss));
    }
  return crc.value();
}

std::int64_t fixed_point(double value, int fraction, int bits) {
  const double most = std::ldexp(1.0, bits - 1);
  return std::llround(std::clamp(std::round(std::ldexp(value, fraction)), -most, most - 1));
}

Expected<ControllerTable> make_controller_table(const SerialRobot& robot, kernel::Model model) {
  if (auto checked = check(robot); !checked) return tl::unexpected(checked.error());
  const auto gain = [](const Section& section) { return section.map().gain; };
  const auto [lowest, highest] = std::ranges::minmax_element(robot.sections, {}, gain);
  const double least = gain(*lowest), greatest = gain(*highest);
  if (greatest >= max_unlike * least)
    return failure(
        "unlike_gains", "sections",
        fmt::format("the greatest gain, {:.3g} mm, is {:.3g} times the least; it must be less than {} times",
                    greatest * millimetres, greatest / least, max_unlike));
  ControllerTable table;
  table.robot = robot.name;
  table.model = model;
  table.tendons = robot.sections[0].tendons;
  table.tolerance = robot.tolerance * millimetres;
  if (robot.motor) table.counts_per_mm = robot.motor->counts_per_length() / millimetres;
  for (const Section& section : robot.sections) {
    table.sections.push_back(make_section(section, greatest));
    table.alike = table.alike && is_alike(section, robot.sections[0]);
  }
  const auto bits = choose_bits(table, greatest * millimetres);
  if (!bits) return tl::unexpected(bits.error());
  table.bits = *bits;
  if (auto checked = check_counts(table); !checked) return tl::unexpected(checked.error());
  return table;
}

}  // namespace sinew::inline v1

#include "io/export/verilog/vectors.hpp"

#include <algorithm>
#include <random>

namespace sinew::inline v1::verilog {
namespace {

constexpr int robots = 24;
using Rows = std::vector<std::array<double, 2>>;

std::int64_t wrapped(std::int64_t value) { return static_cast<std::int16_t>(value); }
std::int64_t saturated(std::int64_t value) { return std::clamp<std::int64_t>(value, -32768, 32767); }
/// Fewer bits behind the point, to the nearest, halves upwards.
std::int64_t rounded(std::int64_t value, int down) {
  return (value + (std::int64_t{1} << (down - 1))) >> down;
}

/// A section's table in integers.
struct Section {
  const ControllerTable& table;
  const ControllerSection& section;

  std::int64_t row(std::size_t i, std::size_t axis) const {
    return fixed_point(section.rows[i][axis], table.bits.row);
  }
  std::int64_t change(std::size_t i, const Bend& sum) const {
    return wrapped(rounded(row(i, 0) * sum.x + row(i, 1) * sum.y, 16));
  }
  std::int64_t nearest_sum(const std::vector<std::int64_t>& changes, std::size_t axis) const {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < changes.size(); ++i)
      sum += fixed_point(section.back[i][axis], table.bits.back) * changes[i];
    return saturated(rounded(sum, table.bits.back + table.bits.length - table.bits.angle));
  }
  std::int64_t times(double share, std::int64_t angle) const {
    if (table.alike) return angle;
    return saturated(rounded(fixed_point(share, ShortBits::share) * angle, ShortBits::share));
  }
  bool allows(const Bend& bend) const {
    const std::int64_t most = table.short_limit(section);
    if (std::max(std::abs(bend.x), std::abs(bend.y)) > most) return false;
    return section.backbone != kernel::Backbone::neutral || bend.x * bend.x + bend.y * bend.y <= most * most;
  }
  int state(std::int64_t measured, std::int64_t asked) const {
    const std::int64_t slack = saturated(measured - asked), tolerance = table.short_tolerance();
    return slack > tolerance ? 1 : slack < saturated(-tolerance) ? 2 : 0;
  }
};

void pass_forward(const Section& section, Bend& sum, bool& in_limits, Vector& vector) {
  sum = {wrapped(sum.x + section.times(section.section.share, vector.bend.x)),
         wrapped(sum.y + section.times(section.section.share, vector.bend.y))};
  in_limits = in_limits && section.allows(vector.bend);
  vector.in_limits = in_limits;
  for (std::size_t i = 0; i < section.section.rows.size(); ++i)
    vector.changes.push_back(section.change(i, sum));
}

void pass_inverse(const Section& section, Bend& before, Vector& vector) {
  const Bend sum{section.nearest_sum(vector.measured, 0), section.nearest_sum(vector.measured, 1)};
  const double back = 1 / section.section.share;
  vector.found = {section.times(back, saturated(sum.x - before.x)),
                  section.times(back, saturated(sum.y - before.y))};
  for (std::size_t i = 0; i < vector.measured.size(); ++i)
    vector.states.push_back(section.state(vector.measured[i], section.change(i, sum)));
  before = sum;
}

/// An input that goes up to `most`: at the first robots what is special, then at random.
std::int64_t draw(std::mt19937& random, int robot, std::int64_t most) {
  const auto any = static_cast<std::int64_t>(random());
  switch (robot) {
    case 0:
      return 0;
    case 1:
      return most;
    case 2:
      return -most;
    case 3:
      return -32768;
    case 4:
      return 32767;
    case 5:
      return any % 2 ? -32768 : 32767;
    default:
      return robot % 2 ? any % (2 * most + 1) - most : any % 65536 - 32768;
  }
}

/// Changes that encoders read: of robots within their limits about what was asked, some tendons too long or
/// too short.
std::vector<std::int64_t> measured(const Section& section, std::mt19937& random, int robot,
                                   std::vector<std::int64_t> changes) {
  const std::int64_t most = 2 * fixed_point(section.table.tolerance, section.table.bits.length);
  for (std::int64_t& change : changes)
    change =
        robot > 5 && robot % 2 ? saturated(change + draw(random, robot, most)) : draw(random, robot, 32767);
  return changes;
}

}  // namespace

std::vector<Vector> vectors(const ControllerTable& table) {
  std::mt19937 random(1);
  std::vector<Vector> result;
  for (int robot = 0; robot < robots; ++robot) {
    Bend sum, before;
    bool in_limits = true;
    for (const ControllerSection& constants : table.sections) {
      const Section section{table, constants};
      Vector vector;
      const std::int64_t most = table.short_limit(constants);
      vector.bend.x = draw(random, robot, most);
      vector.bend.y = draw(random, robot, most);
      pass_forward(section, sum, in_limits, vector);
      vector.measured = measured(section, random, robot, vector.changes);
      pass_inverse(section, before, vector);
      result.push_back(vector);
    }
  }
  return result;
}

}  // namespace sinew::inline v1::verilog

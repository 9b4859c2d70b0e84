#include "arm.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/robots/serial_file.hpp"

namespace sinew::server::device {
namespace {

std::int32_t rounded(double count) {
  return static_cast<std::int32_t>(std::llround(std::clamp(count, -2147483647.0, 2147483647.0)));
}

/// As the controller multiplies: by a rounded number of counts in a step of a length.
double counts_per_metre(const ControllerTable& table) {
  return table.counts_per_step() / 65536.0 / table.length_step() * 1e3;
}

}  // namespace

Arm::Arm(SerialRobot robot, ControllerTable linear, ControllerTable exact, double stage_counts_per_metre)
    : robot_(std::move(robot)),
      work_(robot_),
      linear_(std::move(linear)),
      exact_(std::move(exact)),
      counts_per_metre_(counts_per_metre(linear_)),
      stage_counts_per_metre_(stage_counts_per_metre) {}

Expected<Arm> Arm::read(const Document& document, const std::optional<TendonMotor>& stage_motor) {
  if (!is_serial(document))
    return failure("not_serial", document.source, "a device is a serial robot; this is a parallel one");
  auto robot = read_serial_robot(document);
  if (!robot) return tl::unexpected(robot.error());
  if (!robot->motor)
    return failure(
        "no_motor", document.source,
        "name the motor of its tendons, as in the firmware's table: motor: {lead: 2 mm, counts: 4096}");
  auto linear = make_controller_table(*robot, kernel::Model::linear);
  if (!linear) return tl::unexpected(linear.error());
  auto exact = make_controller_table(*robot, kernel::Model::exact);
  if (!exact) return tl::unexpected(exact.error());
  const double stage = (stage_motor ? *stage_motor : *robot->motor).counts_per_length();
  return Arm(std::move(*robot), std::move(*linear), std::move(*exact), stage);
}

bool Arm::fits(const Hello& hello) {
  const bool is_exact = hello.hash == exact_.hash();
  model_ = is_exact ? kernel::Model::exact : kernel::Model::linear;
  return is_exact || hello.hash == linear_.hash();
}

std::vector<double> Arm::changes(std::span<const Bend> bends) {
  sinew::tendon_changes(bends, model_, work_);
  return work_.changes;
}

std::vector<double> Arm::lengths(std::span<const std::int32_t> counts) const {
  std::vector<double> all;
  for (std::size_t i = 0; i < counts.size(); ++i)
    all.push_back(i < tendon_drives() ? tendon_length(counts[i]) : stage_length(counts[i]));
  return all;
}

std::int32_t Arm::tendon_counts(double length) const { return rounded(length * counts_per_metre_); }
std::int32_t Arm::stage_counts(double length) const { return rounded(length * stage_counts_per_metre_); }

std::vector<std::int32_t> Arm::counts(const Posture& posture, bool has_stage) {
  std::vector<std::int32_t> all;
  for (const double change : changes(posture.bends)) all.push_back(tendon_counts(change));
  if (has_stage) all.push_back(stage_counts(posture.stage));
  return all;
}

std::vector<std::int16_t> Arm::raw(std::span<const Bend> bends, const Hello& hello) const {
  std::vector<std::int16_t> numbers;
  for (std::size_t m = 0; m < sections(); ++m) {
    const Section& section = robot_.sections[m];
    const double most = static_cast<double>(linear_.short_limit(linear_.sections[m]));
    Vec2<double> bend = bends[m] * std::ldexp(1.0, hello.angle_fraction);
    // A disc's limit is checked by squares of rounded numbers: a step inside it.
    if (const double size = bend.norm(); !section.is_twin() && size > most - 1) bend *= (most - 1) / size;
    for (const double x : {bend[0], bend[1]})
      numbers.push_back(static_cast<std::int16_t>(std::lround(std::clamp(x, -most, most))));
  }
  return numbers;
}

Bends Arm::bends(std::span<const std::int16_t> raw, const Hello& hello) const {
  Bends all;
  for (std::size_t m = 0; m < sections(); ++m)
    all.emplace_back(std::ldexp(raw[2 * m], -hello.angle_fraction),
                     std::ldexp(raw[2 * m + 1], -hello.angle_fraction));
  return all;
}

bool Arm::is_within_limits(std::span<const Bend> bends) const {
  return bends.size() == sections() && check_limits(robot_, bends).ok();
}

Vec3<double> Arm::tip(std::span<const Bend> bends) {
  section_ends(bends, work_);
  return work_.ends.back().p;
}

}  // namespace sinew::server::device

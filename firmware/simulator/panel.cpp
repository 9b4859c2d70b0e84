#include "simulator/panel.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "io/document/parse.hpp"
#include "io/robots/arm_file.hpp"
#include "io/robots/serial_file.hpp"
#include "simulator/faults.hpp"
#include "simulator/standard_input.hpp"
#include "simulator/terminal.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::firmware {
namespace {

volatile std::sig_atomic_t is_ended = 0;

/// Sleeps until simulated time has come. What a busy machine has lost for good is not made up for.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  void wait_until(double simulated) {
    constexpr std::chrono::milliseconds max_behind(50);
    const auto then =
        start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(simulated));
    const auto behind = Clock::now() - then;
    if (behind > max_behind) start_ += behind - max_behind;
    std::this_thread::sleep_until(then);
  }

 private:
  Clock::time_point start_ = Clock::now();
};

void say(const std::string& line) {
  std::fputs((line + '\n').c_str(), stdout);
  std::fflush(stdout);
}

void move(SimulatedArm& arm, Drives& drives, double time) {
  arm.advance(time, drives.setpoints, drives.are_enabled());
  for (std::size_t i = 0; i < arm.drive_count(); ++i) drives.positions[i] = arm.count(i);
  for (std::size_t i = 0; i < arm.tendon_count(); ++i)
    drives.tensions[i] = static_cast<std::uint16_t>(std::min(256 * arm.tension(i) + 0.5, 65535.0));
}

std::vector<int> tendons_of(const std::optional<SerialRobot>& robot) {
  std::vector<int> tendons;
  if (robot)
    for (const Section& section : robot->sections) tendons.push_back(section.tendons);
  return tendons;
}

template <class T>
T or_throw(Expected<T> value) {
  if (!value) throw std::runtime_error(to_string(value.error()));
  return std::move(*value);
}

}  // namespace

SerialRobot read_arm(const std::string& path, const std::string& motor) {
  SerialRobot robot = or_throw(load_serial(path));
  if (robot.is_extensible()) throw std::runtime_error(path + ": the arm's sections have fixed lengths");
  if (!motor.empty()) {
    const std::string text = motor.starts_with("motor=") ? motor.substr(6) : motor;
    robot.motor = or_throw(read_motor(or_throw(parse_yaml(text, "--motor-set"))));
  }
  return robot;
}

bool serve_terminal(Controller& controller, Drives& drives, const std::optional<SerialRobot>& robot,
                    unsigned seed, const std::string& link) {
  std::optional<SimulatedArm> arm;
  ArmDrives setup;
  setup.seed = seed;
  if (robot && robot->motor) setup.motor = *robot->motor;
  if (robot) arm.emplace(*robot, setup);
  drives.follow_at_once = !arm;
  std::signal(SIGPIPE, SIG_IGN);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { is_ended = 1; });
  Terminal terminal(link);
  Faults faults(controller, arm ? &*arm : nullptr, tendons_of(robot));
  StandardInput input;
  Pace pace;
  const std::uint64_t slice = controller.cycles(1e-3);
  say("ready " + link);
  while (!is_ended && !faults.has_quit() && !input.has_ended()) {
    while (const auto line = input.line()) say(faults.obey(*line));
    controller.send(faults.on_line(terminal.read()));
    if (!controller.run(slice)) return !controller.has_crashed();
    terminal.write(faults.on_line(controller.received()));
    if (arm) move(*arm, drives, 1e-3);
    pace.wait_until(static_cast<double>(controller.cycle()) / controller.frequency());
  }
  return true;
}

}  // namespace sinew::firmware

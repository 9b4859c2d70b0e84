/// sinew-simulate: firmware on a simulated ATmega2560, its UART0 on stdin and stdout or on a
/// pseudo-terminal, servo drives on its SPI.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "io/robots/arm_file.hpp"
#include "simulator/drives.hpp"
#include "simulator/panel.hpp"
#include "simulator/player.hpp"
#include "simulator/standard_input.hpp"

namespace {

using sinew::firmware::Controller;
using sinew::firmware::Drives;
using sinew::firmware::StandardInput;

constexpr const char* help =
    "sinew-simulate: firmware on a simulated ATmega2560, UART0 on stdin and stdout\n\n"
    "Usage: sinew-simulate FIRMWARE.elf [OPTIONS]\n\n"
    "      --frequency HZ  of the controller's clock; default 16000000\n"
    "      --cycles N      stop after so many; default some time after stdin ends\n"
    "      --turns         send a line of stdin when the one before has been answered\n"
    "      --real-time     as fast as the real one, not as fast as possible\n"
    "      --eeprom FILE   read the EEPROM from there, and write it back at the end\n"
    "      --drives N      servo drives on the SPI; default 15\n"
    "      --play CSV      play this trajectory in binary frames instead, and compare the replies\n"
    "      --rate HZ       its rows a second, whatever their times\n"
    "      --pty LINK      UART0 on a pseudo-terminal of that name, in real time; faults come on stdin\n"
    "      --arm ROBOT     a simulated arm on the drives: tendons whose tension is measured, and a stage\n"
    "      --motor-set M   its motor, else the file's; default '{lead: 2 mm, counts: 4096}'\n"
    "      --seed N        of the slack with which its tendons begin; default 1\n"
    "  -h, --help          this text\n\n"
    "It ends when the firmware sleeps with interrupts off. Exit status: 0, or 1 if the controller crashed\n"
    "or a reply was not what it should be, or 2 if an option or file is bad. The bytes are raw: whoever\n"
    "writes a line waits for its reply, or asks for --turns.\n\n"
    "With --pty it prints \"ready LINK\", then answers each line of stdin by \"ok\" or \"? reason\":\n"
    "  cut SECTION TENDON, mend, stick SECTION TENDON, free   of the arm; both count from 1\n"
    "  noise SHARE, unplug, plug                              of the serial line, both ways\n"
    "  reset, quit, state                                     state: the arm's truth as JSON\n\n"
    "Example:\n  sed -n 's/^> //p' firmware/README.md | sinew-simulate sinew-firmware.elf --turns\n";

struct Options {
  std::string elf, eeprom, play, pty, arm, motor;
  unsigned seed = 1;
  std::uint32_t frequency = Controller::default_frequency;
  std::optional<std::uint64_t> cycles;
  std::size_t drives = 15;
  double rate = 0;
  bool turns = false, real_time = false, help = false;
};

template <class Number>
Number number(const std::string& name, const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value > 0))
    throw std::runtime_error(name + ": \"" + text + "\" is no number above 0");
  return value;
}

Options parse(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    const auto value = [&] {
      if (i + 1 == count) throw std::runtime_error(word + " needs a value");
      return std::string(arguments[++i]);
    };
    if (word == "-h" || word == "--help")
      options.help = true;
    else if (word == "--turns")
      options.turns = true;
    else if (word == "--real-time")
      options.real_time = true;
    else if (word == "--frequency")
      options.frequency = number<std::uint32_t>(word, value());
    else if (word == "--cycles")
      options.cycles = number<std::uint64_t>(word, value());
    else if (word == "--drives")
      options.drives = number<std::size_t>(word, value());
    else if (word == "--play")
      options.play = value();
    else if (word == "--rate")
      options.rate = number<double>(word, value());
    else if (word == "--pty")
      options.pty = value();
    else if (word == "--arm")
      options.arm = value();
    else if (word == "--motor-set")
      options.motor = value();
    else if (word == "--seed")
      options.seed = number<unsigned>(word, value());
    else if (word == "--eeprom")
      options.eeprom = value();
    else if (word.starts_with("-") || !options.elf.empty())
      throw std::runtime_error(word + ": no such option; see --help");
    else
      options.elf = word;
  }
  if (options.elf.empty() && !options.help) throw std::runtime_error("no firmware was named; see --help");
  if (options.pty.empty() && !options.arm.empty()) throw std::runtime_error("--arm needs --pty");
  if (options.arm.empty() && !options.motor.empty()) throw std::runtime_error("--motor-set needs --arm");
  return options;
}

/// stdin for the controller: as it comes, or a line for each reply.
class Input {
 public:
  explicit Input(bool turns) : turns_(turns) {}

  void pass_on(Controller& controller) {
    if (awaiting_) return;
    const std::string bytes = turns_ ? input_.line().value_or("") : input_.bytes();
    if (bytes.empty()) return;
    controller.send(bytes);
    passed_on_ = true;
    awaiting_ = turns_;
  }
  void answered() { awaiting_ = false; }
  /// Since this was last asked.
  bool is_new() { return std::exchange(passed_on_, false); }
  bool is_over() const { return input_.has_ended() && !awaiting_; }

 private:
  StandardInput input_;
  bool turns_, awaiting_ = false, passed_on_ = false;
};

void load(Controller& controller, const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const auto eeprom = controller.eeprom();
  if (file) file.read(reinterpret_cast<char*>(eeprom.data()), static_cast<std::streamsize>(eeprom.size()));
}
void save(Controller& controller, const std::string& path) {
  const auto eeprom = controller.eeprom();
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(eeprom.data()), static_cast<std::streamsize>(eeprom.size()));
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

/// Passes bytes between the streams and the controller. True unless it crashed.
bool serve(Controller& controller, const Options& options) {
  const std::uint64_t slice = controller.cycles(1e-3), patience = controller.cycles(0.1);
  const auto start = std::chrono::steady_clock::now();
  Input input(options.turns);
  std::uint64_t heard = 0;
  for (;;) {
    input.pass_on(controller);
    const std::uint64_t left = options.cycles ? *options.cycles - controller.cycle() : slice;
    const bool runs = controller.run(std::min(slice, left));
    const std::string bytes = controller.received();
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);
    std::fflush(stdout);
    if (bytes.find('\n') != std::string::npos || controller.cycle() - heard > 10 * patience) input.answered();
    if (!runs) return !controller.has_crashed();
    if (options.cycles && controller.cycle() >= *options.cycles) return true;
    if (!bytes.empty() || !controller.all_sent() || input.is_new()) heard = controller.cycle();
    if (!options.cycles && input.is_over() && controller.cycle() - heard > patience) return true;
    if (options.real_time)
      std::this_thread::sleep_until(
          start + std::chrono::duration<double>(static_cast<double>(controller.cycle()) / options.frequency));
  }
}

/// With an arm there is a stage beside its tendons, whose tensions are measured.
bool serve_panel(Controller& controller, const Options& options) {
  std::optional<sinew::SerialRobot> robot;
  if (!options.arm.empty()) robot = sinew::firmware::read_arm(options.arm, options.motor);
  const auto tendons = robot ? static_cast<std::size_t>(robot->tendon_count()) : 0;
  Drives drives(controller, robot ? tendons + 1 : options.drives, tendons);
  return sinew::firmware::serve_terminal(controller, drives, robot, options.seed, options.pty);
}

}  // namespace

int main(int count, char** arguments) try {
  const Options options = parse(count, arguments);
  if (options.help) return std::fputs(help, stdout), 0;
  Controller controller(options.elf, options.frequency);
  if (!options.eeprom.empty()) load(controller, options.eeprom);
  bool good = false;
  if (!options.pty.empty()) {
    good = serve_panel(controller, options);
  } else if (options.play.empty()) {
    Drives drives(controller, options.drives);
    good = serve(controller, options);
  } else {
    good = sinew::firmware::play(controller, options.play, options.rate);
  }
  if (!options.eeprom.empty()) save(controller, options.eeprom);
  if (!good && options.play.empty()) std::fputs("sinew-simulate: the controller crashed\n", stderr);
  return good ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "sinew-simulate: %s\n", error.what());
  return 2;
}

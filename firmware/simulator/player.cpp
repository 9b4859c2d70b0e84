#include "simulator/player.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "protocol/binary.h"
#include "simulator/drives.hpp"
#include "simulator/trajectory.hpp"

namespace sinew::firmware {
namespace {

constexpr double approach = 0.5;      ///< [s] in which the drives go to the first row
constexpr double sign_of_life = 0.1;  ///< [s] after which the host has to say something

/// What a frame is written to.
struct Line {
  void wait_for_room(Uint8) {}
  void put(Uint8 byte) { text += static_cast<char>(byte); }
  void put(const Uint8* bytes, Uint8 size) { text.append(reinterpret_cast<const char*>(bytes), size); }
  void flush() {}
  std::string text;
};

std::string request(char verb, std::uint32_t sequence, const Pose* pose = nullptr, bool has_stage = false) {
  Line line;
  BinaryFrame<Line> frame(line);
  frame.put(static_cast<Uint8>(verb));
  frame.put32(sequence);
  frame.put32(table_hash);
  if (pose) {
    Pose sent = *pose;
    frame.put16(sent.duration);
    for (Uint8 i = 0; i < bend_count; ++i) frame.put16(static_cast<Uint16>(bend_at(sent.bends, i).raw));
    if (has_stage) frame.put32(static_cast<Uint32>(sent.stage));
  }
  frame.end();
  return line.text;
}

/// A reply's bytes without its checksum; nothing if it is not whole.
std::optional<std::vector<Uint8>> read_reply(const std::string& line) {
  std::vector<Uint8> bytes;
  for (std::size_t at = 0;;) {
    const Uint8 link = at < line.size() ? static_cast<Uint8>(line[at]) : 0;
    const std::size_t next = at + link - link_mark;
    if (link <= link_mark || next > line.size()) return {};
    for (std::size_t i = at + 1; i < next; ++i) bytes.push_back(static_cast<Uint8>(line[i]));
    if (next == line.size()) break;
    if (link != bridge) bytes.push_back('\n');
    at = next;
  }
  if (bytes.size() < 10) return {};
  kernel::Crc32 sum;
  for (std::size_t i = 0; i + 4 < bytes.size(); ++i) sum.add(bytes[i]);
  if (read32(bytes.data() + bytes.size() - 4) != sum.value()) return {};
  bytes.resize(bytes.size() - 4);
  return bytes;
}

std::vector<std::int32_t> counts_of(const Pose& pose, bool has_stage) {
  Changes changes;
  Counts counts{};
  plan(pose, changes, counts);
  std::vector<std::int32_t> all(counts, counts + tendon_drives);
  if (has_stage) all.push_back(pose.stage);
  return all;
}

class Player {
 public:
  Player(Controller& controller, const Trajectory& trajectory, double rate)
      : controller_(controller),
        trajectory_(trajectory),
        rate_(rate) {
    controller.on_sent = [this](std::uint8_t byte) { hear(static_cast<char>(byte)); };
  }
  ~Player() { controller_.on_sent = nullptr; }

  bool play() {
    say_hello();
    Drives drives(controller_, tendon_drives + (has_stage_ ? 1u : 0u));
    ask('A');
    await(controller_.cycles(1.0));
    if (refused_ != Error::none)
      throw std::runtime_error("arming was refused: " + std::string(text_of(refused_)));
    go_to_first_row();
    stream();
    return report(drives);
  }

 private:
  struct Asked {
    std::uint32_t sequence;
    double end;  ///< when its last byte has come
    const Trajectory::Row* row;
  };

  double now() const { return static_cast<double>(controller_.cycle()) / controller_.frequency(); }
  void run_until(double time) {
    while (now() < time)
      if (!controller_.run(controller_.cycles(time - now()) + 1))
        throw std::runtime_error("the controller stopped");
  }

  void send(const std::string& frame, const Trajectory::Row* row) {
    controller_.send(frame);
    line_is_free_ =
        std::max(line_is_free_, now()) + static_cast<double>(frame.size()) * controller_.byte_time();
    asked_.push_back({sequence_, line_is_free_, row});
    spoke_ = now();
  }
  void ask(char verb) { send(request(verb, ++sequence_), nullptr); }
  void send_row(const Trajectory::Row& row, long duration, const Trajectory::Row* to_compare) {
    if (duration > 65535) throw std::runtime_error("rows are at most 65.535 s apart");
    Pose pose = row.pose;
    pose.duration = static_cast<Uint16>(duration);
    send(request('P', ++sequence_, &pose, has_stage_), to_compare);
  }

  void hear(char byte) {
    if (byte != '\n') {
      line_ += byte;
      return;
    }
    // It is given to a register before the shift register, which may have a byte to finish.
    take(line_, now() + 2 * controller_.byte_time());
    line_.clear();
  }
  void take(const std::string& line, double time) {
    last_reply_ = read_reply(line);
    if (asked_.empty()) return;
    const Asked asked = asked_.front();
    asked_.pop_front();
    const bool is_refused = !last_reply_ || (*last_reply_)[0] == '!';
    if (is_refused && refused_ == Error::none)
      refused_ =
          last_reply_ && last_reply_->size() > 6 ? static_cast<Error>((*last_reply_)[6]) : Error::checksum;
    if (!asked.row) return;
    worst_time_ = std::max(worst_time_, time - asked.end);
    if (!is_refused && read32(last_reply_->data() + 1) == asked.sequence) compare(*asked.row);
  }
  /// A reply has the lower half of each count.
  void compare(const Trajectory::Row& row) {
    const auto expected = counts_of(row.pose, has_stage_);
    if (last_reply_->size() != 6 + 2 * expected.size()) return;
    bool is_equal = true;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Uint16 half = read16(last_reply_->data() + 6 + 2 * i);
      const auto off = static_cast<std::int16_t>(half - static_cast<Uint16>(expected[i] & 0xFFFF));
      is_equal = is_equal && off == 0;
      const bool is_in_file = i < tendon_drives ? trajectory_.has_counts : trajectory_.has_stage_counts;
      if (!is_in_file) continue;
      const std::int64_t in_file = i < tendon_drives ? row.counts[i] : row.pose.stage;
      off_file_ = std::max<std::int64_t>(off_file_, std::abs(expected[i] + off - in_file));
    }
    if (is_equal) ++equal_;
  }

  /// Until all has been answered, or nothing is any more.
  void await(std::uint64_t patience) {
    const std::uint64_t end = controller_.cycle() + patience;
    while (!asked_.empty() && controller_.cycle() < end) run_until(now() + 1e-4);
  }

  void say_hello() {
    run_until(0.1);
    sequence_ = 0;
    send(request('H', 0), nullptr);
    await(controller_.cycles(1.0));
    constexpr std::size_t size = 6 + 8 + 4 + 4 + 4 + 1 + 1 + 2;
    if (!last_reply_ || last_reply_->size() != size || (*last_reply_)[0] != 'H')
      throw std::runtime_error("the firmware does not answer binary frames of version 3");
    const Uint8* const said = last_reply_->data() + 6;
    const Uint32 hash = read32(said + 8);
    if (hash != table_hash) {
      char text[120];
      std::snprintf(text, sizeof text,
                    "the firmware's table is %08lx, another robot's; the player's is %08lx",
                    static_cast<unsigned long>(hash), static_cast<unsigned long>(table_hash));
      throw std::runtime_error(text);
    }
    has_stage_ = said[3] > 0;
    sequence_ = read32(said + 12);
  }

  /// Milliseconds from the first row.
  long milliseconds(std::size_t i) const {
    const double time =
        rate_ > 0 ? static_cast<double>(i) / rate_ : trajectory_.rows[i].time - trajectory_.rows[0].time;
    return std::lround(1e3 * time);
  }

  void go_to_first_row() {
    send_row(trajectory_.rows[0], std::lround(1e3 * approach), &trajectory_.rows[0]);
    wait_talking(now() + approach + 5e-3);
    await(controller_.cycles(1.0));
    worst_time_ = 0;
  }
  void wait_talking(double end) {
    while (now() < end) {
      run_until(std::min(end, spoke_ + sign_of_life));
      if (now() >= spoke_ + sign_of_life) ask('S');
    }
  }
  /// Each row is sent when the one before is reached, and is reached when its time has come.
  void stream() {
    const double start = now();
    for (std::size_t i = 1; i < trajectory_.rows.size(); ++i) {
      wait_talking(start + 1e-3 * static_cast<double>(milliseconds(i - 1)));
      send_row(trajectory_.rows[i], milliseconds(i) - milliseconds(i - 1), &trajectory_.rows[i]);
    }
    duration_ = 1e-3 * static_cast<double>(milliseconds(trajectory_.rows.size() - 1));
    wait_talking(start + duration_ + 5e-3);
    await(controller_.cycles(1.0));
  }

  bool report(const Drives& drives) {
    const std::size_t rows = trajectory_.rows.size();
    const bool have_arrived = drives.positions == counts_of(trajectory_.rows.back().pose, has_stage_);
    std::printf("rows                  %zu\n", rows);
    if (rows > 1) std::printf("rate                  %.1f Hz\n", static_cast<double>(rows - 1) / duration_);
    std::printf("replies to the count  %zu of %zu\n", equal_, rows);
    if (trajectory_.has_counts || (has_stage_ && trajectory_.has_stage_counts))
      std::printf("off the file's counts %lld at most\n", static_cast<long long>(off_file_));
    std::printf("reply time            %.3f ms at most\n", 1e3 * worst_time_);
    std::printf("drives at the end     %s\n", have_arrived ? "where the last row is" : "elsewhere");
    if (refused_ != Error::none) std::printf("refused               %s\n", text_of(refused_));
    return equal_ == rows && have_arrived && refused_ == Error::none;
  }

  Controller& controller_;
  const Trajectory& trajectory_;
  double rate_, line_is_free_ = 0, spoke_ = 0, worst_time_ = 0, duration_ = 0;
  bool has_stage_ = false;
  std::uint32_t sequence_ = 0;
  std::deque<Asked> asked_;
  std::string line_;
  std::optional<std::vector<Uint8>> last_reply_;
  Error refused_ = Error::none;  ///< the first
  std::size_t equal_ = 0;
  std::int64_t off_file_ = 0;
};

}  // namespace

bool play(Controller& controller, const std::filesystem::path& path, double rate) {
  const Trajectory trajectory = read_trajectory(path);
  return Player(controller, trajectory, rate).play();
}

}  // namespace sinew::firmware

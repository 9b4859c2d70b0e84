/// @file recording.hpp
/// What a device did, in one file that stands alone: CSV that begins with comments, a row for each
/// measurement and for each event. It is written by a thread; what the loop asks here never waits. Form:
/// docs/server.md, "Recordings".
#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "writer.hpp"

namespace sinew::server::device {

/// What the comments say beside the robot's text.
struct RecordingHead {
  std::string robot;
  std::uint32_t table = 0;   ///< hash of the controller's
  std::string_view model;    ///< `lsk` or `pcc`, by which it drives
  double tension_limit = 0;  ///< [N], 0: none
  std::string columns;       ///< names of them, but for the first, `time[s]`
};

/// A field of CSV: one line, in quotes.
std::string quoted(std::string_view text);

class Recording {
 public:
  static constexpr int version = 1;

  /// @param robot_text of its file
  explicit Recording(std::filesystem::path folder, std::string robot_text = {})
      : folder_(std::move(folder)),
        robot_text_(std::move(robot_text)) {}

  /// @param name of the file, without `.csv`
  void begin(const std::string& name, const RecordingHead& head, double now);
  /// @param rest of the row, from its first comma on
  void row(double now, std::string_view rest);
  void event(double now, std::string_view rest);
  /// A picture beside the file. Its name; empty: too much waits to be written.
  std::string picture(std::string bytes, std::string_view extension);
  /// What was homed, beside the file. Its name; empty: nothing is written any more, `error` says why.
  std::string homing(std::string json);
  void end();
  /// Takes what the thread has to tell.
  void poll();
  /// Until all is written, or so long.
  void wait(std::chrono::milliseconds patience) { writer_.wait(patience); }

  bool is_on() const { return is_on_; }
  /// Whether nobody knows yet that it can be written.
  bool is_opening() const { return is_on_ && !is_open_ && error_.empty(); }
  const std::string& name() const { return name_; }
  long rows() const { return count_; }  ///< of measurements
  int pictures() const { return pictures_; }
  /// Why nothing is written any more; empty: all is.
  const std::string& error() const { return error_; }

 private:
  bool append(double now, std::string_view rest);

  std::filesystem::path folder_;
  std::string robot_text_, name_, error_;
  FileWriter writer_;
  bool is_on_ = false, is_open_ = false;
  long number_ = 0, count_ = 0;
  int pictures_ = 0, homings_ = 0;
  double began_ = 0;
};

}  // namespace sinew::server::device

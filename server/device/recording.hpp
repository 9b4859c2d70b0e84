/// @file recording.hpp
/// What a device did, in two files: a row of set-points and measurements each period, and events. Each line
/// is given to the system at once, so that nothing is lost when the program ends.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "sinew/base/error.hpp"

namespace sinew::server::device {

/// A file that only grows.
class GrowingFile {
 public:
  GrowingFile() = default;
  ~GrowingFile() { close(); }
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  /// What was wrong, empty: nothing.
  std::string open(const std::filesystem::path& path);
  std::string append(std::string_view line);
  void close();
  bool is_open() const { return file_ >= 0; }

 private:
  int file_ = -1;
};

class Recording {
 public:
  explicit Recording(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// @param name of the files, without `.csv`
  /// @param header the first line of the rows
  /// @return what was wrong, empty: nothing
  std::string begin(const std::string& name, const std::string& header);
  void row(const std::string& line);
  void event(std::string_view line);
  void end();
  /// Rows from now on go there; for tests of what happens when they cannot be written.
  void continue_in(const std::filesystem::path& path) { error_ = rows_.open(path); }

  bool is_on() const { return rows_.is_open(); }
  const std::string& name() const { return name_; }
  long rows() const { return count_; }
  /// Why nothing is written any more; empty: all is.
  const std::string& error() const { return error_; }

 private:
  std::filesystem::path folder_;
  std::string name_, error_;
  GrowingFile rows_, events_;
  long count_ = 0;
};

}  // namespace sinew::server::device

/// @file writer.hpp
/// Writes files in a thread of its own. Nobody waits for it: where a disk hangs, what is to be written waits
/// in a queue, and where that is full, it is refused.
#pragma once
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

namespace sinew::server::device {

class FileWriter {
 public:
  static constexpr std::size_t max_jobs = 128;                      ///< lines, that wait
  static constexpr std::size_t max_bytes = std::size_t{24} << 20U;  ///< of them and of pictures

  FileWriter() = default;
  /// What waits is written first, if that takes less than a second; a disk that hangs is left alone.
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  /// @name Each false where too much waits, and then nothing is done.
  /// @{
  /// A new file, to which what follows is appended; it must not be there yet, or be empty.
  /// @param head its first bytes
  /// @param number by which `news` tells of it
  bool open(std::filesystem::path path, std::string head, long number);
  bool append(std::string bytes);
  bool write_whole(std::filesystem::path path, std::string bytes);
  /// @}
  void close();

  struct News {
    bool is_open = false;  ///< and has its first bytes
    std::string error;     ///< empty: all could be written so far
  };
  News news(long number) const;
  /// Until all is written. False where it is not by then.
  bool wait(std::chrono::milliseconds patience);

 private:
  struct Job {
    enum class Kind { open, append, whole, close } kind;
    std::filesystem::path path = {};
    std::string bytes = {};
    long number = 0;
  };
  struct State;
  bool put(Job job);

  std::shared_ptr<State> state_;  // shared with a thread that may outlive this
  std::thread thread_;
};

}  // namespace sinew::server::device

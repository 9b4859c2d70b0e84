/// @file chunk_log.hpp
/// Chunks of a sweep as they are finished, in a file that only grows. Each has a checksum: of a process
/// killed at any moment, or a disc that is full, all whole chunks are found again.
#pragma once
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "sinew/base/error.hpp"

namespace sinew::inline v1 {

/// SHA-256.
using Digest = std::array<std::uint8_t, 32>;

/// Where chunks lie that are written where they stay: their log then only says which there are, and by what
/// checksum.
class ChunkPlace {
 public:
  virtual ~ChunkPlace() = default;
  virtual Expected<void> open(bool resumes) = 0;  ///< there may be chunks, or there are none
  virtual Expected<void> write(std::size_t chunk, std::span<const std::byte> bytes) = 0;
  virtual bool read(std::size_t chunk, std::vector<std::byte>& bytes) const = 0;
  virtual void flush() = 0;  ///< to the disc
};

class ChunkLog {
 public:
  enum class Open { create, resume };

  /// The log of a sweep that `key` tells apart from others. Creating, a log that holds chunks is refused;
  /// resuming, a torn end is cut off. Codes: `sweep_begun`, `other_sweep`, `other_options`, `not_a_log`,
  /// `in_use`, `file_unwritable`.
  /// @param place where the chunks go, which must outlive the log; null: into the log
  static Expected<ChunkLog> open(const std::filesystem::path& path, const Digest& key, std::size_t chunks,
                                 Open how, ChunkPlace* place = nullptr);

  bool has(std::size_t chunk) const { return places_[chunk].size > 0; }
  std::size_t count() const { return count_; }         ///< chunks there are
  std::size_t size() const { return places_.size(); }  ///< chunks there will be
  std::uint64_t bytes() const { return end_; }

  /// Code `write_failed`; what was there before still is. Bytes are on the disc within half a minute.
  Expected<void> append(std::size_t chunk, std::span<const std::byte> bytes);
  /// Code `file_unreadable`, also where the bytes are no longer those that were written.
  Expected<void> read(std::size_t chunk, std::vector<std::byte>& bytes) const;
  void flush();  ///< to the disc
  /// The log is of no more use.
  void remove();

  ChunkLog(ChunkLog&&) noexcept;
  ChunkLog& operator=(ChunkLog&&) noexcept;
  ~ChunkLog();

 private:
  struct Place {
    std::uint64_t at = 0, size = 0;  ///< of its record; of the chunk
  };
  ChunkLog(std::filesystem::path path, int file, std::size_t chunks, ChunkPlace* place);
  Expected<void> write_header(const Digest& key);
  Expected<void> check_header(const Digest& key);
  Expected<void> recover();

  bool load(std::uint64_t at, std::vector<std::byte>& bytes) const;

  std::filesystem::path path_;
  int file_ = -1;
  ChunkPlace* place_ = nullptr;
  std::vector<Place> places_;
  std::size_t count_ = 0;
  std::uint64_t end_ = 0;
  std::chrono::steady_clock::time_point flushed_ = std::chrono::steady_clock::now();
};

}  // namespace sinew::inline v1

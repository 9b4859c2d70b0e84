#include "study/results/chunk_log.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "io/file/write_file.hpp"
#include "study/results/file_bytes.hpp"

namespace sinew::inline v1 {
namespace {

// Little-endian as every machine this runs on; the header says so by its first number.
constexpr std::uint64_t log_magic = 0x31676f6c77656e73U;     // "snewlog1"
constexpr std::uint64_t placed_magic = 0x32676f6c77656e73U;  // "snewlog2": the chunks are elsewhere
constexpr std::uint64_t chunk_magic = 0x316b6e7563776e73U;   // "snwcunk1"
/// A killed process loses nothing that was written; a machine without power loses so much.
constexpr std::chrono::seconds between_flushes{20};
constexpr std::string_view not_a_log =
    "is no log of a sweep, or is damaged; remove it, or give another --output";

struct Header {
  std::uint64_t magic = log_magic;
  std::uint64_t chunks = 0;
  Digest key{};
  std::uint64_t checksum = 0;  ///< of what stands before it
};
struct Record {
  std::uint64_t magic = chunk_magic;
  std::uint64_t chunk = 0, size = 0;
  std::uint64_t checksum = 0;  ///< of chunk, size and bytes
};

std::uint64_t checksum_of(const Header& header) { return XXH3_64bits(&header, offsetof(Header, checksum)); }

std::uint64_t checksum_of(const Record& record, std::span<const std::byte> bytes) {
  const std::uint64_t seed = record.chunk * 0x9e3779b97f4a7c15U + record.size;
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

}  // namespace

ChunkLog::ChunkLog(std::filesystem::path path, int file, std::size_t chunks, ChunkPlace* place)
    : path_(std::move(path)),
      file_(file),
      place_(place),
      places_(chunks) {}

ChunkLog::ChunkLog(ChunkLog&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::exchange(other.file_, -1)),
      place_(other.place_),
      places_(std::move(other.places_)),
      count_(other.count_),
      end_(other.end_),
      flushed_(other.flushed_) {}

ChunkLog& ChunkLog::operator=(ChunkLog&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(file_, other.file_);
  std::swap(place_, other.place_);
  std::swap(places_, other.places_);
  std::swap(count_, other.count_);
  std::swap(end_, other.end_);
  std::swap(flushed_, other.flushed_);
  return *this;
}

ChunkLog::~ChunkLog() {
  if (file_ >= 0) ::close(file_);
}

Expected<ChunkLog> ChunkLog::open(const std::filesystem::path& path, const Digest& key, std::size_t chunks,
                                  Open how, ChunkPlace* place) {
  if (path.has_parent_path()) {
    std::error_code ignored;  // opening tells
    std::filesystem::create_directories(path.parent_path(), ignored);
  }
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file < 0) return failure("file_unwritable", path.string(), unwritable(errno));
  ChunkLog log(path, file, chunks, place);
  if (::flock(file, LOCK_EX | LOCK_NB) != 0)
    return failure("in_use", path.string(),
                   "another sweep is writing it; wait for it, or give another --output");
  struct stat status = {};
  ::fstat(file, &status);
  if (!S_ISREG(status.st_mode)) return failure("not_a_log", path.string(), not_a_log);
  if (status.st_size < static_cast<off_t>(sizeof(Header))) {  // new, or killed while it was begun
    const auto size = static_cast<std::size_t>(status.st_size);
    std::array<std::byte, sizeof(Header)> begun{};
    const auto is_begun = [&](const std::uint64_t& magic) {
      const std::size_t there = std::min(size, sizeof magic);
      return std::ranges::equal(std::span(begun).first(there), bytes_of(magic).first(there));
    };
    if (!read_all(file, 0, std::span(begun).first(size)) || (!is_begun(log_magic) && !is_begun(placed_magic)))
      return failure("not_a_log", path.string(), not_a_log);
    auto done = log.write_header(key);
    if (done && place) done = place->open(false);
    if (!done) {
      if (size == 0) log.remove();
      return tl::unexpected(done.error());
    }
    return log;
  }
  if (const auto done = log.check_header(key); !done) return tl::unexpected(done.error());
  if (place)
    if (const auto done = place->open(true); !done) return tl::unexpected(done.error());
  if (const auto done = log.recover(); !done) return tl::unexpected(done.error());
  if (how == Open::create && log.count_ > 0)
    return failure(
        "sweep_begun", path.string(),
        fmt::format("holds {} of {} chunks of this sweep; go on with --resume, or remove it to begin anew",
                    log.count_, chunks));
  return log;
}

Expected<void> ChunkLog::write_header(const Digest& key) {
  Header header{.magic = place_ ? placed_magic : log_magic, .chunks = places_.size(), .key = key};
  header.checksum = checksum_of(header);
  if (::ftruncate(file_, 0) != 0 || !write_all(file_, 0, bytes_of(header)))
    return failure("file_unwritable", path_.string(), unwritable(errno));
  end_ = sizeof(Header);
  return {};
}

Expected<void> ChunkLog::check_header(const Digest& key) {
  Header header;
  if (!read_all(file_, 0, std::as_writable_bytes(std::span(&header, 1))) ||
      (header.magic != log_magic && header.magic != placed_magic) || header.checksum != checksum_of(header))
    return failure("not_a_log", path_.string(), not_a_log);
  if (header.key != key || header.chunks != places_.size())
    return failure(
        "other_sweep", path_.string(),
        "belongs to another sweep: study, robot, list of samples, version or instruction set differ; "
        "remove it, or give another --output");
  if (header.magic != (place_ ? placed_magic : log_magic))
    return failure("other_options", path_.string(),
                   "was begun with another --compress; go on with that one, or remove it to begin anew");
  end_ = sizeof(Header);
  return {};
}

/// The bytes of the record that stands there; false where they are no longer, or not yet, those written.
bool ChunkLog::load(std::uint64_t at, std::vector<std::byte>& bytes) const {
  Record record;
  if (!read_all(file_, at, std::as_writable_bytes(std::span(&record, 1)))) return false;
  if (!place_) bytes.resize(record.size);
  const bool is_there =
      place_ ? place_->read(record.chunk, bytes) : read_all(file_, at + sizeof(Record), bytes);
  return is_there && checksum_of(record, bytes) == record.checksum;
}

/// Whole records from the front; what follows them was being written when the process ended. What is not in
/// the log may be missing of any record, where a machine lost power.
Expected<void> ChunkLog::recover() {
  std::vector<std::byte> bytes;
  struct stat status = {};
  ::fstat(file_, &status);
  const auto size = static_cast<std::uint64_t>(status.st_size);
  for (Record record;;) {
    if (!read_all(file_, end_, std::as_writable_bytes(std::span(&record, 1)))) break;
    const std::uint64_t here = place_ ? 0 : record.size;
    if (record.magic != chunk_magic || record.chunk >= places_.size() || record.size == 0 ||
        here > size - end_ - sizeof(Record))
      break;
    const bool is_whole = load(end_, bytes);
    if (!is_whole && !place_) break;
    if (is_whole) {
      count_ += !has(record.chunk);
      places_[record.chunk] = {end_, record.size};
    }
    end_ += sizeof(Record) + here;
  }
  if (::ftruncate(file_, static_cast<off_t>(end_)) != 0)
    return failure("file_unwritable", path_.string(), unwritable(errno));
  return {};
}

Expected<void> ChunkLog::append(std::size_t chunk, std::span<const std::byte> bytes) {
  Record record{.chunk = chunk, .size = bytes.size()};
  record.checksum = checksum_of(record, bytes);
  if (place_)
    if (auto done = place_->write(chunk, bytes); !done) return done;
  const auto here = place_ ? std::span<const std::byte>() : bytes;
  if (!write_all(file_, end_, bytes_of(record)) || !write_all(file_, end_ + sizeof(Record), here)) {
    const std::string why = unwritable(errno);
    [[maybe_unused]] const int cut = ::ftruncate(file_, static_cast<off_t>(end_));  // else recovery does
    return failure("write_failed", path_.string(),
                   fmt::format("{}; the chunks are kept, go on with --resume", why));
  }
  count_ += !has(chunk);
  places_[chunk] = {end_, bytes.size()};
  end_ += sizeof(Record) + here.size();
  if (std::chrono::steady_clock::now() - flushed_ > between_flushes) flush();
  return {};
}

Expected<void> ChunkLog::read(std::size_t chunk, std::vector<std::byte>& bytes) const {
  if (load(places_[chunk].at, bytes)) return {};
  return failure(
      "file_unreadable", path_.string(),
      fmt::format("chunk {} can no longer be read as it was written; remove the file and begin anew", chunk));
}

void ChunkLog::flush() {
  if (place_) place_->flush();
  ::fdatasync(file_);
  flushed_ = std::chrono::steady_clock::now();
}

void ChunkLog::remove() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace sinew::inline v1

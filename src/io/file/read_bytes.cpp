#include "io/file/read_bytes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace sinew::inline v1 {
namespace {

/// A descriptor that closes itself.
struct File {
  int number = -1;
  std::uintmax_t size = 0;
  File() = default;
  File(File&& other) noexcept : number(std::exchange(other.number, -1)), size(other.size) {}
  ~File() {
    if (number >= 0) ::close(number);
  }
};

tl::unexpected<Errors> unreadable(const std::filesystem::path& path, int reason) {
  return failure("file_unreadable", path.string(),
                 fmt::format("cannot be read: {}", std::generic_category().message(reason)));
}

Expected<File> open(const std::filesystem::path& path) {
  File file;
  // O_NONBLOCK: a pipe that nobody writes would never open. A regular file does not mind.
  file.number = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (file.number < 0 && errno == ENOENT)
    return failure("file_missing", path.string(), "there is no such file; check the path");
  if (file.number < 0 && errno != ENXIO) return unreadable(path, errno);  // of a socket
  struct stat status = {};
  if (file.number >= 0 && ::fstat(file.number, &status) != 0) return unreadable(path, errno);
  if (S_ISDIR(status.st_mode))
    return failure("file_unreadable", path.string(), "this is a folder; give the path of a file");
  if (!S_ISREG(status.st_mode))
    return failure(
        "file_unreadable", path.string(),
        "this is a pipe or a device, not a file; write what comes from it into a file and give that");
  file.size = static_cast<std::uintmax_t>(status.st_size);
  return file;
}

}  // namespace

Expected<std::uintmax_t> regular_file_size(const std::filesystem::path& path) {
  const auto file = open(path);
  return file ? Expected<std::uintmax_t>(file->size) : tl::unexpected(file.error());
}

Expected<std::string> read_bytes(const std::filesystem::path& path, std::uintmax_t most) {
  const auto file = open(path);
  if (!file) return tl::unexpected(file.error());
  if (file->size > most)
    return failure("too_large", path.string(),
                   fmt::format("has {} bytes; {} at most are read at once", file->size, most));
  std::string text;
  constexpr std::size_t block = std::size_t{1} << 20U;
  text.resize(static_cast<std::size_t>(file->size));
  std::size_t size = 0;
  while (true) {  // a file that grows meanwhile, or of /proc, which says that it is empty
    if (size == text.size()) text.resize(std::min<std::uintmax_t>(size + block, most + 1));
    const ssize_t done = ::read(file->number, text.data() + size, text.size() - size);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return unreadable(path, errno);
    if (done == 0) break;
    size += static_cast<std::size_t>(done);
    if (size > most)
      return failure("too_large", path.string(),
                     fmt::format("has more than the {} bytes that are read at once", most));
  }
  text.resize(size);
  return text;
}

}  // namespace sinew::inline v1

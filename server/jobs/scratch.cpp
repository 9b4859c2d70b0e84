#include "scratch.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>

namespace sinew::server {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = "sinew-serve-";
/// [s] A folder is made before it can be locked.
constexpr std::time_t fresh = 60;

int open_folder(const fs::path& path) {
  return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

bool is_left_over(int folder) {
  struct stat status = {};
  return ::fstat(folder, &status) == 0 && status.st_uid == ::geteuid() &&
         status.st_mtime < std::time(nullptr) - fresh && ::flock(folder, LOCK_EX | LOCK_NB) == 0;
}

void remove_left_overs(const fs::path& where) {
  std::error_code ignored;
  for (fs::directory_iterator entry(where, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    if (!entry->path().filename().native().starts_with(prefix)) continue;
    const int folder = open_folder(entry->path());
    if (folder < 0) continue;
    std::error_code kept;
    if (is_left_over(folder)) fs::remove_all(entry->path(), kept);
    ::close(folder);
  }
}

}  // namespace

Expected<Scratch> Scratch::make() {
  std::error_code none;
  const fs::path where = fs::temp_directory_path(none);
  remove_left_overs(where);
  std::string path = (where / prefix).native() + "XXXXXX";
  if (none || !::mkdtemp(path.data()))
    return failure("file_unwritable", "temporary files",
                   fmt::format("no folder can be made among them: {}", std::strerror(errno)));
  const int folder = open_folder(path);
  if (folder >= 0) ::flock(folder, LOCK_EX | LOCK_NB);
  return Scratch(path, folder);
}

Scratch::~Scratch() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace sinew::server

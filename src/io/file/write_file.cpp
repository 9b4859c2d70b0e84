#include "io/file/write_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <optional>
#include <random>
#include <system_error>

#include "sinew/io/table.hpp"

namespace sinew::inline v1 {
namespace {

namespace fs = std::filesystem;

/// `/dev/fd/3` and `/proc/self/fd/3` are files of this process that are open already: their number.
std::optional<int> open_file(const fs::path& path) {
  const std::string text = path.lexically_normal();
  for (const std::string_view folder : {"/proc/self/fd/", "/dev/fd/"}) {
    if (!text.starts_with(folder)) continue;
    const std::string number = text.substr(folder.size());
    if (number.empty() || number.size() > 6 || number.find_first_not_of("0123456789") != std::string::npos)
      return {};
    return std::stoi(number);
  }
  return {};
}

/// A failure that no retry mends; EINTR is none.
int write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(file, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return done == 0 ? ENOSPC : errno;
    bytes.remove_prefix(static_cast<std::size_t>(done));
  }
  return 0;
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// A name that nobody has, in the folder of the file: a rename does not cross file systems.
fs::path beside(const fs::path& target) {
  static std::random_device random;
  return folder_of(target) / fmt::format(".sinew-{:08x}{:08x}", random(), random());
}

/// As the file had them that is replaced; the owner where this is allowed.
void keep_permissions(int file, const struct stat& old) {
  struct stat now = {};
  ::fstat(file, &now);
  if ((now.st_uid != old.st_uid || now.st_gid != old.st_gid) && ::fchown(file, old.st_uid, old.st_gid) != 0)
    errno = 0;
  ::fchmod(file, old.st_mode & 0777U);  // some file systems have none
}

}  // namespace

std::string unwritable(int reason) {
  const auto way_out = [&] {
    switch (reason) {
      case ENOSPC:
      case EDQUOT:
        return "make room on the disc";
      case EFBIG:
        return "raise the limit on the size of files, or make it smaller";
      case EISDIR:
        return "give the name of a file";
      default:
        return "give a folder you may write to";
    }
  };
  return fmt::format("cannot be written: {}; {}", std::generic_category().message(reason), way_out());
}

Expected<fs::path> without_links(const fs::path& path) {
  constexpr int max_links = 40;  // as Linux has it
  fs::path result = path;
  std::error_code code;
  for (int k = 0; k < max_links; ++k) {
    if (open_file(result) || !fs::is_symlink(fs::symlink_status(result, code))) return result;
    const fs::path to = fs::read_symlink(result, code);
    if (code) break;
    result = to.is_absolute() ? to : result.parent_path() / to;
  }
  return failure("file_unwritable", path.string(), unwritable(ELOOP));
}

bool is_stream(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

tl::unexpected<Errors> FileWriter::fails(int reason) const {
  return failure("file_unwritable", path_.string(), unwritable(reason));
}

Expected<FileWriter> FileWriter::open(const fs::path& path, std::string_view part_ending, bool resumes) {
  FileWriter writer;
  writer.path_ = path;
  auto target = without_links(path);
  if (!target) return tl::unexpected(std::move(target.error()));
  writer.target_ = std::move(*target);
  if (const auto number = open_file(writer.target_)) {
    writer.file_ = ::fcntl(*number, F_DUPFD_CLOEXEC, 3);
    if (writer.file_ < 0) return writer.fails(errno);
    return writer;
  }
  struct stat old = {};
  const bool is_there = ::stat(writer.target_.c_str(), &old) == 0;
  if (is_there && S_ISDIR(old.st_mode)) return writer.fails(EISDIR);
  if (is_there && ::access(writer.target_.c_str(), W_OK) != 0) return writer.fails(errno);
  if (is_there && !S_ISREG(old.st_mode)) {
    writer.file_ = ::open(writer.target_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (writer.file_ < 0) return writer.fails(errno);
    return writer;
  }
  std::error_code code;
  if (writer.target_.has_parent_path()) fs::create_directories(writer.target_.parent_path(), code);
  if (code)
    return failure(
        "file_unwritable", path.string(),
        fmt::format("its folder cannot be made: {}; give a folder you may write to", code.message()));
  constexpr int tries = 100;
  for (int k = 0; k < tries && writer.file_ < 0; ++k) {
    const fs::path name =
        part_ending.empty() ? beside(writer.target_) : fs::path(writer.target_) += part_ending;
    if (!part_ending.empty() && !resumes)
      ::unlink(name.c_str());  // of a run that was killed; no link is followed
    writer.file_ = ::open(name.c_str(), O_RDWR | O_CREAT | (resumes ? 0 : O_EXCL) | O_NOFOLLOW | O_CLOEXEC,
                          is_there ? 0600 : 0666);
    if (writer.file_ >= 0) writer.part_ = name;
    if (writer.file_ < 0 && errno != EEXIST) return writer.fails(errno);
  }
  if (writer.file_ < 0) return writer.fails(EEXIST);
  if (is_there) keep_permissions(writer.file_, old);
  writer.is_new_ = !is_there;
  return writer;
}

Expected<void> FileWriter::write(std::string_view bytes) {
  if (const int reason = write_all(file_, bytes)) return fails(reason);
  return {};
}

Expected<void> FileWriter::bring_to_disc() {
  if (file_ < 0) return {};
  if (!is_stream() && ::fsync(file_) != 0 && errno != EINVAL && errno != ENOTSUP) return fails(errno);
  if (::close(std::exchange(file_, -1)) != 0 && errno != EINTR) return fails(errno);
  return {};
}

Expected<void> FileWriter::place(bool is_one_of_several) {
  if (is_stream()) return {};
  if (is_one_of_several && !is_new_) {
    if (::renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) {
      is_swapped_ = is_placed_ = true;
      return {};
    }
    const bool cannot =
        errno == EINVAL || errno == ENOSYS || errno == ENOENT;  // of the file system; gone meanwhile
    if (!cannot) return fails(errno);
  }
  if (::rename(part_.c_str(), target_.c_str()) != 0) return fails(errno);
  is_placed_ = true;
  return {};
}

void FileWriter::take_back() {
  if (is_stream() || !is_placed_) return;
  if (is_swapped_)
    ::renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE);
  else if (is_new_)
    ::unlink(target_.c_str());
}

Expected<void> FileWriter::finish() { return finish_together(std::span(this, 1)); }

Expected<void> finish_together(std::span<FileWriter> files) {
  for (FileWriter& file : files)
    if (auto done = file.bring_to_disc(); !done) return done;
  for (std::size_t k = 0; k < files.size(); ++k) {
    auto done = files[k].place(files.size() > 1);
    if (done) continue;
    for (FileWriter& earlier : files.first(k)) earlier.take_back();
    return done;
  }
  for (FileWriter& file : files) {
    if (file.is_stream()) continue;
    if (std::exchange(file.is_swapped_, false)) ::unlink(file.part_.c_str());
    const int folder = ::open(folder_of(file.target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) continue;
    ::fsync(folder);  // the name; not every system can
    ::close(folder);
  }
  return {};
}

FileWriter::~FileWriter() {
  if (file_ >= 0) ::close(file_);
  if (!part_.empty() && !keeps_part_ && (!is_placed_ || is_swapped_)) ::unlink(part_.c_str());
}

Expected<void> write_text(std::string_view text, const fs::path& path) {
  auto file = FileWriter::open(path);
  if (!file) return tl::unexpected(std::move(file.error()));
  if (auto done = file->write(text); !done) return done;
  return file->finish();
}

}  // namespace sinew::inline v1

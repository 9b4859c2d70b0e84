#include "study/results/result_in_place.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "study/results/file_bytes.hpp"
#include "study/results/hdf5_columns.hpp"

namespace sinew::inline v1 {
namespace {

using hdf5::Handle;
namespace fs = std::filesystem;

/// Names of all columns as they are in the file.
std::vector<std::string> names_of(const ResultLayout& layout) {
  std::vector<std::string> names;
  if (!layout.is_grid)
    for (const auto& axis : layout.axes) names.push_back(axis.name);
  for (const auto& column : layout.columns) names.push_back(column.name);
  names.emplace_back("status");
  return names;
}

std::size_t width_of(std::size_t column, std::size_t columns) {
  return column + 1 == columns ? sizeof(SampleStatus) : sizeof(double);
}

}  // namespace

Expected<ResultInPlace> ResultInPlace::open(const fs::path& path, const ResultLayout& layout, bool resumes) {
  auto file = FileWriter::open(path, ".part", resumes);
  if (!file) return tl::unexpected(file.error());
  if (file->is_stream()) return failure("file_unwritable", path.string(), unwritable(ESPIPE));
  ResultInPlace result(path, std::move(*file));
  if (!resumes || !result.go_on(layout))
    if (const auto begun = result.begin(layout); !begun) return tl::unexpected(begun.error());
  result.file_.keep_part();
  return result;
}

Expected<void> ResultInPlace::begin(const ResultLayout& layout) {
  hdf5::be_quiet();
  Hdf5Columns columns(file_.part(), layout, Hdf5Columns::Room::at_once);
  bool is_good = columns.is_good() && columns.put_provenance();
  places_.clear();
  for (const Handle& data : columns.data()) places_.push_back(H5Dget_offset(data));
  is_good = columns.close() && is_good && !hdf5::has_failed();
  if (!is_good) return failure("file_unwritable", path_.string(), unwritable(hdf5::last_reason()));
  return make_room();
}

/// A full disc is told before anything is computed, where the file system can tell.
Expected<void> ResultInPlace::make_room() {
  struct stat status = {};
  ::fstat(file_.file(), &status);
  bytes_ = static_cast<std::uint64_t>(status.st_size);
  int reason = ::fallocate(file_.file(), 0, 0, status.st_size) == 0 ? 0 : errno;
  if (reason == EOPNOTSUPP || reason == ENOSYS || reason == EINVAL) reason = 0;
  if (reason == 0 && ::fdatasync(file_.file()) != 0)
    reason = errno;  // before the first chunk is said to be there
  if (reason != 0) return failure("file_unwritable", path_.string(), unwritable(reason));
  return {};
}

bool ResultInPlace::go_on(const ResultLayout& layout) {
  hdf5::be_quiet();
  struct stat status = {};
  if (::fstat(file_.file(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  bytes_ = static_cast<std::uint64_t>(status.st_size);
  const Handle file(H5Fopen(file_.part().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.ok()) return false;
  places_.clear();
  const auto names = names_of(layout);
  for (std::size_t c = 0; c < names.size(); ++c) {
    const std::size_t width = width_of(c, names.size());
    const Handle data(H5Dopen2(file, names[c].c_str(), H5P_DEFAULT), H5Dclose);
    const Handle space(H5Dget_space(data), H5Sclose), type(H5Dget_type(data), H5Tclose);
    if (!data.ok() || H5Tget_size(type) != width ||
        H5Sget_simple_extent_npoints(space) != static_cast<hssize_t>(layout.rows))
      return false;
    places_.push_back(H5Dget_offset(data));
    if (places_.back() == HADDR_UNDEF || places_.back() + width * layout.rows > bytes_) return false;
  }
  return true;
}

tl::unexpected<Errors> ResultInPlace::fails(const std::string& reason) const {
  return failure("write_failed", path_.string(), reason + "; the chunks are kept, go on with --resume");
}

Expected<void> ResultInPlace::write(const ResultRows& rows) {
  const std::size_t axes = rows.axes.size() / rows.count;  // and whatever else stands before the columns
  for (std::size_t c = 0; c < places_.size(); ++c) {
    const std::size_t width = width_of(c, places_.size());
    const auto bytes = c + 1 == places_.size()
                           ? std::as_bytes(rows.statuses)
                           : std::as_bytes((c < axes ? rows.axes : rows.columns)
                                               .subspan((c < axes ? c : c - axes) * rows.count, rows.count));
    if (!write_all(file_.file(), places_[c] + rows.first * width, bytes)) return fails(unwritable(errno));
    unsent_ += bytes.size();
  }
#ifdef SYNC_FILE_RANGE_WRITE
  constexpr std::size_t enough = std::size_t{16} << 20U;
  if (unsent_ > enough) {  // on their way while more is computed, so that the end need not wait for all
    unsent_ = 0;
    ::sync_file_range(file_.file(), 0, 0, SYNC_FILE_RANGE_WRITE);
  }
#endif
  return {};
}

bool ResultInPlace::read(std::size_t first, std::size_t count, std::vector<double>& values,
                         std::vector<SampleStatus>& statuses) const {
  values.resize((places_.size() - 1) * count);
  statuses.resize(count);
  for (std::size_t c = 0; c + 1 < places_.size(); ++c)
    if (!read_all(file_.file(), places_[c] + first * sizeof(double),
                  std::as_writable_bytes(std::span(values).subspan(c * count, count))))
      return false;
  return read_statuses(first, statuses);
}

bool ResultInPlace::read_statuses(std::size_t first, std::span<SampleStatus> statuses) const {
  return read_all(file_.file(), places_.back() + first, std::as_writable_bytes(statuses));
}

void ResultInPlace::flush() { ::fdatasync(file_.file()); }

Expected<void> ResultInPlace::finish() {
  if (const auto done = file_.finish(); !done) return fails(done.error().front().message);
  return {};
}

}  // namespace sinew::inline v1

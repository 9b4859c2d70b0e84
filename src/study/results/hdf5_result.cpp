/// Results as HDF5, written by the library: compressed, reduced, or with what was fitted to them.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>

#include "io/file/write_file.hpp"
#include "study/results/hdf5_columns.hpp"
#include "study/results/result_file.hpp"

namespace sinew::inline v1 {
namespace {

using hdf5::Handle;
namespace fs = std::filesystem;

constexpr std::size_t bytes_to_send = std::size_t{16} << 20U;

/// The boxes of an array that a stretch of its elements, in C order, is made of: calls `use(corner, sizes)`.
class Boxes {
 public:
  using Use = std::function<bool(const std::vector<hsize_t>& corner, const std::vector<hsize_t>& sizes)>;
  Boxes(const std::vector<hsize_t>& shape, const Use& use)
      : shape_(shape),
        use_(use),
        corner_(shape.size(), 0) {}

  bool cover(hsize_t first, hsize_t count) { return cover(0, first, count); }

 private:
  /// Within the part of the array that the coordinates before `axis` fix.
  bool cover(std::size_t axis, hsize_t first, hsize_t count) {
    hsize_t step = 1;
    for (std::size_t a = axis + 1; a < shape_.size(); ++a) step *= shape_[a];
    while (count > 0) {
      corner_[axis] = first / step;
      const hsize_t inside = first % step, whole = count / step;
      const bool is_whole = inside == 0 && whole > 0;
      const hsize_t taken = is_whole ? whole * step : std::min(count, step - inside);
      if (is_whole ? !box(axis, whole) : !cover(axis + 1, inside, taken)) return false;
      first += taken;
      count -= taken;
    }
    return true;
  }
  bool box(std::size_t axis, hsize_t along) {
    std::vector<hsize_t> sizes(shape_.size(), 1);
    sizes[axis] = along;
    for (std::size_t a = axis + 1; a < shape_.size(); ++a) {
      sizes[a] = shape_[a];
      corner_[a] = 0;
    }
    return use_(corner_, sizes);
  }

  const std::vector<hsize_t>& shape_;
  const Use& use_;
  std::vector<hsize_t> corner_;
};

class Hdf5Result : public ResultFile {
 public:
  Hdf5Result(const fs::path& path, ResultLayout layout)
      : path_(path),
        layout_(std::move(layout)),
        place_(FileWriter::open(path, ".part")) {
    hdf5::be_quiet();
    if (!place_) {
      reason_ = place_.error().front().message;
      return;
    }
    columns_.emplace(place_->part(), layout_, Hdf5Columns::Room::when_written);
    check(columns_->is_good());
  }
  Expected<void> begun() const override {
    if (reason_.empty()) return {};
    return failure("file_unwritable", path_.string(), reason_);
  }
  bool wants_axes() const override { return !layout_.is_grid; }  // else they are scales

  Expected<void> write(const ResultRows& rows) override {
    const std::size_t axes = layout_.is_grid ? 0 : layout_.axes.size();
    for (std::size_t c = 0; reason_.empty() && c < columns_->data().size(); ++c) {
      const bool is_axis = c < axes, is_status = c >= axes + layout_.columns.size();
      const std::size_t at = (is_axis ? c : c - axes) * rows.count;
      const void* values = is_status ? static_cast<const void*>(rows.statuses.data())
                                     : (is_axis ? rows.axes : rows.columns).data() + at;
      check(put(columns_->data()[c], rows, values, is_status));
      pending_ += rows.count * (is_status ? sizeof(SampleStatus) : sizeof(double));
    }
    if (pending_ > bytes_to_send) send();
    return outcome();
  }

  Expected<void> finish(std::span<const FittedTerms> fits) override {
    if (reason_.empty()) check(columns_->put_provenance() && put_fits(fits));
    check((!columns_ || columns_->close()) && !hdf5::has_failed());
    if (reason_.empty())
      if (const auto done = place_->finish(); !done) reason_ = done.error().front().message;
    return outcome();
  }

 private:
  /// Why the library failed, of the first failure that there was.
  void check(bool is_good) {
    if (!is_good && reason_.empty()) reason_ = unwritable(hdf5::last_reason());
  }
  Expected<void> outcome() const {
    if (reason_.empty()) return {};
    return failure("write_failed", path_.string(), reason_ + "; the chunks are kept, go on with --resume");
  }

  /// On their way to the disc while more is being written, so that the end need not wait for all of it.
  void send() {
    pending_ = 0;
#ifdef SYNC_FILE_RANGE_WRITE
    const int file = ::open(place_->part().c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0) return;
    ::sync_file_range(file, 0, 0, SYNC_FILE_RANGE_WRITE);
    ::close(file);
#endif
  }

  bool put(const Handle& data, const ResultRows& rows, const void* values, bool is_status) {
    const hid_t type = is_status ? H5T_NATIVE_UINT8 : H5T_NATIVE_DOUBLE;
    const std::size_t width = is_status ? sizeof(SampleStatus) : sizeof(double);
    const Handle space(H5Dget_space(data), H5Sclose);
    const auto* next = static_cast<const std::byte*>(values);
    const Boxes::Use write = [&](const std::vector<hsize_t>& corner, const std::vector<hsize_t>& sizes) {
      hsize_t count = 1;
      for (const hsize_t size : sizes) count *= size;
      const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
      const void* from = next;
      next += count * width;
      return H5Sselect_hyperslab(space, H5S_SELECT_SET, corner.data(), nullptr, sizes.data(), nullptr) >= 0 &&
             H5Dwrite(data, type, memory, space, H5P_DEFAULT, from) >= 0;
    };
    return Boxes(columns_->shape(), write).cover(rows.first, rows.count);
  }

  bool put_fits(std::span<const FittedTerms> fits) {
    if (fits.empty()) return true;
    const Handle all = columns_->group("fits");
    bool good = all.ok();
    for (const FittedTerms& fit : fits) {
      const Handle list(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
      H5Pset_obj_track_times(list, false);
      const Handle one(H5Gcreate2(all, fit.name.c_str(), H5P_DEFAULT, list, H5P_DEFAULT), H5Gclose);
      good = good && columns_->put_numbers(one, "coefficients", fit.coefficients) &&
             columns_->put_numbers(one, "deviations", fit.deviations) && put_residuals(one, fit) &&
             hdf5::put_attribute(one, "terms", fmt::format("{}", fmt::join(fit.terms, "; "))) &&
             hdf5::put_attribute(one, "units", fit.unit) && hdf5::put_attribute(one, "rms", fit.rms) &&
             hdf5::put_attribute(one, "largest", fit.largest) &&
             hdf5::put_attribute(one, "samples", static_cast<double>(fit.samples));
    }
    return good;
  }

  /// Of each column of a fit; names, units and formulas in the order of the numbers.
  bool put_residuals(const Handle& group, const FittedTerms& fit) {
    std::vector<double> rms, largest, relative;
    std::vector<std::string> names, units, texts;
    for (const FittedColumn& column : fit.columns) {
      rms.push_back(column.rms);
      largest.push_back(column.largest);
      relative.push_back(column.relative);
      names.push_back(column.name);
      units.push_back(column.unit);
      texts.push_back(column.text);
    }
    return columns_->put_numbers(group, "column_rms", rms) &&
           columns_->put_numbers(group, "column_largest", largest) &&
           columns_->put_numbers(group, "column_relative", relative) &&
           hdf5::put_attribute(group, "columns", fmt::format("{}", fmt::join(names, "; "))) &&
           hdf5::put_attribute(group, "column_units", fmt::format("{}", fmt::join(units, "; "))) &&
           (fit.columns.front().text.empty() ||
            hdf5::put_attribute(group, "formulas", fmt::format("{}", fmt::join(texts, "; "))));
  }

  fs::path path_;
  ResultLayout layout_;
  Expected<FileWriter> place_;
  std::string reason_;
  std::optional<Hdf5Columns> columns_;
  std::size_t pending_ = 0;  ///< bytes written since they were sent
};

}  // namespace

std::unique_ptr<ResultFile> create_hdf5(const fs::path& path, ResultLayout layout) {
  return std::make_unique<Hdf5Result>(path, std::move(layout));
}

std::string recorded_hdf5_fact(const fs::path& path, const std::string& name) {
  hdf5::be_quiet();
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.ok() || H5Lexists(file, "provenance", H5P_DEFAULT) <= 0) return {};
  const Handle facts(H5Gopen2(file, "provenance", H5P_DEFAULT), H5Gclose);
  return hdf5::text_dataset(facts, name.c_str());
}

}  // namespace sinew::inline v1

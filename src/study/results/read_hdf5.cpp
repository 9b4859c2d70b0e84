#include <fmt/format.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>

#include "io/file/read_bytes.hpp"
#include "sinew/io/node.hpp"
#include "sinew/study/study.hpp"
#include "study/results/hdf5.hpp"

namespace sinew::inline v1 {
namespace {

using hdf5::Handle;
namespace fs = std::filesystem;

constexpr std::uintmax_t max_bytes = std::uintmax_t{3} << 30U;     ///< of all columns together
constexpr std::uintmax_t small_bytes = std::uintmax_t{64} << 20U;  ///< that no file needs to deserve
constexpr std::uintmax_t max_packed = 256;  ///< bytes that one byte of a larger file stands for
constexpr std::size_t max_columns = 100'000;

/// A dataset of numbers.
struct Data {
  std::string name, unit;
  std::vector<hsize_t> shape;
  Handle handle;
  bool is_scale = false;

  /// A file may say that it has more than there are numbers for.
  hsize_t size() const {
    hsize_t product = 1;
    for (const hsize_t count : shape)
      if (__builtin_mul_overflow(product, count, &product)) return std::numeric_limits<hsize_t>::max();
    return product;
  }
};

herr_t collect_name(hid_t, const char* name, const H5L_info_t*, void* into) {
  static_cast<std::vector<std::string>*>(into)->emplace_back(name);
  return 0;
}

/// In the order they were made, where the file knows it.
std::vector<std::string> names_in(hid_t file) {
  std::vector<std::string> names;
  hsize_t index = 0;
  if (H5Literate(file, H5_INDEX_CRT_ORDER, H5_ITER_INC, &index, collect_name, &names) < 0) {
    names.clear();
    index = 0;
    H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, &index, collect_name, &names);
  }
  return names;
}

Error column_error(const fs::path& path, const std::string& column, std::string_view why) {
  return {"file_unreadable", path.string(), fmt::format("its column {} {}", in_quotes(column), why)};
}

/// Why a column is not read: its numbers are in other files, whose names the file chooses, or less than it
/// says is there. Empty where it is.
std::string_view objection(const Data& data, std::uintmax_t file_size) {
  const Handle made(H5Dget_create_plist(data.handle), H5Pclose);
  if (!made.ok()) return "cannot be read";
  const H5D_layout_t layout = H5Pget_layout(made);
  if (layout == H5D_VIRTUAL || H5Pget_external_count(made) > 0)
    return "lies in other files, which are not opened; write it into the file itself";
  const Handle type(H5Dget_type(data.handle), H5Tclose);
  const std::uintmax_t numbers = data.size(), width = std::max<std::size_t>(H5Tget_size(type), 1);
  const std::uintmax_t stored = H5Dget_storage_size(data.handle);
  constexpr std::uintmax_t widest = 16;  // numbers of four words; a file may say that one has gigabytes
  if (width > widest) return "has numbers of a size that no number has; the file is damaged";
  if (stored > file_size) return "says that it is larger than the file; the file is cut off or damaged";
  if (layout != H5D_CHUNKED && numbers > 0 && stored / width < numbers && stored > 0)
    return "has less numbers than it says; the file is damaged";
  const std::uintmax_t room = std::max(small_bytes, max_packed * stored);
  if (numbers > room / sizeof(double))
    return "says that it has far more numbers than the file can hold; the file is damaged, or made to fill "
           "the memory";
  if (layout != H5D_CHUNKED) return {};
  std::array<hsize_t, H5S_MAX_RANK> sizes{};
  const int rank = H5Pget_chunk(made, static_cast<int>(sizes.size()), sizes.data());
  std::uintmax_t chunk = width;
  for (int a = 0; a < rank; ++a)
    if (__builtin_mul_overflow(chunk, sizes[static_cast<std::size_t>(a)], &chunk) || chunk > room)
      return "is cut into blocks that are larger than the file can fill; the file is damaged, or made to "
             "fill the memory";
  return {};
}

/// Columns of numbers at the root, with what is wrong with them. Links are not followed: they may lead
/// anywhere, to themselves or into other files.
Expected<std::vector<Data>> columns_of(hid_t file, const fs::path& path) {
  std::vector<Data> found;
  for (const std::string& name : names_in(file)) {
    H5L_info_t link{};
    if (H5Lget_info(file, name.c_str(), &link, H5P_DEFAULT) < 0) continue;
    if (link.type != H5L_TYPE_HARD)
      return tl::unexpected(
          Errors{column_error(path, name, "is a link, which is not followed; give a file that has it")});
    Data data{.name = name,
              .unit = {},
              .shape = {},
              .handle = {H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose}};
    if (!data.handle.ok()) continue;  // a group
    const Handle type(H5Dget_type(data.handle), H5Tclose), space(H5Dget_space(data.handle), H5Sclose);
    const H5T_class_t kind = H5Tget_class(type);
    const int rank = H5Sget_simple_extent_ndims(space);
    if ((kind != H5T_FLOAT && kind != H5T_INTEGER) || rank < 1) continue;
    data.shape.resize(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space, data.shape.data(), nullptr);
    data.unit = hdf5::text_attribute(data.handle, "units");
    data.is_scale = H5DSis_scale(data.handle) > 0;
    found.push_back(std::move(data));
    if (found.size() > max_columns)
      return failure("too_many_columns", path.string(),
                     fmt::format("has more than {} columns; give fewer", max_columns));
  }
  return found;
}

bool read(const Data& data, std::vector<double>& values) {
  values.resize(data.size());
  return H5Dread(data.handle, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
}

/// `status: 0 unreachable, 1 left_domain, ...`, as in CSV; empty where the codes have no words.
std::string status_comment(hid_t data) {
  std::istringstream words(hdf5::text_attribute(data, "flag_meanings"));
  if (H5Aexists(data, "flag_values") <= 0) return {};
  const Handle attribute(H5Aopen(data, "flag_values", H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(attribute), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  constexpr hssize_t most = 256;
  if (count < 1 || count > most) return {};
  std::vector<double> codes(static_cast<std::size_t>(count));
  if (H5Aread(attribute, H5T_NATIVE_DOUBLE, codes.data()) < 0) return {};
  std::string text, word;
  for (std::size_t k = 0; k < codes.size() && words >> word; ++k)
    text += fmt::format("{} {} {}", k == 0 ? "status:" : ",", codes[k], word);
  return text;
}

/// The values of an axis at all samples: it stands for dimension `d` of the shape.
std::vector<double> written_out(const std::vector<double>& values, const std::vector<hsize_t>& shape,
                                std::size_t d) {
  hsize_t inner = 1, all = 1;
  for (std::size_t a = 0; a < shape.size(); ++a) {
    all *= shape[a];
    if (a > d) inner *= shape[a];
  }
  std::vector<double> column(all);
  for (hsize_t k = 0; k < all; ++k) column[k] = values[k / inner % shape[d]];
  return column;
}

}  // namespace

Expected<Table> read_hdf5(const fs::path& path) {
  hdf5::be_quiet();
  const auto file_size = regular_file_size(path);
  if (!file_size) return tl::unexpected(file_size.error());
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.ok())
    return failure("file_unreadable", path.string(),
                   "this is no HDF5 file, or it is damaged; give one that sweep has written");
  const auto data = columns_of(file, path);
  if (!data) return tl::unexpected(data.error());
  const auto first = std::ranges::find_if(*data, [](const Data& one) { return !one.is_scale; });
  if (first == data->end())
    return failure("no_columns", path.string(),
                   "holds no columns of numbers; give a file that sweep has written");
  const std::vector<hsize_t>& shape = first->shape;
  if (first->size() > max_bytes / sizeof(double) / data->size())
    return failure(
        "too_large", path.string(),
        fmt::format("has {} samples in {} columns, too many to read at once", first->size(), data->size()));
  if (const std::string_view why = objection(*first, *file_size);
      !why.empty())  // axes are written out as long
    return tl::unexpected(Errors{column_error(path, first->name, why)});
  Table table;
  std::vector<double> values;
  std::string meanings;
  for (std::size_t d = 0, scales = 0; d < data->size(); ++d) {
    const Data& one = (*data)[d];
    const bool is_axis = one.is_scale && scales < shape.size() && one.size() == shape[scales];
    if (!is_axis && one.shape != shape) continue;
    if (const std::string_view why = objection(one, *file_size); !why.empty())
      return tl::unexpected(Errors{column_error(path, one.name, why)});
    if (!read(one, values))
      return tl::unexpected(Errors{column_error(path, one.name, "cannot be read; the file is damaged")});
    table.columns.push_back({one.name, one.unit, is_axis ? written_out(values, shape, scales) : values});
    scales += is_axis;
    if (one.name == "status") meanings = status_comment(one.handle);
  }
  if (const std::string title = hdf5::text_attribute(file, "title"); !title.empty())
    table.comments.push_back(title);
  if (!meanings.empty()) table.comments.push_back(meanings);
  return table;
}

Expected<Table> read_result(const fs::path& path) {
  return path.extension() == ".h5" ? read_hdf5(path) : read_csv(path);
}

}  // namespace sinew::inline v1

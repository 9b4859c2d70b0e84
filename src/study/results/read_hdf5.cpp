#include <fmt/format.h>
#include <hdf5_hl.h>

#include <algorithm>

#include "sinew/study/result.hpp"
#include "study/results/hdf5.hpp"

namespace sinew::inline v0 {
namespace {

using hdf5::Handle;
namespace fs = std::filesystem;

constexpr hsize_t most_numbers = 400'000'000;  ///< 3 GB

/// A dataset of numbers.
struct Data {
  std::string name, unit;
  std::vector<hsize_t> shape;
  Handle handle;
  bool is_scale = false;

  hsize_t size() const {
    hsize_t product = 1;
    for (const hsize_t count : shape) product *= count;
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

std::vector<Data> columns_of(hid_t file) {
  std::vector<Data> found;
  for (const std::string& name : names_in(file)) {
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
  }
  return found;
}

bool read(const Data& data, std::vector<double>& values) {
  values.resize(data.size());
  return H5Dread(data.handle, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
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
  std::error_code code;
  if (!fs::exists(path, code))
    return failure("file_missing", path.string(), "there is no such file; check the path");
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.ok())
    return failure("file_unreadable", path.string(),
                   "this is no HDF5 file, or it is damaged; give one that sweep has written");
  std::vector<Data> data = columns_of(file);
  const auto first = std::ranges::find_if(data, [](const Data& one) { return !one.is_scale; });
  if (first == data.end())
    return failure("no_columns", path.string(),
                   "holds no columns of numbers; give a file that sweep has written");
  const std::vector<hsize_t> shape = first->shape;
  if (first->size() * data.size() > most_numbers)
    return failure("too_large", path.string(),
                   fmt::format("has {} samples, too many to read at once", first->size()));
  Table table;
  std::vector<double> values;
  for (std::size_t d = 0, scales = 0; d < data.size(); ++d) {
    const Data& one = data[d];
    const bool is_axis = one.is_scale && scales < shape.size() && one.size() == shape[scales];
    if (!is_axis && one.shape != shape) continue;
    if (!read(one, values))
      return failure("file_unreadable", path.string(), fmt::format("its column {} cannot be read", one.name));
    table.columns.push_back({one.name, one.unit, is_axis ? written_out(values, shape, scales) : values});
    scales += is_axis;
  }
  if (const std::string title = hdf5::text_attribute(file, "title"); !title.empty())
    table.comments.push_back(title);
  return table;
}

Expected<Table> read_result(const fs::path& path) {
  return path.extension() == ".h5" ? read_hdf5(path) : read_csv(path);
}

}  // namespace sinew::inline v0

#include "study/results/hdf5_columns.hpp"

#include <hdf5_hl.h>

#include <algorithm>

namespace sinew::inline v1 {

using hdf5::Handle;

namespace {

constexpr hsize_t elements_a_block = 65536;  ///< of compressed columns

}  // namespace

Hdf5Columns::Hdf5Columns(const std::filesystem::path& path, const ResultLayout& layout, Room room)
    : layout_(layout),
      room_(room) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);  // what every reader reads
  H5Pset_obj_track_times(creation, false);                       // the same data, the same bytes
  H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  file_ = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose);
  is_good_ = file_.ok() && create_all();
}

/// Blocks of whole rows where they fit, so that a stretch of samples touches few of them.
std::vector<hsize_t> Hdf5Columns::block() const {
  std::vector<hsize_t> sizes(shape_.size(), 1);
  hsize_t room = elements_a_block;
  for (std::size_t a = shape_.size(); a-- > 0 && room > 0;) {
    sizes[a] = std::max<hsize_t>(1, std::min(shape_[a], room));
    room /= sizes[a];
  }
  return sizes;
}

Handle Hdf5Columns::options(bool is_column) const {
  Handle list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(list, false);
  H5Pset_fill_time(list, H5D_FILL_TIME_NEVER);
  H5Pset_attr_phase_change(list, 16, 8);
  if (is_column && room_ == Room::at_once) H5Pset_alloc_time(list, H5D_ALLOC_TIME_EARLY);
  if (is_column && layout_.compression > 0 && layout_.rows > 0) {
    const auto sizes = block();
    H5Pset_chunk(list, static_cast<int>(sizes.size()), sizes.data());
    H5Pset_shuffle(list);
    H5Pset_deflate(list, static_cast<unsigned>(layout_.compression));
  }
  return list;
}

bool Hdf5Columns::create(const std::string& name, const std::string& unit, hid_t type) {
  const Handle space(H5Screate_simple(static_cast<int>(shape_.size()), shape_.data(), nullptr), H5Sclose);
  Handle data(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, options(true), H5P_DEFAULT),
              H5Dclose);
  bool good = data.ok() && (unit.empty() || hdf5::put_attribute(data, "units", unit));
  for (std::size_t a = 0; good && a < scales_.size(); ++a)
    good = H5DSattach_scale(data, scales_[a], static_cast<unsigned>(a)) >= 0;
  data_.push_back(std::move(data));
  return good;
}

bool Hdf5Columns::create_scale(const ResultLayout::Axis& axis) {
  const hsize_t size = axis.values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  Handle data(
      H5Dcreate2(file_, axis.name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, options(false), H5P_DEFAULT),
      H5Dclose);
  const bool good =
      data.ok() &&
      H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, axis.values.data()) >= 0 &&
      H5DSset_scale(data, axis.name.c_str()) >= 0 &&
      (axis.unit.empty() || hdf5::put_attribute(data, "units", axis.unit));
  scales_.push_back(std::move(data));
  return good;
}

bool Hdf5Columns::create_all() {
  bool good = layout_.title.empty() || hdf5::put_attribute(file_, "title", layout_.title);
  if (layout_.is_grid) {
    for (const auto& axis : layout_.axes) {
      shape_.push_back(axis.values.size());
      good = good && create_scale(axis);
    }
    if (shape_.empty()) shape_.push_back(1);  // all axes were left out
  } else {
    shape_.push_back(layout_.rows);
    for (const auto& axis : layout_.axes) good = good && create(axis.name, axis.unit, H5T_IEEE_F64LE);
  }
  for (const auto& column : layout_.columns) good = good && create(column.name, column.unit, H5T_IEEE_F64LE);
  if (layout_.has_status) good = good && create("status", "", H5T_STD_U8LE) && describe_status();
  return good;
}

/// As the climate and forecast conventions have it: code k of the list of codes is word k.
bool Hdf5Columns::describe_status() {
  std::string words;
  std::vector<SampleStatus> codes;
  for (SampleStatus s = 0; s < sample_statuses; ++s) {
    words += (s == 0 ? "" : " ") + std::string(name_of(s));
    codes.push_back(s);
  }
  const hsize_t count = codes.size();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle values(H5Acreate2(data_.back(), "flag_values", H5T_STD_U8LE, space, H5P_DEFAULT, H5P_DEFAULT),
                      H5Aclose);
  return values.ok() && H5Awrite(values, H5T_NATIVE_UINT8, codes.data()) >= 0 &&
         hdf5::put_attribute(data_.back(), "flag_meanings", words);
}

Handle Hdf5Columns::group(const char* name) const {
  const Handle list(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(list, false);
  return {H5Gcreate2(file_, name, H5P_DEFAULT, list, H5P_DEFAULT), H5Gclose};
}

bool Hdf5Columns::put_provenance() {
  const Handle facts = group("provenance");
  bool good = facts.ok();
  for (const Fact& fact : layout_.provenance)
    good = good && hdf5::put_text(facts, fact.name.c_str(), fact.text);
  return good;
}

bool Hdf5Columns::put_numbers(const Handle& group, const char* name,
                              const std::vector<double>& values) const {
  const hsize_t count = values.size();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle data(H5Dcreate2(group, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, options(false), H5P_DEFAULT),
                    H5Dclose);
  return data.ok() && H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
}

bool Hdf5Columns::close() {
  bool good = true;
  for (Handle& column : data_) good = column.close() && good;
  for (Handle& scale : scales_) good = scale.close() && good;
  return file_.close() && good;
}

}  // namespace sinew::inline v1

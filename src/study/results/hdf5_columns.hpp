/// @file hdf5_columns.hpp
/// The datasets of a file of results: of a grid each column has the grid's shape, with the axes attached as
/// dimension scales; units are attributes, as netCDF and xarray know them.
#pragma once
#include <filesystem>
#include <vector>

#include "study/results/hdf5.hpp"
#include "study/results/result_file.hpp"

namespace sinew::inline v1 {

class Hdf5Columns {
 public:
  enum class Room {
    when_written,
    at_once  ///< in the file, where it is known from then on
  };

  /// Makes the file, with all columns; `is_good` says whether it went well.
  Hdf5Columns(const std::filesystem::path& path, const ResultLayout& layout, Room room);
  bool is_good() const { return is_good_; }

  bool put_provenance();
  hdf5::Handle group(const char* name) const;
  bool put_numbers(const hdf5::Handle& group, const char* name, const std::vector<double>& values) const;
  bool close();

  const std::vector<hsize_t>& shape() const { return shape_; }
  const std::vector<hdf5::Handle>& data() const {
    return data_;
  }  ///< axes that are columns first, status last

 private:
  hdf5::Handle options(bool is_column) const;
  std::vector<hsize_t> block() const;
  bool create(const std::string& name, const std::string& unit, hid_t type);
  bool create_scale(const ResultLayout::Axis& axis);
  bool create_all();
  bool describe_status();

  const ResultLayout& layout_;
  Room room_;
  std::vector<hsize_t> shape_;
  hdf5::Handle file_;
  std::vector<hdf5::Handle> scales_, data_;
  bool is_good_ = false;
};

}  // namespace sinew::inline v1

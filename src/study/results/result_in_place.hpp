/// @file result_in_place.hpp
/// HDF5 results whose rows are written where they stay, in any order. Columns lie in such a file as they do
/// in memory, and where is known as soon as it is begun. It has a name in the meantime until it is complete.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "io/file/write_file.hpp"
#include "study/results/result_file.hpp"

namespace sinew::inline v1 {

class ResultInPlace {
 public:
  /// Begins a file with room for all rows; or goes on with that of a run that was ended, where there is one
  /// with these columns. Code `file_unwritable`.
  static Expected<ResultInPlace> open(const std::filesystem::path& path, const ResultLayout& layout,
                                      bool resumes);

  Expected<void> write(const ResultRows& rows);  ///< Code `write_failed`
  /// Numbers of some rows, those of axes that are columns first, and their statuses. False where the file
  /// cannot be read.
  bool read(std::size_t first, std::size_t count, std::vector<double>& values,
            std::vector<SampleStatus>& statuses) const;
  bool read_statuses(std::size_t first, std::span<SampleStatus> statuses) const;
  void flush();  ///< to the disc
  /// Code `write_failed`; the file of an earlier run then is still there.
  Expected<void> finish();

 private:
  ResultInPlace(std::filesystem::path path, FileWriter file)
      : path_(std::move(path)),
        file_(std::move(file)) {}
  Expected<void> begin(const ResultLayout& layout);
  bool go_on(const ResultLayout& layout);
  Expected<void> make_room();
  tl::unexpected<Errors> fails(const std::string& reason) const;

  std::filesystem::path path_;
  FileWriter file_;
  std::vector<std::uint64_t> places_;  ///< where each column begins, the statuses last
  std::uint64_t bytes_ = 0;
  std::size_t unsent_ = 0;  ///< bytes written that are not yet on their way to the disc
};

}  // namespace sinew::inline v1

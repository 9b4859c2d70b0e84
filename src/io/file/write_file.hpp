/// @file write_file.hpp
/// Whole files: written beside their name, brought to the disc, and renamed over what was there. Whatever
/// fails, the name has the old file or the new one, and nothing else is left in the folder.
///
/// Permissions of a file that is replaced are kept; one that may not be written is refused. A symbolic link
/// stays, the file it leads to is replaced. Devices, pipes and `/dev/stdout` are written as they are, in
/// place.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "sinew/base/error.hpp"

namespace sinew::inline v1 {

/// One file on its way. Destroyed before it is finished, it leaves nothing.
class FileWriter {
 public:
  /// Makes the folders above it. Code of this and all that follows: `file_unwritable`; the message has the
  /// system's reason.
  /// @param part_ending makes the name in the meantime, `.part`, where the next run shall find what a killed
  /// one leaves; default: a name that nobody has
  /// @param resumes what it finds stays
  static Expected<FileWriter> open(const std::filesystem::path& path, std::string_view part_ending = {},
                                   bool resumes = false);

  Expected<void> write(std::string_view bytes);
  /// Puts the file in its place.
  Expected<void> finish();

  /// Whether bytes go to a device or pipe as they are written.
  bool is_stream() const { return part_.empty(); }
  const std::filesystem::path& part() const { return part_; }  ///< the name in the meantime
  int file() const { return file_; }                           ///< open for reading and writing
  void keep_part() { keeps_part_ = true; }  ///< stays there when this is destroyed, for a run that resumes

  FileWriter(FileWriter&& other) noexcept { swap(other); }
  FileWriter& operator=(FileWriter&& other) noexcept {
    swap(other);
    return *this;
  }
  ~FileWriter();

 private:
  FileWriter() = default;
  void swap(FileWriter& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(target_, other.target_);
    std::swap(part_, other.part_);
    std::swap(file_, other.file_);
    std::swap(is_swapped_, other.is_swapped_);
    std::swap(is_placed_, other.is_placed_);
    std::swap(is_new_, other.is_new_);
    std::swap(keeps_part_, other.keeps_part_);
  }
  Expected<void> bring_to_disc();
  Expected<void> place(bool is_one_of_several);
  void take_back();
  tl::unexpected<Errors> fails(int reason) const;
  friend Expected<void> finish_together(std::span<FileWriter> files);

  std::filesystem::path path_, target_, part_;  ///< as given; without links; in the meantime
  int file_ = -1;
  bool is_swapped_ = false;  ///< what was there is at `part_`
  bool is_placed_ = false;
  bool is_new_ = false;  ///< nothing is replaced
  bool keeps_part_ = false;
};

/// Puts several files in their places: all of them, or none.
Expected<void> finish_together(std::span<FileWriter> files);

/// `path` with symbolic links followed to the name they lead to, which need not exist.
Expected<std::filesystem::path> without_links(const std::filesystem::path& path);

/// Whether there is something that is written in place: a device, a pipe.
bool is_stream(const std::filesystem::path& path);

/// What `FileWriter` says of an errno: `cannot be written: No space left on device; make room on the disc`.
std::string unwritable(int reason);

}  // namespace sinew::inline v1

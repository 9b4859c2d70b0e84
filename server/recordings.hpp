/// @file recordings.hpp
/// Recordings of devices in a folder: a list, their texts, their pictures. Names are looked up in the folder
/// and are no paths; what is not a plain file of this form is not there.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

#include "reply.hpp"

namespace sinew::server {

/// What a recording has come to, as the list has it.
struct RecordingSummary {
  std::string robot, table, start;
  std::string worst;  ///< state of a section, as `SLACK`; empty: there is no row
  int version = 0;
  double duration = 0;  ///< [s]
  long rows = 0;        ///< of measurements
  int pictures = 0;
};

class Recordings {
 public:
  /// @param folder that need not be there
  /// @param most bytes of a text
  Recordings(std::filesystem::path folder, std::size_t most) : folder_(std::move(folder)), most_(most) {}

  /// The newest first. Files are read once while they do not change.
  Reply list();
  /// @param every rows of measurements one in so many, besides all events and changes of state; 0: all
  Reply text(std::string_view name, int every) const;
  /// @param number `001`
  Reply picture(std::string_view name, std::string_view number) const;

 private:
  struct Known {
    std::uintmax_t size = 0;
    std::filesystem::file_time_type time;
    RecordingSummary summary;
  };
  std::filesystem::path folder_;
  std::size_t most_;
  std::mutex mutex_;
  std::map<std::string, Known> known_;
};

}  // namespace sinew::server

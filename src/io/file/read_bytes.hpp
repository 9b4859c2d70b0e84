/// @file read_bytes.hpp
/// Regular files, whole. Nothing else is waited for: a pipe or a device that stands where results should be
/// is said to be one.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "sinew/base/error.hpp"

namespace sinew::inline v1 {

/// Its size in bytes. Codes: `file_missing`, `file_unreadable`.
Expected<std::uintmax_t> regular_file_size(const std::filesystem::path& path);

/// Its bytes. Codes: those, `too_large`.
Expected<std::string> read_bytes(const std::filesystem::path& path, std::uintmax_t most);

}  // namespace sinew::inline v1

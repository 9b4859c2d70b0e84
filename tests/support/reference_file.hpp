/// @file reference_file.hpp
/// The one reader of reference numbers under tests/. A file is read once and stays, so that a loop over a
/// part of it, `for (x : reference_file("data/a.json")["rows"])`, does not outlive the whole (the range of a
/// C++20 `for` keeps the last temporary alive only).
#pragma once
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "paths.hpp"

namespace sinew::test {

template <class Json = nlohmann::json>
const Json& reference_file(const std::string& path_in_tests) {
  static std::map<std::string, Json> files;
  auto [entry, is_new] = files.try_emplace(path_in_tests);
  if (is_new) {
    std::ifstream file(std::string(source_folder) + "/tests/" + path_in_tests);
    if (!file) throw std::runtime_error("missing tests/" + path_in_tests);
    entry->second = Json::parse(file);
  }
  return entry->second;
}

}  // namespace sinew::test

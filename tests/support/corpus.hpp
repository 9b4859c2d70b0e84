/// @file corpus.hpp
/// Questions that the fuzz target of sessions begins with: together they have every field.
#pragma once
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "paths.hpp"

namespace sinew::test {

/// Those to a robot that comes with sinew.
inline std::vector<nlohmann::ordered_json> corpus_of(std::string_view robot) {
  std::ifstream file(std::filesystem::path(source_folder) / "tests/fuzz/corpus/session" /
                     (std::string(robot) + ".txt"));
  std::vector<nlohmann::ordered_json> queries;
  std::string line;
  for (std::getline(file, line); std::getline(file, line);)
    queries.push_back(nlohmann::ordered_json::parse(line));
  return queries;
}

}  // namespace sinew::test

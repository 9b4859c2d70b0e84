/// @file sinew_query.hpp
/// Runs the real `sinew query`: what the tests of reference numbers go through.
#pragma once
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "paths.hpp"
#include "reference_file.hpp"

namespace sinew::test {

using Json = nlohmann::ordered_json;

inline const Json& read_json(const std::string& path_in_tests) { return reference_file<Json>(path_in_tests); }

/// Puts the queries to `sinew query ROBOT`, one process, and returns its answers in order.
inline std::vector<Json> ask(const std::string& robot, const std::vector<Json>& queries) {
  static int call = 0;
  const auto folder = std::filesystem::temp_directory_path() /
                      ("sinew-query-" + std::to_string(::getpid()) + "-" + std::to_string(call++));
  std::filesystem::create_directories(folder);
  {
    std::ofstream in(folder / "in.jsonl");
    for (const Json& query : queries) in << query.dump() << '\n';
  }
  const std::string line = std::string(command_path) + " query '" + robot + "' < " +
                           (folder / "in.jsonl").string() + " > " + (folder / "out.jsonl").string();
  const int status = std::system(line.c_str());  // NOLINT: a test, and the line is ours
  if (status != 0) throw std::runtime_error("sinew query ended with status " + std::to_string(status));
  std::vector<Json> answers;
  std::ifstream out(folder / "out.jsonl");
  for (std::string text; std::getline(out, text);) answers.push_back(Json::parse(text));
  std::filesystem::remove_all(folder);
  if (answers.size() != queries.size()) throw std::runtime_error("answers are missing");
  return answers;
}

/// Largest difference of two matrices (lists of rows) over the largest entry of the expected one.
inline double relative_error(const Json& found, const Json& expected) {
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!expected[i].is_array()) {
      worst = std::max(worst, std::abs(found[i].get<double>() - expected[i].get<double>()));
      largest = std::max(largest, std::abs(expected[i].get<double>()));
      continue;
    }
    for (std::size_t j = 0; j < expected[i].size(); ++j) {
      worst = std::max(worst, std::abs(found[i][j].get<double>() - expected[i][j].get<double>()));
      largest = std::max(largest, std::abs(expected[i][j].get<double>()));
    }
  }
  return worst / largest;
}

}  // namespace sinew::test

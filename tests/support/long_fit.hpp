/// @file long_fit.hpp
/// A fit of an arm of three sections (ftdcr-v4) that takes a while, as a question.
#pragma once
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace sinew::test {

/// @param rows that it is fitted to [1]
inline std::string long_fit(int rows = 300) {
  using Json = nlohmann::ordered_json;
  Json columns{{"pulls", Json::array()}, {"markers", Json::array()}};
  for (int k = 0; k < rows; ++k) {
    Json pulls = Json::array();
    for (int m = 0; m < 3; ++m) {
      const double one = 0.002 * std::sin(0.3 * k + m), other = 0.002 * std::cos(0.17 * k * (m + 1));
      for (const double pull : {one, other, -one - other}) pulls.push_back(pull);
    }
    columns["markers"].push_back({5 * pulls[0].get<double>(), 5 * pulls[4].get<double>(), 0.2});
    columns["pulls"].push_back(std::move(pulls));
  }
  return Json{{"query", "identify"}, {"fit", "bending,marker,base"}, {"folds", 3}, {"rows", columns}}.dump();
}

}  // namespace sinew::test

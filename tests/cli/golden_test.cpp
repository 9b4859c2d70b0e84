// What the command says, word for word. Each folder below tests/golden that holds a `cmd` is a case:
//
//     cmd         arguments, one a line; run in a copy of the folder
//     stdin       what it reads, if it reads anything
//     *.yaml      robot files
//     expected    exit code, stdout, stderr
//
// SINEW_UPDATE_GOLDEN=1 writes `expected` anew; read the difference before you keep it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "command.hpp"

namespace {

namespace fs = std::filesystem;
using namespace sinew::test;

const fs::path golden = fs::path(SINEW_SOURCE_DIR) / "tests" / "golden";

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(golden))
    if (entry.path().filename() == "cmd")
      names.push_back(fs::relative(entry.path().parent_path(), golden).string());
  std::ranges::sort(names);
  return names;
}

/// Every match of a pattern, rewritten.
template <class Rewrite>
std::string rewritten(const std::string& text, const std::regex& pattern, Rewrite rewrite) {
  std::string result;
  auto rest = text.cbegin();
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) {
    result.append(rest, (*match)[0].first);
    result += rewrite((*match)[0].str());
    rest = (*match)[0].second;
  }
  return result.append(rest, text.cend());
}

/// The last digits of a double differ between machines: JSON is compared to six digits; what is below 1e-12
/// (a residual) is zero and what is above 1e15 (the condition of a singular matrix) infinite, for both are
/// rounding. So is by how little a path misses its end, and how many iterations rods take to the last digits,
/// which differ between instruction sets.
std::string without_rounding(const std::string& output) {
  static const std::regex number(R"(-?\d+(\.\d+)?([eE][-+]?\d+)?)"), residual(R"(residual [-+.e0-9]+( m)?)"),
      miss(R"(\d(\.\d+)?e-\d+ mm)");
  const auto six_digits = [](const std::string& text) {
    const double value = std::strtod(text.c_str(), nullptr);
    if (!std::isfinite(value)) return text;
    if (std::abs(value) > 1e15) return std::string("~inf");
    return fmt::format("{:.6g}", std::abs(value) < 1e-12 ? 0.0 : value * (1 + 1e-12));
  };
  std::string text;
  for (const std::string& line : lines_of(output))
    text += (line.starts_with('{') ? rewritten(line, number, six_digits) : line) + '\n';
  text = rewritten(text, residual, [](const std::string& found) {
    if (std::strtod(found.c_str() + 9, nullptr) >= 1e-12) return found;
    return std::string(found.ends_with('m') ? "residual ~0 m" : "residual ~0");
  });
  static const std::regex rods(R"(in \d+ iterations, residual ~0, (un)?stable)"),
      rods_json(R"("iterations":\d+(?=[^\n]*"energy"))");
  text = rewritten(text, rods, [](const std::string& found) {
    return "in some iterations, residual ~0," + found.substr(found.rfind(' '));
  });
  text = rewritten(text, rods_json, [](const std::string&) { return std::string("\"iterations\":~"); });
  return rewritten(text, miss, [](const std::string&) { return std::string("~0 mm"); });
}

std::string written_down(const Outcome& outcome) {
  return fmt::format("exit {}\n--- stdout\n{}--- stderr\n{}", outcome.exit, without_rounding(outcome.out),
                     without_rounding(outcome.err));
}

class Golden : public testing::TestWithParam<std::string> {};

TEST_P(Golden, IsWhatTheCommandSays) {
  const fs::path folder = golden / GetParam();
  const Scratch scratch;
  fs::copy(folder, scratch.path(), fs::copy_options::recursive);
  const fs::path input = fs::exists(folder / "stdin") ? folder / "stdin" : fs::path("/dev/null");
  const std::string said =
      written_down(run_command(lines_of(read_text(folder / "cmd")), scratch.path(), input));
  const char* update = std::getenv("SINEW_UPDATE_GOLDEN");
  if (update && *update == '1') write_text(folder / "expected", said);
  EXPECT_EQ(read_text(folder / "expected"), said);
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Command, Golden, testing::ValuesIn(cases()), test_name);

}  // namespace

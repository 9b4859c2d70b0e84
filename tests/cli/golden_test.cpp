// What the command says, word for word. Each file below tests/golden is a case:
//
//     $ sinew check mine.yaml --quiet       the command, as a shell takes it
//     === mine.yaml                         files it finds in its folder, any number; "stdin" is what it
//     reads sinew: 1
//     === exit 2
//     === stdout
//     === stderr
//     mine.yaml:7:19: ...
//
// SINEW_UPDATE_GOLDEN=1 writes what is below "=== exit" anew; read the difference before you keep it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "command.hpp"
#include "paths.hpp"

namespace golden_test {

namespace fs = std::filesystem;
using namespace sinew::test;

const fs::path golden = fs::path(source_folder) / "tests" / "golden";

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(golden))
    if (entry.path().extension() == ".txt")
      names.push_back(fs::relative(entry.path(), golden).replace_extension().string());
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
  return fmt::format("=== exit {}\n=== stdout\n{}=== stderr\n{}", outcome.exit, without_rounding(outcome.out),
                     without_rounding(outcome.err));
}

/// A file of tests/golden, in its parts.
struct Case {
  std::string asked;                                       ///< all that is above the answer
  std::string answered;                                    ///< from "=== exit" on
  std::string command;                                     ///< the first line, without its "$ "
  std::vector<std::pair<std::string, std::string>> files;  ///< name and text
};

Case read_case(const fs::path& path) {
  const std::string text = read_text(path), mark = "\n=== ";
  const std::size_t end = text.find(mark + "exit ") + 1;
  Case result;
  result.asked = text.substr(0, end);
  result.answered = text.substr(end);
  std::size_t at = result.asked.find('\n');
  result.command = result.asked.substr(2, at - 2);
  while (at + 1 < end) {  // at the line feed before a mark
    const std::size_t name = at + mark.size(), line = text.find('\n', name), next = text.find(mark, line);
    result.files.emplace_back(text.substr(name, line - name), text.substr(line + 1, next - line));
    at = next;
  }
  return result;
}

class Golden : public testing::TestWithParam<std::string> {};

TEST_P(Golden, IsWhatTheCommandSays) {
  const fs::path path = golden / (GetParam() + ".txt");
  const Case one = read_case(path);
  ASSERT_TRUE(one.command.starts_with("sinew ") || one.command == "sinew") << one.command;
  const Scratch scratch;
  bool has_input = false;
  for (const auto& [name, text] : one.files) {
    write_text(scratch.path() / name, text);
    has_input = has_input || name == "stdin";
  }
  const std::string said =
      written_down(run_shell(one.command + (has_input ? " <stdin" : ""), scratch.path()));
  const char* update = std::getenv("SINEW_UPDATE_GOLDEN");
  if (update && *update == '1') write_text(path, one.asked + said);
  EXPECT_EQ(one.answered, said);
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Command, Golden, testing::ValuesIn(cases()), test_name);

}  // namespace golden_test

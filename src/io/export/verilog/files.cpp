#include "io/export/verilog/core.hpp"

#include <bit>

#include "io/export/export.hpp"

namespace sinew::inline v1 {
namespace verilog {
namespace {

bool is_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

/// A Verilog identifier; a name of its own is appended, so that none is a keyword.
std::string identifier(const std::string& robot) {
  std::string name;
  for (const char c : robot)
    if (is_word(c))
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  if (name.ends_with('_')) name.pop_back();
  if (name.empty()) return "robot";
  return name[0] >= '0' && name[0] <= '9' ? "robot_" + name : name;
}

}  // namespace

Core core_of(const ControllerTable& table) {
  Core core;
  core.name = identifier(table.robot);
  core.levels = static_cast<int>(std::bit_width(static_cast<unsigned>(table.tendons - 1)));
  core.nearest = 3 + core.levels;  // numbers of the table, products, their sum, rounding
  core.inverse = core.nearest + 4;
  core.forward = table.alike ? 3 : 6;
  return core;
}

}  // namespace verilog

std::vector<ExportedFile> controller_verilog(const ControllerTable& table) {
  const verilog::Core core = verilog::core_of(table);
  return {{core.name + "_core.v", verilog::core_text(table, core)},
          {core.name + "_core_tb.v", verilog::bench_text(table, core)}};
}

}  // namespace sinew::inline v1

#include "io/export/verilog/core.hpp"

#include <algorithm>
#include <bit>

#include "io/export/verilog/adders.hpp"
#include "io/export/verilog/columns.hpp"
#include "io/export/verilog/limits.hpp"
#include "io/export/verilog/modules.hpp"
#include "io/export/verilog/streams.hpp"
#include "io/export/verilog/text.hpp"

namespace sinew::inline v1::verilog {
namespace {

constexpr std::string_view head =
    R"(// Kinematics of the serial robot <robot> in fixed point: LSK forward, inverse, and states of tendons.
// Made by `sinew export ROBOT --to verilog`. Verilog-2005 for synthesis, without primitives of a vendor. One clock,
// synchronous reset. <robot>_core is the whole; <robot>_forward and <robot>_inverse do without
// each other. All bits are those of kernel::LinearTable in C++ with the 16-bit table of hash <hash>, which
// `sinew export ROBOT --to c-header` writes.
//
//   bends    steps of <angle_step> rad (1/2^<angle>); per section (beta_1, beta_2) of a joint of twin pivots,
//            theta (cos phi, sin phi) of a neutral backbone
//   changes  steps of <length_step> mm (1/2^<length>), > 0 pays out; tendon i is bits 16 i to 16 i + 15;
//            at most <rounding> mm from LSK of the same bends
//
// A stream is the <sections> sections of a robot in turn, base first, one a clock or with gaps. `first` stands at the base's
// section and begins anew. Whatever comes is taken at once; there is nothing to wait for. A section's result comes
// <forward> clocks (forward) or <inverse> clocks (inverse) later: a robot's last result, without gaps, <forward_done> or <inverse_done> clocks after its
// first section. With it `in_limits` says that all bends were within limits: hold earlier sections back until then, and
// let nothing move by a robot that was not. Beyond limits sums wrap, as they do in C++.
//
// Test it by <robot>_core_tb.v. How it works and what it takes of an FPGA: docs/theory/controller.md of sinew.
)";

int index_bits(const ControllerTable& table) {
  return std::max(1, static_cast<int>(std::bit_width(table.sections.size() - 1)));
}

/// A `case` of a section's values; the last stands for what does not occur.
template <class Text>
std::string cases(const ControllerTable& table, Text text) {
  std::string result;
  for (std::size_t m = 0; m < table.sections.size(); ++m) {
    const bool is_last = m + 1 == table.sections.size();
    const std::string label = is_last ? "default" : fmt::format("{}'d{}", index_bits(table), m);
    result += fmt::format("      {}: {}{}", label, text(table.sections[m]), is_last ? "" : "\n");
  }
  return result;
}

std::string row_cases(const ControllerTable& table, std::string_view name, Rows ControllerSection::*rows,
                      int places) {
  return cases(table, [&](const ControllerSection& section) {
    std::string list;
    for (std::size_t i = (section.*rows).size(); i-- > 0;)
      for (const std::size_t axis : {1u, 0u})
        list += (list.empty() ? "" : ", ") + signed_text(fixed_point((section.*rows)[i][axis], places));
    return fmt::format("{} <= {{{}}};", name, list);
  });
}

bool has_neutral(const ControllerTable& table) {
  return std::ranges::any_of(table.sections, [](const ControllerSection& section) {
    return section.backbone == kernel::Backbone::neutral;
  });
}

std::string limit_cases(const ControllerTable& table) {
  return cases(table, [&](const ControllerSection& section) {
    const std::int64_t most = table.short_limit(section);
    const std::string limit = fmt::format("limit <= {}", signed_text(most));
    if (!has_neutral(table)) return limit + ";";
    const bool round = section.backbone == kernel::Backbone::neutral;
    return fmt::format("begin {}; square <= 32'd{}; round <= 1'b{:d}; end", limit, most * most, round);
  });
}

template <class Value>
std::string share_cases(const ControllerTable& table, Value value) {
  return cases(table, [&](const ControllerSection& section) {
    return fmt::format("share = {};", signed_text(fixed_point(value(section.share), ShortBits::share)));
  });
}

std::string columns_text(const ControllerTable& table, Rows ControllerSection::*rows, int places) {
  const std::vector<int> x = column_bits(table, rows, places, 0), y = column_bits(table, rows, places, 1);
  std::string list;
  for (std::size_t i = x.size(); i-- > 0;)
    list += fmt::format("{}8'd{}, 8'd{}", list.empty() ? "" : ", ", y[i], x[i]);
  return list;
}

std::string total_text(const ControllerTable& table, const Core& core, std::size_t axis) {
  const std::vector<int> bits = column_bits(table, &ControllerSection::back, table.bits.back, axis);
  return filled(total_module, {{"axis", axis == 0 ? "x" : "y"}, {"tree", adders(bits, core.levels)}});
}

Words sizes(const ControllerTable& table) {
  const int n = table.tendons, sections = static_cast<int>(table.sections.size()), index = index_bits(table);
  return words_of({{"index", index - 1},
                   {"index_bits", index},
                   {"place_bits", index + 1},
                   {"sections", sections},
                   {"last_section", sections - 1},
                   {"tendons", n},
                   {"changes", 16 * n - 1},
                   {"changes_bits", 16 * n},
                   {"pairs", 32 * n - 1},
                   {"states", 2 * n - 1},
                   {"row", table.bits.row},
                   {"back", table.bits.back},
                   {"angle", table.bits.angle},
                   {"length", table.bits.length},
                   {"back_down", table.bits.back + table.bits.length - table.bits.angle}});
}

Words clocks(const ControllerTable& table, const Core& core) {
  const int others = static_cast<int>(table.sections.size()) - 1;
  return words_of({{"levels", core.levels},
                   {"nearest", core.nearest},
                   {"before_nearest", core.nearest - 1},
                   {"asked", core.nearest + 2},
                   {"forward", core.forward},
                   {"forward_last", core.forward - 1},
                   {"forward_rest", core.forward - 2},
                   {"forward_done", core.forward + others},
                   {"inverse", core.inverse},
                   {"inverse_last", core.inverse - 1},
                   {"inverse_rest", core.inverse - 2},
                   {"inverse_done", core.inverse + others}});
}

Words texts(const ControllerTable& table, const Core& core) {
  return {{"robot", core.name},
          {"hash", fmt::format("{:08x}", table.hash())},
          {"angle_step", fmt::format("{:.6g}", table.angle_step())},
          {"length_step", fmt::format("{:.6g}", table.length_step())},
          {"rounding", fmt::format("{:.3g}", table.rounding())},
          {"tolerance", fmt::format("{}", table.short_tolerance())},
          {"row_cases", row_cases(table, "row", &ControllerSection::rows, table.bits.row)},
          {"back_cases", row_cases(table, "back", &ControllerSection::back, table.bits.back)},
          {"limit_cases", limit_cases(table)},
          {"share_cases", share_cases(table, [](double share) { return share; })},
          {"inverse_cases", share_cases(table, [](double share) { return 1 / share; })},
          {"row_bits", columns_text(table, &ControllerSection::rows, table.bits.row)},
          {"back_bits", columns_text(table, &ControllerSection::back, table.bits.back)},
          {"share_bits", fmt::format("{}", share_bits(table, [](double share) { return share; }))},
          {"own_bits", fmt::format("{}", share_bits(table, [](double share) { return 1 / share; }))},
          {"forward_shares", std::string(table.alike ? alike_forward : unlike_forward)},
          {"inverse_shares", std::string(table.alike ? alike_inverse : unlike_inverse)}};
}

}  // namespace

std::string core_text(const ControllerTable& table, const Core& core) {
  Words words = texts(table, core);
  words.merge(sizes(table));
  words.merge(clocks(table, core));
  std::string text(head);
  text += core_module;
  text += forward_module;
  text += inverse_module;
  text += walk_module;
  text += has_neutral(table) ? disc_limits_module : square_limits_module;
  text += tendons_module;
  text += nearest_module;
  for (const std::size_t axis : {0u, 1u}) text += total_text(table, core, axis);
  text += product_module;
  text += state_module;
  if (!table.alike) text += share_module;
  text += fitted_module;
  text += delay_module;
  return filled(text, words);
}

}  // namespace sinew::inline v1::verilog

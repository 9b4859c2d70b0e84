#include "io/export/verilog/core.hpp"
#include "io/export/verilog/text.hpp"
#include "io/export/verilog/vectors.hpp"

namespace sinew::inline v1::verilog {
namespace {

constexpr std::string_view bench_module =
    R"(// Tests <robot>_core by numbers that sinew worked out in C++; made by `sinew export ROBOT --to verilog`.
//   $ verilator --binary --timing --top-module <robot>_core_tb <robot>_core_tb.v <robot>_core.v
//   $ obj_dir/V<robot>_core_tb
// or
//   $ iverilog -g2005 <robot>_core_tb.v <robot>_core.v && ./a.out
// Its last line begins with PASSED or FAILED.
`timescale 1ns / 1ps
module <robot>_core_tb;
  localparam COUNT = <count>;  // sections, of <robots> robots
  reg clock = 1'b0, reset = 1'b1;
  always #5 clock = !clock;

  reg bend_valid = 1'b0, bend_first = 1'b0, measured_valid = 1'b0, measured_first = 1'b0;
  reg signed [15:0] bend_x = 0, bend_y = 0;
  reg [<changes>:0] measured = 0;
  wire change_valid, change_last, in_limits, found_valid, found_last;
  wire [<changes>:0] changes;
  wire signed [15:0] found_x, found_y;
  wire [<states>:0] states;
  <robot>_core core (.clock(clock), .reset(reset), .bend_valid(bend_valid), .bend_first(bend_first),
      .bend_x(bend_x), .bend_y(bend_y), .change_valid(change_valid), .change_last(change_last), .changes(changes),
      .in_limits(in_limits), .measured_valid(measured_valid), .measured_first(measured_first),
      .measured(measured), .tolerance(<tolerance>), .found_valid(found_valid), .found_last(found_last),
      .found_x(found_x), .found_y(found_y), .states(states));

  // {bend_x, bend_y, changes, in_limits} and {measured, found_x, found_y, states}
  reg [<forward_bits>-1:0] forward [0:COUNT-1];
  reg [<inverse_bits>-1:0] inverse [0:COUNT-1];

  integer sent = 0, changed = 0, found = 0, wrong = 0, clocks = 0, seed = 1;

  // Halfway between rising edges: looks at what came, and hands over the next.
  task step(input send);
    begin
      @(negedge clock);
      clocks = clocks + 1;
      if (change_valid) begin
        if ({changes, in_limits} !== forward[changed][<changes_bits>:0]
            || change_last !== (changed % <sections> == <last_section>)) begin
          $display("forward, section %0d: %h is not %h", changed, {changes, in_limits},
              forward[changed][<changes_bits>:0]);
          wrong = wrong + 1;
        end
        changed = changed + 1;
      end
      if (found_valid) begin
        if ({found_x, found_y, states} !== inverse[found][<found_bits>-1:0]
            || found_last !== (found % <sections> == <last_section>)) begin
          $display("inverse, section %0d: %h is not %h", found, {found_x, found_y, states},
              inverse[found][<found_bits>-1:0]);
          wrong = wrong + 1;
        end
        found = found + 1;
      end
      bend_valid = send && sent < COUNT;
      measured_valid = bend_valid;
      bend_first = bend_valid && sent % <sections> == 0;
      measured_first = bend_first;
      if (bend_valid) begin
        {bend_x, bend_y} = forward[sent][<forward_bits>-1 -: 32];
        measured = inverse[sent][<inverse_bits>-1 -: <changes_bits>];
        sent = sent + 1;
      end
    end
  endtask

  // All robots; of a section in `gap` there is none on average.
  task pass(input integer gap);
    begin
      sent = 0; changed = 0; found = 0; clocks = 0;
      while (found < COUNT && clocks < 20 * COUNT) step(gap == 0 || $unsigned($random(seed)) % gap != 0);
      if (changed != COUNT || found != COUNT) begin
        $display("%0d and %0d of %0d sections came", changed, found, COUNT);
        wrong = wrong + 1;
      end
    end
  endtask

  initial begin
<vectors>
    repeat (3) step(1'b0);
    reset = 1'b0;
    pass(0);
    if (clocks != COUNT + <inverse>) begin
      $display("%0d clocks, not %0d", clocks, COUNT + <inverse>);
      wrong = wrong + 1;
    end
    pass(3);
    sent = 0; changed = 0; found = 0;
    repeat (<sections> + <inverse_last>) step(1'b1);  // a reset with sections on their way
    reset = 1'b1;
    step(1'b0);
    reset = 1'b0;
    pass(0);
    if (wrong == 0) $display("PASSED: 3 passes over %0d sections", COUNT);
    else $display("FAILED: %0d differences", wrong);
    $finish;
  end
endmodule
)";

std::string hex(std::int64_t value) { return fmt::format("{:04x}", static_cast<std::uint16_t>(value)); }

std::string hex(const Bend& bend) { return hex(bend.x) + "_" + hex(bend.y); }

/// The last tendon first.
std::string hex(const std::vector<std::int64_t>& changes) {
  std::string text;
  for (std::size_t i = changes.size(); i-- > 0;) text += (text.empty() ? "" : "_") + hex(changes[i]);
  return text;
}

std::string vector_text(std::size_t at, const Vector& vector) {
  std::string states;
  for (std::size_t i = vector.states.size(); i-- > 0;) states += fmt::format("{:02b}", vector.states[i]);
  const std::size_t tendons = vector.changes.size();
  return fmt::format(
      "    forward[{0}] = {{32'h{1}, {2}'h{3}, 1'b{4:d}}}; inverse[{0}] = {{{2}'h{5}, 32'h{6}, {7}'b{8}}};\n",
      at, hex(vector.bend), 16 * tendons, hex(vector.changes), vector.in_limits, hex(vector.measured),
      hex(vector.found), 2 * tendons, states);
}

}  // namespace

std::string bench_text(const ControllerTable& table, const Core& core) {
  const std::vector<Vector> sections = vectors(table);
  std::string lines;
  for (std::size_t i = 0; i < sections.size(); ++i) lines += vector_text(i, sections[i]);
  const int n = table.tendons, count = static_cast<int>(sections.size()),
            of_robot = static_cast<int>(table.sections.size());
  Words words = words_of({{"count", count},
                          {"robots", count / of_robot},
                          {"sections", of_robot},
                          {"last_section", of_robot - 1},
                          {"changes", 16 * n - 1},
                          {"changes_bits", 16 * n},
                          {"states", 2 * n - 1},
                          {"forward_bits", 33 + 16 * n},
                          {"inverse_bits", 32 + 18 * n},
                          {"found_bits", 32 + 2 * n},
                          {"inverse", core.inverse},
                          {"inverse_last", core.inverse - 1}});
  words["robot"] = core.name;
  words["tolerance"] = signed_text(table.short_tolerance());
  words["vectors"] = lines;
  return filled(bench_module, words);
}

}  // namespace sinew::inline v1::verilog

/// @file streams.hpp
/// Modules of a core that a user sees: forward, inverse with states, and both together.
#pragma once
#include <string_view>

namespace sinew::inline v1::verilog {

/// Sections that are alike have a share of 1: the bends themselves are summed up.
constexpr std::string_view alike_forward = R"(
  wire at_taken = taken, at_first = in_first;
  wire [<index>:0] at = section;
  wire signed [15:0] x = in_x, y = in_y;
  assign in_limits = holds;
)";
constexpr std::string_view unlike_forward = R"(
  reg signed [15:0] share;  // the section's gain over the greatest
  always @(*)
    case (section)
<share_cases>
    endcase
  wire at_taken = valid[2], at_first;
  wire [<index>:0] at;
  wire signed [15:0] x, y;
  <robot>_share #(.BITS(<share_bits>)) shared (
      .clock(clock), .share(share), .x(in_x), .y(in_y), .shared_x(x), .shared_y(y));
  <robot>_delay #(.WIDTH(<place_bits>), .CLOCKS(3)) place (
      .clock(clock), .now({section, in_first}), .later({at, at_first}));
  <robot>_delay #(.WIDTH(1), .CLOCKS(3)) judged (.clock(clock), .now(holds), .later(in_limits));
)";

constexpr std::string_view forward_module = R"(
// Changes of tendons from bends, a section a clock, <forward> clocks later.
module <robot>_forward (
  input  wire clock, reset,
  input  wire in_valid, in_first,
  input  wire signed [15:0] in_x, in_y,
  output wire out_valid, out_last,
  output wire [<changes>:0] out_changes,
  output wire in_limits  // all sections so far
);
  wire taken, last, holds;
  wire [<index>:0] section;
  reg [<forward_last>:0] valid, ends;
  <robot>_walk walk (.clock(clock), .reset(reset), .valid(in_valid), .first(in_first),
      .taken(taken), .last(last), .section(section));
  <robot>_limits limits (.clock(clock), .taken(taken), .first(in_first), .section(section),
      .x(in_x), .y(in_y), .holds(holds));
<forward_shares>
  // Modulo 2^16; within limits nothing wraps. Kept: Yosys 0.23 loses a sum that it packs into the multiplier's cell.
  (* keep = "true" *) reg signed [15:0] sum_x, sum_y;
  always @(posedge clock)
    if (at_taken) begin
      sum_x <= (at_first ? 16'sd0 : sum_x) + x;
      sum_y <= (at_first ? 16'sd0 : sum_y) + y;
    end
  <robot>_tendons tendons (.clock(clock), .section(at), .x(sum_x), .y(sum_y), .changes(out_changes));

  always @(posedge clock) begin
    valid <= reset ? <forward>'d0 : {valid[<forward_rest>:0], taken};
    ends <= {ends[<forward_rest>:0], last};
  end
  assign out_valid = valid[<forward_last>];
  assign out_last = ends[<forward_last>];
endmodule
)";

constexpr std::string_view alike_inverse = R"(
  <robot>_delay #(.WIDTH(32), .CLOCKS(4)) found (
      .clock(clock), .now({own_y, own_x}), .later({out_y, out_x}));
)";
constexpr std::string_view unlike_inverse = R"(
  reg signed [15:0] share;  // the greatest gain over the section's
  wire [<index>:0] at;
  wire signed [15:0] x, y;
  always @(*)
    case (at)
<inverse_cases>
    endcase
  <robot>_delay #(.WIDTH(<index_bits>), .CLOCKS(1)) own_place (.clock(clock), .now(at_row), .later(at));
  <robot>_share #(.BITS(<own_bits>)) own (
      .clock(clock), .share(share), .x(own_x), .y(own_y), .shared_x(x), .shared_y(y));
  <robot>_delay #(.WIDTH(32), .CLOCKS(1)) found (.clock(clock), .now({y, x}), .later({out_y, out_x}));
)";

constexpr std::string_view inverse_module = R"(
// Bends and states of tendons from their changes, a section a clock, <inverse> clocks later.
module <robot>_inverse (
  input  wire clock, reset,
  input  wire in_valid, in_first,
  input  wire [<changes>:0] in_changes,
  input  wire signed [15:0] tolerance,
  output wire out_valid, out_last,
  output wire signed [15:0] out_x, out_y,
  output wire [<states>:0] out_states
);
  wire taken, last, at_first;
  wire [<index>:0] section, at_row;
  reg [<inverse_last>:0] valid, ends;
  <robot>_walk walk (.clock(clock), .reset(reset), .valid(in_valid), .first(in_first),
      .taken(taken), .last(last), .section(section));
  always @(posedge clock) begin
    valid <= reset ? <inverse>'d0 : {valid[<inverse_rest>:0], taken};
    ends <= {ends[<inverse_rest>:0], last};
  end
  assign out_valid = valid[<inverse_last>];
  assign out_last = ends[<inverse_last>];

  // A section's bend is what its sum has beyond that of the section before.
  wire signed [15:0] sum_x, sum_y, own_x, own_y;
  reg signed [15:0] before_x, before_y;
  <robot>_nearest nearest (.clock(clock), .section(section), .changes(in_changes), .x(sum_x), .y(sum_y));
  <robot>_delay #(.WIDTH(1), .CLOCKS(<nearest>)) begins (.clock(clock), .now(in_first), .later(at_first));
  <robot>_difference beyond_x (.a(sum_x), .b(at_first ? 16'sd0 : before_x), .result(own_x));
  <robot>_difference beyond_y (.a(sum_y), .b(at_first ? 16'sd0 : before_y), .result(own_y));
  always @(posedge clock)
    if (valid[<before_nearest>]) begin
      before_x <= sum_x;
      before_y <= sum_y;
    end
<inverse_shares>
  // A tendon's state is what it has beyond the change that this sum asks of it.
  wire [<changes>:0] asked, measured;
  <robot>_delay #(.WIDTH(<index_bits>), .CLOCKS(<before_nearest>)) place (.clock(clock), .now(section), .later(at_row));
  <robot>_delay #(.WIDTH(<changes_bits>), .CLOCKS(<asked>)) kept (
      .clock(clock), .now(in_changes), .later(measured));
  <robot>_tendons tendons (.clock(clock), .section(at_row), .x(sum_x), .y(sum_y), .changes(asked));
  genvar i;
  generate
    for (i = 0; i < <tendons>; i = i + 1) begin : tendon
      <robot>_state judge (.clock(clock), .measured(measured[16*i +: 16]), .asked(asked[16*i +: 16]),
          .tolerance(tolerance), .state(out_states[2*i +: 2]));
    end
  endgenerate
endmodule
)";

constexpr std::string_view core_module = R"(
module <robot>_core (
  input  wire clock, reset,  // synchronous
  // Bends of the sections, base first, to changes of their tendons.
  input  wire bend_valid, bend_first,
  input  wire signed [15:0] bend_x, bend_y,
  output wire change_valid, change_last,
  output wire [<changes>:0] changes,
  output wire in_limits,  // with the last section: the whole robot
  // Changes as encoders read them to bends, and to states of tendons.
  input  wire measured_valid, measured_first,
  input  wire [<changes>:0] measured,
  input  wire signed [15:0] tolerance,  // <tolerance> as the robot's file says; hold it still
  output wire found_valid, found_last,
  output wire signed [15:0] found_x, found_y,
  output wire [<states>:0] states  // 0 exact, 1 slack, 2 over-tensioned
);
  <robot>_forward forward (.clock(clock), .reset(reset), .in_valid(bend_valid), .in_first(bend_first),
      .in_x(bend_x), .in_y(bend_y), .out_valid(change_valid), .out_last(change_last), .out_changes(changes),
      .in_limits(in_limits));
  <robot>_inverse inverse (.clock(clock), .reset(reset), .in_valid(measured_valid), .in_first(measured_first),
      .in_changes(measured), .tolerance(tolerance), .out_valid(found_valid), .out_last(found_last),
      .out_x(found_x), .out_y(found_y), .out_states(states));
endmodule
)";

}  // namespace sinew::inline v1::verilog

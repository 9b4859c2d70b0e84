/// @file limits.hpp
/// Modules of a core that judge: bends against their limits, tendons against what the bend asks.
#pragma once
#include <string_view>

namespace sinew::inline v1::verilog {

/// Of sections with twin pivots alone: no squares.
constexpr std::string_view square_limits_module = R"(
// Whether all bends of a robot so far are within their limits. Three clocks.
module <robot>_limits (
  input  wire clock, taken, first,
  input  wire [<index>:0] section,
  input  wire signed [15:0] x, y,
  output reg  holds
);
  reg signed [15:0] of_x, of_y, limit;
  reg fits;
  reg [1:0] is_taken, is_first;
  always @(posedge clock) begin
    of_x <= x;
    of_y <= y;
    case (section)
<limit_cases>
    endcase
    fits <= of_x <= limit && of_x >= -limit && of_y <= limit && of_y >= -limit;
    is_taken <= {is_taken[0], taken};
    is_first <= {is_first[0], first};
    if (is_taken[1]) holds <= fits && (is_first[1] || holds);
  end
endmodule
)";

/// Of a section with a neutral backbone the square of its bend counts, too.
constexpr std::string_view disc_limits_module = R"(
// Whether all bends of a robot so far are within their limits. Three clocks.
module <robot>_limits (
  input  wire clock, taken, first,
  input  wire [<index>:0] section,
  input  wire signed [15:0] x, y,
  output reg  holds
);
  reg signed [15:0] of_x, of_y, limit;
  reg [31:0] square, square_most;  // of the limit
  reg round, is_round, fits;       // a neutral backbone: the bend itself is limited, not x and y alone
  reg [31:0] x_x, y_y;
  reg [1:0] is_taken, is_first;
  always @(posedge clock) begin
    of_x <= x;
    of_y <= y;
    case (section)
<limit_cases>
    endcase
    fits <= of_x <= limit && of_x >= -limit && of_y <= limit && of_y >= -limit;
    x_x <= of_x * of_x;
    y_y <= of_y * of_y;
    is_round <= round;
    square_most <= square;
    is_taken <= {is_taken[0], taken};
    is_first <= {is_first[0], first};
    if (is_taken[1]) holds <= fits && (!is_round || x_x + y_y <= square_most) && (is_first[1] || holds);
  end
endmodule
)";

constexpr std::string_view state_module = R"(
// What a tendon has beyond what the bend asks of it: 0 exact, 1 slack, 2 over-tensioned. Two clocks.
module <robot>_state (
  input  wire clock,
  input  wire signed [15:0] measured, asked, tolerance,
  output reg  [1:0] state
);
  wire signed [15:0] difference, less;
  reg signed [15:0] slack;
  <robot>_difference beyond (.a(measured), .b(asked), .result(difference));
  <robot>_difference negated (.a(16'sd0), .b(tolerance), .result(less));
  always @(posedge clock) begin
    slack <= difference;
    state <= slack > tolerance ? 2'd1 : slack < less ? 2'd2 : 2'd0;
  end
endmodule
)";

}  // namespace sinew::inline v1::verilog

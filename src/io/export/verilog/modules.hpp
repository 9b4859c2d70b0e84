/// @file modules.hpp
/// The modules of a core in Verilog-2005, as text with <words> for what differs from robot to robot.
/// Theory: docs/theory/controller.md
#pragma once
#include <string_view>

namespace sinew::inline v1::verilog {

constexpr std::string_view walk_module = R"(
// Which section a stream is at. `first` begins a robot anew, whatever came before; what follows a robot's last
// section without a `first` is dropped.
module <robot>_walk (
  input  wire clock, reset, valid, first,
  output wire taken, last,
  output wire [<index>:0] section
);
  reg going;
  reg [<index>:0] next;
  assign section = first ? <index_bits>'d0 : next;
  assign taken = valid && (first || going);
  assign last = section == <index_bits>'d<last_section>;
  always @(posedge clock)
    if (reset) going <= 1'b0;
    else if (taken) begin
      going <= !last;
      next <= section + <index_bits>'d1;
    end
endmodule
)";

constexpr std::string_view delay_module = R"(
// The same, so many clocks later; at least 1.
module <robot>_delay #(parameter WIDTH = 1, CLOCKS = 1) (
  input  wire clock,
  input  wire [WIDTH-1:0] now,
  output wire [WIDTH-1:0] later
);
  reg [CLOCKS*WIDTH-1:0] line;
  generate
    if (CLOCKS == 1) always @(posedge clock) line <= now;
    else always @(posedge clock) line <= {line[(CLOCKS-1)*WIDTH-1:0], now};
  endgenerate
  assign later = line[CLOCKS*WIDTH-1:(CLOCKS-1)*WIDTH];
endmodule
)";

constexpr std::string_view fitted_module = R"(
// Fewer bits behind the point, rounded to nearest, halves upwards; what does not fit 16 bits saturates.
module <robot>_fitted #(parameter DOWN = 1) (
  input  wire signed [31:0] value,
  output wire signed [15:0] result
);
  wire signed [31:0] half = {31'd0, value[DOWN-1]}, rounded = (value >>> DOWN) + half;
  assign result = rounded > 32'sd32767 ? 16'h7fff : rounded < -32'sd32768 ? 16'h8000 : rounded[15:0];
endmodule

// a - b; what does not fit saturates.
module <robot>_difference (
  input  wire signed [15:0] a, b,
  output wire signed [15:0] result
);
  wire signed [16:0] whole = {a[15], a} - {b[15], b};
  assign result = whole[16] == whole[15] ? whole[15:0] : whole[16] ? 16'h8000 : 16'h7fff;
endmodule
)";

constexpr std::string_view product_module = R"(
// A number by a factor that needs BITS bits. One clock. As wide as it can be and no wider: Yosys 0.23 loses signs of
// products that it packs with a wider register into a multiplier's cell.
module <robot>_product #(parameter BITS = 16) (
  input  wire clock,
  input  wire signed [15:0] factor, number,
  output wire signed [31:0] product
);
  wire signed [BITS-1:0] narrow = factor[BITS-1:0];
  reg signed [BITS+15:0] exact;
  always @(posedge clock) exact <= narrow * number;
  assign product = {{16-BITS{exact[BITS+15]}}, exact};
endmodule
)";

constexpr std::string_view share_module = R"(
// A bend by its section's share of the greatest gain, or by the inverse of that, Q2.13. Three clocks.
module <robot>_share #(parameter BITS = 16) (
  input  wire clock,
  input  wire signed [15:0] share, x, y,
  output reg  signed [15:0] shared_x, shared_y
);
  reg signed [15:0] factor, of_x, of_y;
  wire signed [31:0] product_x, product_y;
  wire signed [15:0] fitted_x, fitted_y;
  <robot>_product #(.BITS(BITS)) of_share_x (.clock(clock), .factor(factor), .number(of_x), .product(product_x));
  <robot>_product #(.BITS(BITS)) of_share_y (.clock(clock), .factor(factor), .number(of_y), .product(product_y));
  <robot>_fitted #(.DOWN(13)) fit_x (.value(product_x), .result(fitted_x));
  <robot>_fitted #(.DOWN(13)) fit_y (.value(product_y), .result(fitted_y));
  always @(posedge clock) begin
    factor <= share;
    of_x <= x;
    of_y <= y;
    shared_x <= fitted_x;
    shared_y <= fitted_y;
  end
endmodule
)";

constexpr std::string_view tendons_module = R"(
// Changes of a section's tendons by the sums of bends up to it: a X + b Y, rounded to nearest, halves upwards, modulo
// 2^16. `section` comes a clock before its sums, `changes` two clocks after them.
module <robot>_tendons (
  input  wire clock,
  input  wire [<index>:0] section,
  input  wire signed [15:0] x, y,
  output wire [<changes>:0] changes
);
  localparam [<changes>:0] BITS = {<row_bits>};  // of each column
  reg [<pairs>:0] row;  // -g (cos d, sin d) in mm/2^<row>; of each tendon {b, a}, the last tendon first
  always @(posedge clock)
    case (section)
<row_cases>
    endcase
  genvar i;
  generate
    for (i = 0; i < <tendons>; i = i + 1) begin : tendon
      wire signed [31:0] a_x, b_y;
      <robot>_product #(.BITS(BITS[16*i +: 8])) of_a (
          .clock(clock), .factor(row[32*i +: 16]), .number(x), .product(a_x));
      <robot>_product #(.BITS(BITS[16*i+8 +: 8])) of_b (
          .clock(clock), .factor(row[32*i+16 +: 16]), .number(y), .product(b_y));
      wire [31:0] sum = a_x + b_y + 32'sd32768;
      reg [15:0] change;
      always @(posedge clock) change <= sum[31:16];
      assign changes[16*i +: 16] = change;
    end
  endgenerate
endmodule
)";

constexpr std::string_view total_module = R"(
// The sum of a product of each tendon, in <levels> clocks. No more bits than it takes, as in a product.
module <robot>_total_<axis> (
  input  wire clock,
  input  wire [<pairs>:0] products,
  output wire signed [31:0] sum
);
<tree>
endmodule
)";

constexpr std::string_view nearest_module = R"(
// The sums of bends that come nearest to the changes of a section's tendons. <nearest> clocks.
module <robot>_nearest (
  input  wire clock,
  input  wire [<index>:0] section,
  input  wire [<changes>:0] changes,
  output reg  signed [15:0] x, y
);
  localparam [<changes>:0] BITS = {<back_bits>};  // of each column
  reg [<pairs>:0] back;  // -2/(n g) (cos d, sin d) in 1/2^<back> mm; {y, x}, the last tendon first
  reg [<changes>:0] of;
  always @(posedge clock) begin
    of <= changes;
    case (section)
<back_cases>
    endcase
  end
  wire [<pairs>:0] products_x, products_y;
  genvar i;
  generate
    for (i = 0; i < <tendons>; i = i + 1) begin : tendon
      <robot>_product #(.BITS(BITS[16*i +: 8])) to_x (.clock(clock), .factor(back[32*i +: 16]),
          .number(of[16*i +: 16]), .product(products_x[32*i +: 32]));
      <robot>_product #(.BITS(BITS[16*i+8 +: 8])) to_y (.clock(clock), .factor(back[32*i+16 +: 16]),
          .number(of[16*i +: 16]), .product(products_y[32*i +: 32]));
    end
  endgenerate
  wire signed [31:0] total_x, total_y;
  <robot>_total_x sum_x (.clock(clock), .products(products_x), .sum(total_x));
  <robot>_total_y sum_y (.clock(clock), .products(products_y), .sum(total_y));
  wire signed [15:0] fitted_x, fitted_y;
  <robot>_fitted #(.DOWN(<back_down>)) fit_x (.value(total_x), .result(fitted_x));
  <robot>_fitted #(.DOWN(<back_down>)) fit_y (.value(total_y), .result(fitted_y));
  always @(posedge clock) begin
    x <= fitted_x;
    y <= fitted_y;
  end
endmodule
)";

}  // namespace sinew::inline v1::verilog
